"""How near a move must come to its waypoint before the next one may begin."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from ..errors import InputError


def _check(owner: str, **values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value >= 0):
            raise InputError(f"{owner}.{name} must be zero or more, not {value}")


@dataclass(frozen=True, slots=True)
class Fine:
    """A stop point: the robot comes to rest at the waypoint.

    Args:
        programmed: whether its controller waits there until servos are in position, as at all that
            programs say; not where it stops as the next move is not planned in time.
    """

    programmed: bool = True


@dataclass(frozen=True, slots=True)
class Radius:
    """A sphere of TCP distance round the waypoint (ABB zonedata, KUKA C_DIS, UR blend radius).

    Args:
        tcp: radius in m inside which the TCP may leave the programmed path.
        reorientation: TCP distance in m at which reorientation may begin; at least ``tcp``.
        external: TCP distance in m at which external axes may begin; at least ``tcp``.
        angle: angle in rad that takes the place of distances in pure reorientation.
        external_linear: m, for moves of linear external axes alone.
        external_angular: rad, for moves of rotating external axes alone.
        name: a vendor's predefined or declared name (``z10``), kept for the writer.
    """

    tcp: float
    reorientation: float = 0.0
    external: float = 0.0
    angle: float = 0.0
    external_linear: float = 0.0
    external_angular: float = 0.0
    name: str | None = None

    def resized(self, tcp: float) -> Radius:
        """The zone with another radius, m; all its parts grow or shrink in the same proportion.

        So are the zones graded that vendors predefine (ABB's ``z10`` to ``z200``), and zones with
        one distance for all (KUKA's ``C_DIS``, UR's blend radius) keep one. It is another zone
        than the one that was declared, and has no name.

        Raises:
            InputError: the zone has radius 0, which is in no proportion to another one.
        """
        if self.tcp == 0:
            raise InputError("Radius.resized: a zone of radius 0 has no proportions; make a Radius")
        _check("Radius", tcp=tcp)

        def scaled(part: float) -> float:
            return tcp if part == self.tcp else part * (tcp / self.tcp)

        return Radius(
            tcp,
            scaled(self.reorientation),
            scaled(self.external),
            self.angle * (tcp / self.tcp),
            scaled(self.external_linear),
            self.external_angular * (tcp / self.tcp),
        )

    def with_one_distance(self) -> Radius:
        """The zone as a language holds it that has one distance for all: a ``reorientation`` or
        ``external`` of 0 is the TCP's.

        Raises:
            InputError: one of them is stated, and another one.
        """
        for what in ("reorientation", "external"):
            part = getattr(self, what)
            if part != 0 and not math.isclose(part, self.tcp, rel_tol=1e-9):
                raise InputError(
                    f"Radius.{what} is {part:g} m and the TCP's {self.tcp:g} m: make them equal "
                    "(zone.resized(tcp) keeps them so), or 0"
                )
        return replace(self, reorientation=self.tcp, external=self.tcp)

    def __post_init__(self) -> None:
        _check(
            "Radius",
            tcp=self.tcp,
            reorientation=self.reorientation,
            external=self.external,
            angle=self.angle,
            external_linear=self.external_linear,
            external_angular=self.external_angular,
        )


ROOM = Radius(1.0, 1.0, 1.0)
"""A zone that nobody has programmed, as wide as there is room for: half of a segment is less."""


@dataclass(frozen=True, slots=True)
class ContourFraction:
    """KRL ``C_PTP``: a share of the half contour of a joint move; 1 begins at its middle."""

    fraction: float

    def __post_init__(self) -> None:
        _check("ContourFraction", fraction=self.fraction)
        if self.fraction > 1:
            raise InputError(f"ContourFraction.fraction is at most 1, not {self.fraction}")


@dataclass(frozen=True, slots=True)
class Angle:
    """KRL ``C_ORI``: blending may begin when the orientation is this near (rad) to the target's."""

    angle: float

    def __post_init__(self) -> None:
        _check("Angle", angle=self.angle)


ReachLaw = Callable[[Any, Any, Any], Any]
"""Size, speed and acceleration → distance; of sums, products and quotients alone, so that
derivatives go through it."""


def braking(size: Any, speed: Any, acceleration: Any) -> Any:
    """The distance in which braking goes from a share of the speed to rest: (f v)² / 2 A."""
    share = size * speed
    return share * share / (acceleration * 2.0)


@dataclass(frozen=True, slots=True)
class ZoneKind:
    """A kind of zone that a make has for itself: FANUC ``CNT``, KRL ``C_VEL``, Yaskawa ``PL``.

    Args:
        word: what the make calls it, for messages and texts.
        reach: how far before the waypoint such a zone begins, from its size and the speed and
            acceleration of the move that goes there: m, m/s and m/s² along moves of the TCP; shares
            of the line, 1/s and 1/s² along joint moves. None: the size is that distance, m.
        largest: greatest size.
        unit: size of one unit in which it is written: 0.01 of percents, 0.001 of mm.
        step: size that it is written in multiples of; 0 for any.
        sizes: the only sizes that there are, rising; they are called by their numbers, from 1
            (Yaskawa ``PL=3``). Empty for any size.

    Raises:
        InputError: a number makes no sense.
    """

    word: str
    reach: ReachLaw | None = braking
    largest: float = 1.0
    unit: float = 0.01
    step: float = 0.01
    sizes: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        _check("ZoneKind", largest=self.largest, unit=self.unit, step=self.step)
        if self.unit == 0.0:
            raise InputError("ZoneKind.unit must be above zero")

    def sized(self, size: float) -> Zone:
        """The zone of a size, no larger than there are any; `FINE` for none."""
        return VendorZone(self, min(size, self.largest)) if size > 0.0 else FINE

    def rounded(self, size: float) -> float:
        """The greatest size not above another one that can be written; 0 for none."""
        if self.sizes:
            return max((one for one in self.sizes if one <= size * (1 + 1e-9)), default=0.0)
        size = min(size, self.largest)
        if self.step == 0.0:
            return size
        steps = math.floor(size / self.step * (1 + 1e-12) + 1e-9)
        per_unit = self.step / self.unit
        return round(steps * per_unit, 9) * self.unit if per_unit != 1.0 else steps * self.unit


_SHARES_PER_M = 50.0


@dataclass(frozen=True, slots=True)
class VendorZone:
    """A zone of a make's own kind.

    Args:
        kind: see `ZoneKind`; it stays through optimisation, as the words do.
        size: in the kind's own terms: a share, m.
        ratio: how far it goes on behind the waypoint, as a multiple of how far before it begins
            (FANUC ``CR5,10``: 2).

    Raises:
        InputError: the size is beyond the kind's largest, or a number below zero.
    """

    kind: ZoneKind
    size: float
    ratio: float = 1.0

    def __post_init__(self) -> None:
        _check(self.kind.word, size=self.size, ratio=self.ratio)
        if self.size > self.kind.largest:
            most = self.kind.largest / self.kind.unit
            raise InputError(
                f"{self.kind.word} is at most {most:g}, not {self.size / self.kind.unit:g}"
            )

    def resized(self, tcp: float) -> Zone:
        """The zone with about that radius, m.

        How far a kind by speed reaches is not known before it is driven: a centimetre counts as
        half of its largest size.
        """
        size = tcp if self.kind.reach is None else tcp * _SHARES_PER_M * self.kind.largest
        return replace(self, size=min(size, self.kind.largest)) if size > 0.0 else FINE

    def __str__(self) -> str:
        if self.size in self.kind.sizes:
            return f"{self.kind.word} {self.kind.sizes.index(self.size) + 1}"
        behind = f",{self.size * self.ratio / self.kind.unit:.4g}" if self.ratio != 1.0 else ""
        return f"{self.kind.word} {self.size / self.kind.unit:.4g}{behind}"


Zone = Fine | Radius | ContourFraction | Angle | VendorZone
FINE = Fine()


def zone_shown(zone: Zone) -> str:
    """A zone in the units of the shop floor."""
    match zone:
        case Radius(tcp):
            return zone.name or f"{1e3 * tcp:.5g} mm"
        case ContourFraction(fraction):
            return f"{100 * fraction:.3g} %"
        case VendorZone():
            return str(zone)
        case Angle(angle):
            return f"{math.degrees(angle):.4g}°"
    return "fine"


def kind_of(zone: Zone) -> type[Zone] | ZoneKind:
    """What kind of zone it is, as dialects list them."""
    return zone.kind if isinstance(zone, VendorZone) else type(zone)


def kind_word(kind: type[Zone] | ZoneKind) -> str:
    """What a kind of zone is called."""
    return kind.word if isinstance(kind, ZoneKind) else kind.__name__


def zone_word(zone: Zone) -> str:
    """What a zone's kind is called, for messages that refuse it."""
    return kind_word(kind_of(zone))
