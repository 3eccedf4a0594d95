"""What the lines of a program take, however often each runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...core.errors import Span
from ...core.motion.emulator.binding_limits import LimitShare, shares_of
from .report import MoveReport, seconds, target_text

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


@dataclass(frozen=True, slots=True)
class LineReport:
    """All that one line of the source drives.

    Args:
        span: of its first move; None where a move has no line, and is one by itself.
        kind: ``MoveJ``, ``MoveL`` or ``MoveC``.
        target: where it goes, in words; ``several`` if it goes elsewhere each time.
        moves: their numbers, from 1.
        time: s of motion of all of them.
        wait: s of programmed standing still.
        settling: s, see `MoveReport`.
        limits: what holds the speed down, the longest first.
    """

    span: Span | None
    kind: str
    target: str
    moves: tuple[int, ...]
    time: float
    wait: float
    settling: float
    limits: tuple[LimitShare, ...]

    @property
    def total(self) -> float:
        """s."""
        return self.time + self.wait + self.settling


def lines_of(moves: Sequence[MoveReport]) -> tuple[LineReport, ...]:
    """The lines that drive, in the order in which they do so first."""
    by_line: dict[object, list[MoveReport]] = {}
    for move in moves:
        if move.driven:
            at = None if move.span is None else (move.span.file, move.span.line)
            by_line.setdefault(at or move.number, []).append(move)
    return tuple(map(_line, by_line.values()))


def _line(moves: Sequence[MoveReport]) -> LineReport:
    spent: dict[str, float] = {}
    for move in moves:
        for limit in move.limits:
            spent[limit.name] = spent.get(limit.name, 0.0) + limit.share * move.time
    targets = {target_text(move) for move in moves}
    return LineReport(
        span=moves[0].span,
        kind=moves[0].kind,
        target=targets.pop() if len(targets) == 1 else "several",
        moves=tuple(move.number for move in moves),
        time=sum(move.time for move in moves),
        wait=sum(move.wait for move in moves),
        settling=sum(move.settling for move in moves),
        limits=shares_of(spent),
    )


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
        f"×{len(line.moves)}",
        f"{line.time:.3f}",
        seconds(line.wait + line.settling),
        f"{line.total:.3f}",
        f"{100 * line.total / whole:.0f}" if whole else "",
        limit,
    )
