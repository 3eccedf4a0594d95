"""Compiled LU factors of the small square systems of kinematics."""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from .lean import inner


@inner
def factor(matrix: FloatArray, order: IntArray) -> tuple[float, float]:
    """Replace a matrix (n, n) by its LU factors, rows exchanged for the largest pivot.

    Args:
        matrix: (n, n), overwritten by L (unit diagonal) below and U on and above the diagonal.
        order: (n,), written: the row taken for each pivot.

    Returns:
        The smallest and the largest pivot; the smallest is 0 for a singular matrix.
    """
    n = matrix.shape[0]
    smallest, largest = np.inf, 0.0
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        order[k] = best
        if best != k:
            for j in range(n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        pivot = abs(matrix[k, k])
        smallest, largest = min(smallest, pivot), max(largest, pivot)
        if pivot == 0.0:
            return 0.0, largest
        for i in range(k + 1, n):
            matrix[i, k] /= matrix[k, k]
            for j in range(k + 1, n):
                matrix[i, j] -= matrix[i, k] * matrix[k, j]
    return smallest, largest


@inner
def solve(factors: FloatArray, order: IntArray, x: FloatArray) -> None:
    """Solve A y = x for the factored A; y replaces x (n,)."""
    n = factors.shape[0]
    for k in range(n):
        x[k], x[order[k]] = x[order[k]], x[k]
        for j in range(k):
            x[k] -= factors[k, j] * x[j]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            x[k] -= factors[k, j] * x[j]
        x[k] /= factors[k, k]


@inner
def invert_factors(factors: FloatArray, order: IntArray, inverse: FloatArray) -> None:
    """Write A⁻¹ (n, n) for the factored A."""
    n = factors.shape[0]
    for i in range(n):
        for c in range(n):
            inverse[i, c] = 1.0 if i == c else 0.0
    for k in range(n):
        if order[k] != k:
            for c in range(n):
                inverse[k, c], inverse[order[k], c] = inverse[order[k], c], inverse[k, c]
    for k in range(n):
        for j in range(k):
            for c in range(n):
                inverse[k, c] -= factors[k, j] * inverse[j, c]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            for c in range(n):
                inverse[k, c] -= factors[k, j] * inverse[j, c]
        for c in range(n):
            inverse[k, c] /= factors[k, k]


@inner
def solve_transposed(factors: FloatArray, order: IntArray, x: FloatArray) -> None:
    """Solve Aᵀ y = x for the factored A; y replaces x (n,)."""
    n = factors.shape[0]
    for k in range(n):
        for j in range(k):
            x[k] -= factors[j, k] * x[j]
        x[k] /= factors[k, k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            x[k] -= factors[j, k] * x[j]
    for k in range(n - 1, -1, -1):
        x[k], x[order[k]] = x[order[k]], x[k]


@njit(cache=True, error_model="numpy")
def solve_in_place(matrix: FloatArray, x: FloatArray) -> float:
    """Solve A y = x; y replaces x (n,), the factors replace A (n, n).

    Returns:
        The smallest pivot; x is meaningless if it is 0.
    """
    order = np.empty(x.size, dtype=np.int64)
    pivots: tuple[float, float] = factor(matrix, order)
    if pivots[0] > 0.0:
        solve(matrix, order, x)
    return pivots[0]
