"""The programs of a station made faster where that makes the station faster, else slower."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import spelt
from ...core.errors import InputError, UnknownNameError
from ..changes import kept_moves, process_of, targets_of
from ..files.texts import ProgramTexts
from ..optimize import OptimizeOptions, optimize_beside
from ..options.entries import ANGLE, COUNT, Extent, number, switch, value
from ..options.keywords import by_keywords
from ..setup import setup_of_program, start_of
from .changing import Share, StationChangeOptions, changed_station

if TYPE_CHECKING:
    from ...core.collision.proof.certificate import SceneOf
    from ...core.collision.proof.verdict import Certificate
    from ...core.motion.emulator.run import Run
    from ...core.program.program import Program
    from ...core.source.reading import Files
    from ...core.station.station import StationRobot
    from ...problems.improve.solution import Solution
    from ...problems.improve.solve_round_verify import Beside
    from ...problems.improve.station.feasibility import StationFeasibility
    from .changed import ChangedStation


@dataclass(frozen=True, kw_only=True)
class StationOptimizeOptions(StationChangeOptions):
    """How the programs of a station are made better."""

    zones_only: bool = switch("Change zones and speeds alone; every point stays.")
    predefined: bool = switch("Choose among the vendor's predefined zones.")
    release: Sequence[str] = value(
        (),
        "Output that only gives space free, ROBOT.OUTPUT, and may be set earlier; may be given "
        "several times.",
        several=True,
    )
    full_speed: bool = switch("Robots that would wait are not driven slower.")
    tilt: float = number(
        0.0,
        "By how much the tool may be turned at via points, {unit}.",
        ANGLE,
        Extent(0.0, 180.0),
    )
    starts: int | None = number(
        None, "Paths to start from; more find better routes.", COUNT, Extent(1)
    )
    generations: int | None = number(
        None, "How often the best path is varied in turn; 0 is quickest.", COUNT, Extent(0)
    )
    seed: int = number(0, "Of the variations of the path.", COUNT, Extent(0))


def station_optimize_with(source: str | Path, options: StationOptimizeOptions) -> ChangedStation:
    """Make a station faster, and robots that would wait slower, and prove the station.

    Via points and zones of each robot are sought as `optimize` seeks them, beside the other
    robots. Then outputs that only give space free are set as early as is proven, before moves that
    are driven earlier, and robots that would wait drive slower, so that the wait is short.

    Args:
        source: a station file.

    Returns:
        The new programs, read back from their texts, proven each in its cell and beside the others.

    Raises:
        InputError: a file cannot be read, or an option names nothing.
        MotionError: the station never ends, or does not keep its clearances, as it is.
    """

    def faster(program: Program, share: Share, beside: Beside) -> Solution:
        wanted = OptimizeOptions(
            keep=share.keep,
            free=share.free,
            own=options.own,
            zones_only=options.zones_only,
            predefined=options.predefined,
            tilt=options.tilt,
            starts=options.starts,
            generations=options.generations,
            seed=options.seed,
            report=options.report,
        )
        return optimize_beside(program, wanted, beside)

    def later(
        feasibility: StationFeasibility, shares: Mapping[str, Share], solutions: dict[str, Solution]
    ) -> None:
        released = _released(feasibility, options.release)
        for name in feasibility.state.station.members:
            if released:
                options.say(f"looking for outputs of {name} that may come earlier")
                _release(feasibility, name, solutions, released)
        for name in feasibility.state.station.members:
            if not options.full_speed:
                options.say(f"looking for waits of {name} that slower moves shorten")
                _slow(feasibility, shares[name], solutions, options.jitter)

    return changed_station(source, options, faster, later)


station_optimize = by_keywords(station_optimize_with, StationOptimizeOptions)


def _released(feasibility: StationFeasibility, given: Sequence[str]) -> frozenset[str]:
    """Keys of the outputs that may come earlier.

    Raises:
        InputError: one is no output that another robot waits for.
    """
    from ...core.program.signal import SetSignal
    from ...core.station.station import signal_key

    known = {
        signal_key(f"{name}.{action.does.name}"): f"{name}.{action.does.name}"
        for name, doings in feasibility.state.ordered.items()
        for action in doings
        if isinstance(action.does, SetSignal)
    }
    for text in map(str, given):
        if signal_key(text) not in known:
            error = UnknownNameError("output that others wait for", text, known.values())
            raise InputError(f"{spelt('release')}: {error}")
    return frozenset(map(signal_key, map(str, given)))


def _release(
    feasibility: StationFeasibility,
    name: str,
    solutions: dict[str, Solution],
    outputs: frozenset[str],
) -> None:
    """Set a robot's outputs as early as is proven."""
    from ...core.source.patch.edits import reading_of
    from ...problems.improve.station.releases import EarlierReleases

    member = feasibility.state.station.members[name]

    def reread(program: Program, files: Files) -> Program:
        return replace(reading_of(program).again(files), setup=member.program.setup)

    speaks = setup_of_program(member.program).vendor.speaks
    wording = None if speaks is None else speaks.wording
    earlier = EarlierReleases(
        feasibility,
        name,
        _scenes(member),
        start_of(member.program),
        reread,
        outputs,
        str if wording is None else wording.quiet,
    )
    for run, certificate, files in earlier.run():
        _put(feasibility, name, solutions, run, certificate, files)


def _scenes(member: StationRobot) -> SceneOf:
    """Of a robot's program in its own cell."""
    from ...core.collision.handled_scenes import scenes_along

    return scenes_along(
        member.cell,
        member.handling,
        member.program,
        lambda: member.run.path,
        member.cell.clearance,
    )


def _slow(
    feasibility: StationFeasibility, share: Share, solutions: dict[str, Solution], reserve: float
) -> None:
    """Put a slower program in the place of a robot's, where it would wait else."""
    from ...problems.improve.station.slowing import Slowing
    from ...problems.improve.waypoints import WaypointTask

    member = feasibility.state.station.members[share.name]
    setup = setup_of_program(member.program)
    moves, speeds = kept_moves(member.program, share.keep)
    texts = ProgramTexts(setup, member.program, own=True)

    def read_back(changed: Program) -> Program:
        return member.carrying(texts.read_back(member.bare(changed)))

    found = Slowing(
        feasibility,
        share.name,
        _scenes(member),
        setup.vendor.speaks,
        WaypointTask(
            keep=moves,
            keep_speeds=speeds,
            process=process_of(member.program, setup, share.free, targets_of(member.handling)),
        ),
        start_of(member.program),
        reserve,
    ).run(read_back)
    if found is not None and feasibility.take(share.name, found[0]):
        _put(feasibility, share.name, solutions, *found, texts.last)


def _put(
    feasibility: StationFeasibility,
    name: str,
    solutions: dict[str, Solution],
    run: Run,
    certificate: Certificate,
    texts: Files,
) -> None:
    """A robot's solution with a program that was made of it."""
    from ...problems.improve.solution import Solution, measure

    given, known = feasibility.given.station.members[name], solutions.get(name)
    solutions[name] = Solution(
        given.program,
        given.bare(run.program),
        measure(given.controller, given.run) if known is None else known.before,
        measure(given.controller, run, certificate),
        certificate,
        () if known is None else known.notes,
        () if known is None else known.moved,
        {**({} if known is None else known.texts), **texts},
    )
