"""Arcs that the controller would refuse.

The limits are those that RobotComponents checks for (PathGenerator): they follow the controller's
own error messages for circles that are too small or too long.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ....core.errors import InputError
from ....core.program.move import Move, MoveC
from ....core.program.target import PoseTarget
from ....core.spatial.pose import Pose

LEAST_CHORD = 1e-4
"""m, from the start to each of the two points."""
LEAST_ANGLE = math.radians(1)
"""Between the two points, seen from the start."""
LARGEST_ARC = math.radians(240)

FloatArray = NDArray[np.float64]


def check_arc(before: Move | None, move: MoveC) -> None:
    """Refuse an arc that the controller does not drive.

    Nothing is checked where the start is not known from the program alone.

    Raises:
        InputError: the arc is too small or too long.
    """
    start = None if before is None else _start(before, move)
    if start is None or not isinstance(move.target, PoseTarget):
        return
    a, b, c = (
        np.array(point)
        for point in (start.position, move.via.pose.position, move.target.pose.position)
    )
    if min(np.linalg.norm(b - a), np.linalg.norm(c - a)) < LEAST_CHORD:
        raise InputError("MoveC: a point of the arc is less than 0.1 mm from its start")
    if angle_between(b - a, c - a) < LEAST_ANGLE:
        raise InputError(
            "MoveC: seen from the start, its two points are less than 1° apart: use MoveL"
        )
    sweep = arc_angle(a, b, c)
    if sweep > LARGEST_ARC:
        raise InputError(
            f"MoveC: an arc of {math.degrees(sweep):.0f}° is above the 240° that RAPID allows: "
            "split it in two"
        )


def angle_between(u: FloatArray, v: FloatArray) -> float:
    """Angle of two vectors (3,), rad."""
    return math.atan2(float(np.linalg.norm(np.cross(u, v))), float(u @ v))


def arc_angle(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    """Angle at the centre of the arc from ``a`` through ``b`` to ``c``, rad.

    By the inscribed angle theorem the arcs a-b and b-c are twice the angles at c and at a.
    """
    return 2 * (angle_between(b - a, c - a) + angle_between(a - c, b - c))


def _start(before: Move, move: MoveC) -> Pose | None:
    """Where the arc begins, in its own work object and for its own tool."""
    if not isinstance(before.target, PoseTarget):
        return None
    if (before.tool, before.work_object) == (move.tool, move.work_object):
        return before.target.pose
    frames = (before.work_object, move.work_object)
    if any(frame.robot_held or frame.moved_by is not None for frame in frames):
        return None
    flange = frames[0].pose @ before.target.pose @ before.tool.tcp.inverse()
    return frames[1].pose.inverse() @ flange @ move.tool.tcp
