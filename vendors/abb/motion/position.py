"""Where the robot stands, as RAPID's robtargets and jointtargets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ....core.errors import Span
from ....core.motion.path.present_position import PresentPosition
from ....core.program.move import Move
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import Tool, WorkObject
from ....core.spatial.pose import Pose
from ..values.records import EXTERNAL_AXES, MM, UNUSED_AXIS, Record, pose_record
from .configuration import AbbConfiguration, label

if TYPE_CHECKING:
    from ....core.arrays import FloatArray
    from ....core.robot.model import Robot

ARM_AXES = 6


class Position:
    """Follows the robot from target to target.

    Args:
        robot: None if it is not known.
        axes: kinds of its external axes, see `Converter`.
        start: where it stands at first; None if nobody knows.

    Attributes:
        asked: how often the program has asked where the robot stands.
    """

    def __init__(
        self, robot: Robot | None, axes: Sequence[str] | None, start: JointTarget | None = None
    ) -> None:
        self.asked = 0
        self._axes = axes or ()
        self._record: Record = ()
        self._commanded = PresentPosition(robot, start, label)

    @property
    def robot(self) -> Robot | None:
        """Whose position it is; None if it is not known."""
        return self._commanded.robot

    @property
    def tool(self) -> Tool:
        """The tool that was moved last."""
        return self._commanded.tool

    @property
    def work_object(self) -> WorkObject:
        """The work object that was moved in last."""
        return self._commanded.work_object

    def moved(self, move: Move, statement: Span, record: Record) -> None:
        """The robot has driven to the target of a move.

        Args:
            record: the target as it stood in the program.
        """
        self._commanded.moved(move, statement)
        self._record = record

    # ---------------------------------------------------------------- what is asked

    def robtarget(self, tool: Tool, frame: WorkObject, displacement: Pose | None) -> Record | None:
        """The present position as a robtarget; None if it is not known.

        Args:
            displacement: program displacement in force, which the position is given in.
        """
        self.asked += 1
        pose = self._commanded.pose(tool, frame)
        if pose is None:
            return None
        if displacement is not None:
            pose = displacement.inverse() @ pose
        trans, rot = pose_record(pose)
        last, start = self._commanded.last, self._commanded.start
        at = start if last is None else last.target
        return (
            trans,
            rot,
            self._configuration(),
            self._external(() if at is None else at.external),
        )

    def jointtarget(self) -> Record | None:
        """The present joint values as a jointtarget; None if they are not known."""
        self.asked += 1
        last = self._commanded.last
        if last is not None and isinstance(last.target, JointTarget) and self._record:
            return self._record
        q = self._commanded.joints()
        return None if q is None else self._joint_record(q)

    def forward(self, target: JointTarget, tool: Tool, frame: WorkObject) -> Record | None:
        """The robtarget of joint values; None without a robot."""
        standing = self._commanded.at(target)
        if standing is None:
            return None
        trans, rot = pose_record(standing.pose(tool, frame))
        return (trans, rot, self._label(standing.joints()), self._external(target.external))

    def backward(self, target: PoseTarget, tool: Tool, frame: WorkObject) -> Record | None:
        """The jointtarget of a pose; None without a robot.

        Raises:
            FlybyError: the pose cannot be reached.
        """
        self.asked += 1
        q = self._commanded.solve(target, tool, frame)
        return None if q is None else self._joint_record(q)

    # -------------------------------------------------------------------- inside

    def _configuration(self) -> Record:
        last = self._commanded.last
        if last is not None and isinstance(last.target, PoseTarget):
            given = last.target.configuration
            if isinstance(given, AbbConfiguration):
                return tuple(float(v) for v in (given.cf1, given.cf4, given.cf6, given.cfx))
        q = self._commanded.joints()
        return (0.0, 0.0, 0.0, 0.0) if q is None else self._label(q)

    def _label(self, q: FloatArray) -> Record:
        found = None if self.robot is None else label(self.robot, q)
        if found is None:
            return (0.0, 0.0, 0.0, 0.0)
        return tuple(float(v) for v in (found.cf1, found.cf4, found.cf6, found.cfx))

    def _external(self, values: Sequence[float]) -> Record:
        shown = [
            value / MM if kind == "linear" else math.degrees(value)
            for value, kind in zip(values, self._axes, strict=False)
        ]
        return tuple(shown + [UNUSED_AXIS] * (EXTERNAL_AXES - len(shown)))

    def _joint_record(self, q: FloatArray) -> Record:
        arm = len(q) - len(self._axes)
        joints = [math.degrees(v) for v in q[:arm]][:ARM_AXES]
        robax = tuple(joints + [0.0] * (ARM_AXES - len(joints)))
        return (robax, self._external([float(v) for v in q[arm:]]))
