"""What a controller does to its commanded joints in time: moving averages, one after the other.

A moving average of length w takes the mean of the last w seconds. The kernel of the whole cascade
is symmetric about the middle of the window W = Σ w and has weight one, so that, beside the stamped
motion there,

- velocities and accelerations stay within what bounded them before;
- a joint with accelerations within ±a deviates at most a Σ w² / 24: half the kernel's variance, by
  Taylor's formula;
- jerk stays within 2 a / w for the longest w.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.lean import inner, lean
from ..model.motion_model import MotionModel

States = tuple[FloatArray, FloatArray, FloatArray]

STEP = 2e-3
"""s between the knots that stand for a motion, where averages are not so short that they need
more: a 16th of the shortest."""
_FINEST = 2.5e-4
_KNOTS = 16
_SLACK = 1e-6
"""Share of a step by which times may be off through rounding."""


def smoothing_at(model: MotionModel, jerk_fraction: float, joint_moves: bool = False) -> Smoothing:
    """What a model does to the commanded joints where a share of the jerk limit is programmed.

    Args:
        model: of the controller.
        jerk_fraction: that share.
        joint_moves: whether all moves are joint moves.
    """
    widths = model.joint_smoothing if joint_moves and model.joint_smoothing else model.smoothing
    made = Smoothing(tuple(width for width in widths if width > 0))
    if model.jerk is None:
        return made
    return made.lengthened_to(window_for_jerk(model.jerk * jerk_fraction))


def window_for_jerk(jerk: float) -> float:
    """Window in s that holds a jerk limit given as a multiple of acceleration per second.

    A mean over T of accelerations within ±a changes by at most 2 a / T per second.
    """
    return 2.0 / jerk


def knot_step(shortest: float) -> float:
    """s between knots of a motion whose shortest average is that long, in s."""
    return float(np.clip(shortest / _KNOTS, _FINEST, STEP))


@dataclass(frozen=True)
class JointMotion:
    """A motion that rests before its first knot and after its last, cubic between knots.

    Args:
        t: (S,) s, increasing.
        q, dq: (S, N), positions and velocities.
        step: s, between knots that are even; zero where they are not.
        means: of it, by window and step: `averaged` makes each once, whoever asks for commands.
    """

    t: FloatArray
    q: FloatArray
    dq: FloatArray
    step: float = 0.0
    means: dict[tuple[float, float], JointMotion] = field(
        default_factory=dict, repr=False, compare=False
    )

    @cached_property
    def areas(self) -> FloatArray:
        """(S, N), ∫ (q − q₀) dt from the first knot."""
        areas = np.zeros(self.q.shape)
        _fill_areas(self.t, self.q, self.dq, areas)
        return areas

    def at(self, t: FloatArray) -> States:
        """Positions, velocities and accelerations (T, N) at times (T,) that do not decrease."""
        out = _empty(len(t), self.q.shape[1])
        q, dq = np.ascontiguousarray(self.q), np.ascontiguousarray(self.dq)
        _interpolate(self.t, q, dq, t, *out)
        return out

    def averaged(self, window: float, t: FloatArray) -> States:
        """The same of the mean over the last ``window`` > 0 seconds."""
        out = _empty(len(t), self.q.shape[1])
        _average(self.t, self.q, self.dq, self.areas, window, t, *out)
        return out


@dataclass(frozen=True)
class Smoothing:
    """A cascade of moving averages over all joints.

    Args:
        widths: s, all above zero; their order makes no difference.
    """

    widths: tuple[float, ...] = ()

    @property
    def window(self) -> float:
        """Length in s of what the command at one time depends on."""
        return sum(self.widths)

    @property
    def deviation(self) -> float:
        """s²; times a bound of a joint's acceleration, how far it deviates from the stamp."""
        return sum(width**2 for width in self.widths) / 24.0

    @property
    def but_the_longest(self) -> Smoothing:
        """What comes before the last of the averages, which is the longest."""
        return Smoothing(tuple(sorted(self.widths)[:-1]))

    def lengthened_to(self, width: float) -> Smoothing:
        """The same with its longest moving average at least this long."""
        widths = sorted(self.widths) or [0.0]
        return Smoothing((*widths[:-1], max(widths[-1], width)))

    def command(self, motion: JointMotion, t: FloatArray) -> States:
        """The smoothed motion.

        Args:
            motion: what was stamped.
            t: (T,) s, not decreasing.

        Returns:
            Positions, velocities and accelerations (T, N).
        """
        if not self.widths:
            return motion.at(t)
        step = knot_step(min(self.widths))
        # The longest last: what the others leave is then resolved best.
        *first, last = sorted(self.widths)
        for width in first:
            motion = averaged(motion, width, step)
        return motion.averaged(last, t)


def averaged(motion: JointMotion, window: float, step: float) -> JointMotion:
    """The mean over the last ``window`` seconds of a motion, by knots ``step`` apart."""
    if (window, step) not in motion.means:
        motion.means[window, step] = _averaged(motion, window, step)
    return motion.means[window, step]


def _averaged(motion: JointMotion, window: float, step: float) -> JointMotion:
    if motion.step != step:
        t = even_times(motion.t[0], motion.t[-1] + window, step)
        q, dq, _ = motion.averaged(window, t)
        return JointMotion(t, q, dq, step)
    count = len(motion.t) + int(np.ceil(window / step))
    q, dq = np.empty((count, motion.q.shape[1])), np.empty((count, motion.q.shape[1]))
    _average_evenly(motion.q, motion.dq, motion.areas, window, step, q, dq)
    return JointMotion(motion.t[0] + step * np.arange(count), q, dq, step)


