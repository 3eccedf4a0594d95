"""KUKA's angles A, B, C and the quaternion of the same rotation.

R = Rz(A) Ry(B) Rx(C): about Z, then the new Y, then the new X. With half angles a, b, c,

    w + y = (cos b + sin b) cos(a − c)        w − y = (cos b − sin b) cos(a + c)
    z − x = (cos b + sin b) sin(a − c)        z + x = (cos b − sin b) sin(a + c)

so that A − C and A + C come from one arc tangent each, and B from the lengths of the two pairs,
exactly as well near B = ±90° as elsewhere.
"""

from __future__ import annotations

import math
from functools import lru_cache

from ....core.spatial.pose import Quaternion, Vector3

_ONE_AXIS = 1e-12
"""Length of a pair below which A and C turn about one axis and only their sum or difference
counts."""
_DECIMALS = 9
"""Of angles in degrees that are written."""


def angles(quaternion: Quaternion) -> Vector3:
    """A, B, C in degrees of a unit quaternion w, x, y, z; C is 0 where B is ±90°."""
    plus, minus, difference, total = _pairs(quaternion)
    b = math.degrees(2 * math.atan2(plus, minus)) - 90.0
    if minus < _ONE_AXIS:
        return _wrapped(difference), 90.0, 0.0
    if plus < _ONE_AXIS:
        return _wrapped(total), -90.0, 0.0
    return _wrapped((total + difference) / 2), b, _wrapped((total - difference) / 2)


def written_angles(quaternion: Quaternion) -> Vector3:
    """As `angles`, without the decimals that depend on the rounding of the quaternion.

    The rotation is kept to 1e-10 degrees. So angles that are written, read and written again come
    out the same; near B = ±90° fewer decimals of A and C mean anything.
    """
    plus, minus, difference, total = _pairs(quaternion)
    b = round(math.degrees(2 * math.atan2(plus, minus)) - 90.0, _DECIMALS)
    if abs(b) == 90.0:
        return _rounded(difference if b > 0 else total), b, 0.0
    difference = round(difference, _decimals(plus))
    total = round(total, _decimals(minus))
    return _rounded((total + difference) / 2), b, _rounded((total - difference) / 2)


def _pairs(quaternion: Quaternion) -> tuple[float, float, float, float]:
    """Lengths of the two pairs, and A − C and A + C in degrees."""
    w, x, y, z = quaternion
    difference = math.degrees(2 * math.atan2(z - x, w + y))
    total = math.degrees(2 * math.atan2(z + x, w - y))
    return math.hypot(w + y, z - x), math.hypot(w - y, z + x), difference, total


def _decimals(length: float) -> int:
    """Of an angle that turns by the length of its pair only: 1e-10 degrees of rotation."""
    return _DECIMALS + 1 + math.floor(math.log10(min(1.0, length)))


@lru_cache(maxsize=1024)  # neighbouring points are often turned alike
def quaternion(a: float, b: float, c: float) -> Quaternion:
    """The unit quaternion w, x, y, z, w ≥ 0, of A, B, C in degrees."""
    (sa, ca), (sb, cb), (sc, cc) = (
        (math.sin(half), math.cos(half)) for half in (math.radians(v) / 2 for v in (a, b, c))
    )
    w = ca * cb * cc + sa * sb * sc
    x = ca * cb * sc - sa * sb * cc
    y = ca * sb * cc + sa * cb * sc
    z = sa * cb * cc - ca * sb * sc
    return (w, x, y, z) if w >= 0 else (-w, -x, -y, -z)


def _wrapped(angle: float) -> float:
    """An angle in degrees, in (−180, 180]."""
    degrees = math.remainder(angle, 360.0)
    return 180.0 if degrees <= -180.0 else degrees


def _rounded(angle: float) -> float:
    return _wrapped(round(_wrapped(angle), _DECIMALS))
