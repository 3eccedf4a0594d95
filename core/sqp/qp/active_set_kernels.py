"""Compiled parts of `active_set`: the system of a working set, and what its solution shows.

Sides are numbered as in `active_set.WorkingSet`: rows first, then variables; 1 is the upper side or
an equality, -1 the lower side, 0 neither. Matrices come as starts, rows and data.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import BoolArray, FloatArray, IntArray

Sides = NDArray[np.int8]
Columns = tuple[IntArray, IntArray, FloatArray]
Bounds = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
"""lower (m,), upper (m,), d_lower (n,), d_upper (n,)"""


@njit(cache=True, error_model="numpy")
def expected(sides: Sides, bounds: Bounds) -> tuple[BoolArray, FloatArray, BoolArray, FloatArray]:
    """Active rows (m,) and their targets, fixed variables (n,) and their values."""
    lower, upper, d_lower, d_upper = bounds
    m, n = len(lower), len(d_lower)
    rows, target = np.empty(m, dtype=np.bool_), np.empty(m)
    fixed, values = np.empty(n, dtype=np.bool_), np.empty(n)
    for i in range(m):
        rows[i] = sides[i] != 0
        target[i] = upper[i] if sides[i] > 0 else lower[i]
    for j in range(n):
        fixed[j] = sides[m + j] != 0
        values[j] = d_upper[j] if sides[m + j] > 0 else d_lower[j]
    return rows, target, fixed, values


@njit(cache=True, error_model="numpy")
def bound_multipliers(
    P: Columns, q: FloatArray, A: Columns, d: FloatArray, y: FloatArray, sides: Sides
) -> FloatArray:
    """The multipliers (n,) of the variables that a working set fixes, from stationarity."""
    slope, z = _slope(P, q, A, d, y), np.zeros_like(q)
    for j in range(len(q)):
        if sides[len(y) + j] != 0:
            z[j] = -slope[j]
    return z


@njit(cache=True, error_model="numpy")
def shown(A: Columns, bounds: Bounds, d: FloatArray, y: FloatArray, z: FloatArray) -> Sides:
    """The sides (m + n,) whose multiplier is larger than their distance."""
    lower, upper, d_lower, d_upper = bounds
    m, n = len(y), len(d)
    at = _product(A, m, d)
    sides = np.zeros(m + n, dtype=np.int8)
    for i in range(m):
        sides[i] = _side(at[i], y[i], lower[i], upper[i])
    for j in range(n):
        sides[m + j] = _side(d[j], z[j], d_lower[j], d_upper[j])
    return sides


@njit(cache=True, error_model="numpy")
def error(
    P: Columns,
    q: FloatArray,
    A: Columns,
    bounds: Bounds,
    d: FloatArray,
    y: FloatArray,
    z: FloatArray,
) -> float:
    """Largest violation of the optimality conditions; not a number where one is not."""
    lower, upper, d_lower, d_upper = bounds
    worst = 0.0
    slope, at = _slope(P, q, A, d, y), _product(A, len(y), d)
    for j in range(len(d)):
        of_bounds = _error_of_side(d[j], z[j], d_lower[j], d_upper[j])
        left = abs(slope[j] + z[j]) + 0.0 * of_bounds
        if np.isnan(left):
            return np.nan
        worst = max(worst, left, of_bounds)
    for i in range(len(y)):
        of_row = _error_of_side(at[i], y[i], lower[i], upper[i])
        if np.isnan(of_row):
            return np.nan
        worst = max(worst, of_row)
    return worst


@njit(cache=True, error_model="numpy")
def largest(y: FloatArray, z: FloatArray) -> float:
    """Size of the largest multiplier."""
    found = 0.0
    for values in (y, z):
        for value in values:
            found = max(found, abs(value))
    return found


@njit(cache=True, error_model="numpy")
def different(sides: Sides, others: Sides) -> int:
    """How many sides differ."""
    count = 0
    for i in range(len(sides)):
        count += sides[i] != others[i]
    return count


@njit(cache=True, error_model="numpy")
def _side(value: float, multiplier: float, lower: float, upper: float) -> int:
    if upper - value < multiplier or lower == upper:
        return 1
    return -1 if value - lower < -multiplier else 0


@njit(cache=True, error_model="numpy")
def _error_of_side(value: float, multiplier: float, lower: float, upper: float) -> float:
    if np.isnan(value) or np.isnan(multiplier):
        return np.nan
    gap = abs(upper - value) if multiplier > 0.0 else abs(value - lower)
    return max(value - upper, lower - value, min(abs(multiplier), gap), 0.0)


@njit(cache=True, error_model="numpy")
def _slope(P: Columns, q: FloatArray, A: Columns, d: FloatArray, y: FloatArray) -> FloatArray:
    """P d + q + Aᵀ y (n,)."""
    found = q.copy()
    for j in range(len(q)):
        for k in range(P[0][j], P[0][j + 1]):
            found[P[1][k]] += P[2][k] * d[j]
        for k in range(A[0][j], A[0][j + 1]):
            found[j] += A[2][k] * y[A[1][k]]
    return found


@njit(cache=True, error_model="numpy")
def _product(A: Columns, m: int, d: FloatArray) -> FloatArray:
    """A d (m,)."""
    found = np.zeros(m)
    for j in range(len(d)):
        for k in range(A[0][j], A[0][j + 1]):
            found[A[1][k]] += A[2][k] * d[j]
    return found
