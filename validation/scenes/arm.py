"""The arm of the joint-space scenes: an IRB 6640-180/2.55 with limits and capsules of ours."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...core.cell.geometry import Geometry
from ...core.program.tool import Load, Tool
from ...core.registry import find_robot
from ...core.robot.model import Robot
from ...core.robot.shape import Capsule, LinkShape
from ...core.spatial.pose import Pose, Vector3

NAME = "abb/irb6640-180-255"
ORIGIN = "assumed: of a reference scene of ours, rounder than any real arm's"
UPPER_ARM, ELBOW_OFFSET, FOREARM, WRIST = 1.075, 0.2, 1.1425, 0.2
"""m: shoulder to elbow, elbow to the forearm's axis, along it to the wrist, wrist to flange."""
ALONG_X = (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0)
"""Turns z into x: the forearm's axis at zero."""
ALWAYS_TOUCHING = (("J2", "J4"),)
"""Capsules of links that are no neighbours and overlap all the same, at the elbow."""


def scene_arm(
    radii: tuple[float, float, float, float], limits: Mapping[int, tuple[float, float]]
) -> Robot:
    """The arm with one capsule from joint to joint.

    Args:
        radii: m of the capsules from shoulder to elbow, on to the forearm's axis, along it to the
            wrist and on to the flange.
        limits: of the joints by index: velocity in degree/s and acceleration in rad/s².
    """
    robot = find_robot(NAME)
    joints = list(robot.joints)
    for index, (velocity, acceleration) in limits.items():
        joints[index] = replace(
            joints[index], velocity=math.radians(velocity), acceleration=acceleration
        )
    upper, offset, forearm, wrist = radii
    shapes = (
        LinkShape(2, Capsule(upper, UPPER_ARM), Pose((0.0, 0.0, UPPER_ARM / 2))),
        LinkShape(3, Capsule(offset, ELBOW_OFFSET), Pose((0.0, 0.0, ELBOW_OFFSET / 2))),
        LinkShape(4, Capsule(forearm, FOREARM), Pose((FOREARM / 2, 0.0, 0.0), ALONG_X)),
        # On the axis of joint 6, so it may as well stand still with the wrist.
        LinkShape(5, Capsule(wrist, WRIST), Pose((WRIST / 2, 0.0, 0.0), ALONG_X)),
    )
    origins = {**robot.origins, "velocity": ORIGIN, "acceleration": ORIGIN, "shape": ORIGIN}
    return replace(robot, joints=tuple(joints), shapes=shapes, origins=origins)


def rod_tool(name: str, length: float) -> Tool:
    """A tool along the flange's axis, its mass and inertia those of a rod of 20 kg (assumed)."""
    load = Load(20.0, (0.0, 0.0, 0.15), (0.1625, 0.1625, 0.025))
    return Tool(name, Pose((0.0, 0.0, length)), load)


def rod_shape(tip: Vector3, radius: float) -> Geometry:
    """A capsule from the flange's centre to a tip in its frame, m.

    The tip is not opposite to the flange's z axis.
    """
    length = math.hypot(*tip)
    x, y, z = tip
    # The shortest turn from z to the tip's direction, about z × tip.
    w = math.sqrt(0.5 * (1.0 + z / length))
    turn = (w, -0.5 * y / (length * w), 0.5 * x / (length * w), 0.0)
    return Geometry(Capsule(radius, length), Pose((0.5 * x, 0.5 * y, 0.5 * z), turn))


def degrees_per_second(
    velocities: Sequence[float], accelerations: Sequence[float], first: int = 0
) -> dict[int, tuple[float, float]]:
    """Limits of consecutive joints by index, from the ``first`` on, for `scene_arm`."""
    return {first + k: pair for k, pair in enumerate(zip(velocities, accelerations, strict=True))}
