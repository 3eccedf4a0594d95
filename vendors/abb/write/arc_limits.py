"""Arcs that the controller would refuse, as far as the program alone tells."""

from __future__ import annotations

import math

import numpy as np

from ....core.errors import InputError
from ....core.program.move import Move, MoveC
from ....core.program.target import PoseTarget
from ....core.spatial.pose import Pose
from ....core.spatial.rotation import angle_between, arc_angle
from ..motion.arcs import ARCS


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
    if min(np.linalg.norm(b - a), np.linalg.norm(c - a)) < ARCS.least_chord:
        raise InputError("MoveC: a point of the arc is less than 0.1 mm from its start")
    if angle_between(b - a, c - a) < ARCS.least_angle:
        raise InputError(
            "MoveC: seen from the start, its two points are less than 1° apart: use MoveL"
        )
    sweep = arc_angle(a, b, c)
    if sweep > ARCS.longest:
        raise InputError(
            f"MoveC: an arc of {math.degrees(sweep):.0f}° is above the 240° that RAPID allows: "
            "split it in two"
        )


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
