"""Arcs of a given angle (``CIRC …, CA angle``)."""

from __future__ import annotations

import math

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.spatial.pose import Pose

_FULL_TURN = 360.0
_FLAT = 1e-9


def beyond(start: Pose, via: Pose, end: Pose, degrees: float) -> tuple[Pose, Pose]:
    """Auxiliary and end point of the arc that goes on the circle of three points by an angle.

    Args:
        start, via, end: of the circle.
        degrees: from the start, towards ``via`` if above zero.

    Returns:
        The point half way, and the end point; the end keeps the orientation programmed for it.

    Raises:
        InputError: the points lie on a line, or the angle is no part of a turn.
    """
    if not 0 < abs(degrees) < _FULL_TURN:
        raise InputError(
            f"an arc of CA {degrees:g}° is not emulated: full circles and more are to be split "
            "into arcs of less than 360°"
        )
    p, q, r = (np.array(pose.position) for pose in (start, via, end))
    centre, normal = _circle(p, q, r)
    middle = _turned(p, centre, normal, math.radians(degrees) / 2)
    final = _turned(p, centre, normal, math.radians(degrees))
    return Pose(middle, via.quaternion), Pose(final, end.quaternion)


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
