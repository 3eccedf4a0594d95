"""How far smoothing in time takes the links off their path, place by place.

See `averaging`. What motors lead by is what elastic joints give way by, so that links are where
smoothing leaves them; servos that lag take their links with them (`motion.command.elasticity`), and
so does friction, which stays within one bound at every speed (`motion.command.servo`). The bounds
hold for all motions within the path's limits that rest no shorter than reckoned with, so at every
override that stays as it is where rests are always as long.

Where rests end by an in-position window (`motion.timing.rests`), slow motions rest less, and fast
ones without rests would deviate far. So motions are told apart by how much slower they are: an
override lowers limits of speed, or lets time run slower, or both. From `_SPEEDS` and `_TIME` on up
rests are those where both are as low; below, no rests are reckoned with, but speeds, or speeds and
accelerations, are low.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...motion.command.servo import drag_bound, friction_bound, time_to_rest
from ...motion.command.smoothing import Smoothing
from ...motion.emulator.controller import Controller
from ...motion.emulator.run import Run
from ...motion.model.point_masses import filled
from ...motion.model.servo import Servo
from ...motion.path.path import Path
from ...motion.timing.timing import Timing
from .averaging import Averages, Rates, near
from .earliest_times import EarliestTimes
from .speed_bounds import Allowed, greatest

_TOGETHER = 10_000
"""Intervals of a path that are looked at together."""
_ASIDE = 3.0
"""Reaches of the averages within which what is beside a stretch counts: the middle of a kernel may
be one half from its mean place, reaches another half, and its ramp's means as much again."""
_CELLS = 40
"""Cells within what averages reach."""
_STEP = 2e-3
"""s of a cell where there are no averages."""
_SPEEDS, _TIME = 0.1, 0.7
"""Shares of speeds and of the rate of time below which motions are slow."""
_COARSER = 3.0
"""How much longer cells are of motions that are slow."""


class DeviationBounds(NamedTuple):
    """How far joints may be from a path, in C stretches of it.

    The links are those of a place in the stretch and beside it a sum of ways, each times
    a factor of its own, and of what is left.

    Args:
        edge: (C + 1,), σ of the stretches' ends; the first and last reach beyond.
        ways: (C, W, N), rad or m.
        share: (C, W, 2), least (≤ 0) and greatest (≥ 0) factor of each way.
        rest: (C, N) rad or m, bounds of what is left.
        most: (C, N) rad or m, bounds of all.
    """

    edge: FloatArray
    ways: FloatArray
    share: FloatArray
    rest: FloatArray
    most: FloatArray

    @staticmethod
    def within(most: FloatArray) -> DeviationBounds:
        """The same bounds (N,) everywhere."""
        edge, most = np.array([-np.inf, np.inf]), most[None]
        return DeviationBounds(
            edge, np.zeros((1, 0, most.shape[1])), np.zeros((1, 0, 2)), most, most
        )


class BoundsByInterval(NamedTuple):
    """Deviations on M intervals of a path.

    Args:
        first, last: (M,), rows of the deviations that an interval is in.
        own: (M,), that of its middle.
        most: (M, N) rad or m, bounds.
    """

    first: IntArray
    last: IntArray
    own: IntArray
    most: FloatArray


def by_interval(
    deviations: DeviationBounds, begin: FloatArray, end: FloatArray
) -> BoundsByInterval:
    """Where intervals of σ from begin (M,) to end (M,) are."""
    top = len(deviations.edge) - 2
    first = np.clip(np.searchsorted(deviations.edge, begin, "left") - 1, 0, top)
    last = np.clip(np.searchsorted(deviations.edge, end, "right") - 1, first, top)
    own = np.clip(np.searchsorted(deviations.edge, 0.5 * (begin + end), "right") - 1, first, last)
    return BoundsByInterval(first, last, own, _greatest(deviations.most, first, last))


