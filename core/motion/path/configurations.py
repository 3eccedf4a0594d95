"""Finds the configurations of a program's targets.

Along joint moves the configuration of a pose target is chosen among all solutions of inverse
kinematics; what a move of the TCP arrives with is held against the programmed one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from ...arrays import FloatArray
from ...display import counted
from ...door import spelt
from ...errors import FaultCause, InputError, MotionError, Note
from ...program.move import Move
from ...program.target import Configuration, JointTarget, PoseTarget
from ...robot.assembly import assemble
from ...robot.inverse.solution import UnreachableError
from ...robot.joint import JointKind
from ...robot.kinematics.chain_kernels import pose
from ...robot.kinematics.tracking import track
from ...robot.model import Robot
from ...robot.posture import posture
from ...spatial.pose import Pose
from .arm_angles import followed

Label = Callable[[Robot, FloatArray], Configuration | None]

_NAMED = 8
"""Labels in a message: the nearest, as a posture has several where joints turn more than once."""
_MATCH = 1e-9
_SAME = 1e-9
_TURNED = 2.4
"""rad by which an axis is taken to turn only where the arm takes another posture."""
_EDGE = 0.01
"""m or rad by which a posture differs clearly from its neighbour."""
_THIRD = 2
"""The third axis of a seven-axis arm moves linearly along moves of the TCP (as KUKA's E1 does)."""


def located(
    move: Move, index: int, message: str, cause: FaultCause = FaultCause.OTHER
) -> MotionError:
    """An error of a move, with its place in the source."""
    return MotionError(message, index, move.statement, cause)


class ConfigurationFinder:
    """Configurations of one robot under one vendor's labels.

    Args:
        robot: the robot.
        label: the vendor's label of a configuration; None where vendors have none.
        nearest: whether a configuration that contradicts its pose or path gives way to the nearest
            solution.

    Attributes:
        assumed: names of the tools and work objects that nobody knows, by the index of each move
            that uses one: its configuration tells nothing of a pose that is not its own, and gives
            way likewise.
        departures: index of each move that is driven with another configuration than programmed,
            and what there is to say.
        tolerated: the same for those whose configuration the controller takes all the same.
        ambiguous: the same for those whose configuration does not tell postures of the arm apart.
        uneven: index of each move that is led to an arm angle, and rad by which the third axis
            would be elsewhere on the way if that angle turned evenly.
        solved: indices of the axes that inverse kinematics solves for along moves of the TCP;
            six if the arm can follow them.
        prescribed: indices of the others: external axes, and the redundant one of seven.
    """

    def __init__(self, robot: Robot, label: Label, nearest: bool = False) -> None:
        self._robot = robot
        self._nearest = nearest
        self.assumed: dict[int, tuple[str, ...]] = {}
        self.departures: dict[int, str] = {}
        self.tolerated: dict[int, str] = {}
        self.ambiguous: dict[int, str] = {}
        self.uneven: dict[int, float] = {}
        self._label = label
        redundant = [robot.along[_THIRD]] if robot.arm_size == 7 else []
        arm = range(robot.arm_size)
        self.solved = np.array([j for j in arm if j not in redundant], dtype=np.int64)
        self.prescribed = np.array([*redundant, *range(len(arm), robot.size)], dtype=np.int64)
        self.redundant = redundant[0] if redundant else None
        self._full_turn = np.array(
            [2 * np.pi if j.kind is JointKind.REVOLUTE else 0.0 for j in robot.joints]
        )

    def rest(self) -> FloatArray:
        """All axes at zero, or at the limit nearest to it."""
        return self._rest.copy()

    @cached_property
    def _rest(self) -> FloatArray:
        limits = self._robot.limits
        return np.asarray(np.clip(np.zeros(self._robot.size), limits.lower, limits.upper))

    def joints(self, target: JointTarget, before: FloatArray) -> FloatArray:
        """The configuration of a joint target; axes that it does not name keep their values.

        Raises:
            InputError: it has another number of joints than the arm, or more external axes than
                the robot.
        """
        arm = self._robot.arm_size
        if len(target.joints) != arm:
            raise InputError(
                f"a joint target has {len(target.joints)} values, {self._robot.name} has "
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
        arm = self._robot.arm_size
        if len(values) > self._robot.size - arm:
            raise InputError(
                f"a target names {len(values)} external axes, {self._robot.name} has "
                f"{self._robot.size - arm}"
            )
        q = before.copy()
        q[arm : arm + len(values)] = values
        return q

    def choose(self, move: Move, index: int, before: FloatArray) -> FloatArray:
        """The configuration of a joint move's pose target.

        Of the solutions with the programmed configuration, the one nearest to ``before``. A
        seven-axis arm keeps its third axis where the target states no arm angle.

        Raises:
            MotionError: the pose is out of reach (with the third axis kept), or contradicts the
                programmed configuration.
        """
        wanted = move.target.configuration if isinstance(move.target, PoseTarget) else None
        return self._pick(move, index, wanted, self._options(move, index, before), before)

    def led(self, move: Move, index: int, before: FloatArray) -> FloatArray:
        """Where (N,) a move of the TCP ends whose target states an arm angle: the arm goes on in
        its posture, or else takes the nearest.

        Raises:
            MotionError: it cannot take the pose with that arm angle.
        """
        target = move.target
        assert isinstance(target, PoseTarget) and target.arm_angle is not None
        q = self.external(target.external, before)
        if self._robot.measured_arm_angle is not None:
            flange = self.flange(move, target.pose, q)
            reached = followed(self._robot, flange, target.arm_angle, q)
            if reached is not None:
                self.uneven[index] = reached.apart
                return reached.q
        return self.choose(replace(move, target=replace(target, configuration=None)), index, before)

    def starts(self, move: Move, index: int) -> FloatArray:
        """Configurations (K, N) in which the robot may stand at a move's pose target.

        All solutions with the programmed configuration and all turns of them; the one that
        `choose` takes from `rest` is the first.

        Raises:
            MotionError: as `choose`.
        """
        rest = self.rest()
        first = self.choose(move, index, rest)
        target = move.target
        assert isinstance(target, PoseTarget)
        plain = replace(move, target=replace(target, configuration=None))
        options = self._options(plain, index, rest, all_turns=True)
        wanted = target.configuration
        if wanted is not None:
            misses = self._misses(wanted, options)
            options = options[misses <= misses.min() + _MATCH]
        order = np.argsort(np.abs(options - first).sum(axis=1))
        apart = np.abs(options[order] - first).max(axis=1) > _SAME
        return np.concatenate([first[None], options[order][apart]])

    def _options(
        self, move: Move, index: int, before: FloatArray, *, all_turns: bool = False
    ) -> FloatArray:
        """Configurations (K, N) at a move's pose target: `choose` tells which and what it raises.

        Args:
            all_turns: those whole turns away from the nearest, too.
        """
        target = move.target
        assert isinstance(target, PoseTarget)
        q = self.external(target.external, before)
        arm = self._robot.arm_size
        flange = self.flange(move, target.pose, q)
        external = tuple(map(float, q[arm:]))
        try:
            found = [s.q for s in self._robot.inverse(flange, external, target.arm_angle)]
        except UnreachableError as error:
            why = f"target cannot be reached: {error}"
            raise located(move, index, why, error.cause) from error
        except InputError as error:
            raise located(move, index, str(error)) from error
        third = self.redundant
        if third is not None and target.arm_angle is None:
            turned = np.array(self._with_third_kept(found, flange, q, third))
            if not len(turned):
                name, value = self._robot.axis_names[third], np.degrees(q[third])
                raise located(
                    move,
                    index,
                    f"target cannot be reached with the third axis, {name}, kept at "
                    f"{value:.4g}°: turn it first by a joint target",
                    FaultCause.REACH,
                )
        elif target.configuration is None and not all_turns:
            turned = self._nearest_turns(np.array(found), before[:arm])
        else:
            turned = np.concatenate([self._robot.turns(solution) for solution in found])
        options = np.empty((len(turned), len(q)))
        options[:, :arm], options[:, arm:] = turned, q[arm:]
        return options

    def _with_third_kept(
        self, samples: Sequence[FloatArray], flange: Pose, q: FloatArray, third: int
    ) -> list[FloatArray]:
        """Configurations (n,) of a seven-axis arm at a pose, within limits, third axis as in q.

        Args:
            samples: some of the arm's configurations at the pose.
            flange: in the world.
            q: (N,), the arm's present configuration and the target's external axes.
            third: index of the third axis.
        """
        arm = self._robot.arm_size
        matrix = flange.matrix()
        R, p = np.ascontiguousarray(matrix[:3, :3]), np.ascontiguousarray(matrix[:3, 3])
        kept: list[FloatArray] = []
        for sample in (q[:arm], *samples):
            guess = q.copy()
            guess[:arm] = sample
            guess[third] = q[third]
            converged, _, _ = track(self._robot.chain, guess, R, p, self.solved, guess)
            if converged:
                turns = self._robot.turns(guess[:arm])
                kept += [t for t in turns if abs(t[third] - q[third]) < _SAME]
        return kept

    def _nearest_turns(self, q: FloatArray, before: FloatArray) -> FloatArray:
        """Of the arm's configurations whole turns away from each of q (K, n), the one nearest to
        ``before``."""
        limits = self._robot.limits
        size = q.shape[1]
        turned = q + self._full_turn * np.round((before - q) / (2 * np.pi))
        beyond = (turned < limits.lower[:size]) | (turned > limits.upper[:size])
        if beyond.any():
            for k in np.flatnonzero(beyond.any(axis=1)):
                options = self._robot.turns(q[k])
                turned[k] = options[np.argmin(np.abs(options - before).sum(axis=1))]
        return np.asarray(turned)

    def _pick(
        self,
        move: Move,
        index: int,
        wanted: Configuration | None,
        options: FloatArray,
        before: FloatArray,
    ) -> FloatArray:
        distance = np.abs(options - before).sum(axis=1)
        if wanted is None:
            return np.asarray(options[np.argmin(distance)])
        labels = [self._label(self._robot, q) for q in options]
        if self.redundant is not None and all(name is None for name in labels):
            return np.asarray(options[np.argmin(distance)])
        admitted = [name is not None and wanted.admits(name) for name in labels]
        misses = np.where(admitted, _mismatches(wanted, labels), math.inf)
        best = min(range(len(options)), key=lambda k: (misses[k], distance[k]))
        alike = self._alike(wanted, labels, misses, options, best)
        if alike and misses[best] > _MATCH:
            # Only where one posture is near what is programmed it is clear which is meant.
            admitted = [False] * len(options)
        if not any(admitted) and self._gives_way(index):
            best = int(np.argmin(distance))
            self.departures[index] = f"contradicts the pose: driven to with {labels[best]}"
        elif not any(admitted):
            near = dict.fromkeys(str(labels[k]) for k in np.argsort(distance))
            known = ", ".join(list(near)[:_NAMED])
            if len(near) > _NAMED:
                known += f" and {len(near) - _NAMED} more"
            raise located(
                move,
                index,
                f"configuration {wanted} contradicts the pose; the robot reaches it with {known}; "
                "programme one of them, or have the nearest driven "
                f"({spelt('configuration')} nearest)",
                FaultCause.CONFIGURATION,
            )
        elif alike:
            self.ambiguous[index] = f"{wanted} may mean {alike + 1} postures"
        elif misses[best] > _MATCH and not wanted.hint:
            self.tolerated[index] = f"{wanted} is driven to with {labels[best]}"
        return np.asarray(options[best])

    def _gives_way(self, index: int) -> bool:
        return self._nearest or index in self.assumed

    @staticmethod
    def _alike(
        wanted: Configuration,
        labels: Sequence[Configuration | None],
        misses: FloatArray,
        options: FloatArray,
        best: int,
    ) -> int:
        """How many other postures a programmed configuration may mean just as well as the best, on
        arms whose labels leave open which: if none matches, all that it admits."""
        chosen = labels[best]
        if wanted.hint or chosen is None or not chosen.hint:
            return 0
        others = np.abs(options - options[best]).max(axis=1) > _EDGE
        within = np.isfinite(misses) if misses[best] > _MATCH else misses <= _MATCH
        return int(np.count_nonzero(within & others))

    def _misses(self, wanted: Configuration, options: FloatArray) -> FloatArray:
        """Mismatches (K,) of configurations (K, N); infinite where the vendor has no label."""
        return _mismatches(wanted, [self._label(self._robot, q) for q in options])

    def check_arrival(self, move: Move, index: int, arrived: FloatArray) -> None:
        """Hold the end of a move of the TCP against its programmed configuration.

        Raises:
            MotionError: the arm arrives with another one.
        """
        wanted = move.target.configuration if isinstance(move.target, PoseTarget) else None
        if wanted is None:
            return
        label = self._label(self._robot, arrived)
        if label is None or wanted.hint:
            return
        if wanted.mismatch(label) <= _MATCH:
            return
        if wanted.admits(label):
            self.tolerated[index] = f"{wanted} is driven to with {label}"
        elif self._gives_way(index):
            self.departures[index] = f"contradicts the path: the arm arrives with {label}"
        else:
            raise located(
                move,
                index,
                f"configuration {wanted} contradicts the path: the arm arrives with {label}; "
                "use a joint move, or programme the configuration it arrives with, or have it "
                f"given up ({spelt('configuration')} nearest)",
                FaultCause.CONFIGURATION,
            )

    def check_posture(self, move: Move, found: FloatArray, before: FloatArray) -> None:
        """Hold a configuration (N,) that is found for the target of a move of the TCP against where
        the robot was, if the move states none: no line leads to another posture.

        Raises:
            MotionError: the arm is turned over.
        """
        if not isinstance(move.target, PoseTarget) or move.target.configuration is not None:
            return
        a, b = posture(self._robot, found), posture(self._robot, before)
        if a is None or b is None:
            arm = self._robot.arm_size
            turned = np.abs(found - before)[:arm].max() > _TURNED
        else:
            pairs = zip(a, b, strict=True)
            turned = any(x * y < 0 and min(abs(x), abs(y)) > _EDGE for x, y in pairs)
        if turned:
            raise located(
                move,
                0,
                "within its joint limits the arm reaches the target only turned over, in another "
                "posture, to which no line leads: use a joint move, or move the target",
                FaultCause.LIMIT,
            )

    def departure_notes(self, moves: Sequence[Move]) -> list[Note]:
        """Notes on configurations that gave way; one for all of moves whose pose is not known."""
        found = []
        guessed = [move for move in self.departures if move in self.assumed]
        for move, said in self.departures.items():
            target = moves[move].target
            assert isinstance(target, PoseTarget)
            message = f"configuration {target.configuration} {said}"
            if guessed and move == guessed[0]:
                names = dict.fromkeys(name for k in guessed for name in self.assumed[k])
                be = "is" if len(names) == 1 else "are"
                others = len(guessed) - 1
                more = f"; so it is with {counted(others, 'other move')}" if others else ""
                *first, last = names
                named = f"{', '.join(first)} and {last}" if first else last
                message += f", as {named} {be} not known{more}"
            if move not in guessed[1:]:
                found.append(Note(message, move))
        return found

    def tolerance_notes(self) -> list[Note]:
        """Notes on configurations that are not quite those of their poses, or hold for several."""
        found = []
        for moves, end in (
            (self.tolerated, ", the nearest that controllers take"),
            (self.ambiguous, " of this arm: the nearest is taken, and may be another one there"),
        ):
            if moves:
                first, what = next(iter(moves.items()))
                others = len(moves) - 1
                more = f"; so it is with {counted(others, 'other move')}" if others else ""
                found.append(Note(f"configuration {what}{end}{more}", first))
        return found

    def why_unreachable(self, move: Move, near: FloatArray) -> UnreachableError | None:
        """What keeps a move's target out of reach; None if nothing does."""
        if not isinstance(move.target, PoseTarget):
            return None
        q = self.external(move.target.external, near)
        external, flange = tuple(map(float, q[self._robot.arm_size :])), move.target.pose
        try:
            self._robot.inverse(self.flange(move, flange, q), external, move.target.arm_angle)
        except UnreachableError as error:
            return error
        return None

    def flange(self, move: Move, target: Pose, q: FloatArray) -> Pose:
        """The flange in the world that puts the TCP on a target in the work object."""
        tool, work_object = move.tool, move.work_object
        if work_object.robot_held:
            return tool.tcp @ target.inverse() @ work_object.pose.inverse()
        if work_object.moved_by is None:
            return work_object.pose @ target @ tool.tcp.inverse()
        stages = self._robot.frame_stages(work_object.moved_by)
        carrier = np.eye(4)
        pose(assemble([*stages, work_object.pose]), q, carrier[:3, :3], carrier[:3, 3])
        return Pose.from_matrix(carrier) @ target @ tool.tcp.inverse()


def _mismatches(wanted: Configuration, labels: Sequence[Configuration | None]) -> FloatArray:
    """Mismatches (K,) of labels; infinite where there is none."""
    return np.array([math.inf if name is None else wanted.mismatch(name) for name in labels])
