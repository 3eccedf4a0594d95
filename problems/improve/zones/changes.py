"""What became of each zone, and what keeps it from being larger."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ....core.errors import MotionError, Span
from ....core.program.program import Program
from ....core.program.zone import Zone
from .points import Points
from .search import SizeBracket
from .sizes import size_of


@dataclass(frozen=True, slots=True)
class ZoneChange:
    """A zone before and after.

    Args:
        move: index of the move that programs it.
        before, after: the zone.
        clear: all sizes up to this one keep the clearance.
        fails: the smallest size found to fail; None where the rules end first.
        limit: what keeps it from being larger, in words.
        span: of the move in its source.
    """

    move: int
    before: Zone
    after: Zone
    clear: float
    fails: float | None
    limit: str
    span: Span | None = None


def changes(
    points: Points, program: Program, zones: Mapping[int, Zone], found: Mapping[int, SizeBracket]
) -> tuple[ZoneChange, ...]:
    """One entry for each zone that might change, in the order of the moves."""
    group = {corner: members for members in points.groups for corner in members}
    rows = []
    for corner, zone in zones.items():
        index = points.move[corner]
        move, known = program.moves[index], found.get(corner)
        shared = "" if len(group[corner]) == 1 else _shared(points, program, group[corner], found)
        rows.append(
            ZoneChange(
                index,
                move.zone,
                zone,
                0.0 if known is None else known.size,
                None if known is None else known.fails,
                _limit(known, zone, shared),
                move.statement,
            )
        )
    return tuple(sorted(rows, key=lambda row: row.move))


_LESS = 0.98
"""Share of what is clear below which a zone is smaller for another reason."""


def _shared(
    points: Points,
    program: Program,
    members: Sequence[int],
    found: Mapping[int, SizeBracket],
) -> str:
    """Who limits a zone that several moves share, in a sentence."""
    known = {corner: found[corner].size for corner in members if corner in found}
    least = points.move[min(known or members, key=lambda corner: known.get(corner, 0.0))]
    moves = sorted(points.move[corner] for corner in members)
    spans = {program.moves[move].statement for move in moves}
    span = spans.pop()
    if not spans and span is not None:
        return f"line {span.line} runs {len(moves)} times; move {least + 1} limits it"
    named = ", ".join(str(move + 1) for move in moves)
    return f"moves {named} share one zone; move {least + 1} limits it"


def _limit(found: SizeBracket | None, zone: Zone, shared: str) -> str:
    """What limits a zone; shared: who does, where several moves have it in common."""
    if found is None:
        return "the robot stops here whatever the zone"
    if found.size > 0.0 and size_of(zone) < _LESS * found.size:
        if shared:
            return shared
        return "the neighbouring zone"
    if found.fails is None:
        return "the rules for neighbouring points"
    if isinstance(found.reason, MotionError):
        return found.reason.message
    if found.reason is None:
        return "nothing could be decided beyond"
    first, second = found.reason.names
    return f"{first} and {second}"
