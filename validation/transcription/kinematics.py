"""Points on the robot as functions of the joints that move, with first and second derivatives."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.arrays import FloatArray
from ...core.robot.assembly import Stage, assemble
from ...core.robot.kinematics.chain import Chain
from ...core.robot.kinematics.chain_derivatives import hessians
from ...core.robot.kinematics.chain_kernels import jacobians, poses
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose


class MovingPoint:
    """A point fixed to the robot: a `Field` of its three coordinates.

    Args:
        robot: which.
        link: 0 for the base, k for the link behind the arm's joint k, n + 1 for the flange.
        point: in that link's frame, m.
        free: the joints that move.
        rest: (N,) configuration that the other joints keep.
        frame: in which the coordinates are given: None for the world's, else a frame in the world.
    """

    size = 3

    def __init__(
        self,
        robot: Robot,
        link: int,
        point: FloatArray,
        free: Sequence[int],
        rest: FloatArray,
        frame: Pose | None = None,
    ) -> None:
        self._chain = _chain(robot, link, point, frame)
        self._free, self._rest = list(free), rest

    def values(self, q: FloatArray) -> FloatArray:
        """Positions (R, 3) m."""
        return np.asarray(poses(self._chain, self._full(q))[1])

    def jacobian(self, q: FloatArray) -> FloatArray:
        """(R, 3, n)."""
        return np.asarray(jacobians(self._chain, self._full(q))[:, :3, self._free])

    def hessians(self, q: FloatArray) -> FloatArray:
        """(R, 3, n, n) of each coordinate."""
        every = hessians(self._chain, self._full(q))[:, :3]
        return np.asarray(every[:, :, self._free][:, :, :, self._free])

    def hessian(self, q: FloatArray, multipliers: FloatArray) -> FloatArray:
        """See `Field`."""
        return np.asarray(np.einsum("rk,rkab->rab", multipliers, self.hessians(q)))

    def _full(self, q: FloatArray) -> FloatArray:
        full = np.empty((len(q), len(self._rest)))
        full[:] = self._rest
        full[:, self._free] = q
        return full


def _chain(robot: Robot, link: int, point: FloatArray, frame: Pose | None) -> Chain:
    x, y, z = (float(v) for v in point)
    arm: list[Stage] = [*robot.link_stages(min(link, robot.arm_size))]
    if link > robot.arm_size:
        arm.append(robot.flange)
    first: list[Stage] = [] if frame is None else [frame.inverse()]
    return assemble([*first, *robot.base_stages(), *arm, Pose((x, y, z))])
