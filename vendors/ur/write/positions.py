"""Where the robot of a program stands before each move, for what depends on it."""

from __future__ import annotations

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError, MotionError
from ....core.motion.path.commanded_position import Standing
from ....core.program.move import Move, MoveC, MoveJ
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget
from ....core.robot.model import Robot
from ....core.spatial.pose import Pose
from ..motion.arcs import carried_along
from ..motion.configuration import label

_SAME_TURN = 1e-6
"""rad, to which an arc's end must have the orientation that a controller gives it."""


class Standpoint:
    """Follows a robot through a program; kinematics are solved only when they are asked for.

    Args:
        program: says where it starts.
    """

    def __init__(self, robot: Robot, program: Program) -> None:
        self._standing = Standing(robot, label, program.start)
        self._last: Move | None = None

    def moved(self, move: Move) -> None:
        """The robot has driven a move."""
        self._standing.moved(move)
        self._last = move

    def way(self, move: MoveJ) -> FloatArray:
        """How far each joint turns along a joint move (N,), rad.

        Raises:
            InputError: the start is not known, or the target out of reach.
        """
        self._check_known("the speed and acceleration of the leading joint")
        try:
            begin = self._standing.joints()
            if isinstance(move.target, JointTarget):
                return np.abs(np.array(move.target.joints) - begin)
            return np.abs(self._standing.solve(move) - begin)
        except MotionError as error:
            raise InputError(f"its way is not known: {error}") from None

    def check_following(self, move: MoveC) -> None:
        """Refuse an arc whose tool does not keep its orientation to the arc.

        That is what a controller does in mode 1, whatever orientation the end has.

        Raises:
            InputError: the tool arrives with another orientation, or the start is not known.
        """
        assert isinstance(move.target, PoseTarget)
        start, end = self._pose(move), move.target.pose
        turned = carried_along(start, move.via.pose.position, end.position)
        if turned is None:
            return
        off = (Pose(quaternion=turned).inverse() @ Pose(quaternion=end.quaternion)).quaternion
        angle = 2 * float(np.arctan2(np.linalg.norm(off[1:]), abs(off[0])))
        if angle > _SAME_TURN:
            raise InputError(
                f"the tool ends {np.degrees(angle):.3g}° away from the orientation to the arc that "
                "it begins with, which movec cannot say in mode 1: end with that orientation, or "
                "turn the tool from pose to pose (ArcOrientation.FIXED_FRAME)"
            )

    def _pose(self, move: Move) -> Pose:
        """Where a move begins, for its tool and in its work object."""
        last = self._last
        if last is not None and _in_same_frame(last, move) and isinstance(last.target, PoseTarget):
            return last.target.pose
        self._check_known("to know where the arc begins")
        try:
            return self._standing.pose(move.tool, move.work_object)
        except MotionError as error:
            raise InputError(f"where the arc begins is not known: {error}") from None

    def _check_known(self, what: str) -> None:
        if not self._standing.known:
            raise InputError(
                f"URScript needs {what}, which depends on where the robot starts, and the program "
                "does not say it: give the program a start, or move first to a target"
            )


def _in_same_frame(one: Move, other: Move) -> bool:
    return (one.tool, one.work_object) == (other.tool, other.work_object)
