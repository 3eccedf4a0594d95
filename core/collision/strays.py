"""How far smoothing in time and elastic joints take a motion off its path, place by place.

See `motion.averaging` for the first and `motion.lead_bound` for the second. The bounds hold for all
motions within the path's limits that rest no shorter than reckoned with, so at every override that
stays as it is where rests are always as long.

Where rests end by an in-position window (`motion.rests`), slow motions rest less, and fast ones
without rests would stray far. So motions are told apart by how much slower they are: an override
lowers limits of speed, or lets time run slower, or both. From `_SPEEDS` and `_TIME` on up rests are
those where both are as low; below, no rests are reckoned with, but speeds, or speeds and
accelerations, are low.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..motion.allowed import Allowed
from ..motion.averaging import Averages
from ..motion.controller import Controller, Run
from ..motion.course import Course
from ..motion.elasticity import RIGID
from ..motion.lead_bound import most_leads
from ..motion.smoothing import Smoothing
from ..motion.timing import Timing

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_CELLS = 40
"""Cells within what averages reach."""
_STEP = 2e-3
"""s of a cell where there are no averages."""
_SPEEDS, _TIME = 0.1, 0.7
"""Shares of speeds and of the rate of time below which motions are slow."""
_COARSER = 3.0
"""How much longer cells are of motions that are slow."""
_FEWEST = 2
"""Averages after a ramp that bound the joints' accelerations."""


class Strays(NamedTuple):
    """How far joints may be from a path, in C stretches of it.

    The commanded joints are those of a place in the stretch and beside it a sum of ways, each times
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
    def within(most: FloatArray) -> Strays:
        """The same bounds (N,) everywhere."""
        edge, most = np.array([-np.inf, np.inf]), most[None]
        return Strays(edge, np.zeros((1, 0, most.shape[1])), np.zeros((1, 0, 2)), most, most)


class Stretches(NamedTuple):
    """Strays on M intervals of a path.

    Args:
        first, last: (M,), rows of the strays that an interval is in.
        own: (M,), that of its middle.
        most: (M, N) rad or m, bounds.
    """

    first: IntArray
    last: IntArray
    own: IntArray
    most: FloatArray


def stretches(strays: Strays, begin: FloatArray, end: FloatArray) -> Stretches:
    """Where intervals of σ from begin (M,) to end (M,) are."""
    top = len(strays.edge) - 2
    first = np.clip(np.searchsorted(strays.edge, begin, "left") - 1, 0, top)
    last = np.clip(np.searchsorted(strays.edge, end, "right") - 1, first, top)
    own = np.clip(np.searchsorted(strays.edge, 0.5 * (begin + end), "right") - 1, first, last)
    return Stretches(first, last, own, _greatest(strays.most, first, last))


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
        timing: of the path.
        allowed: what they keep to.
        rests: (S,) s, how long they rest at stops on the way at least.
        coarser: how much longer cells may be.
    """

    timing: Timing
    allowed: Allowed
    rests: FloatArray
    coarser: float = 1.0


def strays_of(controller: Controller, run: Run) -> tuple[Strays, ...]:
    """How far the commanded joints of a run may be from its path, at every steady override.

    A motion keeps to one of them from beginning to end.
    """
    smoothing = controller.smoothing(run.program, run.path)
    if not smoothing.widths and controller.model.elasticity == RIGID:
        return (Strays.within(np.zeros(run.path.q.shape[1])),)
    return tuple(_within(controller, smoothing, band) for band in _bands(controller, run))


def _bands(controller: Controller, run: Run) -> list[_Band]:
    """Bands in one of which a run is at any override."""
    timing, allowed, rests = run.timing, Allowed.of(run.timing), run.timing.rests
    if not rests.length.any() or rests.in_position is None:
        return [_Band(timing, allowed, rests.length)]
    slow = controller.stamp_slower(run.program, timing, _SPEEDS)
    least = np.minimum(slow.rests.where_time_runs(_TIME), rests.length)
    none = np.zeros_like(least)
    return [
        _Band(timing, allowed, least),
        _Band(timing, allowed.where_time_runs(_TIME), none, _COARSER),
        _Band(slow, Allowed.of(slow), none, _COARSER),
    ]


def _within(controller: Controller, smoothing: Smoothing, band: _Band) -> Strays:
    """How far the commanded joints of motions in a band may be from their path."""
    timing, allowed, elasticity = band.timing, band.allowed, controller.model.elasticity
    size = timing.path.q.shape[1]
    reach = smoothing.window + timing.ramp
    step = band.coarser * (reach / _CELLS if reach > 0.0 else _STEP)
    course = Course.of(timing, allowed, band.rests, step, max(reach, step))
    few = elasticity != RIGID and len(smoothing.widths) < _FEWEST
    if timing.ramp > 0.0 and (few or (course.way[:, 0] <= 0.0).any()):
        # No bound is known: where what a ramp averages may stand still, it tells no place.
        return Strays.within(np.full(size, np.inf))
    averages = Averages(course, smoothing, timing.ramp)
    offsets = averages.offsets()
    ways, share, rest = offsets.axis[:, None], offsets.along[:, None], offsets.aside
    if elasticity != RIGID:
        leads = most_leads(
            elasticity,
            controller.robot,
            allowed,
            course,
            averages,
            offsets,
            timing.start,
        )
        ways = np.concatenate([ways, leads.ways], axis=1)
        share = np.concatenate([share, leads.share], axis=1)
        rest = rest + leads.rest
    most = rest + np.einsum("cwn,cw->cn", np.abs(ways), np.abs(share).max(axis=2))
    # What cannot be told is not small.
    unknown = ~np.isfinite(most).all(axis=1)
    ways[unknown], share[unknown], rest[unknown], most[unknown] = 0.0, 0.0, np.inf, np.inf
    moves = course.moves
    edge = np.append(course.sigma[:-1][moves], course.sigma[-1])
    return Strays(edge, ways[moves], share[moves], rest[moves], most[moves])
