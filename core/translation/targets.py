"""The targets of a program on another robot: the same poses, in configurations that are alike."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray
from ..dialect import Dialect
from ..door import given
from ..errors import FaultCause, MotionError
from ..motion.configurations.finder import ConfigurationFinder
from ..motion.configurations.targets import located
from ..motion.path.path import Path, Route
from ..program.move import Move, MoveC, MoveJ
from ..program.program import Program
from ..program.speed import Speed
from ..program.target import Configuration, JointTarget, PoseTarget
from ..program.tool import FLANGE, WORLD, WorkObject
from ..program.zone import FINE
from ..robot.inverse.solution import UnreachableError
from ..robot.kinematics.chain_kernels import poses
from ..robot.model import Robot
from ..robot.work_chain import work_chain
from ..spatial.pose import Pose
from .alike import Likeness, Signs, differing
from .emulation import Party, waypoints
from .frames import Frames
from .losses import LossesOfPart
from .resolution import Resolution

_MOST_TRIED = 12
"""Configurations of one target that are tried before the moves that follow are given up."""
_LIMIT_SLACK = 1e-6
_SAME = 1e-6
"""rad and m within which two configurations are one: rounding of inverse kinematics."""


def _nearer() -> str:
    return f"; {given('base', 'X,Y,Z')} (mm, in the old robot's base) has it stand nearer"


@dataclass(frozen=True)
class _Anchor:
    """A target that a joint move goes to, or the start, and the lines and arcs that follow it.

    Args:
        index: of the joint move; None for the start.
        goal: the move on the new robot; its target is a pose.
        old: the old robot's configuration there.
        stance: how it stands in it.
        tail: indices of the moves that follow.
    """

    index: int | None
    goal: Move
    old: FloatArray
    stance: Signs
    tail: range


class Placer:
    """Places programs.

    Args:
        dialect: of the target; None if its language says everything.
    """

    def __init__(
        self, source: Party, target: Party, dialect: Dialect | None, frames: Frames
    ) -> None:
        self._source = source
        self._target = target
        self._dialect = dialect
        self._frames = frames
        self._likeness = Likeness(source.robot, target.robot)
        self._finder = ConfigurationFinder(target.robot, target.vendor.label)
        self._told: set[WorkObject] = set()
        self._external = _have_same_axes(source.robot, target.robot) and (
            dialect is None or dialect.external_axes
        )

    def place(
        self, program: Program, route: Route, losses: LossesOfPart
    ) -> tuple[Program, JointTarget]:
        """The program on the target robot, and where this stands at first.

        Raises:
            MotionError: the new robot cannot reach a target or follow a line.
        """
        reached = waypoints(route, len(program.moves))
        moves = [self._carried(move, i, reached[i], losses) for i, move in enumerate(program.moves)]
        q = np.empty((len(moves), self._target.robot.size))
        before, start = self._finder.targets.rest(), None
        stood: list[tuple[FloatArray, FloatArray]] = []
        for anchor in self._anchors(program, moves, reached, route.ends.q[0, 0]):
            again = next((new for old, new in stood if _same(old, anchor.old)), None)
            stand, ends = self._settle(anchor, moves, before, again, losses)
            if again is None:
                stood.append((anchor.old, stand))
            if anchor.index is not None:
                q[anchor.index] = stand
            q[anchor.tail.start : anchor.tail.stop] = ends
            start = stand if start is None else start
            before = ends[-1] if len(ends) else stand
        assert start is not None
        pairs = zip(program.moves, moves, q, strict=True)
        named = [self._named(*pair) for pair in pairs]
        carried = program.with_moves(tuple(named))
        placed = replace(carried, start=None, notes=(), calls=(), reading=None)
        few = Resolution(self._dialect, self._target.robot)
        return few.program(placed), few.joints(_joint_target(self._target.robot, start))

    # ---------------------------------------------------------------- poses and frames

    def _carried(self, move: Move, i: int, q: FloatArray, losses: LossesOfPart) -> Move:
        """A move to the same pose, in the frames of the new program, without configuration."""
        try:
            tool, work_object = self._frames.tool(move), self._frames.work_object(move)
            loss = self._frames.loss(move)
        except MotionError as error:
            raise located(move, i, error.message) from None
        self._check_carrier(move, i)
        if loss is not None and move.work_object not in self._told:
            self._told.add(move.work_object)
            losses.at(i, loss)
        external = self._external_of(move, i, losses)
        here = self._pose(move, q)
        target = PoseTarget(self._frames.pose(move, here), None, external, move.target.name)
        carried = replace(move, target=target, tool=tool, work_object=work_object)
        if isinstance(carried, MoveC):
            at = self._frames.pose(move, carried.via.pose)
            via = replace(
                carried.via, pose=at, configuration=None, external=external, arm_angle=None
            )
            carried = replace(carried, via=via)
        return carried

    def _check_carrier(self, move: Move, i: int) -> None:
        """Refuse work objects on an axis that the new robot does not have."""
        carrier, robot = move.work_object.moved_by, self._target.robot
        if carrier is not None and carrier not in robot.axis_names[robot.arm_size :]:
            raise located(
                move,
                i,
                f"work object {move.work_object.name} is moved by {carrier}, and {robot.name} has "
                "no such axis here: put it on a frame that stands still",
            )

    def _external_of(self, move: Move, i: int, losses: LossesOfPart) -> tuple[float, ...]:
        values = move.target.external
        if self._external or not values:
            return values
        losses.at(
            i,
            f"external axes at {', '.join(f'{value:.6g}' for value in values)} (m, rad) are left "
            f"out: {self._target.robot.name} has no such axes here, or its language none",
        )
        return ()

    def _pose(self, move: Move, q: FloatArray) -> Pose:
        """Where the old robot has the TCP at the end of a move."""
        if isinstance(move.target, PoseTarget):
            return move.target.pose
        return _tcp(self._source.robot, move, q)

    # ------------------------------------------------------------------ configurations

    def _anchors(
        self, program: Program, moves: Sequence[Move], reached: FloatArray, first: FloatArray
    ) -> Iterator[_Anchor]:
        """The program as joint targets with the lines and arcs that follow each."""
        joints = [i for i, move in enumerate(moves) if isinstance(move, MoveJ)]
        ends = [*joints, len(moves)][1:]
        leading = joints[0] if joints else len(moves)
        if program.start is not None or leading > 0:
            goal = self._start(program, moves, first)
            yield _Anchor(None, goal, first, self._stance(first), range(leading))
        for i, end in zip(joints, ends, strict=True):
            tail = range(i + 1, end)
            yield _Anchor(i, moves[i], reached[i], self._stance(reached[i]), tail)

    def _start(self, program: Program, moves: Sequence[Move], q: FloatArray) -> Move:
        """A joint move to where the robot stands at first."""
        if program.start is None:
            return _joint_move(moves[0], moves[0].target)
        flange = replace(moves[0], tool=FLANGE, work_object=WORLD)
        at = self._frames.pose(flange, _tcp(self._source.robot, flange, q))
        external = program.start.external if self._external else ()
        return _joint_move(flange, PoseTarget(at, None, external))

    def _stance(self, q: FloatArray) -> Signs:
        return self._likeness.signs(self._source.robot, q)

    def _settle(
        self,
        anchor: _Anchor,
        moves: Sequence[Move],
        before: FloatArray,
        again: FloatArray | None,
        losses: LossesOfPart,
    ) -> tuple[FloatArray, FloatArray]:
        """Configurations (N,) at an anchor and (T, N) after the moves that follow it.

        Where the old robot comes back to a configuration, the new one does: to its own there,
        ``again``. A program that ends where it began can be run once more.
        """
        index = anchor.index or 0
        failure: MotionError | None = None
        for otherwise, q in self._options(anchor, index, before, again)[:_MOST_TRIED]:
            try:
                ends = self._follow(moves, anchor.tail, q)
            except MotionError as error:
                failure = failure or error
                continue
            if otherwise:
                losses.at(
                    index,
                    f"{self._target.robot.name} has its {' and '.join(otherwise)} on the other "
                    "side here: it does not reach this, or what follows, as the old robot does",
                )
            if again is not None and not _same(q, again):
                losses.at(
                    index,
                    "the old robot stands here as it has stood before, the new one otherwise: from "
                    "there it could not follow what comes next",
                )
            return q, ends
        assert failure is not None
        out = failure.cause is FaultCause.REACH
        message = failure.message + (_nearer() if out else "")
        raise MotionError(message, failure.move, failure.span, failure.cause) from failure

    def _options(
        self, anchor: _Anchor, index: int, before: FloatArray, again: FloatArray | None
    ) -> list[tuple[tuple[str, ...], FloatArray]]:
        """Configurations (N,) at an anchor and in what they stand otherwise than the old robot.

        ``again`` comes first, then those that are alike, of these those near ``before``.

        Raises:
            MotionError: there is none.
        """
        robot, target = self._target.robot, anchor.goal.target
        assert isinstance(target, PoseTarget)
        q = self._finder.targets.external(target.external, before)
        arm = robot.arm_size
        try:
            flange = self._finder.targets.flange(anchor.goal, target.pose, q)
            found = robot.inverse(flange, tuple(map(float, q[arm:])))
        except UnreachableError as error:
            message = f"{robot.name} cannot reach the target: {error.message}{_nearer()}"
            raise located(anchor.goal, index, message) from error
        options: list[tuple[tuple[str, ...], FloatArray]] = []
        for solution in found:
            stance = self._likeness.signs(robot, _with(q, solution.q))
            otherwise = differing(anchor.stance, stance)
            options += [(otherwise, _with(q, turned)) for turned in robot.turns(solution.q)]

        def rank(option: tuple[tuple[str, ...], FloatArray]) -> tuple[bool, int, float]:
            otherwise, stand = option
            other = again is not None and not _same(stand, again)
            return other, len(otherwise), float(np.abs(stand - before).sum())

        options.sort(key=rank)
        return options

    def _follow(self, moves: Sequence[Move], tail: range, q: FloatArray) -> FloatArray:
        """Where the arm arrives (T, N) along lines and arcs from a configuration.

        Raises:
            MotionError: it cannot follow them, or passes a joint limit; the move is the program's.
        """
        robot = self._target.robot
        if not tail:
            return np.empty((0, robot.size))
        part = Program(tuple(replace(moves[i], zone=FINE) for i in tail))
        try:
            route = self._target.routes.find(part, _joint_target(robot, q))
            if route.moves:
                self._check_limits(self._target.path(route, part), part)
        except MotionError as error:
            move = None if error.move is None else tail.start + error.move
            message = f"{robot.name} cannot follow: {error.message}"
            raise MotionError(message, move, error.span) from error
        return waypoints(route, len(tail), q)

    def _check_limits(self, path: Path, part: Program) -> None:
        """Refuse lines and arcs on which a joint passes its limit."""
        robot, limits = self._target.robot, self._target.robot.limits
        beyond = np.maximum(limits.lower - path.q, path.q - limits.upper)
        row, axis = np.unravel_index(np.argmax(beyond), beyond.shape)
        if beyond[row, axis] > _LIMIT_SLACK:
            i = int(path.sample_moves()[row])
            joint = [*robot.joints, *(axis.joint for axis in robot.external_axes)][axis]
            raise located(
                part.moves[i],
                i,
                f"joint {joint.name} would pass its limit by "
                f"{joint.shown(float(f'{beyond[row, axis]:.3g}'))}; put the robot elsewhere, or "
                "begin the lines from another configuration",
            )

    # -------------------------------------------------------------------------- labels

    def _named(self, old: Move, new: Move, q: FloatArray) -> Move:
        """The move with its configuration; joint targets stay joint targets."""
        assert isinstance(new.target, PoseTarget)
        # Lines and arcs that end at joint values are what few languages have: they get the pose.
        if isinstance(old.target, JointTarget) and isinstance(new, MoveJ):
            joints = _joint_target(self._target.robot, q)
            external = new.target.external
            return replace(new, target=JointTarget(joints.joints, external, old.target.name))
        if self._dialect is not None and not self._dialect.words(new).configurations:
            return new
        robot = self._target.robot
        label, angle = self._target.vendor.label(robot, q), robot.arm_angle(q)
        named = replace(new, target=replace(new.target, configuration=label, arm_angle=angle))
        if isinstance(named, MoveC):
            via = replace(named.via, configuration=self._label_near(named, q))
            named = replace(named, via=via)
        return named

    def _label_near(self, move: MoveC, q: FloatArray) -> Configuration | None:
        """The label at the auxiliary point of an arc; None if the point is beyond reach."""
        try:
            at = self._finder.choose(_joint_move(move, move.via), 0, q)
        except MotionError:
            return None
        return self._target.vendor.label(self._target.robot, at)


def _same(one: FloatArray, other: FloatArray) -> bool:
    return bool(np.abs(one - other).max() < _SAME)


def _with(q: FloatArray, arm: FloatArray) -> FloatArray:
    """The configuration (N,) with other values of the arm's joints."""
    changed = q.copy()
    changed[: len(arm)] = arm
    return changed


def _joint_move(move: Move, target: PoseTarget | JointTarget) -> MoveJ:
    return MoveJ(target, Speed(), tool=move.tool, work_object=move.work_object, origin=move.origin)


def _joint_target(robot: Robot, q: FloatArray) -> JointTarget:
    values = tuple(float(value) for value in q)
    return JointTarget(values[: robot.arm_size], values[robot.arm_size :])


def _tcp(robot: Robot, move: Move, q: FloatArray) -> Pose:
    """The TCP in the move's work object at a configuration (N,)."""
    matrix, chain = np.eye(4), work_chain(robot, move.tool, move.work_object)
    (matrix[:3, :3],), (matrix[:3, 3],) = poses(chain, np.ascontiguousarray(q)[None])
    return Pose.from_matrix(matrix)


def _have_same_axes(first: Robot, second: Robot) -> bool:
    """Whether two robots have external axes of the same kinds in the same order."""
    kinds = [
        [(axis.joint.kind, axis.role) for axis in robot.external_axes] for robot in (first, second)
    ]
    return kinds[0] == kinds[1]
