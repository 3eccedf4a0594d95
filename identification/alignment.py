"""A log and an emulated motion in one time: where the program's motion lies in the log, how the
log's clock is set, and how that changes over the run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import FloatArray, IntArray
from ..core.errors import InputError
from ..core.motion.command.trajectory import Trajectory
from ..core.robot.model import Robot
from .compatibility import check_axes, check_coverage, check_path, check_time
from .logs.cleaning import CleanLog
from .matching import Match, match

STILL = 1e-4
"""rad (m) from where a robot rests within which it counts as resting. Joint noise at rest is 30
µrad on the robots whose logs were seen, ABB's joint resolution 1.7 µrad."""
FAST = 0.2
"""Share of the greatest speed below which a sample says little about time."""
_PAIRS = 300
"""Samples whose pairs give the drift."""


@dataclass(frozen=True, eq=False)
class Alignment:
    """Where and when a log follows an emulated motion.

    ``t_log = t_emulated + offset`` fits best with a constant offset; with a drift,
    ``t_log = t_emulated + offset + drift · (t_emulated − middle)``. Drift holds clocks that run
    differently and a motion that is emulated too fast or too slow alike: a log cannot tell them.
    With both, ``t_log = origin + (1 + drift) · t_emulated``.

    Args:
        rows: (K,) indices of the log's samples from leaving the start to reaching the end; valid
            ones only.
        time: (K,) s of the emulated motion, of the place nearest to each.
        off: (K, N) rad (m), from that place to the sample.
        offset: s; the robust constant one that leaves the least deviation of joints.
        drift: s/s, robust slope of what an offset leaves.
        origin: s, of the log's time, where the emulated one is zero, with the drift.
        spread: s, robust standard deviation of what offset and drift leave.
        moving, logged_moving: s, from leaving the start to reaching the end: emulated, logged.
    """

    rows: IntArray
    time: FloatArray
    off: FloatArray
    offset: float
    drift: float
    origin: float
    spread: float
    moving: float
    logged_moving: float

    @property
    def cycle_time_ratio(self) -> float:
        """Emulated over logged time in motion."""
        return self.moving / self.logged_moving


def align(robot: Robot, trajectory: Trajectory, log: CleanLog) -> Alignment:
    """Align a log with the emulated motion of its program's motors, which is what logs show.

    What the log holds before the motion leaves its start and after it reaches its end plays no
    part.

    Args:
        robot: that moved; names and counts the axes.
        trajectory: the emulated motion, sampled densely: it is taken as straight between samples.
        log: of the same program.

    Raises:
        InputError: the log does not belong to the program; it says why.
    """
    check_axes(robot, trajectory, log)
    valid = np.flatnonzero(log.valid)
    q = log.q[valid]
    still = max(STILL, 6.0 * float(np.linalg.norm(log.noise)))
    found = match(trajectory.t, trajectory.q_motor, q, still)
    begin, end = _ends(found, still)
    inside = slice(begin, end + 1)
    check_path(robot, trajectory, q, found, inside)
    check_coverage(trajectory, q, found, begin, end)
    rows, time, off = valid[inside], found.time[inside], found.off[inside]
    lag = log.t[rows] - time
    weight = _speed(trajectory, time)
    offset = _weighted_median(lag, weight)
    drift, origin, spread = _drift(time, lag, weight, offset)
    motion = slice(int(rows[0]), _rest(log, int(rows[-1]), still))
    logged = moving_time(log.t[motion], log.q[motion])
    moving = moving_time(trajectory.t, trajectory.q_motor)
    check_time(moving, logged)
    return Alignment(rows, time, off, offset, drift, origin, spread, moving, logged)


def moving_time(t: FloatArray, q: FloatArray) -> float:
    """Time in s from leaving the first configuration to reaching the last one, within `STILL`.

    Raises:
        InputError: the robot never leaves.
    """
    away = np.abs(q - q[0]).max(axis=1) > STILL
    short = np.abs(q - q[-1]).max(axis=1) > STILL
    if not away.any() or not short.any():
        raise InputError(f"the robot stays within {STILL:g} rad of where it starts")
    left = int(np.argmax(away))
    arrived = len(t) - int(np.argmax(short[::-1]))
    if arrived <= left:
        raise InputError(f"the robot stays within {STILL:g} rad of where it starts")
    return float(t[arrived] - t[left - 1])


def _ends(found: Match, still: float) -> tuple[int, int]:
    """Index of the last sample before the start is left, and of the first that is at the end."""
    left = found.arc > found.arc.min() + still
    arrived = found.arc >= found.arc.max() - still
    begin = max(int(np.argmax(left)) - 1, 0)
    return begin, max(int(np.argmax(arrived)), begin)


def _rest(log: CleanLog, last: int, still: float) -> int:
    """Index behind the samples that follow ``last`` at rest."""
    away = np.linalg.norm(log.q[last:] - log.q[last], axis=1) > 10 * still
    away &= log.valid[last:]
    return last + int(np.argmax(away)) if away.any() else len(log.t)


def _speed(trajectory: Trajectory, time: FloatArray) -> FloatArray:
    """Speed of joints (K,) at times, zero where it is slow."""
    speed = np.linalg.norm(trajectory.dq_motor, axis=1)
    at = np.interp(time, trajectory.t, speed)
    return np.where(at > FAST * speed.max(), at, 0.0)


def _weighted_median(values: FloatArray, weight: FloatArray) -> float:
    """The value that leaves the least Σ w |value − v|: with speeds as weights, Σ of deviations."""
    order = np.argsort(values)
    total = np.cumsum(weight[order])
    return float(values[order[np.searchsorted(total, 0.5 * total[-1])]])


def _drift(
    time: FloatArray, lag: FloatArray, weight: FloatArray, offset: float
) -> tuple[float, float, float]:
    """Slope of lags over time by the median over pairs (Theil, Sen), where the line begins, and the
    spread about it."""
    rows = np.flatnonzero(weight > 0)
    if len(rows) < 3 or np.ptp(time[rows]) == 0:
        return 0.0, offset, 0.0
    used = rows[np.linspace(0, len(rows) - 1, min(len(rows), _PAIRS)).astype(np.int64)]
    a, b = np.triu_indices(len(used), 1)
    run = time[used][b] - time[used][a]
    apart = np.abs(run) > 0.1 * np.ptp(time[used])
    drift = float(np.median((lag[used][b] - lag[used][a])[apart] / run[apart]))
    rest = lag[rows] - drift * time[rows]
    origin = float(np.median(rest))
    return drift, origin, 1.4826 * float(np.median(np.abs(rest - origin)))
