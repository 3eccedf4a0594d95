"""Where the robot stands: what the program asks of its own position.

The commanded position answers: the last target. In the tool and frame in which it was programmed
it is known from the text; in others as long as both stand on fixed frames; else, and for joint
values, the robot's kinematics are asked.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ....core.errors import Span
from ....core.program.move import Move, MoveJ
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import FLANGE, WORLD, Tool, WorkObject
from ....core.spatial.pose import Pose
from ..values.records import EXTERNAL_AXES, MM, UNUSED_AXIS, Record, pose_record
from .configuration import AbbConfiguration

if TYPE_CHECKING:
    from ....core.arrays import FloatArray
    from ....core.motion.path.commanded_position import Standing
    from ....core.robot.model import Robot


ARM_AXES = 6


class Position:
    """Follows the robot from target to target.

    Args:
        robot: None if it is not known.
        axes: kinds of its external axes, see `Converter`.
        start: where it stands at first; None if nobody knows.
    """

    def __init__(
        self, robot: Robot | None, axes: Sequence[str] | None, start: JointTarget | None = None
    ) -> None:
        self._robot = robot
        self._start = start
        self._axes = axes or ()
        self._last: Move | None = None
        self._record: Record = ()
        self._standing: Standing | None = None
        self._moves: list[tuple[Move, Span]] = []

    @property
    def tool(self) -> Tool:
        """The tool that was moved last."""
        return FLANGE if self._last is None else self._last.tool

    @property
    def work_object(self) -> WorkObject:
        """The work object that was moved in last."""
        return WORLD if self._last is None else self._last.work_object

    def moved(self, move: Move, statement: Span, record: Record) -> None:
        """The robot has driven to the target of a move.

        Args:
            statement: of the move.
            record: the target as it stood in the program.
        """
        self._last, self._record = move, record
        if self._robot is not None:
            self._moves.append((move, statement))

    # ---------------------------------------------------------------- what is asked

    def robtarget(self, tool: Tool, frame: WorkObject, displacement: Pose | None) -> Record | None:
        """The present position as a robtarget; None if it is not known.

        Args:
            displacement: program displacement in force, which the position is given in.
        """
        pose = self._pose(tool, frame)
        if pose is None:
            return None
        if displacement is not None:
            pose = displacement.inverse() @ pose
        trans, rot = pose_record(pose)
        return (trans, rot, self._configuration(), self._external())

    def jointtarget(self) -> Record | None:
        """The present joint values as a jointtarget; None if they are not known."""
        last = self._last
        if last is not None and isinstance(last.target, JointTarget) and self._record:
            return self._record
        q = self._joints()
        return None if q is None else self._joint_record(q)

    def arm(self) -> tuple[float, ...] | None:
        """The arm's joint values, rad; None if they are not known."""
        last = self._last
        if last is not None and isinstance(last.target, JointTarget):
            return last.target.joints
        q = self._joints()
        return None if q is None or self._robot is None else tuple(q[: len(q) - len(self._axes)])

    def forward(self, target: JointTarget, tool: Tool, frame: WorkObject) -> Record | None:
        """The robtarget of joint values; None without a robot."""
        if self._robot is None:
            return None
        standing = _standing(self._robot, target)
        trans, rot = pose_record(standing.pose(tool, frame))
        return (trans, rot, self._label(standing.joints()), self._external_of(target.external))

    def backward(self, target: PoseTarget, tool: Tool, frame: WorkObject) -> Record | None:
        """The jointtarget of a pose; None without a robot.

        Raises:
            FlybyError: the pose cannot be reached.
        """
        if self._robot is None:
            return None
        move = MoveJ(target, Speed(tcp=1.0), tool=tool, work_object=frame)
        return self._joint_record(self._follow().solve(move))

    # -------------------------------------------------------------------- inside

    def _pose(self, tool: Tool, frame: WorkObject) -> Pose | None:
        last = self._last
        if last is not None and isinstance(last.target, PoseTarget):
            if (last.tool.tcp, last.work_object.pose) == (tool.tcp, frame.pose):
                return last.target.pose
            if all(_fixed(f) for f in (last.work_object, frame)):
                flange = last.work_object.pose @ last.target.pose @ last.tool.tcp.inverse()
                return frame.pose.inverse() @ flange @ tool.tcp
        if self._robot is None or not self._follow().known:
            return None
        return self._follow().pose(tool, frame)

    def _joints(self) -> FloatArray | None:
        if self._robot is None or not self._follow().known:
            return None
        return self._follow().joints()

    def _follow(self) -> Standing:
        assert self._robot is not None
        if self._standing is None:
            self._standing = _standing(self._robot, self._start)
        for move, statement in self._moves:
            self._standing.moved(move, statement)
        self._moves.clear()
        return self._standing

    def _configuration(self) -> Record:
        last = self._last
        if last is not None and isinstance(last.target, PoseTarget):
            given = last.target.configuration
            if isinstance(given, AbbConfiguration):
                return tuple(float(v) for v in (given.cf1, given.cf4, given.cf6, given.cfx))
        q = self._joints()
        return (0.0, 0.0, 0.0, 0.0) if q is None else self._label(q)

    def _label(self, q: FloatArray) -> Record:
        from .configuration import label

        found = None if self._robot is None else label(self._robot, q)
        if found is None:
            return (0.0, 0.0, 0.0, 0.0)
        return tuple(float(v) for v in (found.cf1, found.cf4, found.cf6, found.cfx))

    def _external(self) -> Record:
        at = self._start if self._last is None else self._last.target
        return self._external_of(() if at is None else at.external)

    def _external_of(self, values: Sequence[float]) -> Record:
        shown = [
            value / MM if kind == "linear" else math.degrees(value)
            for value, kind in zip(values, self._axes, strict=False)
        ]
        return tuple(shown + [UNUSED_AXIS] * (EXTERNAL_AXES - len(shown)))

    def _joint_record(self, q: FloatArray) -> Record:
        arm = len(q) - len(self._axes)
        joints = [math.degrees(v) for v in q[:arm]][:ARM_AXES]
        robax = tuple(joints + [0.0] * (ARM_AXES - len(joints)))
        return (robax, self._external_of([float(v) for v in q[arm:]]))


def _fixed(frame: WorkObject) -> bool:
    return not frame.robot_held and frame.moved_by is None


def _standing(robot: Robot, start: JointTarget | None) -> Standing:
    from ....core.motion.path.commanded_position import Standing
    from .configuration import label

    return Standing(robot, label, start)
