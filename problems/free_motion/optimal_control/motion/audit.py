"""How far a motion goes beyond its limits, between nodes too.

Positions, speeds, accelerations and jerks are polynomials on each piece: the hull of their
Bernstein coefficients bounds them. Torques and the TCP's speed are looked at densely; what they
may do between two samples is bounded by Δ² / 8 times the most that they can bend there
(`torque_bounds`), and samples are added where that does not tell enough.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .....core.arrays import FloatArray, IntArray
from ..task.limits import MotionLimits
from ..task.sampled import Plant, State, TcpSpeed
from ..task.task import MotionTask
from ..task.torque_bounds import BendBounds
from .motion import Motion
from .scheme import bernstein

_FIRST, _FINEST = 8, 1024
"""Samples between nodes."""


@dataclass(frozen=True)
class Audit:
    """Shares of limits that each piece uses at most, proven; 1 is all.

    Args:
        velocity, acceleration, jerk: (K, n).
        torque: (K, R), first of the joints' own limits, then of those that fall with speed.
        tcp_speed: (K,).
        beyond: (K, n), rad or m beyond the joints' ranges; negative within.
    """

    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray
    torque: FloatArray
    tcp_speed: FloatArray
    beyond: FloatArray

    @property
    def used(self) -> float:
        """The largest share of any limit, those of position left out."""
        parts = (self.velocity, self.acceleration, self.jerk, self.torque, self.tcp_speed)
        return float(max(part.max(initial=0.0) for part in parts))

    @property
    def torque_violation(self) -> float:
        """The largest share by which a torque may be above its limit; 0 for none."""
        return max(0.0, float(self.torque.max(initial=0.0)) - 1.0)

    def holds(self, tolerance: float) -> bool:
        """Whether all limits hold to a share of them, and joints stay in range to 1e-6."""
        return self.used <= 1.0 + tolerance and bool(self.beyond.max(initial=-1.0) <= 1e-6)


def audit(
    task: MotionTask, limits: MotionLimits, plant: Plant | None, motion: Motion, tolerance: float
) -> Audit:
    """Look at a whole motion.

    Args:
        task, limits, plant: what is asked.
        motion: to be looked at.
        tolerance: share of a limit that bounds between samples need not tell apart from it.
    """
    hulls = [_hull(motion, order) for order in range(4)]
    upper = hulls[0].max(axis=1) - limits.upper
    beyond = np.maximum(upper, limits.lower - hulls[0].min(axis=1))
    velocity, acceleration, jerk = (
        np.abs(hull).max(axis=1) / limit
        for hull, limit in zip(
            hulls[1:], (limits.velocity, limits.acceleration, limits.jerk), strict=True
        )
    )
    samples = _Samples(task, limits, plant, motion, tolerance)
    return Audit(velocity, acceleration, jerk, samples.torques(), samples.tcp_speeds(), beyond)


def _hull(motion: Motion, order: int) -> FloatArray:
    """(K, C, n), Bernstein coefficients of a derivative on each piece."""
    return np.moveaxis(bernstein(np.moveaxis(motion.differentiated(order), 1, 0)), 0, 1)


class _Samples:
    """What is looked at densely."""

    def __init__(
        self,
        task: MotionTask,
        limits: MotionLimits,
        plant: Plant | None,
        motion: Motion,
        tolerance: float,
    ) -> None:
        self._task, self._limits, self._plant, self._motion = task, limits, plant, motion
        self._tolerance = tolerance
        self._rates = self._bounded_rates()

    def _bounded_rates(self) -> FloatArray:
        """(K, N, 5), bounds of |q| and its derivatives on every piece."""
        task, motion = self._task, self._motion
        out = np.zeros((len(motion), task.robot.size, 5))
        out[:, :, 0] = np.abs(np.asarray(task.start))
        for order in range(5):
            out[:, task.moving, order] = np.abs(_hull(motion, order)).max(axis=1)
        return out

    def torques(self) -> FloatArray:
        """Proven shares (K, R)."""
        count = len(self._motion)
        proven, sampled = np.zeros((2, count, len(self._limits.torques.axis)))
        if self._plant is None or not self._limits.dynamic:
            return proven
        bends = self._torque_bends()
        rows, parts = np.arange(count), _FIRST
        while len(rows) and parts <= _FINEST:
            seen = self._seen(rows, parts)
            spacing = self._motion.durations[rows] / parts
            sampled[rows] = np.maximum(sampled[rows], seen)
            proven[rows] = sampled[rows] + spacing[:, None] ** 2 / 8.0 * bends[rows]
            aim = np.maximum(1.0 + 0.5 * self._tolerance, sampled[rows] + 0.1 * self._tolerance)
            rows = rows[(proven[rows] > aim).any(axis=1)]
            parts *= 4
        return np.asarray(proven)

    def _seen(self, rows: IntArray, parts: int) -> FloatArray:
        """(M, R), the largest shares at samples of some pieces, both ends included."""
        assert self._plant is not None
        shares = np.linspace(0.0, 1.0, parts + 1)
        piece = Motion(
            np.concatenate([[0.0], np.cumsum(self._motion.durations[rows])]),
            self._motion.coefficients[rows],
            self._motion.leg[rows],
        )
        q, dq, ddq = (
            piece.on_pieces(shares, k).reshape(-1, len(self._task.moving)) for k in range(3)
        )
        state = State(q, dq, ddq, np.repeat(piece.leg, parts + 1))
        torque, rate = self._plant.torques(state), self._plant.rates(state)
        used = np.abs(self._limits.torques.shares(torque, rate))
        return np.asarray(used.reshape(len(rows), parts + 1, -1).max(axis=1))

    def _torque_bends(self) -> FloatArray:
        """(K, R), bounds of the second derivatives of the shares."""
        task, legs = self._task, self._motion.leg
        out = np.empty((len(self._motion), task.robot.arm_size))
        for leg in np.unique(legs):
            rows = legs == leg
            found = BendBounds(task.robot, task.load(int(leg)), task.tcp, self._rates[rows])
            out[rows] = found.torques()
        return self._limits.torques.shares(out, self._rates[:, :, 3])

    def tcp_speeds(self) -> FloatArray:
        """(K,), proven shares of the TCP's speed limit."""
        limit, count = self._limits.tcp_speed, len(self._motion)
        if not np.isfinite(limit):
            return np.zeros(count)
        speed = TcpSpeed(self._task, 1.0)
        bends = BendBounds(self._task.robot, None, self._task.tcp, self._rates).tcp()
        parts = 64
        shares = np.linspace(0.0, 1.0, parts + 1)
        q, dq = (
            self._motion.on_pieces(shares, k).reshape(-1, len(self._task.moving)) for k in (0, 1)
        )
        seen = np.linalg.norm(speed.velocity(q, dq), axis=1).reshape(count, -1).max(axis=1)
        between = (self._motion.durations / parts) ** 2 / 8.0 * bends
        return np.asarray((seen + between) / limit)
