"""Numbers of a translated program without what arithmetic has put behind their last digit.

Inverse kinematics, products of poses and quaternions of eight digits leave 20.000000006 where the
old program says 20.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..dialect import Dialect, Orientation
from ..program.move import Move, MoveC
from ..program.program import Program
from ..program.target import JointTarget, PoseTarget, Target
from ..robot.joint import JointKind
from ..robot.model import Robot
from ..source.lines.positions import PositionForm
from ..spatial.pose import IDENTITY, Pose

_DECIMALS, _OF_JOINTS = 6, 7
"""Of mm and degrees: a nanometre, and a few of them at the end of a long arm."""
_IN_SI = 9, 10
"""Of m and rad."""
_BY_ANGLES = (Orientation.EULER_ZYX, Orientation.EULER_ZYZ)
"""Forms of rotations whose numbers are those of a drawing: 90 and 180."""


@dataclass(frozen=True)
class Resolution:
    """To how many decimals a language's numbers are rounded: never to fewer than its controllers
    keep.

    Args:
        dialect: of the language; None for one that is not described.
        robot: whose joint values they are.
    """

    dialect: Dialect | None
    robot: Robot

    def program(self, program: Program) -> Program:
        """A program with targets, tools and work objects of few digits."""
        return program.with_moves(tuple(map(self._move, program.moves)))

    def joints(self, target: JointTarget) -> JointTarget:
        """Joint values, rad or m, of few digits in the language's unit."""
        each = zip(self.robot.joints, target.joints, strict=True)
        values = (
            self._length(value) if joint.kind is JointKind.PRISMATIC else self._angle(value)
            for joint, value in each
        )
        return replace(target, joints=tuple(values))

    def _move(self, move: Move) -> Move:
        frame = move.work_object
        work_object = replace(frame, user=self._pose(frame.user), frame=self._pose(frame.frame))
        tool = replace(move.tool, tcp=self._pose(move.tool.tcp))
        made = replace(move, target=self._target(move.target), tool=tool, work_object=work_object)
        if isinstance(made, MoveC):
            made = replace(made, via=replace(made.via, pose=self._pose(made.via.pose)))
        return made

    def _target(self, target: Target) -> Target:
        if isinstance(target, PoseTarget):
            return replace(target, pose=self._pose(target.pose))
        return self.joints(target)

    def _pose(self, pose: Pose) -> Pose:
        if pose == IDENTITY:
            return pose
        x, y, z = map(self._length, pose.position)
        spoken = Orientation.QUATERNION if self.dialect is None else self.dialect.orientation
        if self._in_si or spoken not in _BY_ANGLES:
            return Pose((x, y, z), pose.quaternion)
        form, decimals = PositionForm(spoken), self._kept("angle_decimals")
        turns = (round(turn, decimals) for turn in form.numbers(pose)[3:])
        return Pose((x, y, z), form.pose((0.0, 0.0, 0.0, *turns)).quaternion)

    def _length(self, value: float) -> float:
        if self._in_si:
            return round(value, _IN_SI[0])
        return round(1e3 * value, self._kept("length_decimals")) / 1e3

    def _angle(self, value: float) -> float:
        if self._in_si:
            return round(value, _IN_SI[1])
        decimals = self._kept("angle_decimals", _OF_JOINTS)
        return math.radians(round(math.degrees(value), decimals))

    def _kept(self, name: str, least: int = _DECIMALS) -> int:
        """Decimals of mm or degrees."""
        return max(least, (None if self.dialect is None else getattr(self.dialect, name)) or 0)

    @property
    def _in_si(self) -> bool:
        return self.dialect is not None and self.dialect.in_si
