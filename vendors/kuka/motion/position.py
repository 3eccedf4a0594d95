"""Where the robot stands: what ``$POS_ACT``, ``_REL`` and targets that leave components out need.

A pose is as the last target stated it if that was a pose of the same tool in the same base; see
`core.motion.path.present_position` for others.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ....core.errors import FlybyError, SourceError, Span
from ....core.motion.path.present_position import PresentPosition, last_seen_alike
from ....core.program.move import Move, MoveJ
from ....core.program.target import JointTarget, PoseTarget
from ....core.robot.joint import JointKind
from ....core.source.text.axis_values import axis_values
from ....core.spatial.pose import Pose
from ..values.frames import frame_of
from ..values.types import AXIS_FIELDS, EXTERNAL_FIELDS, external_fields
from ..values.values import Placement, Struct, Unknown, Value
from .configuration import label

if TYPE_CHECKING:
    from ....core.arrays import FloatArray
    from ....core.robot.model import Robot

WHERE = "where the robot stands"


class Position:
    """Follows a robot from target to target.

    Args:
        robot: None if none is named.
        start: where it stands at first; None if nobody knows.
    """

    def __init__(self, robot: Robot | None, start: JointTarget | None = None) -> None:
        self._robot = robot
        self._names = external_fields(robot)
        self._commanded = PresentPosition(robot, start, label)
        self._last: Struct | None = None
        self._place: Struct | None = None
        self._left_out: Span | None = None
        if robot is not None and start is not None:
            self._last = self._place = self.axis_struct((*start.joints, *start.external))

    def moved(self, move: Move, statement: Span, target: Struct) -> None:
        """The robot has driven to a target, whose components are all in ``target``."""
        self._commanded.moved(move, statement)
        self._left_out = None
        self._last = target
        if target != self._place:
            self._place = target

    def streamed(self, move: MoveJ, statement: Span) -> None:
        """The robot has driven to joint values that a computer has sent."""
        assert isinstance(move.target, JointTarget)
        self.moved(move, statement, self.axis_struct(move.target.joints))

    def left_out(self, span: Span) -> None:
        """A motion was left out: where the robot stands is not known until the next."""
        self._left_out = span

    @property
    def supposed(self) -> str:
        """See `PresentPosition.supposed`."""
        return self._commanded.supposed

    def suppose(self, reason: str) -> None:
        """See `PresentPosition.suppose`."""
        self._commanded.suppose(reason)

    @property
    def place(self) -> object:
        """Where the robot stands: another object after every move to another place."""
        return self._place

    # ----------------------------------------------------------------------- queries

    def pose(self, placement: Placement, span: Span) -> Struct | Unknown:
        """The pose of the tool in the base, with S, T and external axes as far as they are known.

        Raises:
            SourceError: a target on the way cannot be reached.
        """
        if self._left_out is not None:
            return self._unknown(span)
        tool, base, last = placement.tool, placement.work_object, self._commanded.last
        if (
            last is not None
            and isinstance(last.target, PoseTarget)
            and last_seen_alike(last, tool, base)
        ):
            assert self._last is not None
            return self._last.copy()
        try:
            pose = self._commanded.pose(tool, base)
            if pose is None:
                return self._unknown(span)
            made = frame_of(pose, "e6pos")
            made.fields.update(self._present_external())
        except FlybyError as error:
            raise SourceError(f"{WHERE}: {error}", span) from None
        return made

    def axes(self, span: Span) -> Struct | Unknown:
        """The axis values.

        Raises:
            SourceError: a target on the way cannot be reached.
        """
        if self._left_out is not None:
            return self._unknown(span)
        last = self._last
        if last is not None and "a1" in last.fields:
            return last.copy()
        try:
            q = self._commanded.joints()
        except FlybyError as error:
            raise SourceError(f"{WHERE}: {error}", span) from None
        return self._unknown(span) if q is None else self.axis_struct(q)

    def _unknown(self, span: Span) -> Unknown:
        out = self._left_out
        why = self._commanded.why_unknown() if out is None else f"after the one of line {out.line}"
        return Unknown(f"{WHERE} ({why})", span)

    def axis_struct(self, q: Sequence[float] | FloatArray) -> Struct:
        """A configuration (N,) as axis values."""
        fields: dict[str, Value] = dict(zip(AXIS_FIELDS, axis_values(self._robot, q), strict=False))
        return Struct("e6axis", {**fields, **self._external_fields(q)})

    def forward(self, target: JointTarget, placement: Placement) -> Pose | None:
        """The pose of the tool in the base at axis values; None without a robot."""
        return self._commanded.forward(target, placement.tool, placement.work_object)

    def backward(
        self, target: PoseTarget, placement: Placement, near: JointTarget | None, span: Span
    ) -> Struct | None:
        """The axis values at a pose; None without a robot.

        Args:
            near: the solution nearest to it is taken; None for where the robot stands.

        Raises:
            SourceError: it cannot be reached.
        """
        tool, base = placement.tool, placement.work_object
        try:
            q = self._commanded.solve(target, tool, base, near)
        except FlybyError as error:
            raise SourceError(str(error), span) from None
        return None if q is None else self.axis_struct(q)

    def external(self, index: int) -> Value | None:
        """The value that an external axis (from 0) was last sent to; None if to none yet."""
        return None if self._last is None else self._last.fields.get(self._names[index])

    def _external_fields(self, q: Sequence[float] | FloatArray) -> dict[str, Value]:
        if self._robot is None:
            return {}
        values = [float(v) for v in q[self._robot.arm_size :]]
        fields: dict[str, Value] = {}
        for name, axis, value in zip(self._names, self._robot.external_axes, values, strict=False):
            linear = axis.joint.kind is JointKind.PRISMATIC
            fields[name] = value * 1000 if linear else math.degrees(value)
        return fields

    def _present_external(self) -> dict[str, Value]:
        """The external axes, as the robot has them or, where none is named, as they were sent."""
        if self._robot is None:
            fields = {} if self._last is None else self._last.fields
            return {name: fields[name] for name in EXTERNAL_FIELDS if name in fields}
        if not self._robot.external_axes:
            return {}
        q = self._commanded.joints()
        return {} if q is None else self._external_fields(q)
