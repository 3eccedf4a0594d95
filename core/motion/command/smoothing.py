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
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.lean import inlined, inner, lean
from ..model.motion_model import MotionModel

States = tuple[FloatArray, FloatArray, FloatArray]

STEP = 2e-3
"""s between the knots that stand for a motion, where averages are not so short that they need
more: a 16th of the shortest."""
_FINEST = 2.5e-4
_KNOTS = 16
_SLACK = 1e-6
"""Share of a step by which times may be off through rounding."""
_NOT_WANTED = np.empty((0, 0))


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

    @classmethod
    def through(cls, t: FloatArray, values: FloatArray) -> JointMotion:
        """The cubic spline through values (S, N) at even times (S,) in s."""
        values = np.ascontiguousarray(values)
        slopes = np.zeros_like(values)
        if len(t) > 2:
            _fill_slopes(values, float(t[1] - t[0]), slopes, np.zeros(len(values)))
        return cls(t, values, slopes)

    @cached_property
    def areas(self) -> FloatArray:
        """(S, N), ∫ (q − q₀) dt from the first knot."""
        areas = np.zeros(self.q.shape)
        _fill_areas(self.t, self.q, self.dq, areas)
        return areas

    def at(self, t: FloatArray, out: States | None = None) -> States:
        """Positions, velocities and accelerations (T, N) at times (T,) that do not decrease."""
        out = out or _empty(len(t), self.q.shape[1])
        q, dq = np.ascontiguousarray(self.q), np.ascontiguousarray(self.dq)
        _interpolate(self.t, q, dq, t, np.empty((3, q.shape[1])), *out)
        return out

    def averaged(self, window: float, t: FloatArray, out: States | None = None) -> States:
        """The same of the mean over the last ``window`` > 0 seconds."""
        out = out or _empty(len(t), self.q.shape[1])
        _fill_averages(self, window, t, _at_knots(self, t), *out)
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

    def command(self, motion: JointMotion, t: FloatArray, out: States | None = None) -> States:
        """The smoothed motion.

        Args:
            motion: what was stamped.
            t: (T,) s, not decreasing.
            out: (T, N) each, written and returned; None for new ones.

        Returns:
            Positions, velocities and accelerations (T, N).
        """
        if not self.widths:
            return motion.at(t, out)
        step = knot_step(min(self.widths))
        # The longest last: what the others leave is then resolved best.
        *first, last = sorted(self.widths)
        for width in first:
            motion = averaged(motion, width, step)
        return motion.averaged(last, t, out)


def averaged(motion: JointMotion, window: float, step: float) -> JointMotion:
    """The mean over the last ``window`` seconds of a motion, by knots ``step`` apart."""
    if (window, step) not in motion.means:
        places = 0, 1
        if motion.step == step:
            t = motion.t[0] + step * np.arange(len(motion.t) + int(np.ceil(window / step)))
        else:
            t = even_times(motion.t[0], motion.t[-1] + window, step)
            places = _at_knots(motion, t)
        q, dq = (np.empty((len(t), motion.q.shape[1])) for _ in range(2))
        _fill_averages(motion, window, t, places, q, dq, _NOT_WANTED)
        motion.means[window, step] = JointMotion(t, q, dq, step)
    return motion.means[window, step]


