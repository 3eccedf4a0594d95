"""The speeds and accelerations that a program states, as variables.

Each move that is driven has one number by which it is driven faster or slower, and one by which it
accelerates harder or more gently, in the words of its language. A variable is the number's
logarithm. A programmed speed that the robot does not reach has no effect; a search begins at what
is reached. Nothing is ever driven faster than it was programmed.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import FloatArray
from ....core.dialect import Dialect
from ....core.motion.gradients.derivatives import ProgramGradient
from ....core.motion.timing.timing import Timing
from ....core.program.move import Move, MoveJ
from ....core.program.program import Program
from ....core.robot.model import Robot
from ....core.translation.emulation import Peaks
from ..waypoints import WaypointTask as Wishes

_STILL = 1e-6
"""m/s below which the TCP does not move: the move turns the tool."""
_SCALE = 0.3
"""Change of a logarithm that matters like a tenth of a rad of a joint."""
_SHARES = ("joint_fraction", "joint_acceleration_fraction")
_STEP = 1e-4
"""Of speeds in m/s and rad/s, of accelerations, and of shares where a language takes any."""
_BINDS = 0.99
"""Share of a speed from which on it counts as reached."""
_HARDLY = 0.015
"""Share by which a reduced acceleration is worth an instruction."""
_LEAST_ACCELERATION = 0.02
"""Share of the programmed acceleration below which none is sought."""


@dataclass(frozen=True)
class SpeedNumber:
    """One number of one move's speed.

    Args:
        move: its index.
        name: of the number in `Speed`.
        begin: value that a search begins with.
        least, most: of its values.
        step: of what is written.
    """

    move: int
    name: str
    begin: float
    least: float
    most: float
    step: float

    @property
    def accelerates(self) -> bool:
        """Whether it is an acceleration."""
        return "acceleration" in self.name

    def rounded(self, value: float) -> float:
        """The value as it is written: a multiple of the step, or a bound.

        An acceleration that is hardly reduced is not: it would be an instruction for nothing.
        """
        if value >= self.most * (1.0 - (_HARDLY if self.accelerates else 1e-9)):
            return self.most
        per_unit = round(1.0 / self.step)
        nearest = round(value * per_unit) / per_unit
        return min(max(nearest, self.least), self.most)


class Pacing:
    """The variables of a program's speeds.

    Args:
        numbers: one a variable.

    Attributes:
        lower, upper, start, scale: (n,), of the logarithms.
    """

    def __init__(self, numbers: Sequence[SpeedNumber]) -> None:
        self.numbers = tuple(numbers)
        self.lower, self.upper, self.start = (
            np.log([getattr(number, name) for number in numbers])
            for name in ("least", "most", "begin")
        )
        self.scale = np.full(len(self.numbers), _SCALE)

    @property
    def size(self) -> int:
        """SpeedNumber of variables."""
        return len(self.numbers)

    def applied(self, program: Program, y: FloatArray) -> Program:
        """The program with these logarithms."""
        return self._with(program, np.exp(np.clip(y, self.lower, self.upper)).tolist())

    def written(self, program: Program, y: FloatArray) -> Program:
        """The program with numbers near these, as a person would write them."""
        values = np.exp(np.clip(y, self.lower, self.upper)).tolist()
        pairs = zip(self.numbers, values, strict=True)
        return self._with(program, [number.rounded(value) for number, value in pairs])

    def gradient(self, made: ProgramGradient, y: FloatArray) -> FloatArray:
        """(n,), from the program's numbers to their logarithms."""
        slopes = [float(getattr(made.speed, n.name)[n.move]) for n in self.numbers]
        return np.array(slopes) * np.exp(y)

    def coarse(self) -> NDArray[np.bool_]:
        """(n,), accelerations: their steps are large, so that all else is sought again when they
        have been rounded."""
        return np.array([number.accelerates for number in self.numbers], dtype=bool)

    def rounded(self, y: FloatArray) -> FloatArray:
        """Logarithms of the numbers that are written."""
        pairs = zip(self.numbers, np.exp(y).tolist(), strict=True)
        return np.log([number.rounded(value) for number, value in pairs])

    def released(self, y: FloatArray, timing: Timing, robot: Robot) -> FloatArray:
        """Logarithms with the programmed number in the place of every speed that is not reached.

        Args:
            y: (n,).
            timing: of the program with these.
            robot: that drives it.
        """
        peaks, out = Peaks.of(timing), y.copy()
        segment = {move: k for k, move in enumerate(timing.path.route.moves)}
        for index, number in enumerate(self.numbers):
            if number.accelerates:
                continue
            reached = _reached(number.name, peaks, segment[number.move], robot)
            if reached < _BINDS * np.exp(y[index]):
                out[index] = self.upper[index]
        return out

    def _with(self, program: Program, values: Sequence[float]) -> Program:
        moves = list(program.moves)
        for number, value in zip(self.numbers, values, strict=True):
            speed = moves[number.move].speed
            if getattr(speed, number.name) == value:
                continue
            changed: dict[str, Any] = {number.name: value}
            # A predefined name says another number.
            if not number.accelerates:
                changed["name"] = None
            moves[number.move] = replace(moves[number.move], speed=replace(speed, **changed))
        return program.with_moves(tuple(moves))


