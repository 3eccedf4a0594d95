"""Where an arm of seven axes comes to stand that is led to a pose and an arm angle at once."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.chain_kernels import poses
from ...robot.model import Robot
from ...robot.seven_axes.arm_angle import settle, wrapped
from ...spatial.rotation import matrix_from_rotation_vector, rotation_vector

_THIRD = 2
"""Of the axes from base to flange."""
_STEP_LENGTH, _STEP_TURN = 0.02, 0.05
"""m, and rad of the flange and the arm angle, of a step on the way."""


class Followed(NamedTuple):
    """Where an arm is led.

    Args:
        q: (N,), its configuration there.
        apart: rad by which its third axis is elsewhere on the way than if it turned evenly.
    """

    q: FloatArray
    apart: float


def followed(robot: Robot, flange: FloatArray, wanted: float, q: FloatArray) -> Followed | None:
    """The configuration that an arm reaches from another one without a jump.

    The flange goes straight, and the arm angle the shorter way round.

    Args:
        robot: with an arm angle.
        flange: (4, 4), in the world.
        wanted: rad, the arm angle.
        q: (N,), where the arm stands; external axes as they are at the end.

    Returns:
        None where the way is barred by a singularity, or leads out of the joints' ranges.
    """
    angle = robot.measured_arm_angle
    before = robot.arm_angle(q)
    assert angle is not None and before is not None
    size = robot.arm_size
    (base_R,), (base_p,) = poses(robot.base_chain, q[None])
    (first_R,), (first_p,) = poses(robot.arm_chain, q[None, :size].copy())
    R, p = base_R.T @ flange[:3, :3], base_R.T @ (flange[:3, 3] - base_p)
    turn, change = rotation_vector(first_R.T @ R), wrapped(wanted - before)
    turned = max(float(np.linalg.norm(turn)), abs(change))
    length = float(np.linalg.norm(p - first_p))
    steps = math.ceil(max(length / _STEP_LENGTH, turned / _STEP_TURN, 1.0))
    arm = q[:size].copy()
    third = np.empty(steps + 1)
    third[0] = arm[robot.along[_THIRD]]
    for k in range(1, steps + 1):
        share = k / steps
        here = np.ascontiguousarray(first_R @ matrix_from_rotation_vector(share * turn))
        at = first_p + share * (p - first_p)
        if not settle(robot.arm_chain, angle, here, at, before + share * change, arm):
            return None
        third[k] = arm[robot.along[_THIRD]]
    lower, upper = robot.limits.lower[:size], robot.limits.upper[:size]
    if np.any(arm < lower) or np.any(arm > upper):
        return None
    evenly = np.linspace(third[0], third[-1], steps + 1)
    return Followed(np.concatenate([arm, q[size:]]), float(np.abs(third - evenly).max()))
