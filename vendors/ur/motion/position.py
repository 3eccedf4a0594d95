"""Where the robot stands in the course of a program, and what its kinematics answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....core.errors import InputError, MotionError, SourceError, Span
from ....core.program.move import Move, MoveJ
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import WORLD, Tool, WorkObject
from ....core.spatial.pose import IDENTITY, Pose
from ..values.values import AtStart, Unknown, Value
from .configuration import UrConfiguration, label

if TYPE_CHECKING:
    from ....core.motion.path.commanded_position import Standing
    from ....core.robot.model import Robot

Joints = tuple[float, ...]


class Position:
    """Follows the moves of a program.

    Without a robot only what the last target states is known.

    Args:
        robot: whose kinematics answer; None if none is at hand.
        start: where it stands at first; None if nobody knows.

    Attributes:
        asked: how often somebody wanted to know.
        base: the frame in which programs give poses: the robot's base, wherever it stands.
    """

    def __init__(self, robot: Robot | None, start: JointTarget | None = None) -> None:
        self._robot = robot
        self._start = start
        self.base = WORLD
        if robot is not None and robot.base != IDENTITY:
            self.base = WorkObject("base", user=robot.base)
        self._moves: list[Move] = []
        self._statements: list[Span] = []
        self._fed = 0
        self._follower: Standing | None = None
        self.asked = 0

    @property
    def has_robot(self) -> bool:
        """Whether kinematics can be asked."""
        return self._robot is not None

    @property
    def known(self) -> bool:
        """Whether there was a move, or a start is known."""
        return bool(self._moves) or self._start is not None

    def is_here(self, value: Value) -> bool:
        """Whether a value is where the robot stands now, though nobody knows where that is."""
        return isinstance(value, AtStart) and not self._moves

    def moved(self, move: Move, statement: Span) -> None:
        """The robot has driven to the target of a move."""
        self._moves.append(move)
        self._statements.append(statement)

    def joints(self, what: str, span: Span) -> Joints | Unknown:
        """The joint values, rad.

        Args:
            what: is asked, for the reason why it is not known.
        """
        self.asked += 1
        if not self._moves and self._start is None:
            return AtStart(_before(what), span)
        last = self._moves[-1].target if self._moves else self._start
        if isinstance(last, JointTarget):
            return last.joints
        if self._robot is None:
            return _nameless(what, span)
        try:
            return self._arm(self._standing().joints())
        except (InputError, MotionError) as error:
            return Unknown(f"{what} ({error})", span)

    def pose(self, tool: Tool, what: str, span: Span) -> Pose | Unknown:
        """The TCP of a tool in the robot's base; ``what`` as in `joints`."""
        self.asked += 1
        if not self._moves and self._start is None:
            return Unknown(_before(what), span)
        last = self._moves[-1] if self._moves else None
        if last is not None and isinstance(last.target, PoseTarget):
            if last.tool.tcp == tool.tcp:
                return last.target.pose
            return last.target.pose @ last.tool.tcp.inverse() @ tool.tcp
        if self._robot is None:
            return _nameless(what, span)
        try:
            return self._standing().pose(tool, self.base)
        except (InputError, MotionError) as error:
            return Unknown(f"{what} ({error})", span)

    def forward(self, joints: Joints, tool: Tool, what: str, span: Span) -> Pose | Unknown:
        """The TCP at joint values."""
        if self._robot is None:
            return _nameless(what, span)
        from ....core.motion.path.commanded_position import Standing

        try:
            return Standing(self._robot, label, JointTarget(joints)).pose(tool, self.base)
        except (InputError, MotionError) as error:
            raise SourceError(f"{what}: {error}", span) from None

    def solve(
        self, pose: Pose, tcp: Pose, near: UrConfiguration | None, span: Span
    ) -> Joints | None:
        """Joint values that put a TCP on a pose; None if there are none.

        Raises:
            SourceError: ``near`` has another number of joints than the arm.
        """
        move = MoveJ(PoseTarget(pose, near), Speed(), tool=Tool("tcp", tcp), work_object=self.base)
        try:
            return self._arm(self._standing().solve(move))
        except MotionError:
            return None
        except InputError as error:
            raise SourceError(f"get_inverse_kin: {error}", span) from None

    def _standing(self) -> Standing:
        if self._follower is None:
            from ....core.motion.path.commanded_position import Standing

            assert self._robot is not None
            self._follower = Standing(self._robot, label, self._start)
        for k in range(self._fed, len(self._moves)):
            self._follower.moved(self._moves[k], self._statements[k])
        self._fed = len(self._moves)
        return self._follower

    def _arm(self, q: object) -> Joints:
        import numpy as np

        assert self._robot is not None and isinstance(q, np.ndarray)
        return tuple(float(value) for value in q[: self._robot.arm_size])


def _before(what: str) -> str:
    return f"{what} before the first move, when nobody knows where the robot stands (give a start)"


def _nameless(what: str, span: Span) -> Unknown:
    return Unknown(f"{what}, for which the robot's kinematics are needed (name the robot)", span)
