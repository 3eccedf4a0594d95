"""What the time of a run is lost to, and what each cause would give back if it fell away."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...core.driving.driven_program import DrivenPart, DrivenProgram
from ...core.driving.without_limits import seconds_without
from ...core.errors import MotionError, Span
from ...core.motion.emulator.binding_limits import limit_seconds
from ...core.motion.emulator.controller import Controller
from ...core.program.program import Program
from .report import Report, seconds
from .shares import standing

if TYPE_CHECKING:
    from ...core.program.zone import Zone

COLUMNS = (
    ("what holds the program back", "left"),
    ("time\ns", "right"),
    ("%", "right"),
    ("without it\ns", "right"),
    ("moves", "right"),
    ("most of it at line", "right"),
)
WAITS, DEVICES, SETTLING = "waits of the program", "devices", "settling"
PlaceOf = Callable[[Span], str]
_WORTH = 0.005
"""Share of the time that a cause gives back at least to be looked at first."""
_SAID = {"corner": "the speed in corners", "settling": "settling at stops"}
SMALLEST = 0.002
"""Share of the time below which a limit is not looked into."""
PASSED = 0.01
"""m, the zone that stops are tried with."""


@dataclass(frozen=True, slots=True)
class TimeCause:
    """Something that a run loses time to.

    Args:
        name: of the limit that binds, as moves name it; or waits, devices, settling, stops.
        time: s that it takes or binds for; None for stops, whose time is that of limits.
        gain: s that the run would be shorter if this alone fell away: the same path is stamped
            again without it; of stops, the path is planned again. None where that is not known.
        moves: numbers of the moves that lose time to it.
        span: of the line that loses most; None where that is not known.
    """

    name: str
    time: float | None
    gain: float | None
    moves: tuple[int, ...]
    span: Span | None


@dataclass(frozen=True)
class _Account:
    """s by cause, move and line."""

    spent: dict[str, dict[tuple[int, Span | None], float]]

    def add(self, name: str, move: int, span: Span | None, time: float) -> None:
        if time > 0.0:
            by_place = self.spent.setdefault(name, {})
            by_place[move, span] = by_place.get((move, span), 0.0) + time


def causes_of(
    controller: Controller, driven: DrivenProgram, report: Report, zone: Zone
) -> tuple[TimeCause, ...]:
    """What the time of a run is lost to, what gives back most first.

    Args:
        controller: that drove it.
        driven: the run.
        report: of it.
        zone: that stops are passed in for a trial.
    """
    names, account = controller.robot.axis_names, _Account({})
    for part in driven.parts:
        for segment, by_name in enumerate(limit_seconds(part.run, names)):
            for name, time in by_name.items():
                index = part.first + part.run.path.route.moves[segment]
                account.add(name, index + 1, driven.program.moves[index].statement, time)
    found = [
        _cause(name, by_place, _gain(controller, driven.parts, name))
        for name, by_place in account.spent.items()
        if sum(by_place.values()) >= SMALLEST * report.driven_time
    ]
    found += [*_rests(driven.program, report), *_stops(controller, driven, zone)]
    return tuple(sorted(found, key=lambda cause: -(cause.gain or 0.0)))


def _gain(controller: Controller, parts: Sequence[DrivenPart], name: str) -> float | None:
    gains = [seconds_without(controller, part.run, name) for part in parts]
    known = [gain for gain in gains if gain is not None]
    return sum(known) if known else None


def _cause(
    name: str, by_place: dict[tuple[int, Span | None], float], gain: float | None
) -> TimeCause:
    by_line: dict[Span | None, float] = {}
    for (_, span), time in by_place.items():
        by_line[span] = by_line.get(span, 0.0) + time
    most = max(by_line, key=lambda span: by_line[span])
    moves = sorted({move for move, _ in by_place})
    return TimeCause(name, sum(by_place.values()), gain, tuple(moves), most)


def _rests(program: Program, report: Report) -> Iterator[TimeCause]:
    """Standing still: all of it would be given back, as the stops stay."""
    account = _Account({})
    first = next((move.number for move in report.moves if move.driven), 1)
    for wait, done in standing(program, report):
        move = done or first
        span = wait.span or report.moves[move - 1].span
        account.add(DEVICES if wait.device else WAITS, move, span, wait.duration)
    for row in report.moves:
        account.add(SETTLING, row.number, row.span, row.settling)
    for name, by_place in account.spent.items():
        yield _cause(name, by_place, sum(by_place.values()))


def _stops(controller: Controller, driven: DrivenProgram, zone: Zone) -> Iterator[TimeCause]:
    """Stops that are only programmed: what it would give back to pass them."""
    from ...core.program.zone import zone_shown
    from ...problems.improve.zones.points import passable_stops

    gained, stops = 0.0, []
    for part in driven.parts:
        program = part.run.program
        passable = [i for i in passable_stops(program) if i in part.run.path.route.moves]
        moves = list(program.moves)
        for index in passable:
            moves[index] = replace(moves[index], zone=zone)
        if not passable:
            continue
        try:
            changed = program.with_moves(tuple(moves))
            path = controller.plan(changed, part.run.start)
            if path.route.moves != part.run.path.route.moves:
                continue
            gained += part.run.timing.duration - controller.stamp(changed, path).duration
        except MotionError:
            continue
        stops += [part.first + index + 1 for index in passable]
    if stops and gained > 0.0:
        name = f"stops, if passed in zones of {zone_shown(zone)}"
        span = driven.program.moves[stops[0] - 1].statement
        yield TimeCause(name, None, gained, tuple(stops), span)


def first_to_change(
    causes: Sequence[TimeCause], runs: Mapping[Span, int], whole: float, places: PlaceOf
) -> str:
    """What to look at first, in a sentence or two; empty where nothing is worth it.

    Args:
        causes: of a run, what gives back most first.
        runs: how often each line drives.
        whole: s of the run.
        places: a line, short.
    """
    worth = [cause for cause in causes if (cause.gain or 0.0) >= _WORTH * whole > 0.0]
    return " ".join(
        _sentence(cause, word, runs, whole, places)
        for cause, word in zip(worth[:2], ("Look first at", "Then at"), strict=False)
    )


def _sentence(
    cause: TimeCause, word: str, runs: Mapping[Span, int], whole: float, places: PlaceOf
) -> str:
    where = ""
    if cause.span is not None:
        times = runs.get(cause.span, 1)
        often = f", which runs {times} times" if times > 1 else ""
        where = f", most of it at line {places(cause.span)}{often}"
    spent = ""
    if cause.time is not None:
        spent = f", {cause.time:.2f} s of {whole:.2f} s"
    name = _SAID.get(cause.name, cause.name)
    return f"{word} {name}{spent}{where}: without it the cycle would be {cause.gain:.2f} s shorter."


def cause_row(cause: TimeCause, place: str, whole: float) -> tuple[str, ...]:
    """The cells of a cause.

    Args:
        cause: the cause.
        place: of the line that loses most, short.
        whole: s of the run.
    """
    share = "" if cause.time is None or not whole else f"{100 * cause.time / whole:.0f}"
    return (
        cause.name,
        "" if cause.time is None else seconds(cause.time),
        share,
        "" if cause.gain is None else f"{0.0 - cause.gain:.3f}",
        str(len(cause.moves)),
        place,
    )
