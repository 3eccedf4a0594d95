"""When a robot is at the places of its path, at the emulated timing.

What averages over time make of a motion has two places: the one that the stamp has at the middle
of the averages, and the mean of those that they look at. Bounds of deviations hold beside the one
or the other (`..deviation.averaging`); times here hold for both.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray, IntArray
from ...motion.command.ramp import way_slopes
from ...motion.command.smoothing import Smoothing
from ...motion.path.tcp_samples import States
from ...motion.timing.interval import Intervals, progress
from ...motion.timing.timing import Timing
from ...robot.kinematics.lean import lean

_STEP, _INSTANTS = 2.5e-4, 1_000_000
"""s between the instants that are looked at, and how many at most."""
_SAME = 1e-8
"""Share of a path's length below which places are the same."""


class PassingTimes:
    """Times between which places are passed, by even instants on both sides.

    Args:
        timing: of the path.
        smoothing: what averages the joints.
    """

    def __init__(self, timing: Timing, smoothing: Smoothing) -> None:
        duration = timing.duration + 2.0 * timing.lag
        step = max(_STEP, duration / _INSTANTS)
        self._t: FloatArray = step * np.arange(np.ceil(duration / step) + 2.0)
        middle = timing.place_at(self._t - timing.lag)
        mean = middle
        if timing.lag > 0.0:
            mean = _mean_place(timing, smoothing, self._t, step)
        same = _SAME * max(float(timing.path.sigma[-1]), 1.0)
        self._least = np.maximum.accumulate(np.minimum(middle, mean)) - same
        self._greatest = np.maximum.accumulate(np.maximum(middle, mean)) + same

    def over(self, begin: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
        """From when to when the motion is between two places at the most, (M,) s each.

        Args:
            begin, end: (M,), σ of the places.
        """
        reached = np.searchsorted(self._greatest, begin, "left")
        left = np.searchsorted(self._least, end, "right")
        t = np.concatenate([[-np.inf], self._t, [np.inf]])
        return t[reached], t[left + 1]


def _mean_place(timing: Timing, smoothing: Smoothing, t: FloatArray, step: float) -> FloatArray:
    """σ (T,) of the means of ℓ that the averages of the joints make."""
    intervals, states = timing.intervals, timing.along.states
    stamped = np.ascontiguousarray(timing.start.stamped(t)[0])
    row = np.clip(np.searchsorted(intervals.begin, stamped, side="right") - 1, 0, None)
    share = np.empty(len(t))
    _shares(stamped, row, intervals, share)
    if timing.ramp > 0.0:
        row, share = _ramped(intervals, states, row, share, step, timing.ramp)
    edges = np.concatenate([[0.0], np.cumsum(intervals.spacing)])
    place = edges[row] + share * intervals.spacing[row]
    for width in smoothing.widths:
        place = _averaged(place, step, width)
    row = np.clip(np.searchsorted(edges, place, "right") - 1, 0, len(intervals.spacing) - 1)
    share = np.clip((place - edges[row]) / intervals.spacing[row], 0.0, 1.0)
    return _sigma(timing, row, share)


def _ramped(
    intervals: Intervals,
    states: States,
    row: IntArray,
    share: FloatArray,
    step: float,
    ramp: float,
) -> tuple[IntArray, FloatArray]:
    """Interval and share (T,) where the mean of the way is over the last while."""
    slope = way_slopes(states)
    first, last = slope[intervals.sample], slope[intervals.sample + 1]
    edges = np.concatenate([[0.0], np.cumsum(0.5 * intervals.spacing * (first + last))])
    bend = 0.5 * (last - first)
    own = intervals.spacing[row] * share * (first[row] + share * bend[row])
    way = _averaged(edges[row] + own, step, ramp)
    row = np.clip(np.searchsorted(edges, way, "right") - 1, 0, len(first) - 1)
    rest = (way - edges[row]) / intervals.spacing[row]
    # The root of bend z² + first z = rest that is 0 where rest is.
    root = np.sqrt(np.maximum(first[row] ** 2 + 4.0 * bend[row] * rest, 0.0))
    under = first[row] + root
    share = np.divide(2.0 * rest, under, out=np.zeros_like(rest), where=under > 0.0)
    return row, np.clip(share, 0.0, 1.0)


def _averaged(value: FloatArray, step: float, width: float) -> FloatArray:
    """Means (T,) over the last ``width`` seconds of values that were zero before the first."""
    area = step * np.concatenate([[0.0], np.cumsum(0.5 * (value[1:] + value[:-1]))])
    back = np.arange(len(value)) - width / step
    k = np.clip(np.floor(back).astype(np.int64), 0, len(value) - 2)
    z = np.maximum(back - k, 0.0)
    before = area[k] + step * z * (value[k] + 0.5 * z * (value[k + 1] - value[k]))
    return np.asarray((area - before) / width)


def _sigma(timing: Timing, row: IntArray, share: FloatArray) -> FloatArray:
    """σ (T,) at shares of intervals, as `Timing.place_at` has it between samples."""
    sample, length = timing.intervals.sample[row], timing.intervals.spacing[row]
    sigma, rate = timing.path.sigma, timing.along.rate
    rise = sigma[sample + 1] - sigma[sample]
    lead, tail = length / rate[sample] - rise, rise - length / rate[sample + 1]
    z = share
    return np.asarray(sigma[sample] + z * (rise + (1 - z) * ((1 - z) * lead + z * tail)))


@lean
def _shares(t: FloatArray, row: IntArray, intervals: Intervals, share: FloatArray) -> None:
    for i in range(t.size):
        share[i] = progress(intervals, row[i], t[i])[0]
