"""What became of each zone, and what keeps it from being larger."""

from __future__ import annotations

from collections.abc import Mapping
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
        others = [points.move[other] for other in group[corner] if other != corner]
        rows.append(
            ZoneChange(
                index,
                move.zone,
                zone,
                0.0 if known is None else known.size,
                None if known is None else known.fails,
                _limit(known, zone, others),
                move.statement,
            )
        )
    return tuple(sorted(rows, key=lambda row: row.move))


_LESS = 0.98
"""Share of what is clear below which a zone is smaller for another reason."""


def _limit(found: SizeBracket | None, zone: Zone, others: list[int]) -> str:
    if found is None:
        return "the robot stops here whatever the zone"
    if found.size > 0.0 and size_of(zone) < _LESS * found.size:
        if others:
            return f"one zone for {len(others) + 1} moves, and another of them needs it so"
        return "the neighbouring zone"
    if found.fails is None:
        return "the rules for neighbouring points"
    if isinstance(found.reason, MotionError):
        return found.reason.message
    if found.reason is None:
        return "nothing could be decided beyond"
    first, second = found.reason.names
    return f"{first} and {second}"
