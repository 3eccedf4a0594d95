"""The largest of a vendor's predefined zones below the first that fails."""

from __future__ import annotations

from collections.abc import Sequence

from ....core.errors import MotionError
from ....core.program.zone import Radius
from .search import Asking, Sides, SizeBracket, examine, whole


def choices(zones: Sequence[Radius], largest: float) -> list[Radius]:
    """The zones that the rules allow, in order of their size."""
    allowed = (zone for zone in zones if 0.0 < zone.tcp <= largest * (1 + 1e-9))
    return sorted(allowed, key=lambda zone: zone.tcp)


def choose(sides: Sides, zones: Sequence[Radius]) -> Asking:
    """Search among zones; sizes are those of the TCP.

    Args:
        sides: of the waypoint.
        zones: in order of their size.
    """
    best = 0.0
    for zone in zones:
        path = (yield [zone.tcp])[zone.tcp]
        if isinstance(path, MotionError):
            return SizeBracket(best, zone.tcp, path)
        reason, left = examine(sides, whole(path, sides), (), path)
        if reason is not None or any(map(len, left)):
            return SizeBracket(best, zone.tcp, reason)
        best = zone.tcp
    return SizeBracket(best)
