"""Which singularity of its arm a configuration is nearest to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from .inverse.arm_inverse import SOLVERS
from .inverse.ranges import FULL_TURN
from .kinematics.chain_kernels import poses
from .model import Robot


class Singularity(NamedTuple):
    """A kind of singular configuration.

    Args:
        name: shoulder, elbow or wrist.
        meaning: what the arm looks like there.
        remedy: how a path of the TCP gets round it.
    """

    name: str
    meaning: str
    remedy: str


_IN_IT = 1e-6
"""Of the distance from a singularity: as near as the closed form tells."""

_KINDS = (
    Singularity(
        "shoulder",
        "the wrist is as near to axis 1 as it gets",
        "lead the path past axis 1 at a distance, or use a joint move",
    ),
    Singularity(
        "elbow",
        "the arm is stretched or folded to its end",
        "keep the path within the arm's reach, or use a joint move",
    ),
    Singularity(
        "wrist",
        "axes 4 and 6 are parallel",
        "turn the tool a little on the way, or use a joint move",
    ),
)


def nearest_singularity(robot: Robot, q: ArrayLike) -> Singularity | None:
    """The singularity that a configuration (N,) is nearest to; None where no closed form of the
    arm tells them apart."""
    apart = _distances(robot, q)
    return None if apart is None else _KINDS[int(np.argmin(apart))]


def is_singular(robot: Robot, q: ArrayLike) -> bool:
    """Whether an arm stands in a singularity itself, as far as a closed form tells."""
    apart = _distances(robot, q)
    return apart is not None and float(np.min(apart)) < _IN_IT


def _distances(robot: Robot, q: ArrayLike) -> FloatArray | None:
    """How far a configuration is from each kind, without a unit."""
    known = robot.recognised
    if known is None:
        return None
    arm = np.ascontiguousarray(np.asarray(q, dtype=float)[: robot.arm_size])
    R, p = poses(robot.arm_chain, arm[None])
    solutions, measures = np.empty((1, 8, 6)), np.empty((1, 8, 4))
    SOLVERS[known.family](known.geometry, R, p, solutions, measures)
    apart = solutions[0] - known.angles(arm)
    apart -= FULL_TURN * np.round(apart / FULL_TURN)
    shoulder, *sines = np.abs(measures[0, np.argmin(np.abs(apart).max(axis=1)), :3])
    upper = np.linalg.norm(known.geometry.elbow - known.geometry.shoulder)
    return np.array([shoulder / upper, *sines])
