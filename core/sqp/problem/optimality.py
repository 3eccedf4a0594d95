"""Optimality: multipliers and residuals in the user's own scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from ..algebra.matrices import SparseMatrix
from . import violation

_ON_BOUND = 1e-8
_ROUNDING = 1e-14
Bounds = tuple[FloatArray, FloatArray, FloatArray, FloatArray]


@dataclass(slots=True)
class OptimalityResiduals:
    """How far a point is from a solution.

    Args:
        stationarity: largest of |∇f + Jᵀλ + ν|.
        complementarity: largest multiplier times distance from its bound, or multiplier of the
            wrong sign.
        violation: of constraints and bounds.
        relative: largest residual over the size of what it is the difference of, but at least
            over 1: |∇f + Jᵀλ + ν|ⱼ over |∇f|ⱼ + (|J|ᵀ|λ|)ⱼ of the same variable, and a product of
            multiplier and distance over the same multiplier.
        violation_is_rounding: whether no violation is more than rounding of what a constraint is
            the sum of, |c| + |J||x|.
        bound_multipliers: (n,) ν.
    """

    stationarity: float
    complementarity: float
    violation: float
    relative: float
    violation_is_rounding: bool
    bound_multipliers: FloatArray

    @property
    def kkt(self) -> float:
        """Largest residual but for the violation."""
        return max(self.stationarity, self.complementarity)

    def within(self, tolerance: float) -> bool:
        """Whether it is a solution."""
        return self.kkt <= tolerance and self.violation <= tolerance


def lagrangian_slope(g: FloatArray, J: SparseMatrix, multipliers: FloatArray) -> FloatArray:
    """∇f + Jᵀλ (n,)."""
    return g + J.transposed_times(multipliers) if len(multipliers) else g


def slope_terms(g: FloatArray, J: SparseMatrix, multipliers: FloatArray) -> FloatArray:
    """|∇f| + |J|ᵀ|λ| (n,): the size of what the Lagrangian's slope is the sum of."""
    size = np.abs(g)
    return size + J.absolute().transposed_times(np.abs(multipliers)) if len(multipliers) else size


def row_terms(x: FloatArray, c: FloatArray, J: SparseMatrix) -> FloatArray:
    """|c| + |J||x| (m,): about the size of what the constraints are sums of."""
    return np.abs(c) + J.absolute() @ np.abs(x) if len(c) else np.abs(c)


def residuals(
    x: FloatArray,
    c: FloatArray,
    slope: FloatArray,
    terms: FloatArray,
    row_terms: FloatArray,
    multipliers: FloatArray,
    bounds: Bounds,
) -> OptimalityResiduals:
    """Residuals at x, all in the user's scale; multipliers of bounds follow from stationarity.

    Args:
        x: (n,).
        c: (m,).
        slope: (n,) `lagrangian_slope`.
        terms: (n,) `slope_terms`.
        row_terms: (m,) `row_terms`.
        multipliers: (m,).
        bounds: x_lower, x_upper, c_lower, c_upper.
    """
    x_lower, x_upper, c_lower, c_upper = bounds
    nu = bound_multipliers(x, slope, x_lower, x_upper)
    left = np.abs(slope + nu)
    pressed_x = np.abs(nu) * np.where(nu == 0.0, 0.0, np.where(nu > 0, x_upper - x, x - x_lower))
    gap = np.where(multipliers > 0, np.abs(c_upper - c), np.abs(c - c_lower))
    # A distance beyond 1 counts as 1: a multiplier without a bound, or far from it, counts itself.
    pressed_c = np.abs(multipliers) * np.minimum(gap, 1.0)
    outside = np.maximum(np.maximum(c_lower - c, c - c_upper), 0.0)
    parts = ((left, terms), (pressed_x, np.abs(nu)), (pressed_c, np.abs(multipliers)))
    return OptimalityResiduals(
        _largest(left),
        max(_largest(pressed_x), _largest(pressed_c)),
        max(violation.largest(x, x_lower, x_upper), violation.largest(c, c_lower, c_upper)),
        max(_largest(part / np.maximum(1.0, size)) for part, size in parts),
        bool((outside <= _ROUNDING * row_terms).all()),
        nu,
    )


def at_bounds(x: FloatArray, lower: FloatArray, upper: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Which variables (n,) are at their lower, and which at their upper bounds.

    Near is what is small beside the variable and beside the distance of its bounds.
    """
    near = _ON_BOUND * np.minimum(np.maximum(1.0, np.abs(x)), upper - lower)
    return x - lower <= near, upper - x <= near


def bound_multipliers(
    x: FloatArray, slope: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """The multipliers of the bounds that leave least of the Lagrangian's slope.

    Args:
        slope: (n,) of the Lagrangian without bounds.
    """
    at_lower, at_upper = at_bounds(x, lower, upper)
    active = (at_lower & (slope > 0)) | (at_upper & (slope < 0))
    return np.where(active, -slope, 0.0)


def _largest(values: FloatArray) -> float:
    return float(values.max(initial=0.0))
