"""Where the robot stands after moves that were executed but not planned.

Programs ask for their own position (RAPID ``CRobT``, KRL ``$POS_ACT``, URScript
``get_actual_tcp_pose``). What is commanded answers them: after a joint target its values, after a
pose the inverse-kinematics solution with its configuration, or the one nearest to where the robot
came from.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError, MotionError, Span
from ...program.move import Move
from ...program.target import JointTarget
from ...program.tool import Tool, WorkObject
from ...robot.kinematics.chain_kernels import poses
from ...robot.model import Robot
from ...robot.work_chain import work_chain
from ...spatial.pose import Pose
from ..configurations.finder import ConfigurationFinder, Label


class Standing:
    """Follows a robot from target to target.

    Inverse kinematics is only solved when somebody asks.

    Args:
        robot: the robot.
        label: the vendor's label of a configuration.
        start: where it stands at first; None if nobody knows.
        past_faults: whether a move that cannot be driven leaves it where it is; who drives the
            program tells of it.
    """

    def __init__(
        self,
        robot: Robot,
        label: Label,
        start: JointTarget | None = None,
        *,
        past_faults: bool = False,
    ) -> None:
        self._robot = robot
        self._past_faults = past_faults
        self._finder = ConfigurationFinder(robot, label)
        self._q: FloatArray | None = None
        self._pending: list[tuple[int, Move, Span | None]] = []
        self._count = 0
        if start is not None:
            self._q = self._finder.targets.joints(start, self._finder.targets.rest())

    def moved(self, move: Move, statement: Span | None = None) -> None:
        """The robot has driven to the target of a move.

        Args:
            move: as it was executed.
            statement: where it stands in the source, for moves without an origin yet.
        """
        if isinstance(move.target, JointTarget) and not _partial(move.target, self._robot):
            self._pending.clear()
        self._pending.append((self._count, move, statement))
        self._count += 1

    @property
    def known(self) -> bool:
        """Whether anything is known: a start, or a move."""
        return self._q is not None or bool(self._pending)

    def joints(self) -> FloatArray:
        """The configuration (N,), rad and m.

        Raises:
            InputError: the program asks before its first move, and no start is known.
            MotionError: a move cannot be driven; the error names it and its statement.
        """
        if not self.known:
            raise InputError(
                "where the robot stands is not known before the first move: give a start, or an "
                "answer"
            )
        q = self._finder.targets.rest() if self._q is None else self._q
        for index, move, statement in self._pending:
            try:
                q = self._reached(move, index, q)
            except MotionError as error:
                if self._past_faults:
                    continue
                span = error.span or statement
                raise MotionError(error.message, error.move, span, error.cause) from error
            except InputError as error:
                if self._past_faults:
                    continue
                raise MotionError(str(error), index, statement) from error
        self._q = q
        self._pending.clear()
        return q.copy()

    def _reached(self, move: Move, index: int, q: FloatArray) -> FloatArray:
        """The configuration (N,) after a move from ``q``."""
        if isinstance(move.target, JointTarget):
            return self._finder.targets.joints(move.target, q)
        return self._finder.choose(move, index, q)

    def pose(self, tool: Tool, work_object: WorkObject) -> Pose:
        """The TCP of ``tool`` in ``work_object``.

        Raises:
            InputError, MotionError: as `joints`.
        """
        chain = work_chain(self._robot, tool, work_object)
        frame = np.eye(4)
        (frame[:3, :3],), (frame[:3, 3],) = poses(chain, self.joints()[None])
        return Pose.from_matrix(frame)

    def solve(self, move: Move, near: FloatArray | None = None) -> FloatArray:
        """The configuration (N,) in which a joint move to a pose would end.

        Args:
            move: its target is a pose.
            near: (N,) the solution nearest to this is taken; None for where the robot stands.

        Raises:
            MotionError: the pose cannot be reached.
        """
        if near is None:
            near = self.joints() if self.known else self._finder.targets.rest()
        return self._finder.choose(move, self._count, near)


def _partial(target: JointTarget, robot: Robot) -> bool:
    """Whether the target leaves axes where they are."""
    return len(target.joints) + len(target.external) < robot.size
