"""The last digits of a solution, by the active set that an interior point shows.

With the active constraints known, what is left is one Newton step on the conditions of optimality:
the barrier's last iterations, each of which gains a digit or two, are not needed, and what comes of
it lies on its bounds.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..algebra.linear import Saddle, SaddlePatterns
from ..algebra.matrices import SparseMatrix
from ..best import Best
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from ..problem.hessians import HessianSource
from ..problem.scaled import ScaledProblem
from ..progress import Progress
from ..qp.active_set import WorkingSet, settled
from ..qp.problem import QuadraticProgram
from .iterate import Box, Iterate
from .newton import Place

_SYSTEMS = 4
_STEPS = 3
_LEAST_GAIN = 0.1
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
        progress: Progress,
        tolerance: float,
    ) -> None:
        self._problem = problem
        self._hessian = hessian
        self._saddle = Saddle(patterns)
        self._progress = progress
        self._tolerance = tolerance

    def of(self, place: Place, box: Box, H: SparseMatrix) -> Best | None:
        """The solution near a place; None where the active set that it shows leads to none.

        Args:
            H: (n, n) there.
        """
        guess, point, y = shown_by(place.at, box), place.point, place.at.y
        before = np.inf
        first = point.x
        for count in range(_STEPS):
            H = H if count == 0 else self._hessian.matrix(point, y)
            found = settled(self._program(point, H), guess, self._saddle, _SYSTEMS)
            if found is None:
                return None
            problem = self._problem
            x = np.clip(point.x + found.d, problem.x_lower, problem.x_upper)
            change = np.abs(x - first) / np.maximum(1.0, np.abs(first))
            if not float(change.max()) <= _NEAR:
                return None
            try:
                point = problem.evaluation.point(x)
                problem.evaluation.differentiate(point)
            except CallableError:
                return None
            y = found.y
            at = problem.residuals(point, y)
            if at.within(self._tolerance):
                return self._progress.as_best(point, y, at)
            left = max(at.kkt, at.violation)
            if not left <= _LEAST_GAIN * before:
                return None
            before = left
            guess = _sides_of(found.y, found.z, guess)
        return None

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


def shown_by(at: Iterate, box: Box) -> WorkingSet:
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
