"""How near a move must come to its waypoint before the next one may begin."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..errors import InputError


def _check(owner: str, **values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value >= 0):
            raise InputError(f"{owner}.{name} must be zero or more, not {value}")


@dataclass(frozen=True, slots=True)
class Fine:
    """A stop point: the robot comes to rest at the waypoint."""


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


@dataclass(frozen=True, slots=True)
class SpeedFraction:
    """KRL ``C_VEL``: blending begins when braking has come down to this share of the speed."""

    fraction: float

    def __post_init__(self) -> None:
        _check("SpeedFraction", fraction=self.fraction)
        if self.fraction > 1:
            raise InputError(f"SpeedFraction.fraction is at most 1, not {self.fraction}")


Zone = Fine | Radius | ContourFraction | Angle | SpeedFraction
FINE = Fine()


def zone_shown(zone: Zone) -> str:
    """A zone in the units of the shop floor."""
    match zone:
        case Radius(tcp):
            return zone.name or f"{1e3 * tcp:.5g} mm"
        case ContourFraction(fraction) | SpeedFraction(fraction):
            return f"{100 * fraction:.3g} %"
        case Angle(angle):
            return f"{math.degrees(angle):.4g}°"
    return "fine"
