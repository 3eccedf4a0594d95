"""The numbers with which moves take as long as they took on the other robot."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..dialect import Dialect
from ..motion.path.path import Path
from ..program.move import Move, MoveJ
from ..program.program import Program
from ..program.speed import Speed
from ..robot.model import Robot
from .emulation import EmulatedProgram, Party
from .overrides import OVERRIDE, accelerates_by

_ROUNDS = 8
_GROWTHS = 4
"""How often times are sought anew with greater accelerations."""
_MET = 2e-3
"""Share of a move's time by which it may miss what is wanted before another round is made."""
_LATE = 0.05
"""Share by which a move may be slower before its acceleration grows."""
_SHARES = ("joint_fraction", OVERRIDE)
"""Numbers that are shares."""
_SIGNIFICANT = 4
"""Digits of the numbers that are sought."""


class TimeSearch:
    """Seeks the numbers of one program.

    Args:
        old: the program on the old robot.
        target: the new robot.
        dialect: its language.
        sought: the number of `Speed` that is sought of each move; it grows while speeds are stated.
        tied: of moves that are one, by each of them, all of them.
    """

    def __init__(
        self,
        old: EmulatedProgram,
        target: Party,
        dialect: Dialect,
        sought: Mapping[int, str],
        tied: Mapping[int, Sequence[int]],
    ) -> None:
        self._old = old
        self._target = target
        self._dialect = dialect
        self._sought = sought
        self._tied = tied

    def in_time(self, program: Program, path: Path, segment: Mapping[int, int]) -> Program:
        """The program with those numbers that were left to be sought.

        Where a share of acceleration keeps a joint move from its time, the share grows.
        """
        sought = [i for i in self._sought if i in segment]
        for _ in range(_GROWTHS):
            if not sought:
                break
            program, late = self._matched(program, path, segment, sought)
            slow = [i for i in late if self._may_accelerate(program.moves[i])]
            program = self._accelerated(program, {i: late[i] for i in slow})
            again = (k for i in slow for k in self._tied.get(i, (i,)))
            sought = [i for i in again if i in self._sought and i in segment]
        return program

    def _matched(
        self, program: Program, path: Path, segment: Mapping[int, int], sought: Sequence[int]
    ) -> tuple[Program, dict[int, float]]:
        """The program with numbers that meet the times, and by what factor moves are late.

        Times are nearly linear in the inverse of a speed: secant steps in it, all moves at once.
        """
        rows = [segment[i] for i in sought]
        # Moves that are one take as long as before all together.
        leads = [self._tied.get(i, (i,))[0] for i in sought]
        first, group = np.unique(leads, return_index=True, return_inverse=True)[1:]
        one = [sought[k] for k in first]
        old = self._old.peaks.duration[[self._old.segment[i] for i in sought]]
        wanted = _sums(group, old)
        value = np.array([getattr(program.moves[i].speed, self._sought[i]) for i in one])
        most = np.full(len(one), np.inf)
        np.minimum.at(most, group, [self._most(path, i, segment[i]) for i in sought])
        slow = 1.0 / np.minimum(value, most)
        before: tuple[FloatArray, FloatArray] | None = None
        for _ in range(_ROUNDS):
            program = self._at(program, one, 1.0 / slow)
            path = self._target.repaced(path, program)
            spent = _sums(group, self._target.timing(program, path).settled_durations()[rows])
            error = wanted - spent
            if (np.abs(error) < _MET * wanted).all():
                break
            step = slow * (wanted / np.maximum(spent, 1e-9) - 1.0)
            if before is not None:
                slope = (spent - before[1]) / np.where(slow == before[0], np.inf, slow - before[0])
                step = np.where(slope > 1e-9, error / np.maximum(slope, 1e-9), step)
            before = slow, spent
            slow = np.clip(slow + step, np.maximum(1.0 / most, 0.2 * slow), 5.0 * slow)
        # Late at the greatest speed: not for want of speed, nor for its rounding.
        late = (spent > (1 + _LATE) * wanted) & (slow * most < 1.0 + _LATE)
        factors = {one[int(k)]: float(spent[k] / wanted[k]) for k in np.flatnonzero(late)}
        return self._at(program, one, 1.0 / slow), factors

    def _may_accelerate(self, move: Move) -> bool:
        """Whether a move's acceleration is below what the new robot can do."""
        speed = move.speed
        if not isinstance(move, MoveJ):
            return False
        if self._accelerates_by != "joint_acceleration":
            return bool(getattr(speed, self._accelerates_by) < 1.0)
        most = self._most_acceleration
        return speed.joint_acceleration is not None and speed.joint_acceleration < most

    @property
    def _most_acceleration(self) -> float:
        """rad/s² that a joint move may state."""
        own = float(self._target.robot.limits.acceleration.max())
        return min(own, self._dialect.most.get("joint_acceleration", math.inf))

    @property
    def _accelerates_by(self) -> str:
        return accelerates_by(self._dialect.joint) or "joint_acceleration"

    def _accelerated(self, program: Program, late: Mapping[int, float]) -> Program:
        """The program with moves accelerated by the square of the factor by which they are late."""
        moves, name = list(program.moves), self._accelerates_by
        for i, factor in late.items():
            value = getattr(moves[i].speed, name) * 1.05 * factor**2
            most = self._most_acceleration
            share = name != "joint_acceleration"
            number = self.stepped(min(1.0, value), up=True) if share else rounded(min(most, value))
            for k in self._tied.get(i, (i,)):
                moves[k] = replace(moves[k], speed=_with(moves[k].speed, name, number))
        return program.with_moves(tuple(moves))

    def _most(self, path: Path, i: int, k: int) -> float:
        """The greatest value of the number that is sought."""
        name = self._sought[i]
        if name in _SHARES:
            return 1.0
        if name == "joint":
            turned = path.route.ends.q[k, 1] - path.route.ends.q[k, 0]
            leading = leading_axis(self._target.robot, turned)
            return rounded_down(float(self._target.robot.limits.velocity[leading]))
        return self._dialect.fastest if name == "tcp" else 4 * np.pi

    def _at(self, program: Program, sought: Sequence[int], values: FloatArray) -> Program:
        moves = list(program.moves)
        for i, value in zip(sought, map(float, values), strict=True):
            name = self._sought[i]
            number = self.stepped(value) if name in _SHARES else rounded(value)
            for k in self._tied.get(i, (i,)):
                moves[k] = replace(moves[k], speed=_with(moves[k].speed, name, number))
        return program.with_moves(tuple(moves))

    def stepped(self, share: float, up: bool = False) -> float:
        """A share as the language says it, at least one step; ``up``: no less than it is."""
        step = self._dialect.share_step
        if step == 0.0:
            return share
        steps = math.ceil(share / step - 1e-6) if up else round(share / step)
        return min(1.0, max(step, round(steps * step, 9)))


def _sums(group: IntArray, values: FloatArray) -> FloatArray:
    """The sum of the values of each group."""
    sums: FloatArray = np.bincount(group, values).astype(np.float64)
    return sums


def _with(speed: Speed, name: str, value: float) -> Speed:
    changed: dict[str, Any] = {name: value}
    return replace(speed, **changed)


def leading_axis(robot: Robot, turned: FloatArray) -> int:
    """The axis of the arm that needs the longest for its way."""
    arm = robot.arm_size
    return int(np.argmax(np.abs(turned[:arm]) / robot.limits.velocity[:arm]))


def rounded(value: float) -> float:
    """The value with so many digits as mean something."""
    return float(f"{value:.{_SIGNIFICANT}g}")


def rounded_down(value: float) -> float:
    """The same, of a limit: at most the value."""
    near = rounded(value)
    step = 10.0 ** (math.floor(math.log10(value)) + 1 - _SIGNIFICANT)
    return near if near <= value else rounded(value - step)
