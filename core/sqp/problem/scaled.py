"""A problem in its own scale, and its measures in the user's."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from . import violation
from .evaluation import Evaluation, Point
from .nlp import NLP
from .optimality import OptimalityResiduals, residuals
from .patterns import Pattern


class ScaledProblem:
    """Values, bounds and measures of one solution.

    Args:
        nlp: the problem.
        jacobian, hessian: the patterns of its matrices.

    Attributes:
        evaluation: the callables.
        x_lower, x_upper: (n,).
        closed: whether every variable has two finite bounds.
        c_lower, c_upper: (m,), scaled.
    """

    def __init__(self, nlp: NLP, jacobian: Pattern, hessian: Pattern) -> None:
        self.nlp = nlp
        self.evaluation = Evaluation(nlp, jacobian, hessian)
        self._bounds = nlp.bounds
        self.x_lower, self.x_upper, self.c_lower, self.c_upper = self._bounds
        self.closed = bool(np.isfinite(self.x_lower).all() and np.isfinite(self.x_upper).all())

    def first_point(self, x0: FloatArray) -> Point:
        """The start within the bounds, with derivatives; it decides the scale.

        Raises:
            CallableError: a value there is not finite.
        """
        point = self.evaluation.point(np.clip(x0, self.x_lower, self.x_upper))
        self.evaluation.differentiate(point)
        self.evaluation.scale(point)
        factors = self.evaluation.constraint_factors
        self.c_lower, self.c_upper = self.c_lower * factors, self.c_upper * factors
        return point

    def theta(self, c: FloatArray) -> float:
        """Sum of the scaled violations."""
        return violation.total(c, self.c_lower, self.c_upper)

    def violation(self, point: Point) -> float:
        """Largest violation of a constraint, unscaled."""
        _, _, lower, upper = self._bounds
        return violation.largest(point.c / self.evaluation.constraint_factors, lower, upper)

    def objective(self, point: Point) -> float:
        """The objective, unscaled."""
        return point.f / self.evaluation.objective_factor

    def to_user(self, multipliers: FloatArray) -> FloatArray:
        """Multipliers (m,) of the unscaled problem."""
        evaluation = self.evaluation
        return multipliers * evaluation.constraint_factors / evaluation.objective_factor

    def from_user(self, multipliers: FloatArray) -> FloatArray:
        """Multipliers (m,) of the scaled problem; what is not finite becomes zero."""
        evaluation = self.evaluation
        found = multipliers / evaluation.constraint_factors * evaluation.objective_factor
        return np.where(np.isfinite(found), found, 0.0)

    def residuals(self, point: Point, multipliers: FloatArray) -> OptimalityResiduals:
        """How far a point is from a solution, unscaled; multipliers are the scaled ones."""
        factors = self.evaluation.objective_factor, self.evaluation.constraint_factors
        return residuals(point.x, point.c, point.g, point.J, multipliers, self._bounds, factors)

    def result_residuals(
        self, point: Point, multipliers: FloatArray
    ) -> tuple[float, OptimalityResiduals]:
        """Objective and residuals at a point, computed anew from the callables; multipliers (m,)
        are the unscaled ones."""
        f, c, g, J = self.evaluation.unscaled(point)
        ones = 1.0, np.ones(self.nlp.m)
        return f, residuals(point.x, c, g, J, multipliers, self._bounds, ones)
