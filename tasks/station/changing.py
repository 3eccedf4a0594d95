"""How the programs of a station are improved: one robot after the other, beside the others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import spelt
from ...core.errors import FlybyError, InputError, Note, OptionError
from ..options.entries import MILLISECONDS, Extent, TaskOptions, number, switch, value
from ..options.moves import is_named
from ..setup import setup_of_program, start_of
from .opening import OpenedStation, is_station_file, open_station
from .station import JITTER

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ...problems.improve.solution import Solution
    from ...problems.improve.solve_round_verify import Beside
    from ...problems.improve.station.feasibility import StationFeasibility
    from .changed import ChangedStation

Later = Callable[["StationFeasibility", "Mapping[str, Share]", "dict[str, Solution]"], None]
"""What is done when all robots are improved: it may put other solutions in the place of these."""
Improve = Callable[["Program", "Share", "Beside"], "Solution"]
"""Makes of a robot's program a better one, beside the others."""


@dataclass(frozen=True, kw_only=True)
class StationChangeOptions(TaskOptions):
    """What must stay in the programs of a station."""

    keep: Sequence[str] = value(
        (),
        "Moves that stay: ROBOT.WHICH, or of all robots that have it the name of a target or of a "
        "speed; may be given several times.",
        several=True,
    )
    free: Sequence[str] = value(
        (),
        "Stops that may be passed: ROBOT.WHICH, the name of a target, or 'all'; may be given "
        "several times.",
        several=True,
    )
    jitter: float = number(
        JITTER,
        "{unit} by which each robot may be early or late where times alone keep robots apart.",
        MILLISECONDS,
        Extent(0.0, 10_000.0),
    )
    own: bool = switch("Moves that share one datum, or compute it, get one of their own.")


@dataclass(frozen=True)
class Share:
    """What options say of one robot of a station.

    Args:
        name: of the robot.
        keep, free: as options of commands on one program have them.
    """

    name: str
    keep: tuple[str, ...]
    free: tuple[str, ...]


def changed_station(
    source: str | Path,
    options: StationChangeOptions,
    improve: Improve,
    later: Later | None = None,
) -> ChangedStation:
    """A station whose programs are improved, the robot that ends last first.

    Args:
        source: a station file.
        options: what stays.
        improve: what is done to each.
        later: what is done to all behind that.

    Raises:
        InputError: a file cannot be read, or an option names nothing.
        MotionError: the station never ends, or does not keep its clearances, as it is.
    """
    from .changed import ChangedStation, refuse_unwritable

    if not is_station_file(Path(source)):
        raise InputError(f"{source}: programs of station files (.toml) are improved together")
    opened = open_station(Path(source), options.say)
    refuse_unwritable(Path(source), opened.station.members)
    shares = _shares(opened, options)
    members = opened.station.members
    feasibility = feasibility_of(opened, options.jitter, options.say)
    ends = feasibility.state.run.schedules
    solutions: dict[str, Solution] = {}
    notes = [*opened.notes, *opened.unknown]
    for name in sorted(members, key=lambda name: -ends[name].end):
        member = members[name]
        options.say(f"improving {name}")
        try:
            made = improve(member.program, shares[name], feasibility.beside(name))
        except FlybyError as error:
            notes.append(Note(f"{name} stays as it is: {error}"))
            continue
        if made.changed:
            run = member.controller.run(member.carrying(made.program), start_of(made.program))
            if not feasibility.take(name, run):
                notes.append(Note(f"{name} stays as it is: beside the others it does not hold"))
                continue
        solutions[name] = made
        notes += [replace(note, message=f"{name}: {note.message}") for note in made.notes]
    if later is not None:
        later(feasibility, shares, solutions)
    return ChangedStation(
        Path(source),
        opened.station,
        feasibility.given,
        feasibility.state,
        {name: solutions[name] for name in members if name in solutions},
        tuple(notes),
    )


def feasibility_of(
    opened: OpenedStation, jitter: float, say: Callable[[str], None]
) -> StationFeasibility:
    """What a station has to stand while one of its robots is otherwise.

    Args:
        opened: the station.
        jitter: s by which each robot may be early or late where times alone keep robots apart.
        say: told what is being done.

    Raises:
        InputError, MotionError: as `StationFeasibility`.
    """
    from ...problems.improve.station.feasibility import StationFeasibility

    words = {}
    for name, member in opened.station.members.items():
        speaks = setup_of_program(member.program).vendor.speaks
        words[name] = None if speaks is None else speaks.signals
    say("sweeping motions")
    return StationFeasibility(opened.station, words, not opened.unknown, jitter, say)


def _shares(opened: OpenedStation, options: StationChangeOptions) -> dict[str, Share]:
    """What options say of each robot.

    Raises:
        OptionError: one is a number or a line, and does not say of which robot.
        InputError: one names nothing of any robot.
    """
    from ..changes import freed_stops, kept_moves

    asked: dict[str, Callable[[Program, str], object]] = {
        "keep": lambda program, text: kept_moves(program, [text]),
        "free": lambda program, text: freed_stops(program, setup_of_program(program), [text], ()),
    }
    found: dict[str, dict[str, list[str]]] = {
        name: {"keep": [], "free": []} for name in opened.station.members
    }
    for option, resolved in asked.items():
        for text in map(str, getattr(options, option)):
            robot, dot, rest = text.partition(".")
            if dot and robot in found:
                try:
                    resolved(opened.station.members[robot].program, rest)
                except InputError as error:
                    raise type(error)(f"{robot}: {error}") from None
                found[robot][option].append(rest)
                continue
            if is_named(text):
                raise OptionError(
                    f"{spelt(option)} {text}: of which robot? Write {next(iter(found))}.{text}"
                )
            failed: InputError | None = None
            before = sum(len(one[option]) for one in found.values())
            for name, member in opened.station.members.items():
                try:
                    resolved(member.program, text)
                    found[name][option].append(text)
                except InputError as error:
                    failed = error
            if failed is not None and sum(len(one[option]) for one in found.values()) == before:
                raise failed
    return {
        name: Share(name, tuple(one["keep"]), tuple(one["free"])) for name, one in found.items()
    }