def even_times(begin: float, end: float, step: float) -> FloatArray:
    """Multiples (T,) of a step, the first not after ``begin`` and the last not before ``end``."""
    first = int(np.floor(begin / step + _SLACK))
    return np.asarray(
        step * np.arange(first, max(int(np.ceil(end / step - _SLACK)), first + 1) + 1)
    )


def _empty(count: int, size: int) -> States:
    return np.empty((count, size)), np.empty((count, size)), np.empty((count, size))


@lean
def _fill_areas(t: FloatArray, q: FloatArray, dq: FloatArray, out: FloatArray) -> None:
    for k in range(t.size - 1):
        h = t[k + 1] - t[k]
        for j in range(q.shape[1]):
            mean = 0.5 * (q[k, j] + q[k + 1, j]) - q[0, j]
            out[k + 1, j] = out[k, j] + h * (mean + h / 12 * (dq[k, j] - dq[k + 1, j]))


@inner
def _forward(t: FloatArray, at: float, k: int) -> int:
    """The last interval that begins at or before a time, from one that does; -1 before all."""
    while k + 1 < t.size and t[k + 1] <= at:
        k += 1
    return k


@inner
def _cubic(
    t: FloatArray, q: FloatArray, dq: FloatArray, k: int, at: float, j: int
) -> tuple[float, float, float, float]:
    """∫ (q − q₀) dt from knot k, q, q̇ and q̈ of joint j at a time in interval k."""
    if k < 0:
        return 0.0, q[0, j], 0.0, 0.0
    rest = q[k, j] - q[0, j]
    tau = at - t[k]
    if k + 1 >= t.size:
        return tau * rest, q[k, j], 0.0, 0.0
    h = t[k + 1] - t[k]
    z = tau / h
    v0, v1, d = h * dq[k, j], h * dq[k + 1, j], q[k + 1, j] - q[k, j]
    c2, c3 = 3 * d - 2 * v0 - v1, v0 + v1 - 2 * d
    area = tau * (rest + z * (v0 / 2 + z * (c2 / 3 + z * c3 / 4)))
    position = q[k, j] + z * (v0 + z * (c2 + z * c3))
    return area, position, (v0 + z * (2 * c2 + z * 3 * c3)) / h, (2 * c2 + 6 * z * c3) / h**2


@lean
def _average_evenly(
    q: FloatArray,
    dq: FloatArray,
    area: FloatArray,
    window: float,
    step: float,
    position: FloatArray,
    velocity: FloatArray,
) -> None:
    """`_average` at the knots and on, a step apart: cubics are weighed alike at all of them."""
    count, size = q.shape
    behind = window / step
    back = int(np.ceil(behind))
    z = back - behind
    # Values and slopes to either side of the place a window ago, and their integrals up to it.
    w0, w1 = 1 - z * z * (3 - 2 * z), z * z * (3 - 2 * z)
    v0, v1 = step * z * (1 - z) ** 2, -step * z * z * (1 - z)
    a0, a1 = step * z * (1 - z * z * (1 - z / 2)), step * z**3 * (1 - z / 2)
    b0 = step**2 * z * z * (0.5 - z * (2 / 3 - z / 4))
    b1 = -(step**2) * z**3 * (1 / 3 - z / 4)
    for i in range(position.shape[0]):
        now, over = min(i, count - 1), step * max(i - count + 1, 0)
        s = i - back
        for j in range(size):
            rest = q[0, j]
            whole = area[now, j] + over * (q[now, j] - rest)
            before = rest
            if s >= 0:
                n = min(s + 1, count - 1)
                before = w0 * q[s, j] + w1 * q[n, j] + v0 * dq[s, j] + v1 * dq[n, j]
                whole -= area[s, j] + a0 * (q[s, j] - rest) + a1 * (q[n, j] - rest)
                whole -= b0 * dq[s, j] + b1 * dq[n, j]
            position[i, j] = rest + whole / window
            velocity[i, j] = (q[now, j] - before) / window


@lean
def _interpolate(
    t: FloatArray,
    q: FloatArray,
    dq: FloatArray,
    at: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
) -> None:
    k = -1
    for i in range(at.size):
        k = _forward(t, at[i], k)
        for j in range(q.shape[1]):
            _, position[i, j], velocity[i, j], acceleration[i, j] = _cubic(t, q, dq, k, at[i], j)


@lean
def _average(
    t: FloatArray,
    q: FloatArray,
    dq: FloatArray,
    area: FloatArray,
    window: float,
    at: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
) -> None:
    now = then = -1
    for i in range(at.size):
        now, then = _forward(t, at[i], now), _forward(t, at[i] - window, then)
        for j in range(q.shape[1]):
            a1, q1, v1, _ = _cubic(t, q, dq, now, at[i], j)
            a0, q0, v0, _ = _cubic(t, q, dq, then, at[i] - window, j)
            whole = area[max(now, 0), j] - area[max(then, 0), j]
            position[i, j] = q[0, j] + (whole + a1 - a0) / window
            velocity[i, j] = (q1 - q0) / window
            acceleration[i, j] = (v1 - v0) / window
