"""Where the robot stands: what ``$POS_ACT``, ``_REL`` and targets that leave components out need.

A pose is known without kinematics if the last target was a pose of the same tool in the same base;
else the robot's own kinematics answer, if it is named.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ....core.errors import FlybyError, SourceError, Span
from ....core.program.move import Move
from ....core.robot.joint import JointKind
from ..values.frames import frame_of
from ..values.placement import Placement
from ..values.types import AXIS_FIELDS, EXTERNAL_FIELDS
from ..values.values import Struct, Unknown, Value

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ....core.motion.path.commanded_position import Standing
    from ....core.program.target import JointTarget
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
        self._start = start
        self._moves: list[tuple[Move, Span]] = []
        self._told = 0
        self._standing: Standing | None = None
        self._last: Struct | None = None
        self._placement: Placement | None = None
        if robot is not None and start is not None:
            self._last = self.axis_struct((*start.joints, *start.external))

    def moved(self, move: Move, statement: Span, target: Struct, placement: Placement) -> None:
        """The robot has driven to a target, whose components are all in ``target``."""
        if self._robot is not None:
            self._moves.append((move, statement))
        self._last = target
        self._placement = placement

    @property
    def last_move_numbers(self) -> Struct | None:
        """The components of the last target, or of the start; None if neither is known."""
        return self._last

    # ----------------------------------------------------------------------- queries

    def pose(self, placement: Placement, span: Span) -> Struct | Unknown:
        """The pose of the tool in the base, with S, T and external axes as far as they are known.

        Raises:
            SourceError: a target on the way cannot be reached.
        """
        last, at = self._last, self._placement
        if last is not None and at is not None and "x" in last.fields and _same(at, placement):
            return last.copy()
        if self._robot is None:
            return Unknown(f"{WHERE} (name the robot: its kinematics tell)", span)
        if last is None:
            return Unknown(f"{WHERE} before the first move (give a start)", span)
        q = self.joints(span)
        try:
            pose = self._follow().pose(placement.tool, placement.work_object)
        except FlybyError as error:
            raise SourceError(f"{WHERE}: {error}", span) from None
        made = frame_of(pose, "e6pos")
        made.fields.update(self._external_fields(q))
        return made

    def axes(self, span: Span) -> Struct | Unknown:
        """The axis values.

        Raises:
            SourceError: a target on the way cannot be reached.
        """
        last = self._last
        if last is not None and "a1" in last.fields:
            return last.copy()
        if self._robot is None:
            return Unknown(f"{WHERE} (name the robot: its kinematics tell)", span)
        if last is None:
            return Unknown(f"{WHERE} before the first move (give a start)", span)
        q = self.joints(span)
        return self.axis_struct(q)

    def axis_struct(self, q: Sequence[float] | NDArray[np.float64]) -> Struct:
        """A configuration (N,) as axis values."""
        fields: dict[str, Value] = {
            name: math.degrees(float(v)) for name, v in zip(AXIS_FIELDS, q, strict=False)
        }
        return Struct("e6axis", {**fields, **self._external_fields(q)})

    def joints(self, span: Span) -> NDArray[np.float64]:
        """The configuration (N,); the robot must be named.

        Raises:
            SourceError: a target on the way cannot be reached.
        """
        try:
            return self._follow().joints()
        except FlybyError as error:
            raise SourceError(f"{WHERE}: {error}", span) from None

    def solve(
        self, move: Move, near: NDArray[np.float64] | None, span: Span
    ) -> NDArray[np.float64]:
        """The configuration (N,) in which a joint move to a pose would end.

        Raises:
            SourceError: it cannot be reached.
        """
        try:
            return self._follow().solve(move, near)
        except FlybyError as error:
            raise SourceError(str(error), span) from None

    def external(self, index: int) -> Value | None:
        """The value that an external axis (from 0) was last sent to; None if to none yet."""
        return None if self._last is None else self._last.fields.get(EXTERNAL_FIELDS[index])

    def _external_fields(self, q: Sequence[float] | NDArray[np.float64]) -> dict[str, Value]:
        assert self._robot is not None
        values = [float(v) for v in q[self._robot.arm_size :]]
        fields: dict[str, Value] = {}
        for name, axis, value in zip(
            EXTERNAL_FIELDS, self._robot.external_axes, values, strict=False
        ):
            linear = axis.joint.kind is JointKind.PRISMATIC
            fields[name] = value * 1000 if linear else math.degrees(value)
        return fields

    def _follow(self) -> Standing:
        from ....core.motion.path.commanded_position import Standing
        from .configuration import label

        assert self._robot is not None
        if self._standing is None:
            self._standing = Standing(self._robot, label, self._start)
        for move, statement in self._moves[self._told :]:
            self._standing.moved(move, statement)
        self._told = len(self._moves)
        return self._standing


def _same(first: Placement, second: Placement) -> bool:
    """Whether poses in both mean the same."""
    return (
        first.tool.tcp == second.tool.tcp
        and first.tool.robot_held == second.tool.robot_held
        and first.work_object.pose == second.work_object.pose
        and first.work_object.moved_by == second.work_object.moved_by
    )
