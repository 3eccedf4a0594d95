"""Multipliers to begin and to end with, and the steepest descent that they come from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ..algebra.linear import Saddle
from ..algebra.matrices import SparseMatrix, Sparsity
from ..problem.evaluation import Point
from ..problem.optimality import at_bounds, slope_terms
from ..problem.scaled import ScaledProblem
from ..qp.problem import QpSolution, QpStatus, QuadraticProgram
from ..qp.subproblems import Subproblems

_LARGEST = 1e3


def first_multipliers(point: Point, problem: ScaledProblem, identity: Sparsity) -> FloatArray:
    """Those (m,) of the equalities that leave least of the objective's slope, in least squares;
    zeros where they are so large that rows must depend on each other (Wächter and Biegler, section
    3.6).

    Args:
        point: with derivatives.
        identity: pattern (n, n).
    """
    m, n = point.J.shape
    rows = problem.c_lower == problem.c_upper
    if not rows.any():
        return np.zeros(m)
    at_lower, at_upper = at_bounds(point.x, problem.x_lower, problem.x_upper)
    P = SparseMatrix(identity, np.ones(n))
    held = at_lower | at_upper
    found = Saddle().solve(P, point.g, point.J, rows, np.zeros(m), held, np.zeros(n))
    if found is None or float(np.abs(found[1]).max()) > _LARGEST:
        return np.zeros(m)
    return found[1]


def steepest_descent(
    point: Point,
    problem: ScaledProblem,
    subproblems: Subproblems,
    identity: Sparsity,
    diagonal: FloatArray,
    limits: tuple[FloatArray, FloatArray] | None = None,
) -> QpSolution | None:
    """The step that minimises g·d + ½ Σ dⱼ² diagonalⱼ within the linearised constraints; None if
    that has no solution.

    Its multipliers have the right signs and leave least of the slope. Where constraints nearly
    depend on each other those of the last model may be far from them, at a point that is a
    solution.

    Args:
        point: with derivatives; its own violations are allowed.
        identity: pattern (n, n).
        diagonal: (n,) positive.
        limits: lower and upper limits (n,) of the step besides the bounds.
    """
    n = len(point.x)
    unit = 1.0 / np.sqrt(diagonal)
    lower, upper = problem.x_lower - point.x, problem.x_upper - point.x
    if limits is not None:
        lower, upper = np.maximum(lower, limits[0]), np.minimum(upper, limits[1])
    qp = QuadraticProgram(
        SparseMatrix(identity, np.ones(n)),
        point.g * unit,
        SparseMatrix(point.J.pattern, point.J.data * unit[point.J.pattern.columns]),
        np.minimum(problem.c_lower - point.c, 0.0),
        np.maximum(problem.c_upper - point.c, 0.0),
        np.minimum(lower, 0.0) / unit,
        np.maximum(upper, 0.0) / unit,
    )
    found = subproblems.solve(qp)
    if found.status is not QpStatus.SOLVED:
        return None
    return replace(found, d=found.d * unit, z=found.z / unit)


def own_curvature(point: Point, problem: ScaledProblem, multipliers: FloatArray) -> FloatArray:
    """A diagonal (n,) for `steepest_descent` that no unit of a variable changes: the size of what
    the Lagrangian's slope is the sum of, over the variable's size.

    Args:
        point: with derivatives.
        multipliers: (m,).
    """
    terms = slope_terms(point.g, point.J, multipliers)
    span = problem.x_upper - problem.x_lower
    size = np.where(point.x != 0.0, np.abs(point.x), np.where(np.isfinite(span), span, 1.0))
    largest = float(terms.max(initial=0.0))
    least = np.finfo(float).eps * (largest if largest > 0 else 1.0)
    return np.maximum(terms, least) / np.where(size > 0, size, 1.0)
