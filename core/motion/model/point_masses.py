"""What models of carried masses share: the chain to a joint's axis, and rows of figures."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError
from ...robot.kinematics.chain import Chain
from ...robot.model import Robot


def chain_to_axis(robot: Robot, joint: int, key: str) -> Chain:
    """The chain from the world to the origin of an arm's joint, counted from one.

    Args:
        robot: the robot.
        joint: where the chain ends.
        key: of the figure that names the joint, for the message.

    Raises:
        InputError: the arm has no such joint.
    """
    if joint > robot.arm_size:
        raise InputError(f"{key}: {robot.name} has {robot.arm_size} joints, no joint {joint}")
    chain = robot.chain
    k = int(np.flatnonzero(chain.joint == joint - 1)[0])
    return Chain(
        chain.rotation[:k],
        chain.translation[:k],
        chain.axis[:k],
        chain.prismatic[:k],
        chain.joint[:k],
        chain.sign[:k],
        np.eye(3),
        chain.translation[k],
    )


def filled(values: tuple[float, ...], size: int) -> FloatArray:
    """(size,), the values and zeros behind them."""
    out = np.zeros(size)
    out[: len(values)] = values[:size]
    return out
