"""Where the robot stands, as RAPID's robtargets and jointtargets."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from ....core.errors import Span
from ....core.motion.path.present_position import PresentPosition
from ....core.program.move import Move
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import Tool, WorkObject
from ....core.source.text.axis_values import axis_values
from ....core.spatial.pose import Pose
from ..values.records import (
    ARM_AXES,
    EXTERNAL_AXES,
    MM,
    NO_AXIS,
    UNUSED_AXIS,
    Record,
    arm_axes,
    in_places,
    pose_record,
)
from .configuration import AbbConfiguration, label

if TYPE_CHECKING:
    from ....core.arrays import FloatArray
    from ....core.robot.model import Robot


class Position(PresentPosition):
    """Follows the robot from target to target.

    Args:
        robot: None if it is not known.
        axes: kinds of its external axes, see `Converter`.
        start: where it stands at first; None if nobody knows.
    """

    def __init__(
        self, robot: Robot | None, axes: Sequence[str] | None, start: JointTarget | None = None
    ) -> None:
        super().__init__(robot, start, label)
        self._axes = axes or ()
        self._record: Record = ()

    def moved(self, move: Move, statement: Span, record: Record = ()) -> None:
        """The robot has driven to the target of a move.

        Args:
            record: the target as it stood in the program.
        """
        super().moved(move, statement)
        self._record = record

    # ---------------------------------------------------------------- what is asked

    def robtarget(self, tool: Tool, frame: WorkObject, displacement: Pose | None) -> Record | None:
        """The present position as a robtarget; None if it is not known.

        Args:
            displacement: program displacement in force, which the position is given in.
        """
        pose = self.pose(tool, frame)
        if pose is None:
            return None
        if displacement is not None:
            pose = displacement.inverse() @ pose
        trans, rot = pose_record(pose)
        last, start = self.last, self.start
        at = start if last is None else last.target
        external = () if at is None else at.external
        return (trans, rot, self._configuration(), self._extax_at(external, at, self.joints))

    def jointtarget(self) -> Record | None:
        """The present joint values as a jointtarget; None if they are not known."""
        self.asked += 1
        last = self.last
        if last is not None and isinstance(last.target, JointTarget) and self._record:
            return self._record
        q = self.joints()
        return None if q is None else self._joint_record(q)

    def robtarget_at(self, target: JointTarget, tool: Tool, frame: WorkObject) -> Record | None:
        """The robtarget of joint values; None without a robot."""
        standing = self.at(target)
        if standing is None:
            return None
        trans, rot = pose_record(standing.pose(tool, frame))
        extax = self._extax_at(target.external, target, standing.joints)
        return (trans, rot, self._confdata(standing.joints()), extax)

    def jointtarget_at(self, target: PoseTarget, tool: Tool, frame: WorkObject) -> Record | None:
        """The jointtarget of a pose; None without a robot.

        Raises:
            FlybyError: the pose cannot be reached.
        """
        self.asked += 1
        q = self.solve(target, tool, frame)
        return None if q is None else self._joint_record(q)

    # -------------------------------------------------------------------- inside

    def _configuration(self) -> Record:
        last = self.last
        if last is not None and isinstance(last.target, PoseTarget):
            given = last.target.configuration
            if isinstance(given, AbbConfiguration):
                return given.record
        q = self.joints()
        return (0.0, 0.0, 0.0, 0.0) if q is None else self._confdata(q)

    def _confdata(self, q: FloatArray) -> Record:
        found = None if self.robot is None else label(self.robot, q)
        return (0.0, 0.0, 0.0, 0.0) if found is None else found.record

    def _extax_at(
        self,
        external: tuple[float, ...],
        at: PoseTarget | JointTarget | None,
        joints: Callable[[], FloatArray | None],
    ) -> Record:
        """The extjoint of a robtarget where the robot stands at a target.

        Args:
            joints: asked for the arm angle where the target states none.
        """
        if arm_axes(self._axes) == ARM_AXES:
            return self._extax(external)
        angle = at.arm_angle if isinstance(at, PoseTarget) else None
        if angle is None and self.robot is not None:
            q = joints()
            angle = None if q is None else self.robot.arm_angle(q)
        return self._extax((angle, *external))

    def _extax(self, values: Sequence[float | None]) -> Record:
        shown = [
            UNUSED_AXIS
            if value is None
            else (value / MM if kind == "linear" else math.degrees(value))
            for value, kind in zip(in_places(values, self._axes), self._axes, strict=False)
        ]
        return tuple(shown + [UNUSED_AXIS] * (EXTERNAL_AXES - len(shown)))

    def _joint_record(self, q: FloatArray) -> Record:
        own = sum(kind != NO_AXIS for kind in self._axes)
        arm = len(q) - own  # the first six of seven
        joints = axis_values(self.robot, q[:arm])[:ARM_AXES]
        robax = tuple(joints + [0.0] * (ARM_AXES - len(joints)))
        return (robax, self._extax([float(v) for v in q[arm:]]))
