"""Optimality: multipliers and residuals in the user's own scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .matrices import SparseMatrix
from .nlp import FloatArray

_ON_BOUND = 1e-7


@dataclass(slots=True)
class Residuals:
    """How far a point is from a solution.

    Args:
        stationarity: largest of |∇f + Jᵀλ + ν|.
        complementarity: largest multiplier times distance from its bound, or multiplier of the
            wrong sign.
        violation: of constraints and bounds.
        size: of the multipliers, at least 1: what residuals are measured against where they are
            large (Wächter and Biegler, equation 6).
        bound_multipliers: (n,) ν.
    """

    stationarity: float
    complementarity: float
    violation: float
    size: float
    bound_multipliers: FloatArray

    @property
    def kkt(self) -> float:
        """Largest residual but for the violation."""
        return max(self.stationarity, self.complementarity)


def residuals(
    x: FloatArray,
    c: FloatArray,
    g: FloatArray,
    J: SparseMatrix,
    multipliers: FloatArray,
    bounds: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
) -> Residuals:
    """Residuals at x with multipliers (m,); those of the bounds follow from stationarity."""
    x_lower, x_upper, c_lower, c_upper = bounds
    slope = g + J.transposed_times(multipliers) if len(multipliers) else g
    nu = bound_multipliers(x, slope, x_lower, x_upper)
    left = np.abs(slope + nu)
    stationarity = float(left.max(initial=0.0))
    bound_gap = np.where(nu > 0, x_upper - x, x - x_lower)
    complementarity = float((np.abs(nu) * np.where(nu == 0, 0.0, bound_gap)).max(initial=0.0))
    violation = _excess(x, x_lower, x_upper)
    if len(multipliers):
        gap = np.where(multipliers > 0, np.abs(c_upper - c), np.abs(c - c_lower))
        gap = np.minimum(gap, 1.0)  # a multiplier without a bound counts itself
        pressed = float((np.abs(multipliers) * gap).max(initial=0.0))
        complementarity = max(complementarity, pressed)
        violation = max(violation, _excess(c, c_lower, c_upper))
    total = float(np.abs(multipliers).sum() + np.abs(nu).sum())
    size = max(1.0, total / (len(multipliers) + len(nu)) / 100.0)
    return Residuals(stationarity, complementarity, violation, size, nu)


def bound_multipliers(
    x: FloatArray, slope: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """The multipliers of the bounds that leave least of the Lagrangian's slope.

    Args:
        slope: (n,) of the Lagrangian without bounds.
    """
    near = _ON_BOUND * np.maximum(1.0, np.abs(x))
    at_lower, at_upper = x - lower <= near, upper - x <= near
    pushes_down, pushes_up = slope > 0, slope < 0
    active = (at_lower & pushes_down) | (at_upper & pushes_up)
    return np.where(active, -slope, 0.0)


def _excess(value: FloatArray, lower: FloatArray, upper: FloatArray) -> float:
    return float(np.maximum(lower - value, value - upper).max(initial=0.0))
