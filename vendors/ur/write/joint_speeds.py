"""Speeds of the leading joint for joint moves that are limited joint by joint.

``movej`` takes the speed and acceleration of the joint that turns farthest; programs of other
vendors give each joint a share of its own maximum. For a move whose ends are known, both say the
same.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....core.arrays import FloatArray
from ....core.program.move import MoveJ
from ....core.robot.model import Robot
from .positions import Standpoint


def with_leading_speed(move: MoveJ, robot: Robot, standpoint: Standpoint) -> MoveJ:
    """The move with ``joint`` and ``joint_acceleration`` in the place of shares.

    Args:
        robot: whose speeds and accelerations are shared out.

    Raises:
        InputError: where it begins is not known, or its target is out of reach.
    """
    speed = move.speed
    if speed.duration is not None or speed.tcp is not None:
        return move
    fast = speed.joint is not None and speed.joint_fraction == 1.0
    strong = speed.joint_acceleration is not None and speed.joint_acceleration_fraction == 1.0
    if fast and strong:
        return move
    way, limits = standpoint.way(move), robot.limits
    if not fast:
        own = _leading(way, speed.joint_fraction * limits.velocity)
        speed = replace(speed, joint=min(own, speed.joint or own), joint_fraction=1.0)
    if not strong:
        own = _leading(way, speed.joint_acceleration_fraction * limits.acceleration)
        least = min(own, speed.joint_acceleration or own)
        speed = replace(speed, joint_acceleration=least, joint_acceleration_fraction=1.0)
    return replace(move, speed=speed)


def _leading(way: FloatArray, limits: FloatArray) -> float:
    """The leading joint's limit under limits (N,) of all joints along a straight way (N,)."""
    farthest = float(way.max())
    if farthest == 0:
        return float(limits.min())
    with np.errstate(divide="ignore"):
        return float((limits * (farthest / way)).min())