@njit(cache=True, error_model="numpy")
def _greatest(most: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    """(M, N), the greatest of rows (C, N) from first (M,) to last (M,)."""
    out = np.zeros((first.size, most.shape[1]))
    for m in range(first.size):
        for c in range(first[m], last[m] + 1):
            for j in range(most.shape[1]):
                out[m, j] = max(out[m, j], most[c, j])
    return out


class _Band(NamedTuple):
    """Motions on a path.

    Args:
        most: (K + 1,), greatest ℓ̇² at each of its samples.
        rests: (S,) s, how long they rest at stops on the way at least.
        coarser: how much longer cells may be.
    """

    most: FloatArray
    rests: FloatArray
    coarser: float = 1.0


@dataclass(frozen=True)
class Deviation:
    """How far the links of a run may be from its path, at every steady override.

    Told stretch by stretch: of a long path all of it would take much memory.
    """

    controller: Controller
    run: Run
    smoothing: Smoothing
    bands: tuple[_Band, ...]

    @classmethod
    def of(cls, controller: Controller, run: Run) -> Deviation:
        """Of a run."""
        smoothing = controller.smoothing(run.program, run.path)
        model = controller.model
        nowhere = not smoothing.widths and not any(model.elasticity.lag) and model.servo.still
        return cls(controller, run, smoothing, () if nowhere else _bands(controller, run))

    def over(self, first: int, last: int) -> tuple[DeviationBounds, ...]:
        """On the intervals from one to before another; a motion keeps to one from end to end."""
        if not self.bands:
            return (DeviationBounds.within(np.zeros(self.run.path.q.shape[1])),)
        return tuple(_within(self, band, first, last) for band in self.bands)


def deviation_bounds(controller: Controller, run: Run) -> tuple[DeviationBounds, ...]:
    """How far the links of a run may be from its path, on all of it."""
    return Deviation.of(controller, run).over(0, len(run.timing.along.spacing))


def parts_of(path: Path) -> Iterator[tuple[int, int]]:
    """Stretches of a path that are looked at together: first piece, and the one behind the last."""
    first_interval, first = path.pieces.first_interval, 0
    while first + 1 < len(first_interval):
        last = int(np.searchsorted(first_interval, first_interval[first] + _TOGETHER, "right")) - 1
        last = max(last, first + 1)
        yield first, last
        first = last


def _bands(controller: Controller, run: Run) -> tuple[_Band, ...]:
    """Bands in one of which a run is at any override."""
    most, rests = greatest(run.timing), run.timing.rests
    if not rests.length.any() or rests.in_position is None:
        return (_Band(most, rests.length),)
    slow = controller.stamp_slower(run.program, run.timing, _SPEEDS)
    least = np.minimum(slow.rests.where_time_runs(_TIME), rests.length)
    none = np.zeros_like(least)
    return (
        _Band(most, least),
        # Where time runs at a rate, ℓ̇² goes with its square.
        _Band(_TIME**2 * most, none, _COARSER),
        _Band(greatest(slow), none, _COARSER),
    )


def _within(known: Deviation, band: _Band, first: int, last: int) -> DeviationBounds:
    """How far the links of motions in a band may be from their path."""
    timing, smoothing = known.run.timing, known.smoothing
    model = known.controller.model
    lag = model.elasticity.lag
    size = timing.path.q.shape[1]
    reach = smoothing.window + timing.ramp
    step = band.coarser * (reach / _CELLS if reach > 0.0 else _STEP)
    servo = model.servo
    away = max(reach, step) + time_to_rest(servo)
    first, last = _with_what_counts(timing, band.most, first, last, _ASIDE * away)
    allowed = Allowed.of(timing, band.most, first, last)
    course = EarliestTimes.of(timing, allowed, band.rests, step, away)
    if timing.ramp > 0.0 and (course.way[:, 0] <= 0.0).any():
        # No bound is known: where what a ramp averages may stand still, it tells no place.
        return DeviationBounds.within(np.full(size, np.inf))
    averages = Averages(course, smoothing, timing.ramp)
    offsets = averages.offsets()
    ways, share, rest = offsets.axis[:, None], offsets.along[:, None], offsets.aside
    if any(lag) or any(servo.drag):
        rates, late = averages.rates(), filled(lag, size)
        rest += _drag(servo, course, rates)
        speed = np.stack([np.zeros_like(rates.speed), rates.speed], -1)
        ways = np.concatenate([ways, (late * course.tangent)[:, None]], axis=1)
        share = np.concatenate([share, speed[:, None]], axis=1)
        late_ones = late != 0.0
        rest[:, late_ones] += np.abs(late[late_ones]) * rates.veer[:, late_ones]
    rest += friction_bound(servo, size)
    most = rest + np.einsum("cwn,cw->cn", np.abs(ways), np.abs(share).max(axis=2))
    # What is not known is not small.
    unknown = ~np.isfinite(most).all(axis=1)
    ways[unknown], share[unknown], rest[unknown], most[unknown] = 0.0, 0.0, np.inf, np.inf
    moves = course.moves
    edge = np.append(course.sigma[:-1][moves], course.sigma[-1])
    return DeviationBounds(edge, ways[moves], share[moves], rest[moves], most[moves])


def _drag(servo: Servo, course: EarliestTimes, rates: Rates) -> FloatArray:
    """(C, N), bounds of what drag sets joints off by: that of the greatest velocity of a while."""
    found = np.zeros_like(rates.veer)
    if not any(servo.drag):
        return found
    for j in range(found.shape[1]):
        fastest = np.abs(course.tangent[:, j]) * rates.speed + rates.veer[:, j]
        found[:, j] = near(course, fastest, servo.drag_delay)
    return drag_bound(servo, found)


def _with_what_counts(
    timing: Timing, most: FloatArray, first: int, last: int, away: float
) -> tuple[int, int]:
    """The same intervals with those that the fastest motion passes within ``away`` s of them."""
    speed = np.sqrt(most)
    theta = np.cumsum(2.0 * timing.along.spacing / (speed[:-1] + speed[1:]))
    begin = 0.0 if first == 0 else theta[first - 1]
    before = int(np.searchsorted(theta, begin - away))
    behind = int(np.searchsorted(theta, theta[last - 1] + away)) + 1
    return min(before, first), max(min(behind, len(theta)), last)
