"""A problem in its own scale, and its measures in the user's."""

from __future__ import annotations

import numpy as np

from .elastic import violation
from .evaluation import Evaluation, Point
from .kkt import Residuals, residuals
from .nlp import NLP, FloatArray
from .patterns import Pattern


class ScaledProblem:
    """Values, bounds and measures of one solution.

    Args:
        nlp: the problem.
        jacobian, hessian: the patterns of its matrices.

    Attributes:
        evaluation: the callables.
        x_lower, x_upper: (n,).
        c_lower, c_upper: (m,), scaled.
    """

    def __init__(self, nlp: NLP, jacobian: Pattern, hessian: Pattern) -> None:
        self.nlp = nlp
        self.evaluation = Evaluation(nlp, jacobian, hessian)
        self.x_lower, self.x_upper, self.c_lower, self.c_upper = nlp.bounds

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
        return violation(c, self.c_lower, self.c_upper)

    def violation(self, point: Point) -> float:
        """Largest violation of a constraint, unscaled."""
        c = point.c / self.evaluation.constraint_factors
        _, _, lower, upper = self.nlp.bounds
        return float(np.maximum(lower - c, c - upper).max(initial=0.0))

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

    def residuals(self, point: Point, multipliers: FloatArray) -> Residuals:
        """How far a point is from a solution, unscaled; multipliers are the scaled ones."""
        factor, factors = self.evaluation.objective_factor, self.evaluation.constraint_factors
        bounds = (self.x_lower, self.x_upper, self.c_lower, self.c_upper)
        found = residuals(point.x, point.c, point.g, point.J, multipliers, bounds)
        found.stationarity /= factor
        found.complementarity /= factor
        found.violation = self.violation(point)
        found.bound_multipliers = found.bound_multipliers / factor
        if factor != 1.0 or (factors != 1.0).any():
            total = np.abs(multipliers * factors).sum() / factor
            total += np.abs(found.bound_multipliers).sum()
            found.size = max(1.0, float(total) / (len(multipliers) + self.nlp.n) / 100.0)
        return found
