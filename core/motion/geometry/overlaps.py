"""What zones that overlap on a segment do to each other: they shrink, or one is left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .corners import POSITION
from .reach import Reach, least

_TOUCHING = 1e-9
"""Share of a segment by which zones that touch may seem to overlap."""
Reaches = tuple[tuple[Reach, Reach], ...]
"""Of position, turning and prescribed axes, into the segment before a corner and the one after."""


def taken(segment: int, wanted: Sequence[Reaches] | Mapping[int, Reaches], count: int) -> Reach:
    """Share of a segment that the zones at its ends take together; above 1 they overlap.

    Args:
        segment: its index.
        wanted: by corner; those at its ends count.
        count: of all segments.
    """
    before = wanted[segment - 1][POSITION][1] if segment > 0 else Reach(0.0)
    after = wanted[segment][POSITION][0] if segment + 1 < count else Reach(0.0)
    return before + after


def shrunk(wanted: Sequence[Reaches]) -> tuple[list[Reaches], dict[int, float]]:
    """Both zones on a segment shrunk in proportion until they touch, and by what factor the corners
    that shrink do."""
    factors = [Reach(1.0) for _ in wanted]
    for segment in range(1, len(wanted)):
        total = taken(segment, wanted, len(wanted) + 1)
        if total.value > 1.0:
            factor = total.inverse()
            factors[segment - 1] = least(factors[segment - 1], factor)
            factors[segment] = least(factors[segment], factor)
    made: list[Reaches] = [
        tuple((before * f, after * f) for before, after in pairs)
        for pairs, f in zip(wanted, factors, strict=True)
    ]
    return made, {i: f.value for i, f in enumerate(factors) if f.value < 1.0 - _TOUCHING}


def left_out(wanted: Sequence[Reaches]) -> list[int]:
    """Corners to leave out; no two neighbours, as leaving one out changes the other."""
    found: list[int] = []
    for segment in range(len(wanted) + 1):
        share = taken(segment, wanted, len(wanted) + 1).value
        outermost = segment in (0, len(wanted)) and share >= 1.0
        corner = min(segment, len(wanted) - 1)
        if (share > 1.0 + _TOUCHING or outermost) and not (found and corner - found[-1] < 2):
            found.append(corner)
    return found
