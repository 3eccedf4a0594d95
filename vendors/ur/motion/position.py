"""Where the robot stands in the course of a program, and what its kinematics answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....core.errors import InputError, MotionError, SourceError, Span
from ....core.motion.path.present_position import PresentPosition
from ....core.program.move import Move
from ....core.program.target import JointTarget, PoseTarget, Target
from ....core.program.tool import WORLD, Tool, WorkObject
from ....core.spatial.pose import IDENTITY, Pose
from ..values.values import AtStart, Unknown, Value
from .configuration import UrConfiguration, label

if TYPE_CHECKING:
    from ....core.arrays import FloatArray
    from ....core.robot.model import Robot

Joints = tuple[float, ...]


class Position:
    """Follows the moves of a program.

    Without a robot only what the last target states is known.

    Args:
        robot: whose kinematics answer; None if none is at hand.
        start: where it stands at first; None if nobody knows.

    Attributes:
        place: where it stands: another target after every move to another place.
        base: the frame in which programs give poses: the robot's base, wherever it stands.
    """

    def __init__(self, robot: Robot | None, start: JointTarget | None = None) -> None:
        self._commanded = PresentPosition(robot, start, label)
        self.place: Target | None = start
        self._left_out: Span | None = None
        self.base = WORLD
        if robot is not None and robot.base != IDENTITY:
            self.base = WorkObject("base", user=robot.base)

    @property
    def asked(self) -> int:
        """How often the program has asked where the robot stands."""
        return self._commanded.asked

    @property
    def supposed(self) -> str:
        """See `PresentPosition.supposed`."""
        return self._commanded.supposed

    def suppose(self, reason: str) -> None:
        """See `PresentPosition.suppose`."""
        self._commanded.suppose(reason)

    @property
    def has_robot(self) -> bool:
        """Whether kinematics can be asked."""
        return self._commanded.robot is not None

    @property
    def known(self) -> bool:
        """Whether there was a move, or a start is known."""
        return self._commanded.last is not None or self._commanded.start is not None

    def is_here(self, value: Value) -> bool:
        """Whether a value is where the robot stands now, though nobody knows where that is."""
        return isinstance(value, AtStart) and self._commanded.last is None

    def moved(self, move: Move, statement: Span) -> None:
        """The robot has driven to the target of a move."""
        self._commanded.moved(move, statement)
        self._left_out = None
        if move.target != self.place:
            self.place = move.target

    def left_out(self, span: Span) -> None:
        """A move was left out: where the robot stands is not known until the next."""
        self._left_out = span

    def joints(self, what: str, span: Span) -> Joints | Unknown:
        """The joint values, rad.

        Args:
            what: is asked, for the reason why it is not known.
        """
        if self._left_out is not None:
            return _after(what, self._left_out, span)
        commanded = self._commanded
        last = commanded.start if commanded.last is None else commanded.last.target
        if last is None or isinstance(last, JointTarget):
            commanded.asked += 1
            return AtStart(_before(what), span) if last is None else last.joints
        try:
            q = commanded.joints()
        except (InputError, MotionError) as error:
            return Unknown(f"{what} ({error})", span)
        return _nameless(what, span) if q is None else self._arm(q)

    def pose(self, tool: Tool, what: str, span: Span) -> Pose | Unknown:
        """The TCP of a tool in the robot's base; ``what`` and ``span`` as in `joints`."""
        if self._left_out is not None:
            return _after(what, self._left_out, span)
        try:
            pose = self._commanded.pose(tool, self.base)
        except (InputError, MotionError) as error:
            return Unknown(f"{what} ({error})", span)
        if pose is not None:
            return pose
        return _nameless(what, span) if self.known else Unknown(_before(what), span)

    def forward(self, joints: Joints, tool: Tool, what: str, span: Span) -> Pose | Unknown:
        """The TCP at joint values."""
        try:
            pose = self._commanded.forward(JointTarget(joints), tool, self.base)
        except (InputError, MotionError) as error:
            raise SourceError(f"{what}: {error}", span) from None
        return _nameless(what, span) if pose is None else pose

    def solve(
        self, pose: Pose, tcp: Pose, near: UrConfiguration | None, span: Span
    ) -> Joints | None:
        """Joint values that put a TCP on a pose; None if there are none, or no robot is at hand.

        Raises:
            SourceError: ``near`` has another number of joints than the arm.
        """
        try:
            q = self._commanded.solve(PoseTarget(pose, near), Tool("tcp", tcp), self.base)
        except MotionError:
            return None
        except InputError as error:
            raise SourceError(f"get_inverse_kin: {error}", span) from None
        return None if q is None else self._arm(q)

    def _arm(self, q: FloatArray) -> Joints:
        robot = self._commanded.robot
        assert robot is not None
        return tuple(float(value) for value in q[: robot.arm_size])


def _after(what: str, left_out: Span, span: Span) -> Unknown:
    return Unknown(f"{what} after the move of line {left_out.line}, which is left out", span)


def _before(what: str) -> str:
    return f"{what} before the first move, when nobody knows where the robot stands (give a start)"


def _nameless(what: str, span: Span) -> Unknown:
    return Unknown(f"{what}, for which the robot's kinematics are needed (name the robot)", span)
