"""Where the flange is at the targets of moves, without their inverse kinematics."""

from __future__ import annotations

import numpy as np

from ..program.move import Move
from ..program.target import JointTarget
from ..robot.assembly import assemble
from ..robot.kinematics.chain_kernels import poses
from ..robot.model import Robot
from ..spatial.pose import IDENTITY, Pose, Vector3


class FlangeFollower:
    """Follows the flange from target to target.

    Args:
        robot: whose.
        start: where it stands; None if nobody knows.

    Attributes:
        flange: in the world; None where nobody knows where the robot stands.
        tcp: of the last move's tool, in the world, m.
    """

    def __init__(self, robot: Robot, start: JointTarget | None) -> None:
        self._robot = robot
        self._q = np.clip(np.zeros(robot.size), robot.limits.lower, robot.limits.upper)
        self.flange: Pose | None = None
        self.tcp: Vector3 | None = None
        if start is not None:
            self.flange = self._at(start)
            self.tcp = None if self.flange is None else self.flange.position

    def moved(self, move: Move) -> None:
        """The robot has driven to the target of a move."""
        target, tool = move.target, move.tool
        self.flange = self.tcp = None
        if move.open:
            return
        if isinstance(target, JointTarget):
            self.flange = self._at(target)
        else:
            self._external(target.external)
            held = move.work_object.pose @ target.pose
            if tool.robot_held:
                frame = self.frame(move.work_object.moved_by)
                self.flange = frame @ held @ tool.tcp.inverse()
            else:
                self.flange = tool.tcp @ held.inverse()
        if self.flange is not None:
            at = self.flange @ tool.tcp if tool.robot_held else self.flange
            self.tcp = at.position

    def frame(self, axis: str | None) -> Pose:
        """The frame behind an external axis, in the world; None for the world."""
        if axis is None:
            return IDENTITY
        R, p = poses(assemble(self._robot.frame_stages(axis)), self._q[None])
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = R[0], p[0]
        return Pose.from_matrix(matrix)

    def _external(self, values: tuple[float, ...]) -> None:
        arm = self._robot.arm_size
        self._q[arm : arm + len(values)] = values[: self._robot.size - arm]

    def _at(self, target: JointTarget) -> Pose | None:
        if len(target.joints) != self._robot.arm_size:
            return None
        self._q[: self._robot.arm_size] = target.joints
        self._external(target.external)
        return self._robot.flange_pose(self._q)