def _fill_averages(
    motion: JointMotion,
    window: float,
    t: FloatArray,
    places: tuple[int, int],
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
) -> None:
    """Write the mean over a window at times (T,); accelerations where there is room for them.

    Where times stand at every knot, or at each so many (see `_at_knots`), the window begins at the
    same place of an interval each time: what weighs knots is worked out once.
    """
    first, stride = places
    begin = end = 0
    if stride > 0:
        # Between these the whole window lies in the motion, and behind it goes on.
        back = int(np.ceil(window / motion.step - _SLACK))
        begin = min(max(-((first - back) // stride), 0), len(t))
        end = min(max((len(motion.t) - 1 - first) // stride, begin), len(t))
    for part in (slice(0, begin), slice(end, len(t))):
        if part.start < part.stop:
            given = motion.t, motion.q, motion.dq, motion.areas, window, t[part]
            _average(*given, q[part], dq[part], ddq[part])
    if begin >= end:
        return
    now, size = first + begin * stride, (end - begin) * stride

    def rows(values: FloatArray, at: int) -> FloatArray:
        """(E, …), of each time the values from a knot on, of which the first N count."""
        return values[at : at + size].reshape(end - begin, -1)

    _fill_means(
        1.0 / window,
        np.array([0.0, motion.step]),
        back * motion.step - window,
        motion.q[0],
        *(rows(motion.q, now - behind) for behind in (0, back, back - 1)),
        *(rows(motion.dq, now - behind) for behind in (0, back, back - 1)),
        *(rows(motion.areas, now - behind) for behind in (0, back)),
        q[begin:end],
        dq[begin:end],
        ddq[begin:end],
    )


def _at_knots(motion: JointMotion, t: FloatArray) -> tuple[int, int]:
    """Which of a motion's knots the first of times (T,) stands at, and how many knots lie from each
    to the next; zero where they do not stand so."""
    if motion.step == 0.0 or len(t) < 2:
        return 0, 0
    first, rate = float(t[0] - motion.t[0]) / motion.step, float(t[1] - t[0]) / motion.step
    at, stride = round(first), round(rate)
    if abs(rate - stride) > _SLACK:
        return at, 0
    off = (t - motion.t[0]) / motion.step - (at + stride * np.arange(len(t)))
    return at, stride if np.abs(off).max() <= _SLACK else 0


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


class _Cubic(NamedTuple):
    """What weighs values and slopes of knots k and n about a time, of all joints alike.

    Args:
        k, n: the knots.
        rise, v0, v1: of the position there, beside that of knot k: the way to n, and the slopes.
        rate, d0, d1: of the velocity, likewise.
        since, area, b0, b1: of ∫ (q − q₀) dt from knot k: its rest, the way to n, and the slopes.
    """

    k: int
    n: int
    rise: float
    v0: float
    v1: float
    rate: float
    d0: float
    d1: float
    since: float
    area: float
    b0: float
    b1: float


@inlined
def _cubic(t: FloatArray, k: int, at: float) -> _Cubic:
    """At a time in interval k; at rest before all knots (k = -1) and after them."""
    if k < 0:
        return _Cubic(0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    tau = at - t[k]
    if k + 1 >= t.size:
        return _Cubic(k, k, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, tau, 0.0, 0.0, 0.0)
    h = t[k + 1] - t[k]
    z = tau / h
    y, square = 1.0 - z, z * z
    return _Cubic(
        k,
        k + 1,
        square * (3.0 - 2.0 * z),
        tau * y * y,
        -tau * z * y,
        6.0 * z * y / h,
        y * (1.0 - 3.0 * z),
        z * (3.0 * z - 2.0),
        tau,
        tau * square * (1.0 - 0.5 * z),
        tau * tau * (0.5 - z * (2.0 / 3.0 - 0.25 * z)),
        tau * tau * z * (0.25 * z - 1.0 / 3.0),
    )


@inlined
def _position(w: _Cubic, q: FloatArray, dq: FloatArray, j: int) -> float:
    way = q[w.n, j] - q[w.k, j]
    found: float = q[w.k, j] + (w.rise * way + w.v0 * dq[w.k, j] + w.v1 * dq[w.n, j])
    return found


@inlined
def _velocity(w: _Cubic, q: FloatArray, dq: FloatArray, j: int) -> float:
    found: float = w.rate * (q[w.n, j] - q[w.k, j]) + w.d0 * dq[w.k, j] + w.d1 * dq[w.n, j]
    return found


@inlined
def _area(w: _Cubic, q: FloatArray, dq: FloatArray, j: int) -> float:
    rest = w.since * (q[w.k, j] - q[0, j]) + w.area * (q[w.n, j] - q[w.k, j])
    found: float = rest + w.b0 * dq[w.k, j] + w.b1 * dq[w.n, j]
    return found


@inlined
def interpolate_at(
    t: FloatArray, q: FloatArray, dq: FloatArray, at: float, k: int, out: FloatArray
) -> int:
    """Write position, velocity and acceleration (3, N) at a time, with its interval k searched from
    one that begins before; returns that."""
    k = _forward(t, at, k)
    w = _cubic(t, k, at)
    bend = e0 = e1 = 0.0
    if w.n > w.k:
        h = t[w.n] - t[w.k]
        z = w.since / h
        bend, e0, e1 = (6.0 - 12.0 * z) / (h * h), (6.0 * z - 4.0) / h, (6.0 * z - 2.0) / h
    for j in range(q.shape[1]):
        out[0, j], out[1, j] = _position(w, q, dq, j), _velocity(w, q, dq, j)
        out[2, j] = bend * (q[w.n, j] - q[w.k, j]) + e0 * dq[w.k, j] + e1 * dq[w.n, j]
    return k


@lean
def _interpolate(
    t: FloatArray,
    q: FloatArray,
    dq: FloatArray,
    at: FloatArray,
    state: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
) -> None:
    k = -1
    for i in range(at.size):
        k = interpolate_at(t, q, dq, at[i], k, state)
        for j in range(q.shape[1]):
            position[i, j], velocity[i, j] = state[0, j], state[1, j]
            acceleration[i, j] = state[2, j]


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
    """Accelerations are written where there is room for them."""
    now = then = -1
    rate = 1.0 / window
    for i in range(at.size):
        now, then = _forward(t, at[i], now), _forward(t, at[i] - window, then)
        a, b = _cubic(t, now, at[i]), _cubic(t, then, at[i] - window)
        for j in range(q.shape[1]):
            whole = area[a.k, j] - area[b.k, j] + _area(a, q, dq, j) - _area(b, q, dq, j)
            position[i, j] = q[0, j] + rate * whole
            velocity[i, j] = rate * (_position(a, q, dq, j) - _position(b, q, dq, j))
        if i < acceleration.shape[0]:
            for j in range(q.shape[1]):
                change = _velocity(a, q, dq, j) - _velocity(b, q, dq, j)
                acceleration[i, j] = rate * change


@lean
def _fill_means(
    rate: float,
    interval: FloatArray,
    since: float,
    rest: FloatArray,
    now: FloatArray,
    begin: FloatArray,
    end: FloatArray,
    now_slope: FloatArray,
    begin_slope: FloatArray,
    end_slope: FloatArray,
    area: FloatArray,
    begin_area: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
) -> None:
    """The window begins ``since`` after the beginning of an interval, whose ends are given;
    accelerations are written where there is room for them."""
    w = _cubic(interval, 0, since)
    for i in range(position.shape[0]):
        for j in range(position.shape[1]):
            first, way = begin[i, j], end[i, j] - begin[i, j]
            rise, fall = begin_slope[i, j], end_slope[i, j]
            passed = since * (first - rest[j]) + w.area * way + w.b0 * rise + w.b1 * fall
            position[i, j] = rest[j] + rate * (area[i, j] - begin_area[i, j] - passed)
            gone = w.rise * way + w.v0 * rise + w.v1 * fall
            velocity[i, j] = rate * (now[i, j] - first - gone)
            if i < acceleration.shape[0]:
                change = now_slope[i, j] - w.rate * way - w.d0 * rise - w.d1 * fall
                acceleration[i, j] = rate * change


@lean
def _fill_slopes(values: FloatArray, step: float, slopes: FloatArray, pivot: FloatArray) -> None:
    """Slopes (T, N) of the cubic spline through values a step apart, at rest at its ends.

    Its second derivative is continuous where m₋ + 4 m + m₊ = 3 (v₊ − v₋) / step.
    """
    last = values.shape[0] - 1
    for i in range(1, last):
        pivot[i] = 1.0 / (4.0 - pivot[i - 1])
        for j in range(values.shape[1]):
            rise = 3.0 * (values[i + 1, j] - values[i - 1, j]) / step
            slopes[i, j] = (rise - slopes[i - 1, j]) * pivot[i]
    for i in range(last - 1, 0, -1):
        for j in range(values.shape[1]):
            slopes[i, j] -= pivot[i] * slopes[i + 1, j]
