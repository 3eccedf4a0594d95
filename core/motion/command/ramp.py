"""Accelerations along the path that rise and fall over a while.

Where a controller limits how fast accelerations change, they rise and fall over about the same
time T wherever limits are reached. That is a moving average of length T over the way λ that has
been covered along the path: λ̈ is then what it was on average over the last T seconds, at most as
great as before. It leaves the path alone, unlike a moving average over the joints (`smoothing`).
λ is the TCP's way, with a turn of the tool counted as `_TURNING` and one of the joints as
`_SWAYING`, so that it grows wherever anything moves. (An average of ℓ would pass limits of speed
where ℓ runs unevenly.)

Between samples dλ/dℓ is linear in ℓ and ℓ a parabola in time, so that λ is a quartic in time: its
integral is known, and with it the average, its rate and the place on the path, all without steps in
time. Only while time comes up to speed (`start_ramp`) λ is of a higher degree, and the integral,
by three of its values (Gauss), as good as intervals are short.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.lean import inner, lean
from ..path.between_states import joint_at
from ..path.tcp_samples import States
from ..timing.interval import Intervals
from ..timing.start_ramp import StartRamp, stamped_time

_TURNING, _SWAYING = 0.1, 0.01
"""m that a turn of the tool, and one of the joints, by one rad counts."""
_GAUSS = 0.5 * 0.6**0.5
"""Of an interval's length, the outer two of Gauss's three places from its middle."""


class _Way(NamedTuple):
    """What is covered in K intervals of a stamped path.

    Args:
        since, until: (K,) s, when each is entered and left, as driven.
        slope: (S,), dλ/dℓ at the samples.
        speed: (K,), dℓ/dt where each is entered.
        change: (K,), half of d²ℓ/dt².
        bend: (K,), half of d²λ/dℓ².
        covered: (K + 1,) m, λ where each is entered, from the first on.
        area: (K,) m s, its integral over time until then.
    """

    since: FloatArray
    until: FloatArray
    slope: FloatArray
    speed: FloatArray
    change: FloatArray
    bend: FloatArray
    covered: FloatArray
    area: FloatArray


def ramped(
    intervals: Intervals, states: States, start: StartRamp, window: float, t: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Where the stamped motion is on average over the last while, and how fast that changes.

    Args:
        intervals: of the path.
        states: (S,) samples with respect to ℓ.
        start: how time comes up to speed.
        window: s that are averaged over, above zero.
        t: (T,) s, increasing.

    Returns:
        Positions and velocities (T, N).
    """
    shape = len(t), states.q.shape[1]
    q, dq = np.empty(shape), np.empty(shape)
    # Only what these times look at, and one more to both sides: a program has many stretches.
    stamped = start.stamped(np.array([t[0] - window, t[-1]]))[0]
    first, last = np.searchsorted(intervals.begin, stamped, side="right")
    part = intervals.rows(max(int(first) - 2, 0), int(last) + 1)
    left = int(part.sample[0])
    part = part._replace(sample=part.sample - left)
    states = states.rows(left, left + int(part.sample[-1]) + 2)
    slope = way_slopes(states)
    enters, leaves = slope[part.sample], slope[part.sample + 1]
    covered = 0.5 * part.spacing * (enters + leaves)
    way = _Way(
        start.driven(part.begin),
        start.driven(part.end),
        slope,
        np.sqrt(part.x[:-1]),
        np.diff(part.x) / (4.0 * part.spacing),
        0.5 * (leaves - enters) / part.spacing,
        np.concatenate([[0.0], np.cumsum(covered)]),
        np.zeros(len(covered)),
    )
    _drive(part, way, start.begin, start.length, window, t, states, q, dq)
    return q, dq


def way_slopes(states: States) -> FloatArray:
    """(S,), dλ/dℓ at the samples of a path, whose derivatives are with respect to ℓ."""
    squares = np.sum(states.v[:, :3] ** 2, axis=1) + np.sum((_SWAYING * states.dq) ** 2, axis=1)
    return np.asarray(np.sqrt(squares + np.sum((_TURNING * states.v[:, 3:]) ** 2, axis=1)))


