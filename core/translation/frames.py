"""Tools, work objects and poses as the other robot's language has them."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..dialect import Dialect
from ..errors import MotionError
from ..program.move import Move
from ..program.tool import WORLD, Tool, WorkObject
from ..spatial.pose import IDENTITY, Pose


@dataclass(frozen=True)
class Frames:
    """How frames are carried over.

    Args:
        base: the new robot's base in the world of the old one.
        dialect: of the new language; None if it has everything.
    """

    base: Pose = IDENTITY
    dialect: Dialect | None = None

    def tool(self, move: Move) -> Tool:
        """The tool of a move.

        Raises:
            MotionError: the tool stands still, and the language has no such thing.
        """
        tool = move.tool
        if tool.robot_held:
            return tool
        if self.dialect is not None and not self.dialect.stationary_tools:
            raise MotionError(
                f"tool {tool.name} stands still and the robot carries the work object, which this "
                "language cannot say: let the robot hold the tool"
            )
        return replace(tool, tcp=self._seen(tool.tcp))

    def work_object(self, move: Move) -> WorkObject:
        """The work object of a move.

        Raises:
            MotionError: it is moved by an axis, and the language has no frames.
        """
        if self._folded(move):
            return WORLD
        frame = move.work_object
        if not frame.robot_held and frame.moved_by is None and frame != WORLD:
            frame = replace(frame, user=self._seen(frame.user))
        if self._joined(move):
            return replace(frame, user=IDENTITY, frame=frame.pose)
        return frame

    def pose(self, move: Move, pose: Pose) -> Pose:
        """A pose in the move's work object, in the work object that the new program has."""
        if self._folded(move) and move.work_object != WORLD:
            return self._seen(move.work_object.pose @ pose)
        return self._seen(pose) if move.work_object == WORLD else pose

    def loss(self, move: Move) -> str | None:
        """What becomes of the move's work object, if that is less than it was."""
        frame = move.work_object
        if self._folded(move) and frame != WORLD:
            return f"work object {frame.name}: the language has no frames; poses are in the base"
        if self._joined(move) and frame.user != IDENTITY and frame.frame != IDENTITY:
            return f"work object {frame.name}: user frame and object frame become one frame"
        return None

    def _joined(self, move: Move) -> bool:
        dialect = self.dialect
        return dialect is not None and not dialect.user_frames and move.work_object != WORLD

    def _folded(self, move: Move) -> bool:
        """Whether targets are given in the base instead of the work object."""
        if self.dialect is None or self.dialect.work_objects:
            return False
        frame = move.work_object
        if frame.moved_by is not None:
            raise MotionError(
                f"work object {frame.name} is moved by {frame.moved_by}, which this language "
                "cannot say: put it on a frame that stands still"
            )
        return not frame.robot_held

    def _seen(self, pose: Pose) -> Pose:
        """A pose in the old robot's world, in that of the new one, whose origin is its base."""
        return pose if self.base == IDENTITY else self.base.inverse() @ pose
