"""What the interior point needs of a problem."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix
from ..problem.evaluation import Point
from ..problem.hessians import HessianSource
from ..problem.scaled import ScaledProblem

ConstraintHessian = Callable[[FloatArray, FloatArray], SparseMatrix]
"""x (n,), multipliers (m,) → Hessian of multipliers·c (n, n)."""


class Functions(Protocol):
    """Functions and limits, scaled.

    Attributes:
        x_lower, x_upper: (n,).
        c_lower, c_upper: (m,).
    """

    x_lower: FloatArray
    x_upper: FloatArray
    c_lower: FloatArray
    c_upper: FloatArray

    def point(self, x: FloatArray) -> Point:
        """Values at x (n,).

        Raises:
            CallableError: one is not finite.
        """
        ...

    def differentiate(self, point: Point) -> None:
        """Add the derivatives.

        Raises:
            CallableError: one is not finite.
        """
        ...

    def hessian(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        """Of the Lagrangian, or what stands for it (n, n), both triangles.

        Raises:
            CallableError: an entry is not finite.
        """
        ...


class UserFunctions:
    """Those of a problem.

    Args:
        problem: the problem, whose scale is chosen.
        hessian: of its Lagrangian.
    """

    def __init__(self, problem: ScaledProblem, hessian: HessianSource) -> None:
        self.x_lower, self.x_upper = problem.x_lower, problem.x_upper
        self.c_lower, self.c_upper = problem.c_lower, problem.c_upper
        self.point = problem.evaluation.point
        self.differentiate = problem.evaluation.differentiate
        self.hessian = hessian.matrix