@inner
def _at(
    n: Intervals, way: _Way, starts: float, length: float, k: int, t: float
) -> tuple[float, float]:
    """λ and its integral at a time from interval k on; before the first nothing has happened."""
    covered, area = way.covered[k], way.area[k]
    since, until = way.since[k], way.until[k]
    if t <= since:
        return covered, area + covered * (t - since)
    stop, risen = min(t, until), starts + length
    own, integral = _covered(n, way, starts, length, k, stop)
    # Where time has come up to speed its rate has a kink.
    if stop <= risen:
        integral = _integral(n, way, starts, length, k, since, stop)
    elif since < risen:
        integral -= _covered(n, way, starts, length, k, risen)[1]
        integral += _integral(n, way, starts, length, k, since, risen)
    area += (stop - since) * covered + integral
    if t < until:
        return covered + own, area
    return way.covered[k + 1], area + (t - until) * way.covered[k + 1]


@inner
def _integral(
    n: Intervals, way: _Way, starts: float, length: float, k: int, first: float, last: float
) -> float:
    """Of λ covered in interval k, over times that come up to speed, by Gauss's three places."""
    middle, reach = 0.5 * (first + last), _GAUSS * (last - first)
    mean = 5.0 * _covered(n, way, starts, length, k, middle - reach)[0]
    mean += 8.0 * _covered(n, way, starts, length, k, middle)[0]
    mean += 5.0 * _covered(n, way, starts, length, k, middle + reach)[0]
    integral: float = (last - first) * mean / 18.0
    return integral


@inner
def _covered(
    n: Intervals, way: _Way, starts: float, length: float, k: int, t: float
) -> tuple[float, float]:
    """λ covered in interval k until a driven time, and its integral over stamped time."""
    since = stamped_time(t, starts, length) - n.begin[k]
    tau = min(max(since, 0.0), n.end[k] - n.begin[k])
    speed, change, bend = way.speed[k], way.change[k], way.bend[k]
    first = way.slope[n.sample[k]]
    # ℓ = τ (v + c τ), λ = s ℓ + b ℓ².
    way_on = tau * (speed + change * tau)
    square = speed * speed / 3.0 + tau * change * (0.5 * speed + 0.2 * change * tau)
    integral = first * (0.5 * speed + change * tau / 3.0) + bend * tau * square
    return way_on * (first + bend * way_on), tau * tau * integral


@inner
def _share(n: Intervals, way: _Way, k: int, place: float) -> tuple[float, float]:
    """The share of interval k behind which λ has a value, and dλ/dℓ there."""
    first, last = way.slope[n.sample[k]], way.slope[n.sample[k] + 1]
    rest = (place - way.covered[k]) / n.spacing[k]
    root = max(first * first + 2.0 * rest * (last - first), 0.0) ** 0.5
    if first + root <= 0.0:
        return 0.0, 0.0
    z = min(max(2.0 * rest / (first + root), 0.0), 1.0)
    return z, first + z * (last - first)


@lean
def _drive(
    n: Intervals,
    way: _Way,
    starts: float,
    length: float,
    window: float,
    t: FloatArray,
    states: States,
    q: FloatArray,
    dq: FloatArray,
) -> None:
    count = way.since.size
    for k in range(count - 1):
        way.area[k + 1] = _at(n, way, starts, length, k, way.since[k + 1])[1]
    now = then = place = 0
    for i in range(t.size):
        while now + 1 < count and way.since[now + 1] <= t[i]:
            now += 1
        while then + 1 < count and way.since[then + 1] <= t[i] - window:
            then += 1
        here, area = _at(n, way, starts, length, now, t[i])
        behind, area_behind = _at(n, way, starts, length, then, t[i] - window)
        mean = (area - area_behind) / window
        while place + 1 < count and way.covered[place + 1] <= mean:
            place += 1
        z, slope = _share(n, way, place, mean)
        rate = (here - behind) / (window * slope) if slope > 0.0 else 0.0
        for j in range(q.shape[1]):
            q[i, j], tangent, _ = joint_at(states, n.sample[place], j, n.spacing[place], z)
            dq[i, j] = tangent * rate
