"""Shapes drawn around the axes of a six-axis arm whose real ones are not known.

The radii are powers of payload m (kg) and reach r (m), mm: exp(a + b ln m + c ln r). They were set
once for all arms that vendors list, by eye from a few of them, and are no maker's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..spatial.pose import Pose, Vector3
from .joint import Joint
from .shape import Capsule, Cylinder, LinkShape, Sphere, pose_along

ORIGIN = "assumed: hulls drawn around the axes from the lengths, not from CAD"
_RADII = (
    (5.18739, -0.00393, 1.01767),
    (4.80709, 0.05693, 0.73963),
    (4.6238, 0.01711, 0.66225),
    (4.60798, 0.03297, 0.72206),
    (4.14817, 0.11083, 0.39647),
    (4.13069, 0.10036, 0.55746),
    (3.49957, 0.12599, 0.54851),
)
"""a, b, c of the base and the six links."""
_BASE_TOP, _SHOULDER_FOOT, _FLANGE_FOOT = 0.45, 0.75, 0.6
"""Shares of the height of axis 2, and of the way from the wrist to the flange."""
_ABOVE_FLOOR = 0.0204
"""m that the lower end of link 1 keeps above the floor."""
_POINT = 1e-6
"""m, below which a capsule is a sphere."""


def hulls(
    joints: Sequence[Joint], flange: Pose, payload: float, reach: float
) -> tuple[LinkShape, ...]:
    """Hulls of the base and the six links.

    Args:
        joints: six; their frames are parallel to the base's, axis 2 above it.
        flange: in the frame behind the last joint.
        payload: kg.
        reach: m, from axis 1 to the wrist.
    """
    radii = [1e-3 * math.exp(a + b * math.log(payload) + c * math.log(reach)) for a, b, c in _RADII]
    places = [np.array(joint.placement.position) for joint in joints]
    shoulder, tip = places[0] + places[1], np.array(flange.position)
    height, zero = float(shoulder[2]), np.zeros(3)
    up = np.array([0.0, 0.0, 1.0])
    made = []
    if height > _POINT:
        made.append(_cylinder(0, radii[0], zero, _BASE_TOP * height * up))
        radii[1] = min(radii[1], max(_SHOULDER_FOOT * height - _ABOVE_FLOOR, 0.1 * height))
    ends = (
        (_SHOULDER_FOOT * height * up - places[0], places[1]),
        *((zero, p) for p in places[2:5]),
    )
    for link, (start, end) in enumerate(ends, 1):
        made.append(_round(link, radii[link], start, end))
    made.append(LinkShape(5, Sphere(radii[5]), Pose()))
    if float(np.linalg.norm(tip)) > _POINT:
        made.append(_cylinder(6, radii[6], _FLANGE_FOOT * tip, tip))
    return tuple(made)


def _cylinder(link: int, radius: float, start: FloatArray, end: FloatArray) -> LinkShape:
    length = float(np.linalg.norm(end - start))
    return LinkShape(link, Cylinder(radius, length), pose_along(start, end))


def _round(link: int, radius: float, start: FloatArray, end: FloatArray) -> LinkShape:
    """A capsule, or a sphere where both ends are one."""
    length = float(np.linalg.norm(end - start))
    if length > _POINT:
        return LinkShape(link, Capsule(radius, length), pose_along(start, end))
    x, y, z = (float(v) for v in end)
    at: Vector3 = (x, y, z)
    return LinkShape(link, Sphere(radius), Pose(at))


def reach_of(joints: Sequence[Joint]) -> float:
    """m from axis 1 to the wrist of a six-axis arm that is stretched out."""
    _, shoulder, elbow, fourth, fifth, _ = (np.array(joint.placement.position) for joint in joints)
    forearm = float(np.linalg.norm(fourth + fifth))
    return float(np.hypot(shoulder[0], shoulder[1])) + float(np.linalg.norm(elbow)) + forearm
