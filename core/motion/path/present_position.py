"""Where the robot stands: what a program asks of its own position.

The commanded position answers: the last target. In the tool and frame in which it was programmed
it is known from the text; in others as long as both stand on fixed frames; else, and for joint
values, the robot's kinematics are asked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...errors import Span
from ...program.move import Move, MoveJ
from ...program.speed import Speed
from ...program.target import JointTarget, PoseTarget
from ...program.tool import FLANGE, WORLD, Tool, WorkObject
from ...robot.model import Robot
from ...spatial.pose import Pose

if TYPE_CHECKING:
    from ...arrays import FloatArray
    from ..configurations.finder import Label
    from .commanded_position import Standing


NO_ROBOT = "name the robot: its kinematics tell"
NO_START = "the robot has not moved yet: give a start"


class PresentPosition:
    """Follows the robot from target to target; kinematics are solved when they are asked for.

    Args:
        robot: None if none is named.
        start: where it stands at first; None if nobody knows.
        label: the vendor's label of a configuration.

    Attributes:
        asked: how often the program has asked where the robot stands.
        last: the last move; None before the first.
        supposed: what it depends on where the robot stands, if it was driven there on a way that
            was chosen by rule, or by a move that is `Move.supposed`; empty if on nothing.
    """

    def __init__(self, robot: Robot | None, start: JointTarget | None, label: Label) -> None:
        self.robot = robot
        if start is None and robot is not None and not robot.has_arm:
            start = JointTarget((0.0,) * robot.arm_size)
        self.start = start
        self.asked = 0
        self.last: Move | None = None
        self.supposed = ""
        self._label = label
        self._standing: Standing | None = None
        self._ahead: list[tuple[Move, Span]] = []

    @property
    def tool(self) -> Tool:
        """The tool that was moved last."""
        return FLANGE if self.last is None else self.last.tool

    @property
    def work_object(self) -> WorkObject:
        """The work object that was moved in last."""
        return WORLD if self.last is None else self.last.work_object

    def moved(self, move: Move, statement: Span) -> None:
        """The robot has driven to the target of a move."""
        self.last = move
        self.supposed = move.supposed and f"where the robot stands ({move.supposed})"
        if self.robot is not None:
            self._ahead.append((move, statement))

    def lose(self) -> None:
        """The robot has driven to where nobody knows."""
        self.last = self.start = self._standing = None
        self._ahead.clear()

    def suppose(self, reason: str) -> None:
        """The robot stands where it does by a way that was chosen by rule."""
        self.supposed = self.supposed or f"where the robot stands ({reason})"

    def why_unknown(self) -> str:
        """What is missing where nobody knows where the robot stands."""
        return NO_ROBOT if self.robot is None else NO_START

    def pose(self, tool: Tool, frame: WorkObject) -> Pose | None:
        """The pose of a tool in a frame; None if it is not known (see `why_unknown`)."""
        self.asked += 1
        last = self.last
        if last is not None and isinstance(last.target, PoseTarget):
            if last_seen_alike(last, tool, frame):
                return last.target.pose
            if _fixed(last.work_object) and _fixed(frame):
                flange = last.target.pose @ last.tool.tcp.inverse()
                if last.work_object.pose != frame.pose:
                    flange = frame.pose.inverse() @ (last.work_object.pose @ flange)
                return flange @ tool.tcp
        standing = self._followed()
        return None if standing is None or not standing.known else standing.pose(tool, frame)

    def joints(self) -> FloatArray | None:
        """The configuration (N,), the arm's joints first; None if it is not known."""
        self.asked += 1
        standing = self._followed()
        return None if standing is None or not standing.known else standing.joints()

    def at(self, start: JointTarget | None) -> Standing | None:
        """A robot that stands somewhere, or nobody knows where; None without one."""
        from .commanded_position import Standing  # late: it takes time

        if self.robot is None:
            return None
        return Standing(self.robot, self._label, start, past_faults=True)

    def forward(self, target: JointTarget, tool: Tool, frame: WorkObject) -> Pose | None:
        """The pose of a tool at joint values; None without a robot."""
        standing = self.at(target)
        return None if standing is None else standing.pose(tool, frame)

    def solve(
        self, target: PoseTarget, tool: Tool, frame: WorkObject, near: JointTarget | None = None
    ) -> FloatArray | None:
        """The configuration (N,) at a pose; None without a robot.

        Args:
            near: the solution nearest to it is taken; None for where the robot stands.

        Raises:
            FlybyError: the pose cannot be reached.
        """
        standing = self._followed()
        if standing is not None and near is not None:
            standing = self.at(near)
        if standing is None:
            return None
        return standing.solve(MoveJ(target, Speed(tcp=1.0), tool=tool, work_object=frame))

    def _followed(self) -> Standing | None:
        """The robot, when all moves have been driven; None without one."""
        if self._standing is None:
            self._standing = self.at(self.start)
        if self._standing is not None:
            for move, statement in self._ahead:
                self._standing.moved(move, statement)
            self._ahead.clear()
        return self._standing


def last_seen_alike(last: Move, tool: Tool, frame: WorkObject) -> bool:
    """Whether the numbers of a pose mean the same in a tool and frame as in a move."""
    mine = (last.tool.tcp, last.tool.robot_held, last.work_object.pose, last.work_object.moved_by)
    return mine == (tool.tcp, tool.robot_held, frame.pose, frame.moved_by)


def _fixed(frame: WorkObject) -> bool:
    return not frame.robot_held and frame.moved_by is None
