"""Numbers of a changed program as a person would write them.

What is rounded is what is proven: programs are rounded before their certificate, and in the units
and the form of rotations that their language has, so that the text shows few digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import FloatArray
from ...core.dialect import Dialect, Orientation
from ...core.program.zone import FINE, Angle, ContourFraction, Radius, VendorZone, Zone
from ...core.spatial.pose import Pose, Quaternion, Vector3
from ...core.spatial.rotation import (
    euler_zyx,
    euler_zyz,
    matrix_from_euler_zyx,
    matrix_from_euler_zyz,
    matrix_from_rotation_vector,
    quaternion_from_matrix,
    rotation_vector,
)

SMALLEST = 1e-4
"""Size of a zone (m, rad or share) below which there is no zone worth having."""
STEP = 1e-5
"""m, step of positions and radii."""
_PER_MM, _PER_DEGREE = 100, 10_000
_PER_MM_FINE, _PER_DEGREE_FINE = 1000, 1_000_000
"""Steps of radii below a millimetre, and of the parts of a zone beside the TCP's."""
_PER_DEGREE_OF_ZONE = 1000
_PER_RADIAN = 100
"""Steps in a radian for each in a degree."""
_PER_WHOLE = 100
_MILLIMETRE = 1e-3
_QUATERNION_DECIMALS = 8
"""With fewer a quaternion may be 1e-7 off unit length."""
_NEAR = 1e-9
"""Share of a step by which floating point may miss a multiple of it."""

_Rule = Callable[[float, int], float]
"""A value and steps per unit → a multiple of the step."""


