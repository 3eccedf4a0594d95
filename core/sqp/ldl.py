"""LDLᵀ factorisation of sparse symmetric matrices of one pattern.

The up-looking method of Davis, "Algorithm 849: a concise sparse Cholesky factorization package"
(2005), as QDLDL has it: no pivoting, hence for quasi-definite matrices. Ordering and symbolic work
are done once.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import linalg

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_LEAST_PIVOT = 1e-300


class Ldl:
    """Factorisations of matrices (n, n) that have entries at the same places.

    Args:
        n: size.
        rows, columns: (k,) places of the upper triangle's entries, each once, in any order; the
            whole diagonal is among them.

    Attributes:
        positive: number of positive pivots of the last factorisation.
    """

    def __init__(self, n: int, rows: IntArray, columns: IntArray) -> None:
        self.positive = 0
        self._order = _ordering(n, rows, columns)
        inverse = np.empty(n, dtype=np.int64)
        inverse[self._order] = np.arange(n)
        first, second = inverse[rows], inverse[columns]
        upper, right = np.minimum(first, second), np.maximum(first, second)
        self._take = np.lexsort((upper, right))
        self._rows = upper[self._take]
        self._starts = np.searchsorted(right[self._take], np.arange(n + 1)).astype(np.int64)
        self._parents, counts = _tree(n, self._starts, self._rows)
        self._l_starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        entries = int(self._l_starts[-1])
        self._l_rows = np.zeros(entries, dtype=np.int64)
        self._l_data = np.zeros(entries)
        self._pivots = np.ones(n)

    def factorise(self, data: FloatArray) -> bool:
        """Factorise the matrix with these entries (k,); False if a pivot is zero or not finite."""
        found = _factorise(
            self._starts,
            self._rows,
            data[self._take],
            self._parents,
            self._l_starts,
            self._l_rows,
            self._l_data,
            self._pivots,
        )
        self.positive = int(found)
        return self.positive >= 0

    def solve(self, right: FloatArray) -> FloatArray:
        """The solution (n,) of the system factorised last."""
        inner = right[self._order]
        _substitute(self._l_starts, self._l_rows, self._l_data, self._pivots, inner)
        found = np.empty_like(inner)
        found[self._order] = inner
        return found


def _ordering(n: int, rows: IntArray, columns: IntArray) -> IntArray:
    """A minimum-degree ordering: SuperLU's, of a matrix that has these places."""
    off = rows != columns
    i, j = rows[off], columns[off]
    diagonal = np.arange(n)
    down, right = np.concatenate([i, j, diagonal]), np.concatenate([j, i, diagonal])
    dominant = 2.0 + np.bincount(right, minlength=n)
    values = np.concatenate([np.ones(2 * len(i)), dominant])
    order = np.lexsort((down, right))
    starts = np.searchsorted(right[order], np.arange(n + 1)).astype(np.int32)
    matrix = sparse.csc_matrix((values[order], down[order].astype(np.int32), starts), shape=(n, n))
    options = {"SymmetricMode": True}
    found = linalg.splu(matrix, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    return np.argsort(found.perm_c).astype(np.int64)


@njit(cache=True, error_model="numpy")
def _tree(n: int, starts: IntArray, rows: IntArray) -> tuple[IntArray, IntArray]:
    """Elimination tree and the number of entries below each pivot."""
    parents = np.full(n, -1, dtype=np.int64)
    counts = np.zeros(n, dtype=np.int64)
    seen = np.full(n, -1, dtype=np.int64)
    for j in range(n):
        seen[j] = j
        for k in range(starts[j], starts[j + 1]):
            i = rows[k]
            while seen[i] != j:
                if parents[i] == -1:
                    parents[i] = j
                counts[i] += 1
                seen[i] = j
                i = parents[i]
    return parents, counts


@njit(cache=True, error_model="numpy")
def _factorise(
    starts: IntArray,
    rows: IntArray,
    data: FloatArray,
    parents: IntArray,
    l_starts: IntArray,
    l_rows: IntArray,
    l_data: FloatArray,
    pivots: FloatArray,
) -> int:
    """Fill L and the pivots; the number of positive pivots, -1 where one is zero or not finite."""
    n = len(pivots)
    row = np.zeros(n)
    filled = l_starts[:-1].copy()
    seen = np.full(n, -1, dtype=np.int64)
    path = np.empty(n, dtype=np.int64)
    reach = np.empty(n, dtype=np.int64)
    positive = 0
    for j in range(n):
        top = n
        seen[j] = j
        pivot = 0.0
        for k in range(starts[j], starts[j + 1]):
            i = rows[k]
            if i == j:
                pivot = data[k]
                continue
            row[i] = data[k]
            length = 0
            while seen[i] != j:
                path[length] = i
                length += 1
                seen[i] = j
                i = parents[i]
            while length > 0:
                length -= 1
                top -= 1
                reach[top] = path[length]
        for k in range(top, n):
            i = reach[k]
            value = row[i]
            row[i] = 0.0
            for p in range(l_starts[i], filled[i]):
                row[l_rows[p]] -= l_data[p] * value
            share = value / pivots[i]
            pivot -= share * value
            l_rows[filled[i]] = j
            l_data[filled[i]] = share
            filled[i] += 1
        if not (abs(pivot) > _LEAST_PIVOT and np.isfinite(pivot)):
            return -1
        pivots[j] = pivot
        if pivot > 0.0:
            positive += 1
    return positive


@njit(cache=True, error_model="numpy")
def _substitute(
    starts: IntArray, rows: IntArray, data: FloatArray, pivots: FloatArray, x: FloatArray
) -> None:
    """Solve L D Lᵀ x = x in place."""
    n = len(pivots)
    for j in range(n):
        value = x[j]
        for k in range(starts[j], starts[j + 1]):
            x[rows[k]] -= data[k] * value
    for j in range(n):
        x[j] /= pivots[j]
    for j in range(n - 1, -1, -1):
        value = x[j]
        for k in range(starts[j], starts[j + 1]):
            value -= data[k] * x[rows[k]]
        x[j] = value
