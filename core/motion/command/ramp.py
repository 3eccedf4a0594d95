"""Accelerations along the path that rise and fall over a while.

Where a controller limits how fast accelerations change, they rise and fall over about the same
time T wherever limits are reached. That is a moving average of length T over the way λ that has
been covered along the path: λ̈ is then what it was on average over the last T seconds, at most as
great as before. It leaves the path alone, unlike a moving average over the joints (`smoothing`).
λ is the TCP's way, with a turn of the tool counted as `_TURNING` and one of the joints as
`_SWAYING`, so that it grows wherever anything moves. (An average of ℓ would pass limits of speed
where ℓ runs unevenly.)

Between samples dλ/dℓ is linear in ℓ and ℓ a parabola in time, so that λ is a quartic in time: its
integral over any part of an interval follows from three of its values (Gauss), and with it the
average, its two derivatives and the place on the path, all without steps in time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from ..path.tcp_samples import States
from ..timing.interval import joint_at, progress
from ..timing.start_ramp import stamped_time
from ..timing.timing import Timing
from .smoothing import STEP, JointMotion

_TURNING, _SWAYING = 0.1, 0.01
"""m that a turn of the tool, and one of the joints, by one rad counts."""
_GAUSS = 0.5 * 0.6**0.5
"""Of an interval's length, the outer two of Gauss's three places from its middle."""


class _Intervals(NamedTuple):
    """K intervals of a stamped path.

    Args:
        since, until: (K,) s, when each is entered and left, as driven.
        begin, end: (K,) s, the same as stamped.
        sample: (K,), the sample at the left of each.
        spacing: (K,), ℓ of each.
        x: (K + 1,), (dℓ/dt)².
        slope: (S,), dλ/dℓ at the samples.
        way: (K + 1,) m, λ where each is entered, from the first on.
        area: (K,) m s, its integral over time until then.
    """

    since: FloatArray
    until: FloatArray
    begin: FloatArray
    end: FloatArray
    sample: IntArray
    spacing: FloatArray
    x: FloatArray
    slope: FloatArray
    way: FloatArray
    area: FloatArray


def ramped(timing: Timing, t: FloatArray) -> JointMotion:
    """The motion that is at a time where the stamped one is on average over the last T seconds.

    Args:
        timing: of the path.
        t: (S,) s, even; the knots.
    """
    shape = len(t), timing.path.q.shape[1]
    q, dq = np.empty(shape), np.empty(shape)
    since = timing.start.driven(timing.begin)
    first = max(int(np.searchsorted(since, t[0] - timing.ramp, side="right")) - 1, 0)
    part = slice(first, max(int(np.searchsorted(since, t[-1], side="right")), first + 1))
    sample, spacing = timing.path.pieces.interval_samples[part], timing.along.spacing[part]
    slope = way_slopes(timing.along.states)
    way = np.cumsum(0.5 * spacing * (slope[sample] + slope[sample + 1]))
    intervals = _Intervals(
        since[part],
        timing.start.driven(timing.end[part]),
        timing.begin[part],
        timing.end[part],
        sample,
        spacing,
        timing.stamp.x[part.start : part.stop + 1],
        slope,
        np.concatenate([[0.0], way]),
        np.zeros(len(spacing)),
    )
    _drive(
        intervals,
        timing.start.begin,
        timing.start.length,
        timing.ramp,
        t,
        timing.along.states,
        q,
        dq,
    )
    return JointMotion(t, q, dq, STEP)


def way_slopes(states: States) -> FloatArray:
    """(S,), dλ/dℓ at the samples of a path, whose derivatives are with respect to ℓ."""
    squares = np.sum(states.v[:, :3] ** 2, axis=1) + np.sum((_SWAYING * states.dq) ** 2, axis=1)
    return np.asarray(np.sqrt(squares + np.sum((_TURNING * states.v[:, 3:]) ** 2, axis=1)))


@lean
def _at(n: _Intervals, starts: float, length: float, k: int, t: float) -> tuple[float, float]:
    """λ and its integral at a time from interval k on; before the first nothing has happened."""
    way, area = n.way[k], n.area[k]
    if t <= n.since[k]:
        return way, area + way * (t - n.since[k])
    since, until = n.since[k], min(t, n.until[k])
    # Where time has come up to speed its rate has a kink.
    kink = min(max(starts + length, since), until)
    area += (until - since) * way
    area += _integral(n, starts, length, k, since, kink)
    area += _integral(n, starts, length, k, kink, until)
    if t < n.until[k]:
        return way + _covered(n, starts, length, k, t), area
    return n.way[k + 1], area + (t - until) * n.way[k + 1]


@lean
def _integral(
    n: _Intervals, starts: float, length: float, k: int, first: float, last: float
) -> float:
    """Of λ covered in interval k, over driven times, by Gauss's three places."""
    if last <= first:
        return 0.0
    middle, reach = 0.5 * (first + last), _GAUSS * (last - first)
    mean = 5.0 * _covered(n, starts, length, k, middle - reach)
    mean += 8.0 * _covered(n, starts, length, k, middle)
    mean += 5.0 * _covered(n, starts, length, k, middle + reach)
    integral: float = (last - first) * mean / 18.0
    return integral


@lean
def _covered(n: _Intervals, starts: float, length: float, k: int, t: float) -> float:
    """λ covered in interval k until a driven time."""
    stamped = stamped_time(t, starts, length)
    z, _ = progress(n.begin[k], n.end[k], n.spacing[k], n.x[k], n.x[k + 1], stamped)
    first, last = n.slope[n.sample[k]], n.slope[n.sample[k] + 1]
    covered: float = n.spacing[k] * z * (first + 0.5 * z * (last - first))
    return covered


@lean
def _share(n: _Intervals, k: int, way: float) -> tuple[float, float]:
    """The share of interval k behind which λ has a value, and dλ/dℓ there."""
    first, last = n.slope[n.sample[k]], n.slope[n.sample[k] + 1]
    rest = (way - n.way[k]) / n.spacing[k]
    root = max(first * first + 2.0 * rest * (last - first), 0.0) ** 0.5
    if first + root <= 0.0:
        return 0.0, 0.0
    z = min(max(2.0 * rest / (first + root), 0.0), 1.0)
    return z, first + z * (last - first)


@njit(cache=True, error_model="numpy")
def _drive(
    n: _Intervals,
    starts: float,
    length: float,
    window: float,
    t: FloatArray,
    states: States,
    q: FloatArray,
    dq: FloatArray,
) -> None:
    count = n.since.size
    for k in range(count - 1):
        n.area[k + 1] = _at(n, starts, length, k, n.since[k + 1])[1]
    now = then = place = 0
    for i in range(t.size):
        while now + 1 < count and n.since[now + 1] <= t[i]:
            now += 1
        while then + 1 < count and n.since[then + 1] <= t[i] - window:
            then += 1
        way, area = _at(n, starts, length, now, t[i])
        way_before, area_before = _at(n, starts, length, then, t[i] - window)
        mean = (area - area_before) / window
        while place + 1 < count and n.way[place + 1] <= mean:
            place += 1
        z, slope = _share(n, place, mean)
        rate = (way - way_before) / (window * slope) if slope > 0.0 else 0.0
        for j in range(q.shape[1]):
            q[i, j], tangent, _ = joint_at(states, n.sample[place], j, n.spacing[place], z)
            dq[i, j] = tangent * rate
