"""Compiled LU factors of the small square systems of kinematics."""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from .lean import inner


@inner
def factor(matrix: FloatArray, order: IntArray, n: int) -> tuple[float, float]:
    """Replace a matrix (n, n) by its LU factors, rows exchanged for the largest pivot.

    Args:
        matrix: (n, n), overwritten by L (unit diagonal) below and U on and above the diagonal.
        order: (n,), written: the row taken for each pivot.
        n: how many rows there are; loops over as many as are written out become straight code.

    Returns:
        The smallest and the largest pivot; the smallest is 0 for a singular matrix.
    """
    smallest, largest = np.inf, 0.0
    for k in range(n):
        best, pivot = k, abs(matrix[k, k])
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > pivot:
                best, pivot = i, abs(matrix[i, k])
        order[k] = best
        if best != k:
            for j in range(n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        smallest, largest = min(smallest, pivot), max(largest, pivot)
        if pivot == 0.0:
            return 0.0, largest
        inverse = 1.0 / matrix[k, k]
        for i in range(k + 1, n):
            share = matrix[i, k] * inverse
            matrix[i, k] = share
            for j in range(k + 1, n):
                matrix[i, j] -= share * matrix[k, j]
    return smallest, largest


@inner
def solve(factors: FloatArray, order: IntArray, x: FloatArray, n: int) -> None:
    """Solve A y = x for the factored A (n, n); y replaces x (n,)."""
    for k in range(n):
        value = x[order[k]]
        x[order[k]] = x[k]
        for j in range(k):
            value -= factors[k, j] * x[j]
        x[k] = value
    for k in range(n - 1, -1, -1):
        value = x[k]
        for j in range(k + 1, n):
            value -= factors[k, j] * x[j]
        x[k] = value / factors[k, k]


@inner
def invert_factors(factors: FloatArray, order: IntArray, inverse: FloatArray, n: int) -> None:
    """Write A⁻¹ (n, n) for the factored A."""
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
        share = 1.0 / factors[k, k]
        for c in range(n):
            inverse[k, c] *= share


@inner
def solve_transposed(factors: FloatArray, order: IntArray, x: FloatArray, n: int) -> None:
    """Solve Aᵀ y = x for the factored A (n, n); y replaces x (n,)."""
    for k in range(n):
        value = x[k]
        for j in range(k):
            value -= factors[j, k] * x[j]
        x[k] = value / factors[k, k]
    for k in range(n - 1, -1, -1):
        value = x[k]
        for j in range(k + 1, n):
            value -= factors[j, k] * x[j]
        x[k] = value
    for k in range(n - 1, -1, -1):
        x[k], x[order[k]] = x[order[k]], x[k]


@njit(cache=True, error_model="numpy")
def solve_in_place(matrix: FloatArray, x: FloatArray) -> float:
    """Solve A y = x; y replaces x (n,), the factors replace A (n, n).

    Returns:
        The smallest pivot; x is meaningless if it is 0.
    """
    order = np.empty(x.size, dtype=np.int64)
    pivots: tuple[float, float] = factor(matrix, order, x.size)
    if pivots[0] > 0.0:
        solve(matrix, order, x, x.size)
    return pivots[0]
