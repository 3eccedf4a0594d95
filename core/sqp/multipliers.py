"""Multipliers to begin and to end with."""

from __future__ import annotations

import numpy as np

from .evaluation import Point
from .linear import Saddle
from .matrices import SparseMatrix, identity
from .nlp import FloatArray
from .qp.problem import QpStatus, QuadraticProgram
from .qp.subproblems import Subproblems
from .scaled import ScaledProblem

_LARGEST = 1e3


def first_multipliers(point: Point, problem: ScaledProblem) -> FloatArray:
    """Those (m,) of the equalities that leave least of the objective's slope, in least squares;
    zeros where they are so large that rows must depend on each other (Wächter and Biegler, section
    3.6).

    Args:
        point: with derivatives.
    """
    m, n = point.J.shape
    rows = problem.c_lower == problem.c_upper
    if not rows.any():
        return np.zeros(m)
    x = point.x
    held = (x <= problem.x_lower) | (x >= problem.x_upper)
    P = SparseMatrix(identity(n), np.ones(n))
    found = Saddle().solve(P, point.g, point.J, rows, np.zeros(m), held, np.zeros(n))
    if found is None or float(np.abs(found[1]).max()) > _LARGEST:
        return np.zeros(m)
    return found[1]


def last_multipliers(
    point: Point, problem: ScaledProblem, subproblems: Subproblems
) -> FloatArray | None:
    """Those (m,), with the right signs, that leave least of the slope: the multipliers of the
    steepest descent within the linearised constraints; None if that has no solution.

    Where constraints nearly depend on each other the ones of the last model may be far from them,
    at a point that is a solution.

    Args:
        point: with derivatives.
    """
    n = len(point.x)
    qp = QuadraticProgram(
        SparseMatrix(identity(n), np.ones(n)),
        point.g,
        point.J,
        np.minimum(problem.c_lower - point.c, 0.0),
        np.maximum(problem.c_upper - point.c, 0.0),
        np.minimum(problem.x_lower - point.x, 0.0),
        np.maximum(problem.x_upper - point.x, 0.0),
    )
    found = subproblems.solve(qp)
    return found.y if found.status is QpStatus.SOLVED else None
