"""The last digits of a solution, by the active set that an interior point shows.

With the active constraints known, what is left is one Newton step on the conditions of optimality:
the barrier's last iterations, each of which gains a digit or two, are not needed, and what comes of
it lies on its bounds.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ..algebra.linear import Saddle, SaddlePatterns
from ..algebra.matrices import SparseMatrix
from ..best import Best
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from ..problem.hessians import HessianSource
from ..problem.scaled import ScaledProblem
from ..progress import SolutionProgress
from ..qp.active_set import WorkingSet, settled
from ..qp.problem import QuadraticProgram
from .iterate import InteriorIterate, InteriorLimits
from .newton import Place

_REGULARISATION = 1e-8
_SYSTEMS = 3
_STEPS = 3
_LEAST_GAIN = 0.1
_NO_MULTIPLIER = 1e-2
_LEAST_UNDECIDED, _SHARE_UNDECIDED, _DECIDED = 2, 0.02, 10.0
"""Limits whose multiplier and distance differ by less than a factor of ten, from which on an active
set is not worth trying."""
_NEAR = 5e-2
"""Largest change of a variable, in its size, that counts as a last digit."""


class LastDigits:
    """Steps to solutions.

    Args:
        problem: the problem.
        hessian: of its Lagrangian.
        patterns: keeps symbolic factorisations.
        progress: judges.
        tolerance: of the residuals, unscaled.
    """

    def __init__(
        self,
        problem: ScaledProblem,
        hessian: HessianSource,
        patterns: SaddlePatterns,
        progress: SolutionProgress,
        tolerance: float,
    ) -> None:
        self._problem = problem
        self._hessian = hessian
        self._saddle = Saddle(patterns, _REGULARISATION)
        self._progress = progress
        self._tolerance = tolerance

    def of(self, place: Place, box: InteriorLimits, H: SparseMatrix) -> Best | None:
        """The solution near a place; None where the active set that it shows leads to none.

        Args:
            H: (n, n) there.
        """
        if undecided(place.at, box) > _LEAST_UNDECIDED + _SHARE_UNDECIDED * len(box.held):
            return None
        guess, point = shown_by(place.at, box), place.point
        first, before, y = point.x, np.inf, place.at.y
        for count in range(_STEPS):
            H = H if count == 0 else self._hessian.matrix(point, y)
            found = settled(self._program(point, H), guess, self._saddle, _SYSTEMS)
            if found is None:
                return None
            y = found.y
            moved = self._near(first, point.x + found.d)
            if moved is None:
                return None
            point = moved
            at = self._problem.residuals(point, y)
            if at.within(self._tolerance):
                return self._progress.as_best(point, y, at)
            left = max(at.kkt, at.violation)
            if not left <= _LEAST_GAIN * before:
                return None
            before = left
            guess = _sides_of(found.y, found.z, guess)
        return None

    def snapped(self, place: Place, box: InteriorLimits) -> Best | None:
        """The place with variables on bounds that are near; None if it is no solution."""
        n, at = len(place.point.x), place.at
        x = place.point.x
        with np.errstate(invalid="ignore"):
            x = np.where(at.low[:n] > x - box.lower[:n], box.lower[:n], x)
            x = np.where(at.high[:n] > box.upper[:n] - x, box.upper[:n], x)
        y = np.where(np.abs(at.y) > _NO_MULTIPLIER * self._tolerance, at.y, 0.0)
        point = self._near(place.point.x, x)
        if point is None:
            return None
        found = self._problem.residuals(point, y)
        return self._progress.as_best(point, y, found) if found.within(self._tolerance) else None

    def _near(self, origin: FloatArray, x: FloatArray) -> Point | None:
        """The point, with derivatives, at x (n,) within the bounds; None where that is too far from
        the origin (n,), or nothing has a value."""
        problem = self._problem
        x = np.clip(x, problem.x_lower, problem.x_upper)
        change = np.abs(x - origin) / np.maximum(1.0, np.abs(origin))
        if not float(change.max()) <= _NEAR:
            return None
        try:
            point = problem.evaluation.point(x)
            problem.evaluation.differentiate(point)
        except CallableError:
            return None
        return point

    def _program(self, point: Point, H: SparseMatrix) -> QuadraticProgram:
        problem = self._problem
        return QuadraticProgram(
            H,
            point.g,
            point.J,
            problem.c_lower - point.c,
            problem.c_upper - point.c,
            np.minimum(problem.x_lower - point.x, 0.0),
            np.maximum(problem.x_upper - point.x, 0.0),
        )


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


def _sides_of(y: FloatArray, z: FloatArray, guess: WorkingSet) -> WorkingSet:
    both = np.concatenate([y, z])
    sides = np.where(both > 0, 1, np.where(both < 0, -1, 0))
    kept = np.where((both == 0.0) & (guess.sides != 0), guess.sides, sides)
    return WorkingSet(guess.rows, kept.astype(np.int8))
