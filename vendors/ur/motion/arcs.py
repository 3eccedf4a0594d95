"""How a tool turns that keeps its orientation to an arc."""

from __future__ import annotations

import math

import numpy as np

from ....core.spatial.pose import Pose, Quaternion, Vector3
from ..values.poses import quaternion_of

_COLLINEAR = 1e-4


def carried_along(start: Pose, via: Vector3, end: Vector3) -> Quaternion | None:
    """The orientation of ``start`` turned with the arc's tangent from ``start`` to ``end``.

    Args:
        start: where the arc begins.
        via, end: points of the arc, m.

    Returns:
        None if the points lie on a line.
    """
    origin = np.array(start.position)
    a, b = np.array(via) - origin, np.array(end) - origin
    normal = np.cross(a, b)
    size = float(np.linalg.norm(normal))
    if size <= _COLLINEAR * float(np.linalg.norm(a) * np.linalg.norm(b)):
        return None
    axis = normal / size
    # Centre from the start: the point of the plane equally far from all three.
    centre = np.cross(np.dot(a, a) * b - np.dot(b, b) * a, normal) / (2 * size**2)
    x = -centre / np.linalg.norm(centre)
    y = np.cross(axis, x)
    out = b - centre
    angle = math.atan2(float(out @ y), float(out @ x)) % math.tau
    rx, ry, rz = (float(v) for v in angle * axis)
    return (
        Pose(quaternion=quaternion_of(rx, ry, rz)) @ Pose(quaternion=start.quaternion)
    ).quaternion
