"""Where a robot may stand at the targets of moves: joint values, and solutions at poses."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from ...arrays import FloatArray
from ...errors import FaultCause, InputError, MotionError
from ...program.move import Move
from ...program.target import JointTarget, PoseTarget
from ...program.tool import Tool, WorkObject
from ...robot.assembly import assemble
from ...robot.inverse.solution import UnreachableError
from ...robot.joint import JointKind
from ...robot.kinematics.chain_kernels import poses
from ...robot.kinematics.tracking import track
from ...robot.model import Robot
from ...robot.posture import elbow_height
from ...robot.ready_posture import ready_posture
from ...spatial.pose import Pose

_SAME = 1e-9
_STRETCHED = 1e-3
"""m by which the elbow of an arm that is stretched out is off the line to its wrist."""
_THIRD = 2
"""The third axis of a seven-axis arm moves linearly along moves of the TCP (as KUKA's E1 does)."""


def located(
    move: Move, index: int, message: str, cause: FaultCause = FaultCause.OTHER
) -> MotionError:
    """An error of a move, with its place in the source."""
    return MotionError(message, index, move.statement, cause)


class Targets:
    """Targets of one robot.

    Args:
        robot: the robot.

    Attributes:
        solved: indices of the axes that inverse kinematics solves for along moves of the TCP;
            six if the arm can follow them.
        prescribed: indices of the others: external axes, and the redundant one of seven.
        redundant: that one's index; None of arms without one.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        redundant = [robot.along[_THIRD]] if robot.arm_size == 7 else []
        arm = range(robot.arm_size)
        self.solved = np.array([j for j in arm if j not in redundant], dtype=np.int64)
        self.prescribed = np.array([*redundant, *range(len(arm), robot.size)], dtype=np.int64)
        self.redundant = redundant[0] if redundant else None
        turns = [1.0 if j.kind is JointKind.REVOLUTE else 0.0 for j in robot.joints]
        self._full_turn = 2 * np.pi * np.array(turns)
        limits = robot.limits
        self._lower, self._upper = (one[: len(turns)] for one in (limits.lower, limits.upper))

    def rest(self) -> FloatArray:
        """Where the robot is near if nobody knows where it stands: all axes at zero, or at the
        limit nearest to it; an arm that is stretched out there, in its ready posture."""
        return self._rest.copy()

    @cached_property
    def _rest(self) -> FloatArray:
        limits = self.robot.limits
        zero = np.asarray(np.clip(np.zeros(self.robot.size), limits.lower, limits.upper))
        height = elbow_height(self.robot, zero)
        ready = (
            ready_posture(self.robot) if height is not None and abs(height) < _STRETCHED else None
        )
        return zero if ready is None else np.array(ready)

    def joints(self, target: JointTarget, before: FloatArray) -> FloatArray:
        """The configuration of a joint target; axes that it does not name keep their values.

        Raises:
            InputError: it has another number of joints than the arm, or more external axes than
                the robot.
        """
        arm = self.robot.arm_size
        if len(target.joints) != arm:
            raise InputError(
                f"a joint target has {len(target.joints)} values, {self.robot.name} has "
                f"{arm} joints"
            )
        q = self.external(target.external, before)
        q[:arm] = target.joints
        return q

    def external(self, values: Sequence[float], before: FloatArray) -> FloatArray:
        """A configuration with external axes set to the values that are given.

        Raises:
            InputError: there are more values than axes.
        """
        arm = self.robot.arm_size
        if len(values) > self.robot.size - arm:
            raise InputError(
                f"a target names {len(values)} external axes, {self.robot.name} has "
                f"{self.robot.size - arm}"
            )
        q = before.copy()
        q[arm : arm + len(values)] = values
        return q

    def solutions(
        self, tool: Tool, work_object: WorkObject, targets: FloatArray, q: FloatArray
    ) -> list[FloatArray | None]:
        """The arm's configurations (K, n) at each of many targets, for `options`.

        Args:
            tool, work_object, targets, q: as in `flanges`, of all external axes.

        Returns:
            None where targets have to be looked at one by one.
        """
        if self.redundant is not None:
            return [None] * len(targets)
        flanges = self.flanges(tool, work_object, targets, q)
        return self.robot.inverse_at_each(flanges, q[:, self.robot.arm_size :])

    def options(
        self,
        move: Move,
        index: int,
        before: FloatArray,
        known: FloatArray | None = None,
        *,
        all_turns: bool = False,
    ) -> FloatArray:
        """Configurations (K, N) at a move's pose target: `choose` tells which and what it raises.

        Args:
            known: what `solutions` found there.
            all_turns: those whole turns away from the nearest, too.
        """
        target = move.target
        assert isinstance(target, PoseTarget)
        q, arm = self.external(target.external, before), self.robot.arm_size
        found = self._solved(move, index, q) if known is None else known
        if self.redundant is not None and target.arm_angle is None:
            turned = self._with_third_kept(move, index, found, q)
        elif target.configuration is None and not all_turns:
            turned = self._nearest_turns(found, before[:arm])
        else:
            turned = np.concatenate([self.robot.turns(solution) for solution in found])
        if arm == len(q):
            return turned
        options = np.empty((len(turned), len(q)))
        options[:, :arm], options[:, arm:] = turned, q[arm:]
        return options

    def _solved(self, move: Move, index: int, q: FloatArray) -> FloatArray:
        """The arm's configurations (K, n) at a move's pose target; external axes as in q (N,)."""
        target = move.target
        assert isinstance(target, PoseTarget)
        flange, external = self.flange(move, target.pose, q), q[self.robot.arm_size :]
        try:
            found = self.robot.inverse(flange, tuple(map(float, external)), target.arm_angle)
        except UnreachableError as error:
            why = f"target cannot be reached: {error}"
            raise located(move, index, why, error.cause) from error
        except InputError as error:
            raise located(move, index, str(error)) from error
        return np.array([solution.q for solution in found])

    def _with_third_kept(
        self, move: Move, index: int, samples: FloatArray, q: FloatArray
    ) -> FloatArray:
        """Configurations (T, n) of a seven-axis arm at a move's target, third axis as in q.

        Args:
            move, index: the move.
            samples: (K, n), some of the arm's configurations there.
            q: (N,), the arm's present configuration and the target's external axes.
        """
        arm, third = self.robot.arm_size, self.redundant
        assert third is not None and isinstance(move.target, PoseTarget)
        flange = self.flange(move, move.target.pose, q)
        R, p = np.ascontiguousarray(flange[:3, :3]), np.ascontiguousarray(flange[:3, 3])
        kept: list[FloatArray] = []
        for sample in (q[:arm], *samples):
            guess = q.copy()
            guess[:arm] = sample
            guess[third] = q[third]
            converged, _, _ = track(self.robot.chain, guess, R, p, self.solved, guess)
            if converged:
                turns = self.robot.turns(guess[:arm])
                kept += [t for t in turns if abs(t[third] - q[third]) < _SAME]
        if not kept:
            name, value = self.robot.axis_names[third], np.degrees(q[third])
            raise located(
                move,
                index,
                f"target cannot be reached with the third axis, {name}, kept at {value:.4g}°: "
                "turn it first by a joint target",
                FaultCause.REACH,
            )
        return np.array(kept)

    def _nearest_turns(self, q: FloatArray, before: FloatArray) -> FloatArray:
        """Of the arm's configurations whole turns away from each of q (K, n), the one nearest to
        ``before``."""
        turned = q + self._full_turn * np.rint((before - q) / (2 * np.pi))
        beyond = (turned < self._lower) | (turned > self._upper)
        if beyond.any():
            for k in np.flatnonzero(beyond.any(axis=1)):
                options = self.robot.turns(q[k])
                turned[k] = options[np.argmin(np.abs(options - before).sum(axis=1))]
        return np.asarray(turned)

    def why_unreachable(self, move: Move, near: FloatArray) -> UnreachableError | None:
        """What keeps a move's target out of reach; None if nothing does."""
        if not isinstance(move.target, PoseTarget):
            return None
        q = self.external(move.target.external, near)
        external, flange = tuple(map(float, q[self.robot.arm_size :])), move.target.pose
        try:
            self.robot.inverse(self.flange(move, flange, q), external, move.target.arm_angle)
        except UnreachableError as error:
            return error
        return None

    def flange(self, move: Move, target: Pose, q: FloatArray) -> FloatArray:
        """The flange (4, 4) in the world that puts the TCP on a target in the work object."""
        given = move.tool, move.work_object, target.matrix()[None], q[None]
        return np.asarray(self.flanges(*given)[0])

    def flanges(
        self, tool: Tool, work_object: WorkObject, targets: FloatArray, q: FloatArray
    ) -> FloatArray:
        """The flange (K, 4, 4) in the world that puts the TCP on each of targets (K, 4, 4).

        Args:
            tool, work_object: of all of them.
            targets: in the work object.
            q: (K, N), of which external axes that move the work object count.
        """
        if work_object.robot_held:
            back = work_object.pose.inverse().matrix()
            return np.asarray(tool.tcp.matrix() @ np.linalg.inv(targets) @ back)
        carrier = work_object.pose.matrix()
        if work_object.moved_by is not None:
            stages = self.robot.frame_stages(work_object.moved_by)
            R, p = poses(assemble([*stages, work_object.pose]), q)
            carrier = np.tile(np.eye(4), (len(q), 1, 1))
            carrier[:, :3, :3], carrier[:, :3, 3] = R, p
        return np.asarray(carrier @ targets @ tool.tcp.inverse().matrix())
