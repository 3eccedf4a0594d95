"""Finds the configurations of a program's targets.

Along joint moves the configuration of a pose target is chosen among all solutions of inverse
kinematics; what a move of the TCP arrives with is held against the programmed one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ...door import spelt
from ...errors import FaultCause
from ...program.move import Move
from ...program.target import Configuration, PoseTarget
from ...robot.model import Robot
from ...robot.posture import posture
from .arm_angles import followed
from .remarks import Remarks
from .targets import Targets, located

Label = Callable[[Robot, FloatArray], Configuration | None]

_NAMED = 8
"""Labels in a message: the nearest, as a posture has several where joints turn more than once."""
_MATCH = 1e-9
_SAME = 1e-9
_TURNED = 2.4
"""rad by which an axis is taken to turn only where the arm takes another posture."""
_EDGE = 0.01
"""m or rad by which a posture differs clearly from its neighbour."""


class ConfigurationFinder:
    """Configurations of one robot under one vendor's labels.

    Args:
        robot: the robot.
        label: the vendor's label of a configuration; None where vendors have none.
        nearest: whether a configuration that contradicts its pose or path gives way to the nearest
            solution.

    Attributes:
        targets: of the robot.
        remarks: on the moves of one program; who looks at another one begins with new ones.
    """

    def __init__(self, robot: Robot, label: Label, nearest: bool = False) -> None:
        self._robot = robot
        self._nearest = nearest
        self._label = label
        self.targets = Targets(robot)
        self.remarks = Remarks()

    def choose(
        self, move: Move, index: int, before: FloatArray, known: FloatArray | None = None
    ) -> FloatArray:
        """The configuration of a joint move's pose target.

        Of the solutions with the programmed configuration, the one nearest to ``before``. A
        seven-axis arm keeps its third axis where the target states no arm angle.

        Args:
            move, index: the move.
            before: (N,), where the robot stands.
            known: the arm's solutions there, see `Targets.solutions`; None if they are not known.

        Raises:
            MotionError: the pose is out of reach (with the third axis kept), or contradicts the
                programmed configuration.
        """
        wanted = move.target.configuration if isinstance(move.target, PoseTarget) else None
        options = self.targets.options(move, index, before, known)
        return self._pick(move, index, wanted, options, before)

    def led(self, move: Move, index: int, before: FloatArray) -> FloatArray:
        """Where (N,) a move of the TCP ends whose target states an arm angle: the arm goes on in
        its posture, or else takes the nearest.

        Raises:
            MotionError: it cannot take the pose with that arm angle.
        """
        target = move.target
        assert isinstance(target, PoseTarget) and target.arm_angle is not None
        q = self.targets.external(target.external, before)
        if self._robot.measured_arm_angle is not None:
            flange = self.targets.flange(move, target.pose, q)
            reached = followed(self._robot, flange, target.arm_angle, q)
            if reached is not None:
                self.remarks.uneven[index] = reached.apart
                return reached.q
        return self.choose(replace(move, target=replace(target, configuration=None)), index, before)

    def starts(self, move: Move, index: int) -> FloatArray:
        """Configurations (K, N) in which the robot may stand at a move's pose target.

        All solutions with the programmed configuration and all turns of them; the one that
        `choose` takes from `rest` is the first.

        Raises:
            MotionError: as `choose`.
        """
        rest = self.targets.rest()
        first = self.choose(move, index, rest)
        target = move.target
        assert isinstance(target, PoseTarget)
        plain = replace(move, target=replace(target, configuration=None))
        options = self.targets.options(plain, index, rest, all_turns=True)
        wanted = target.configuration
        if wanted is not None:
            misses = self._misses(wanted, options)
            options = options[misses <= misses.min() + _MATCH]
        order = np.argsort(np.abs(options - first).sum(axis=1))
        apart = np.abs(options[order] - first).max(axis=1) > _SAME
        return np.concatenate([first[None], options[order][apart]])

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
        if self.targets.redundant is not None and all(name is None for name in labels):
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
            self.remarks.departures[index] = f"contradicts the pose: driven to with {labels[best]}"
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
            self.remarks.ambiguous[index] = f"{wanted} may mean {alike + 1} postures"
        elif misses[best] > _MATCH and not wanted.hint:
            self.remarks.tolerated[index] = f"{wanted} is driven to with {labels[best]}"
        return np.asarray(options[best])

    def _gives_way(self, index: int) -> bool:
        return self._nearest or index in self.remarks.assumed

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
            self.remarks.tolerated[index] = f"{wanted} is driven to with {label}"
        elif self._gives_way(index):
            self.remarks.departures[index] = f"contradicts the path: the arm arrives with {label}"
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


def _mismatches(wanted: Configuration, labels: Sequence[Configuration | None]) -> FloatArray:
    """Mismatches (K,) of labels; infinite where there is none."""
    return np.array([math.inf if name is None else wanted.mismatch(name) for name in labels])
