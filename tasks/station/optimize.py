"""The programs of a station made faster where that makes the station faster, else slower."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..changes import kept_moves
from ..files.texts import ProgramTexts
from ..optimize import OptimizeOptions, optimize_beside
from ..options.entries import ANGLE, COUNT, Extent, number, switch
from ..options.keywords import by_keywords
from ..setup import setup_of_program, start_of
from .changing import Share, StationChangeOptions, changed_station

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ...problems.improve.solution import Solution
    from ...problems.improve.solve_round_verify import Beside
    from ...problems.improve.station.feasibility import StationFeasibility
    from .changed import ChangedStation


@dataclass(frozen=True, kw_only=True)
class StationOptimizeOptions(StationChangeOptions):
    """How the programs of a station are made better."""

    zones_only: bool = switch("Change zones and speeds alone; every point stays.")
    predefined: bool = switch("Choose among the vendor's predefined zones.")
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
    robots. Then robots that would wait drive slower, so that the wait is short.

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

    def slower(
        feasibility: StationFeasibility, shares: Mapping[str, Share], solutions: dict[str, Solution]
    ) -> None:
        for name in feasibility.state.station.members:
            options.say(f"looking for waits of {name} that slower moves shorten")
            _slow(feasibility, shares[name], solutions, options.jitter)

    return changed_station(source, options, faster, None if options.full_speed else slower)


station_optimize = by_keywords(station_optimize_with, StationOptimizeOptions)


def _slow(
    feasibility: StationFeasibility, share: Share, solutions: dict[str, Solution], reserve: float
) -> None:
    """Put a slower program in the place of a robot's, where it would wait else."""
    from ...core.collision.proof.certificate import scenes_of
    from ...problems.improve.solution import Solution, measure
    from ...problems.improve.station.slowing import Slowing
    from ...problems.improve.waypoints import WaypointTask

    member = feasibility.state.station.members[share.name]
    program, given = member.program, feasibility.given.station.members[share.name]
    setup = setup_of_program(program)
    moves, speeds = kept_moves(program, share.keep)
    texts = ProgramTexts(setup, program, own=True)
    found = Slowing(
        feasibility,
        share.name,
        scenes_of(member.cell),
        setup.vendor.speaks,
        WaypointTask(keep=moves, keep_speeds=speeds),
        start_of(program),
        reserve,
    ).run(texts.read_back)
    if found is None or not feasibility.take(share.name, found[0]):
        return
    run, certificate = found
    known = solutions.get(share.name)
    before = measure(given.controller, given.run) if known is None else known.before
    solutions[share.name] = Solution(
        given.program,
        run.program,
        before,
        measure(given.controller, run, certificate),
        certificate,
        () if known is None else known.notes,
        () if known is None else known.moved,
        {**({} if known is None else known.texts), **texts.last},
    )
