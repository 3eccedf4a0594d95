"""What the lines of a program take, however often each runs."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass, field
from typing import TypeVar

from ...core.errors import Span
from ...core.motion.emulator.binding_limits import LimitShare, shares_of
from ...core.program.move import Wait
from ...core.program.program import Program
from .report import MoveReport, Report, seconds, target_text
from .shares import standing

COLUMNS = (
    ("line", "right"),
    ("move", "left"),
    ("target", "left"),
    ("times", "right"),
    ("time\ns", "right"),
    ("wait and\nsettling, s", "right"),
    ("together\ns", "right"),
    ("%", "right"),
    ("limited by", "left"),
)


T = TypeVar("T")
WAIT, DEVICE = "wait", "device"
_SAME = 1e-9
"""s."""


@dataclass(frozen=True, slots=True)
class LineReport:
    """What one line of the source drives and waits.

    Args:
        span: of it; None where a move has no line, and is one by itself.
        kind: ``MoveJ``, ``MoveL`` or ``MoveC``; ``wait`` or ``device`` of a line that only waits.
        target: where it goes, in words, or how long it waits; ``several`` if it is another one
            each time, ``P[1] to P[3]`` of items of one array.
        times: how often it runs.
        moves: their numbers, from 1; of a line that only waits, those that it stands behind.
        time: s of motion of all of them.
        wait: s of standing still.
        settling: s, see `MoveReport`.
        limits: what holds the speed down, the longest first.
    """

    span: Span | None
    kind: str
    target: str
    times: int
    moves: tuple[int, ...]
    time: float
    wait: float
    settling: float
    limits: tuple[LimitShare, ...]

    @property
    def total(self) -> float:
        """s."""
        return self.time + self.wait + self.settling


@dataclass(slots=True)
class _Line:
    """What stands in one line: moves, waits with the number of the move before each, and s that
    the moves wait without a line of their own."""

    span: Span | None
    moves: list[MoveReport] = field(default_factory=list)
    waits: list[tuple[Wait, int]] = field(default_factory=list)
    unnamed: float = 0.0


def in_lines(things: Iterable[T], said: Callable[[T], tuple[Hashable, ...]]) -> list[list[T]]:
    """Things of which the same is said, in the order of the first: a line that runs six times is
    one row.

    Args:
        things: in their order.
        said: the line of one, and what is said of it; what has no line is a row by itself.
    """
    rows: dict[Hashable, list[T]] = {}
    for thing in things:
        place, *more = said(thing)
        rows.setdefault((place, *more) if place else len(rows), []).append(thing)
    return list(rows.values())


def lines_of(program: Program, report: Report) -> tuple[LineReport, ...]:
    """The lines that drive or wait, in the order in which they do so first."""
    waits = _waits(program, report)
    lines: dict[object, _Line] = {}
    for wait in waits.get(0, ()):
        _at(lines, wait.span, 0).waits.append((wait, 0))
    for move in report.moves:
        own = waits.get(move.number, ())
        if move.driven:
            line = _at(lines, move.span, move.number)
            line.moves.append(move)
            line.unnamed += move.wait - sum(wait.duration for wait in own)
        for wait in own:
            _at(lines, wait.span, move.number).waits.append((wait, move.number))
    return tuple(map(_line, lines.values()))


def _at(lines: dict[object, _Line], span: Span | None, number: int) -> _Line:
    key = number if span is None else (span.file, span.line)
    return lines.setdefault(key, _Line(span))


def _waits(program: Program, report: Report) -> dict[int, list[Wait]]:
    """Waits with a line, by the number of the move in whose row they are; 0 for those before the
    first move."""
    spent = {move.number: move.wait for move in report.moves}
    spent[0] = report.first_wait
    found: dict[int, list[Wait]] = {}
    for wait, done in standing(program, report):
        if wait.span is not None and wait.duration > 0.0:
            found.setdefault(_behind(done, report), []).append(wait)
    return {
        number: own
        for number, own in found.items()
        if sum(wait.duration for wait in own) <= spent.get(number, 0.0) + _SAME
    }


def _behind(done: int, report: Report) -> int:
    """The row of what comes behind so many moves: the last of them in its part that is driven,
    else the one behind which the part begins."""
    before = next((a - 1 for a, b in report.parts if a - 1 <= done <= b), 0)
    driven = (move.number for move in report.moves[before:done][::-1] if move.driven)
    return next(driven, before)


def _line(line: _Line) -> LineReport:
    spent: dict[str, float] = {}
    for move in line.moves:
        for limit in move.limits:
            spent[limit.name] = spent.get(limit.name, 0.0) + limit.share * move.time
    if line.moves:
        kind = line.moves[0].kind
        told = {target_text(move) for move in line.moves}
        numbers = [move.number for move in line.moves]
    else:
        kind = DEVICE if line.waits[0][0].device else WAIT
        told = {f"{wait.duration:.3g} s" for wait, _ in line.waits}
        numbers = [number for _, number in line.waits if number]
    return LineReport(
        span=line.span,
        kind=kind,
        target=told.pop() if len(told) == 1 else _items_of_one(told) or "several",
        times=len(line.moves or line.waits),
        moves=tuple(numbers),
        time=sum(move.time for move in line.moves),
        wait=line.unnamed + sum(wait.duration for wait, _ in line.waits),
        settling=sum(move.settling for move in line.moves),
        limits=shares_of(spent),
    )


_ITEM = re.compile(r"([^\W\d][\w$.]*)([\[{])(\d+)([\]}])")
"""``XP[3]`` of KRL and URScript, ``pPick{3}`` of RAPID."""


def _items_of_one(names: Iterable[str]) -> str:
    """The first and the last item, where all are of one array; empty if not."""
    items = [_ITEM.fullmatch(name) for name in names]
    if not all(items) or len({(item[1], item[2]) for item in items if item}) != 1:
        return ""
    numbers = sorted(int(item[3]) for item in items if item)
    name, begins, _, ends = next(item for item in items if item).groups()
    return f"{name}{begins}{numbers[0]}{ends} to {name}{begins}{numbers[-1]}{ends}"


def line_row(line: LineReport, place: str, whole: float) -> tuple[str, ...]:
    """The cells of a line.

    Args:
        line: the line.
        place: where it stands, short.
        whole: s, of all lines together.
    """
    limit = f"{line.limits[0].name} ({100 * line.limits[0].share:.0f} %)" if line.limits else ""
    return (
        place,
        line.kind,
        line.target,
        f"×{line.times}",
        seconds(line.time),
        seconds(line.wait + line.settling),
        f"{line.total:.3f}",
        f"{100 * line.total / whole:.0f}" if whole else "",
        limit,
    )