@dataclass(frozen=True, slots=True)
class Rounding:
    """How numbers are rounded: lengths to 0.01 mm, angles to 0.0001° (or 1e-6 rad).

    A rounded number is the double that a reader makes of its few digits: of 227.925 mm that is
    227.925 / 1000, which is not 0.227925.

    Args:
        in_si: whether the language says lengths in m and angles in rad, not in mm and degrees.
        orientation: the form in which it says rotations.
        predefined: zones with a radius are to be chosen from these; empty for zones of any size.
        decimals: of lengths and of angles that the language's controllers keep; None for any.
    """

    in_si: bool = False
    orientation: Orientation = Orientation.QUATERNION
    predefined: tuple[Radius, ...] = ()
    decimals: tuple[int | None, int | None] = (None, None)

    @classmethod
    def of(cls, dialect: Dialect | None, predefined: Sequence[Radius] = ()) -> Rounding:
        """For a language; None for one that is not described."""
        if dialect is None:
            return cls(predefined=tuple(predefined))
        decimals = dialect.length_decimals, dialect.angle_decimals
        return cls(dialect.in_si, dialect.orientation, tuple(predefined), decimals)

    def angle(self, value: float, lower: float = -math.inf, upper: float = math.inf) -> float:
        """An angle, rad, that stays within its bounds.

        Where no multiple of the step lies between them it is the value itself, or a bound.
        """
        rounded = (self._angle(rule, value, _PER_DEGREE) for rule in (_nearest, _down, _up))
        return _first_within(rounded, value, lower, upper)

    def position(self, value: Sequence[float], lower: FloatArray, upper: FloatArray) -> Vector3:
        """A position, m, each coordinate within its bounds; as `angle`."""
        x, y, z = (
            _first_within(
                (self._length(rule, v, _PER_MM) for rule in (_nearest, _down, _up)), v, a, b
            )
            for v, a, b in zip(value, lower.tolist(), upper.tolist(), strict=True)
        )
        return x, y, z

    def quaternion(self, value: Quaternion) -> Quaternion:
        """A rotation, of few digits in the language's own form."""
        if self.orientation is Orientation.QUATERNION:
            w, x, y, z = (round(v, _QUATERNION_DECIMALS) for v in value)
            return w, x, y, z
        matrix = Pose(quaternion=value).matrix()[:3, :3]
        if self.orientation is Orientation.ROTATION_VECTOR:
            vector = [self.angle(v) for v in rotation_vector(matrix).tolist()]
            return _quaternion(matrix_from_rotation_vector(np.array(vector)))
        if self.orientation is Orientation.EULER_ZYZ:
            return _quaternion(matrix_from_euler_zyz(*map(self.angle, euler_zyz(matrix))))
        return _quaternion(matrix_from_euler_zyx(*map(self.angle, euler_zyx(matrix))))

    def zone(self, zone: Zone) -> Zone:
        """A zone no larger, and `FINE` for one of next to nothing.

        It is the largest of the predefined ones if there are any. Otherwise radii are whole
        hundredths of a millimetre (micrometres below a millimetre), shares whole percents. Parts
        beside the radius keep their proportion to it, to micrometres and millionths of a degree.
        """
        if isinstance(zone, ContourFraction):
            fraction = _down(zone.fraction, _PER_WHOLE)
            return FINE if fraction < SMALLEST else ContourFraction(min(1.0, fraction))
        if isinstance(zone, Angle):
            angle = self._angle(_down, zone.angle, _PER_DEGREE_OF_ZONE)
            return FINE if angle < SMALLEST else Angle(angle)
        if isinstance(zone, VendorZone):
            size = zone.kind.rounded(zone.size)
            return replace(zone, size=size) if size >= SMALLEST else FINE
        if not isinstance(zone, Radius):
            return zone
        if self.predefined:
            fitting = (z for z in self.predefined if 0.0 < z.tcp <= zone.tcp * (1 + _NEAR))
            return max(fitting, key=lambda z: z.tcp, default=FINE)
        per_mm = _PER_MM if zone.tcp >= _MILLIMETRE else _PER_MM_FINE
        tcp = self._length(_down, zone.tcp, per_mm)
        return FINE if tcp < SMALLEST else self._with_rounded_parts(zone.resized(tcp))

    def _with_rounded_parts(self, zone: Radius) -> Radius:
        def length(value: float) -> float:
            return value if value == zone.tcp else self._length(_nearest, value, _PER_MM_FINE)

        def angle(value: float) -> float:
            return self._angle(_nearest, value, _PER_DEGREE_FINE)

        return replace(
            zone,
            reorientation=max(zone.tcp, length(zone.reorientation)) if zone.reorientation else 0.0,
            external=max(zone.tcp, length(zone.external)) if zone.external else 0.0,
            angle=angle(zone.angle),
            external_linear=length(zone.external_linear),
            external_angular=angle(zone.external_angular),
        )

    def _length(self, rule: _Rule, value: float, per_mm: int) -> float:
        if self.in_si:
            return rule(value, _at_most(1000 * per_mm, self.decimals[0]))
        return rule(1000 * value, _at_most(per_mm, self.decimals[0])) / 1000

    def _angle(self, rule: _Rule, value: float, per_degree: int) -> float:
        if self.in_si:
            return rule(value, _at_most(_PER_RADIAN * per_degree, self.decimals[1]))
        return math.radians(rule(math.degrees(value), _at_most(per_degree, self.decimals[1])))


def _at_most(per_unit: int, decimals: int | None) -> int:
    """Steps in a unit, no more than decimals tell apart."""
    return per_unit if decimals is None else min(per_unit, 10**decimals)


def _nearest(value: float, per_unit: int) -> float:
    return round(value * per_unit) / per_unit


def _down(value: float, per_unit: int) -> float:
    """The multiple below a value, which may be one itself but for floating point."""
    return math.floor(value * per_unit * (1 + 1e-12) + _NEAR) / per_unit


def _up(value: float, per_unit: int) -> float:
    return -_down(-value, per_unit)


def _first_within(rounded: Iterable[float], value: float, lower: float, upper: float) -> float:
    inside = (candidate for candidate in rounded if lower <= candidate <= upper)
    return next(inside, min(max(value, lower), upper))


def _quaternion(matrix: FloatArray) -> Quaternion:
    w, x, y, z = (float(v) for v in quaternion_from_matrix(matrix))
    return w, x, y, z
