"""Arcs of a given angle (``CIRC …, CA angle``)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.spatial.pose import Pose, Quaternion
from ....core.spatial.rotation import (
    matrix_from_rotation_vector,
    quaternion_from_matrix,
    rotation_vector,
)

_FULL_TURN = 360.0
_MOST = 10 * _FULL_TURN
_FLAT = 1e-9


class Arcs(NamedTuple):
    """Arcs one after the other on a circle.

    Args:
        parts: of each the point half way and the end point.
        radius: of the circle, m.
    """

    parts: list[tuple[Pose, Pose]]
    radius: float


def beyond(start: Pose, via: Pose, end: Pose, degrees: float, follows: bool) -> Arcs:
    """The arcs that go on the circle of three points by an angle.

    Args:
        start, via, end: of the circle.
        degrees: from the start, towards ``via`` if above zero; full turns and more make several
            arcs, one after the other.
        follows: whether the tool turns with the arc.

    Returns:
        The last end keeps the orientation that is programmed for it.

    Raises:
        InputError: the points lie on a line, or the angle is no part of a few turns.
    """
    if not 0 < abs(degrees) <= _MOST:
        raise InputError(f"an arc of CA {degrees:g}°: more than 0 and at most {_MOST:g} are wanted")
    p, q, r = (np.array(pose.position) for pose in (start, via, end))
    centre, normal = _circle(p, q, r)
    count = int(abs(degrees) // _FULL_TURN) + 1
    made: list[tuple[Pose, Pose]] = []
    for k in range(count):
        middle, final = (math.radians(degrees) * (k + part) / count for part in (0.5, 1.0))
        share = (k + 1) / count
        turned = end.quaternion
        if share < 1:
            turned = _between(start, end, share, normal, math.radians(degrees) if follows else 0.0)
        place = _turned(p, centre, normal, final)
        half = Pose(_turned(p, centre, normal, middle), via.quaternion)
        made.append((half, Pose(place, turned)))
    return Arcs(made, float(np.linalg.norm(p - centre)))


def _between(start: Pose, end: Pose, share: float, axis: FloatArray, turn: float) -> Quaternion:
    """An orientation on the way, of a tool that turns with the arc by so much besides."""
    one, other = start.matrix()[:3, :3], end.matrix()[:3, :3]
    back = matrix_from_rotation_vector(-turn * axis)
    rest = rotation_vector(back @ other @ one.T)
    turned = matrix_from_rotation_vector(share * turn * axis) @ matrix_from_rotation_vector(
        share * rest
    )
    w, x, y, z = map(float, quaternion_from_matrix(turned @ one))
    return w, x, y, z


def _circle(p: FloatArray, q: FloatArray, r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Centre, and the unit normal about which the arc from p by q to r turns."""
    a, b = q - p, r - p
    normal = np.cross(a, b)
    square = float(normal @ normal)
    if square <= _FLAT * float(a @ a) * float(b @ b):
        raise InputError(
            "the start, auxiliary and end points of an arc lie on a line: they make no circle"
        )
    offset = (float(a @ a) * np.cross(b, normal) + float(b @ b) * np.cross(normal, a)) / (
        2 * square
    )
    return p + offset, normal / math.sqrt(square)


def _turned(
    p: FloatArray, centre: FloatArray, axis: FloatArray, angle: float
) -> tuple[float, float, float]:
    """A point turned about an axis through the centre (Rodrigues; the arm is normal to it)."""
    arm = p - centre
    x, y, z = centre + math.cos(angle) * arm + math.sin(angle) * np.cross(axis, arm)
    return float(x), float(y), float(z)
