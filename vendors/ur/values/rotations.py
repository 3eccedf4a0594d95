"""Rotation vectors that come back, and that stay near others.

A rotation has many vectors, 2π apart along its axis. A controller takes all of them; a patched
program keeps to the one that was taught.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ....core.spatial.pose import Quaternion, Vector3
from .poses import quaternion_of, rotation_vector_of

DECIMALS = 14
"""Of a rotation vector in rad: ten times what rounding leaves uncertain."""
_NO_AXIS = 1e-12
"""rad, below which a rotation has no axis to go round."""


def lasting_rotation_vector(quaternion: Quaternion) -> Vector3:
    """The rotation vector (rad), half a turn long at most, of a unit quaternion.

    A vector that is read, and computed from its quaternion again, comes back with other last
    digits; with those left out it comes back as it is.
    """
    seen: list[Vector3] = []
    vector = _rounded(quaternion)
    while vector not in seen:
        seen.append(vector)
        vector = _rounded(quaternion_of(*vector))
    # Beyond half a turn a vector comes back as the opposite one: either leads to the same.
    return max(seen[seen.index(vector) :])


def _rounded(quaternion: Quaternion) -> Vector3:
    x, y, z = (round(value, DECIMALS) + 0.0 for value in rotation_vector_of(quaternion))
    return x, y, z


def nearest_rotation_vector(quaternion: Quaternion, near: Sequence[float]) -> Vector3:
    """Of the rotation vectors (rad) of a unit quaternion the one nearest to ``near``."""
    x, y, z = rotation_vector_of(quaternion)
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < _NO_AXIS:
        return x, y, z
    along = (x * near[0] + y * near[1] + z * near[2]) / angle
    turns = round((along - angle) / math.tau)
    scale = 1 + turns * math.tau / angle
    return scale * x, scale * y, scale * z
