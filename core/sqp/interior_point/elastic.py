"""Restoration's problem: the least violation near a point, by the same method.

    minimise  ρ Σ (p + q) + ζ/2 |D (x − x₀)|²   subject to  c_lower ≤ c(x) − p + q ≤ c_upper,
                                                            p, q ≥ 0, and the bounds on x

(Wächter and Biegler, section 3.3.)
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix, Sparsity
from ..problem.evaluation import Point
from .functions import ConstraintHessian, Functions

_PRICE = 1000.0
_LEAST = 1e-8


class ElasticFunctions:
    """See above.

    Args:
        functions: of the problem.
        curvature: of its constraints.
        origin: x₀, with derivatives.
        weight: ζ.
    """

    def __init__(
        self, functions: Functions, curvature: ConstraintHessian, origin: Point, weight: float
    ) -> None:
        n, m = len(origin.x), len(origin.c)
        self._n = n
        self._functions = functions
        self._curvature = curvature
        self._origin = origin.x
        self._weights = weight / np.maximum(1.0, np.abs(origin.x)) ** 2
        self.x_lower = np.concatenate([functions.x_lower, np.zeros(2 * m)])
        self.x_upper = np.concatenate([functions.x_upper, np.full(2 * m, np.inf)])
        self.c_lower, self.c_upper = functions.c_lower, functions.c_upper
        self._known_H: Sparsity | None = None
        self._known_J: Sparsity | None = None

    def begin(self, origin: Point, slacks: FloatArray, mu: float) -> Point:
        """The start: p and q (m,) that are best for μ and x₀, with derivatives."""
        rest = origin.c - slacks
        half = (mu - _PRICE * rest) / (2.0 * _PRICE)
        q = np.maximum(half + np.sqrt(half**2 + mu * rest / (2.0 * _PRICE)), _LEAST)
        p = np.maximum(rest + q, _LEAST)
        point = self.point(np.concatenate([origin.x, p, q]))
        self.differentiate(point)
        return point

    def inner(self, point: Point) -> FloatArray:
        """x (n,) of a point."""
        return point.x[: self._n].copy()

    def point(self, x: FloatArray) -> Point:
        n = self._n
        inner = self._functions.point(x[:n].copy())
        p, q = np.split(x[n:], 2)
        moved = x[:n] - self._origin
        f = _PRICE * float((p + q).sum()) + 0.5 * float(self._weights @ moved**2)
        return Point(x, f, inner.c - p + q)

    def differentiate(self, point: Point) -> None:
        n, m = self._n, len(point.c)
        p, q = np.split(point.x[n:], 2)
        inner = Point(point.x[:n].copy(), 0.0, point.c + p - q)
        self._functions.differentiate(inner)
        J = inner.J
        if self._known_J is not J.pattern:
            self._known_J = J.pattern
            rows = np.concatenate([J.pattern.rows, np.arange(m), np.arange(m)])
            starts = np.concatenate([J.pattern.starts, J.pattern.size + 1 + np.arange(2 * m)])
            self._J = Sparsity((m, n + 2 * m), rows, starts)
        ones = np.ones(m)
        point.J = SparseMatrix(self._J, np.concatenate([J.data, -ones, ones]))
        slope = self._weights * (point.x[:n] - self._origin)
        point.g = np.concatenate([slope, np.full(2 * m, _PRICE)])

    def hessian(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        n, m = self._n, len(multipliers)
        H = self._curvature(point.x[:n], multipliers)
        if self._known_H is not H.pattern:
            self._known_H = H.pattern
            keys = np.concatenate([H.pattern.columns * n + H.pattern.rows, np.arange(n) * (n + 1)])
            places, at = np.unique(keys, return_inverse=True)
            self._at = at
            starts = np.searchsorted(places // n, np.arange(n + 1))
            ends = np.full(2 * m, len(places))
            size = n + 2 * m
            self._H = Sparsity((size, size), places % n, np.concatenate([starts, ends]))
        values = np.concatenate([H.data, self._weights])
        total = np.bincount(self._at, values, minlength=self._H.size)
        return SparseMatrix(self._H, np.asarray(total, np.float64))
