"""The last digits of a solution, by the active set that an interior point shows.

The barrier's last iterations, each of which gains a digit or two, are not needed, and what comes of
it lies on its bounds.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ..active_steps import ActiveSteps
from ..algebra.matrices import LowRankSum, SparseMatrix
from ..best import Best
from ..given import Given
from ..qp.active_set import WorkingSet
from .iterate import InteriorIterate, InteriorLimits
from .newton import Place

_NO_MULTIPLIER = 1e-2
_LEAST_UNDECIDED, _SHARE_UNDECIDED, _DECIDED = 2, 0.02, 10.0
"""Limits whose multiplier and distance differ by less than a factor of ten, from which on an active
set is not worth trying."""


class LastDigits:
    """Steps to solutions."""

    def __init__(self, given: Given) -> None:
        self._problem = given.problem
        self._steps = ActiveSteps(given)
        self._progress = given.progress
        self._tolerance = given.options.tolerance

    def of(self, place: Place, box: InteriorLimits, H: SparseMatrix) -> Best | None:
        """The solution near a place; None where the active set that it shows leads to none.

        Args:
            H: (n, n) there.
        """
        if isinstance(H, LowRankSum):
            return None  # its steps are not Newton's
        if undecided(place.at, box) > _LEAST_UNDECIDED + _SHARE_UNDECIDED * len(box.held):
            return None
        return self._steps.solution(place.point, place.at.y, shown_by(place.at, box), H)

    def snapped(self, place: Place, box: InteriorLimits) -> Best | None:
        """The place with variables on bounds that are near; None if it is no solution."""
        n, at = len(place.point.x), place.at
        x = place.point.x
        with np.errstate(invalid="ignore"):
            x = np.where(at.low[:n] > x - box.lower[:n], box.lower[:n], x)
            x = np.where(at.high[:n] > box.upper[:n] - x, box.upper[:n], x)
        y = np.where(np.abs(at.y) > _NO_MULTIPLIER * self._tolerance, at.y, 0.0)
        point = self._steps.near(place.point.x, x)
        if point is None:
            return None
        found = self._problem.residuals(point, y)
        return self._progress.as_best(point, y, found) if found.within(self._tolerance) else None


@njit(cache=True, error_model="numpy")
def undecided(at: InteriorIterate, box: InteriorLimits) -> int:
    """How many limits may be active or not."""
    count = 0
    for k in range(len(at.v)):
        if box.held[k]:
            continue
        if np.isfinite(box.lower[k]):
            share = at.low[k] / (at.v[k] - box.lower[k])
            count += 1.0 / _DECIDED < share < _DECIDED
        if np.isfinite(box.upper[k]):
            share = at.high[k] / (box.upper[k] - at.v[k])
            count += 1.0 / _DECIDED < share < _DECIDED
    return count


def shown_by(at: InteriorIterate, box: InteriorLimits) -> WorkingSet:
    """The sides whose multiplier is larger than their distance."""
    m = len(at.y)
    n = len(at.v) - m
    above = box.held | (at.high > box.upper - at.v)
    below = ~above & (at.low > at.v - box.lower)
    sides = np.where(above, 1, np.where(below, -1, 0)).astype(np.int8)
    return WorkingSet(m, np.concatenate([sides[n:], sides[:n]]))
