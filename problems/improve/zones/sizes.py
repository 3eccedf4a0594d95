"""One number for each zone: its size, by which it grows from nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ....core.dialect import Dialect
from ....core.errors import InputError
from ....core.program.zone import (
    FINE,
    Angle,
    ContourFraction,
    Fine,
    Radius,
    VendorZone,
    Zone,
    ZoneKind,
)
from ..rounding import Rounding

GRADED = Radius(
    0.1,
    0.15,
    0.15,
    math.radians(15.0),
    0.15,
    math.radians(15.0),
)
"""Proportions of the zones that ABB predefines (z100: 100, 150, 150 mm, 15°, 150 mm, 15°)."""


def pattern_for(dialect: Dialect | None) -> Radius | VendorZone:
    """Proportions of zones for points that had none, in a language; None: one that says all."""
    own = [] if dialect is None else [k for k in dialect.line.zones if isinstance(k, ZoneKind)]
    if dialect is not None and own and Radius not in dialect.line.zones:
        return VendorZone(own[0], own[0].largest)
    if dialect is None or dialect.zone_parts:
        return GRADED
    return Radius(GRADED.tcp, GRADED.tcp, GRADED.tcp)


@dataclass(frozen=True, slots=True)
class Growth:
    """A zone of every size, in the proportions of one of them.

    Args:
        pattern: a zone that is no stop.

    Raises:
        InputError: it is one, or has no size.
    """

    pattern: Radius | ContourFraction | Angle | VendorZone

    @classmethod
    def of(cls, zone: Zone) -> Growth:
        """The growth that a programmed zone belongs to."""
        if isinstance(zone, Radius | ContourFraction | Angle | VendorZone) and size_of(zone) > 0:
            return cls(zone)
        raise InputError(f"a zone that can grow has a size above zero and is no stop, not {zone}")

    def zone(self, size: float) -> Zone:
        """The zone of a size: m of the TCP's radius, share of the contour, rad, or of a kind."""
        if size <= 0:
            return FINE
        if isinstance(self.pattern, Radius):
            return self.pattern.resized(size)
        if isinstance(self.pattern, ContourFraction):
            return ContourFraction(min(1.0, size))
        if isinstance(self.pattern, VendorZone):
            return replace(self.pattern, size=min(self.pattern.kind.largest, size))
        return Angle(size)

    def rounded(self, size: float, rounding: Rounding) -> Zone:
        """The zone of a size rounded down, in numbers that a person would write."""
        return rounding.zone(self.zone(size))


def size_of(zone: Zone) -> float:
    """A zone's size; 0 for a stop."""
    match zone:
        case Fine():
            return 0.0
        case Radius(tcp):
            return tcp
        case ContourFraction(fraction):
            return fraction
        case Angle(angle):
            return angle
        case VendorZone(_, size):
            return size
