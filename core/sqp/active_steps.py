"""Newton's steps to a solution whose active constraints are nearly known.

With them known, what is left of the conditions of optimality is a system of equations, and a step
on it one factorisation. An interior point ends with such steps, and a warm start begins with them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import FloatArray
from .algebra.linear import Saddle
from .algebra.matrices import SparseMatrix
from .best import Best
from .given import Given
from .problem.errors import CallableError
from .problem.evaluation import Point
from .problem.optimality import OptimalityResiduals
from .qp.active_set import WorkingSet, settled, shown_by
from .qp.problem import QuadraticProgram

_REGULARISATION = 1e-8
_SYSTEMS = 3
_STEPS = 3
_LEAST_GAIN = 0.1
"""By which residuals have to fall from the second step on, by default."""
_NEAR = 5e-2
"""Largest change of a variable, in its size, that counts as a last digit."""


Judge = Callable[[Point, FloatArray], OptimalityResiduals | None]
"""Point with derivatives, multipliers (m,) → residuals there; None to go no further."""


class ActiveSteps:
    """Steps to solutions.

    Args:
        given: of the solution.
        steps: at most.
        reach: largest change of a variable, in its size.
        systems: how often a step's active set may change.
        gain: share of the residuals that a step may leave, from the second on.
    """

    def __init__(
        self,
        given: Given,
        steps: int = _STEPS,
        reach: float = _NEAR,
        systems: int = _SYSTEMS,
        gain: float = _LEAST_GAIN,
    ) -> None:
        self._problem = given.problem
        self._hessian = given.hessian
        self._saddle = Saddle(given.workspace.saddles, _REGULARISATION)
        self._progress = given.progress
        self._tolerance = given.options.tolerance
        self._steps, self._reach, self._systems = steps, reach, systems
        self._gain = gain

    @property
    def convex(self) -> bool:
        """Whether the Lagrangian curves upwards along what was active in the last step."""
        return self._saddle.convex

    def solution(
        self,
        point: Point,
        y: FloatArray,
        guess: WorkingSet,
        H: SparseMatrix | None = None,
        judged: Judge | None = None,
    ) -> Best | None:
        """The solution near a point; None where the active set leads to none.

        Args:
            point: with derivatives.
            y: (m,) multipliers.
            guess: the active set.
            H: (n, n) of the Lagrangian there; None where it is not known yet.
            judged: residuals after a step; None for those of the problem.
        """
        first, before = point.x, np.inf
        judged = judged or self._problem.residuals
        for _ in range(self._steps):
            H = self._hessian.matrix(point, y) if H is None else H
            program = self._program(point, H)
            found = settled(program, guess, self._saddle, self._systems)
            if found is None:
                return None
            y, H = found.y, None
            moved = self.near(first, point.x + found.d)
            if moved is None:
                return None
            point = moved
            at = judged(point, y)
            if at is None:
                return None
            if at.within(self._tolerance):
                return self._progress.as_best(point, y, at)
            left = max(at.kkt, at.violation)
            if not left <= self._gain * before:
                return None
            before = left
            guess = shown_by(program, found.d, found.y, found.z)
        return None

    def near(self, origin: FloatArray, x: FloatArray) -> Point | None:
        """The point, with derivatives, at x (n,) within the bounds; None where that is too far from
        the origin (n,), or nothing has a value."""
        problem = self._problem
        x = np.minimum(np.maximum(x, problem.x_lower), problem.x_upper)
        change = np.abs(x - origin) / np.maximum(1.0, np.abs(origin))
        if not float(change.max()) <= self._reach:
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
