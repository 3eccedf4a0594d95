"""Optimality: multipliers and residuals in the user's own scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray, IntArray
from ..algebra.matrices import SparseMatrix

_ON_BOUND = 1e-8
_PRODUCT = 1e-8
"""Slope times distance from a bound up to which the bound's multiplier is the slope."""
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


def residuals(
    x: FloatArray,
    c: FloatArray,
    g: FloatArray,
    J: SparseMatrix,
    multipliers: FloatArray,
    bounds: Bounds,
    factors: tuple[float, FloatArray],
) -> OptimalityResiduals:
    """Residuals at x, all in the user's scale; multipliers of bounds follow from stationarity.

    Args:
        x: (n,).
        c: (m,) scaled, as are g (n,), J (m, n) and the multipliers (m,).
        bounds: x_lower, x_upper, c_lower, c_upper, unscaled.
        factors: of the objective and of the rows (m,): scaled over unscaled.
    """
    return OptimalityResiduals(
        *_measured(
            x, c, g, J.pattern.starts, J.pattern.rows, J.data, multipliers, *factors, *bounds
        )
    )


@njit(cache=True, error_model="numpy")
def bound_multipliers(
    x: FloatArray, slope: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """The multipliers of the bounds that leave least of the Lagrangian's slope: of bounds that x is
    on, or near to in proportion to the slope, as interior points end.

    Args:
        slope: (n,) of the Lagrangian without bounds.
    """
    found = np.zeros_like(x)
    for j in range(len(x)):
        near = _ON_BOUND * min(max(1.0, abs(x[j])), upper[j] - lower[j])
        near = max(near, min(_PRODUCT / max(abs(slope[j]), _PRODUCT), 1.0))
        gap = x[j] - lower[j] if slope[j] > 0.0 else upper[j] - x[j]
        if gap <= near and abs(slope[j]) > 0.0:
            found[j] = -slope[j]
    return found


@njit(cache=True, error_model="numpy")
def _measured(
    x: FloatArray,
    c: FloatArray,
    g: FloatArray,
    starts: IntArray,
    rows: IntArray,
    data: FloatArray,
    multipliers: FloatArray,
    factor: float,
    factors: FloatArray,
    x_lower: FloatArray,
    x_upper: FloatArray,
    c_lower: FloatArray,
    c_upper: FloatArray,
) -> tuple[float, float, float, float, bool, FloatArray]:
    """The measures of `OptimalityResiduals`, in their order."""
    stationarity, pressed, violation, relative, rounding = 0.0, 0.0, 0.0, 0.0, True
    slopes, terms, row_terms = np.empty_like(x), np.empty_like(x), np.zeros(len(c))
    for j in range(len(x)):
        total, size = g[j], abs(g[j])
        for k in range(starts[j], starts[j + 1]):
            i = rows[k]
            term = data[k] * multipliers[i]
            total += term
            size += abs(term)
            row_terms[i] += abs(data[k] * x[j])
        slopes[j], terms[j] = total / factor, size / factor
    nu = bound_multipliers(x, slopes, x_lower, x_upper)
    for j in range(len(x)):
        left = abs(slopes[j] + nu[j])
        stationarity = max(stationarity, left)
        relative = max(relative, left / max(1.0, terms[j]))
        violation = max(violation, x_lower[j] - x[j], x[j] - x_upper[j])
        if nu[j] != 0.0:
            gap = x_upper[j] - x[j] if nu[j] > 0.0 else x[j] - x_lower[j]
            pressed = max(pressed, abs(nu[j]) * gap)
            relative = max(relative, abs(nu[j]) * gap / max(1.0, abs(nu[j])))
    for i in range(len(c)):
        value, y = c[i] / factors[i], multipliers[i] * factors[i] / factor
        outside = max(c_lower[i] - value, value - c_upper[i], 0.0)
        violation = max(violation, outside)
        # The row is the sum of about |c| + |J||x|.
        rounding = rounding and outside <= _ROUNDING * (abs(value) + row_terms[i] / factors[i])
        gap = abs(c_upper[i] - value) if y > 0.0 else abs(value - c_lower[i])
        # A distance beyond 1 counts as 1: a multiplier without a bound, or far from it, counts
        # itself.
        product = abs(y) * min(gap, 1.0)
        pressed = max(pressed, product)
        relative = max(relative, product / max(1.0, abs(y)))
    return stationarity, pressed, violation, relative, rounding, nu


def at_bounds(x: FloatArray, lower: FloatArray, upper: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Which variables (n,) are at their lower, and which at their upper bounds.

    Near is what is small beside the variable and beside the distance of its bounds.
    """
    near = _ON_BOUND * np.minimum(np.maximum(1.0, np.abs(x)), upper - lower)
    return x - lower <= near, upper - x <= near