def make_pacing(
    program: Program,
    timing: Timing,
    robot: Robot,
    dialect: Dialect | None,
    wishes: Wishes,
    slowest: float,
) -> Pacing:
    """The variables of a driven program.

    Args:
        program: what was driven.
        timing: its stamp.
        robot: that drove it.
        dialect: what its language has words for; None for everything.
        wishes: which moves stay.
        slowest: share of the speed that a move reaches below which it is not driven.
    """
    peaks = Peaks.of(timing)
    numbers: list[SpeedNumber] = []
    for k, i in enumerate(timing.path.route.moves):
        move = program.moves[i]
        if _held(move, i, wishes):
            continue
        leading = _leading(timing, k, robot)
        numbers += _speed(i, move, peaks, k, robot, dialect, slowest)
        numbers += _acceleration(i, move, robot, dialect, leading)
    return Pacing(numbers)


def _held(move: Move, i: int, wishes: Wishes) -> bool:
    """Whether a move's speed is the process's, or something else than its speed paces it."""
    names: Collection[str] = wishes.keep_speeds
    return (
        i in wishes.keep
        or i in wishes.process
        or move.speed.name in names
        or bool(move.events)
        or move.speed.duration is not None
    )


def _said(dialect: Dialect | None, move: Move, name: str) -> bool:
    return dialect is None or name in dialect.words(move).speeds


def _speed(
    i: int,
    move: Move,
    peaks: Peaks,
    k: int,
    robot: Robot,
    dialect: Dialect | None,
    slowest: float,
) -> list[SpeedNumber]:
    """The number by which a move is driven faster or slower."""
    joint = isinstance(move, MoveJ)
    name = dialect.pace if joint and dialect is not None else "tcp"
    if name == "tcp" and peaks.tcp[k] < _STILL:
        name = "reorientation"
    if not _said(dialect, move, name):
        return []
    reached = _reached(name, peaks, k, robot)
    if reached <= 0.0:
        return []
    programmed = getattr(move.speed, name)
    most = 2.0 * reached if programmed is None else programmed
    least = slowest * min(reached, most)
    step = _share_step(dialect) if name in _SHARES else _STEP
    return [SpeedNumber(i, name, min(reached, most), max(least, step), most, step)]


def _reached(name: str, peaks: Peaks, k: int, robot: Robot) -> float:
    """What a segment reaches of a number of its speed."""
    rates = peaks.joint[k][: robot.arm_size]
    shares = rates / robot.limits.velocity[: robot.arm_size]
    return {
        "tcp": float(peaks.tcp[k]),
        "reorientation": float(peaks.turn[k]),
        "joint": float(rates.max()),
        "joint_fraction": float(shares.max()),
    }[name]


def _acceleration(
    i: int, move: Move, robot: Robot, dialect: Dialect | None, leading: int
) -> list[SpeedNumber]:
    """The number by which it accelerates harder or more gently."""
    if _said(dialect, move, "joint_acceleration_fraction"):
        most = move.speed.joint_acceleration_fraction
        least = 0.01 if dialect is None else dialect.least_acceleration_share
        step, name = _share_step(dialect), "joint_acceleration_fraction"
    else:
        name = "joint_acceleration" if isinstance(move, MoveJ) else "tcp_acceleration"
        if not _said(dialect, move, name):
            return []
        programmed = getattr(move.speed, name)
        if programmed is None:
            if name == "tcp_acceleration":
                return []
            programmed = float(robot.limits.acceleration[leading])
        most, least, step = programmed, _LEAST_ACCELERATION * programmed, _STEP
    return [SpeedNumber(i, name, most, least, most, step)] if least < most else []


def _share_step(dialect: Dialect | None) -> float:
    return _STEP if dialect is None or dialect.share_step == 0.0 else dialect.share_step


def _leading(timing: Timing, k: int, robot: Robot) -> int:
    """The axis of the arm that needs the longest for its way."""
    ends = timing.path.route.ends
    turned = np.abs(ends.q[k, 1] - ends.q[k, 0])[: robot.arm_size]
    return int(np.argmax(turned / robot.limits.velocity[: robot.arm_size]))
