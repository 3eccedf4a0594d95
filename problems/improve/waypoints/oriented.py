"""A joint target that moves while the tool keeps its orientation.

The arm's configurations with the flange turned as programmed form a surface. Its points are named
by coordinates in the plane that touches it at the programmed configuration; from there, Newton
steps square to the plane lead onto it. With six joints it has three dimensions (the tool is
shifted), with two joints whose axes are parallel one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import MotionError
from ....core.program.move import Move
from ....core.program.target import JointTarget
from ....core.robot.kinematics.chain import Chain
from ....core.robot.kinematics.chain_kernels import jacobian
from ....core.spatial.rotation import rotation_vector
from ..rounding import Rounding
from .parts import JointPoint

_STEPS, _TURNED, _LARGEST = 40, 1e-11, 0.5
"""Newton steps at most; rad of orientation that may be left; rad of a step at most."""
_FREE = 1e-6
"""Of the largest singular value: what turns the tool by less does not turn it."""


@dataclass(frozen=True)
class OrientedPoint(JointPoint):
    """A joint target whose tool keeps its orientation.

    Args:
        chain: from the robot's base to its flange.
    """

    chain: Chain

    @property
    def plane(self) -> FloatArray:
        """(len(axes), size), orthonormal directions in which the tool does not turn at first."""
        return self._directions[0]

    def values(self) -> FloatArray:
        return np.zeros(self.plane.shape[1])

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        most = np.full(self.size, float(np.linalg.norm(self.upper - self.lower)))
        return -most, most

    def along(self, change: FloatArray) -> FloatArray:
        return np.asarray(self.plane.T @ super().along(change))

    def applied(self, move: Move, values: FloatArray) -> Move:
        return super().applied(move, self._joints(values))

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        return super().written(move, self._joints(values), rounding)

    def slope(self, values: FloatArray) -> FloatArray:
        N, M = self._directions
        J = self._turning(self._joints(values))[1]
        return np.asarray(N - M @ np.linalg.lstsq(J @ M, J @ N, rcond=None)[0])

    def _pulled(self, by_joint: FloatArray, values: FloatArray) -> FloatArray:
        return np.asarray(by_joint @ self.slope(values))

    @cached_property
    def _orientation(self) -> FloatArray:
        return self._placed(self.given)[0]

    @cached_property
    def _directions(self) -> tuple[FloatArray, FloatArray]:
        """Those in which the tool does not turn, and those square to them."""
        J = self._placed(self.given)[1]
        _, sizes, rows = np.linalg.svd(J)
        rank = int((sizes > _FREE * max(1.0, sizes[0])).sum())
        return np.ascontiguousarray(rows[rank:].T), np.ascontiguousarray(rows[:rank].T)

    def _joints(self, values: FloatArray) -> FloatArray:
        """(len(axes),) at these values."""
        N, M = self._directions
        joints = self.given + N @ values
        for _ in range(_STEPS):
            turned, J = self._turning(joints)
            if np.abs(turned).max() < _TURNED:
                break
            step = -np.linalg.lstsq(J @ M, turned, rcond=None)[0]
            size = float(np.linalg.norm(step))
            joints = joints + M @ (step * min(1.0, _LARGEST / size))
        else:
            raise MotionError(
                "a via point cannot be moved so far with its tool kept as it is turned"
            )
        if np.any(joints < self.lower) or np.any(joints > self.upper):
            raise MotionError("a via point with its tool kept as it is turned is out of range")
        return joints

    def _turning(self, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far the tool is turned from what is programmed (3,), and what turns it (3, axes)."""
        R, J = self._placed(joints)
        return rotation_vector(R @ self._orientation.T), J

    def _placed(self, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
        q = np.array(self.target.joints)
        q[list(self.axes)] = joints
        R, p, J = np.empty((3, 3)), np.empty(3), np.empty((6, len(q)))
        jacobian(self.chain, q, R, p, J)
        return R, J[3:, list(self.axes)]


def stays_oriented(target: JointTarget, chain: Chain, axes: Sequence[int]) -> bool:
    """Whether a joint target cannot move at all while its tool keeps its orientation."""
    none = np.zeros(len(axes))
    return OrientedPoint((), target, tuple(axes), none, none, chain).size == 0
