"""LDLᵀ factorisation of sparse symmetric matrices of one pattern.

The up-looking method of Davis, "Algorithm 849: a concise sparse Cholesky factorization package"
(2005), as QDLDL has it: no pivoting, hence for quasi-definite matrices. Ordering and symbolic work
are done once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy import sparse
from scipy.sparse import linalg

from ...arrays import FloatArray, IntArray

_LEAST_PIVOT = 1e-300
_DENSE_DEGREE, _DENSE_SHARE = 16, 10.0
"""Neighbours, and their number over √n, from which on a variable is eliminated last."""


class Factors(NamedTuple):
    """A factorisation as compiled code takes it; `factorise` overwrites the last three.

    Args:
        order: (n,) the variable that is eliminated first, second, …
        starts, rows: (n + 1,), (k,) the permuted upper triangle by columns.
        parents: (n,) elimination tree.
        l_starts, l_rows, l_data: (n + 1,), (e,), (e,) L by columns, without its diagonal.
        inverses: (n,) reciprocal pivots.
    """

    order: IntArray
    starts: IntArray
    rows: IntArray
    parents: IntArray
    l_starts: IntArray
    l_rows: IntArray
    l_data: FloatArray
    inverses: FloatArray


class Ldl:
    """Factorisations of matrices (n, n) that have entries at the same places.

    Args:
        n: size.
        rows, columns: (k,) places of the upper triangle's entries, each once, in any order; the
            whole diagonal is among them.

    Attributes:
        positive: number of positive pivots of the last factorisation.
        factors: the last factorisation.
        places: (k,) where each entry goes in the data that `factorise` takes.
    """

    def __init__(self, n: int, rows: IntArray, columns: IntArray) -> None:
        self.positive = 0
        order = _ordering(n, rows, columns)
        inverse = np.empty(n, dtype=np.int64)
        inverse[order] = np.arange(n)
        first, second = inverse[rows], inverse[columns]
        upper, right = np.minimum(first, second), np.maximum(first, second)
        self._take = np.lexsort((upper, right))
        self.places: IntArray = np.empty(len(rows), dtype=np.int64)
        self.places[self._take] = np.arange(len(rows))
        inner = upper[self._take]
        starts = np.searchsorted(right[self._take], np.arange(n + 1)).astype(np.int64)
        parents, counts = _tree(n, starts, inner)
        l_starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        entries = int(l_starts[-1])
        l_rows = np.zeros(entries, dtype=np.int64)
        self.factors = Factors(
            order, starts, inner, parents, l_starts, l_rows, np.zeros(entries), np.ones(n)
        )

    def factorise(self, data: FloatArray) -> bool:
        """Factorise the matrix with these entries (k,); False if a pivot is zero or not finite."""
        self.positive = int(factorise(self.factors, data[self._take]))
        return self.positive >= 0

    def solve(self, right: FloatArray) -> FloatArray:
        """The solution (n,) of the system factorised last."""
        found = np.empty_like(right)
        substitute(self.factors, right, found, np.empty_like(right))
        return found


def _ordering(n: int, rows: IntArray, columns: IntArray) -> IntArray:
    """A minimum-degree ordering; what meets very many others (a final time, say) comes last, which
    the search for the least degree would spend most of its time on."""
    degrees = np.bincount(rows, minlength=n) + np.bincount(columns, minlength=n)
    few = degrees <= max(_DENSE_DEGREE, _DENSE_SHARE * np.sqrt(n))
    if few.all():
        return _minimum_degree(n, rows, columns)
    sparse_ones = np.flatnonzero(few)
    number = np.full(n, -1)
    number[sparse_ones] = np.arange(len(sparse_ones))
    both = few[rows] & few[columns]
    inner = _minimum_degree(len(sparse_ones), number[rows[both]], number[columns[both]])
    return np.concatenate([sparse_ones[inner], np.flatnonzero(~few)])


def _minimum_degree(n: int, rows: IntArray, columns: IntArray) -> IntArray:
    """SuperLU's, of a matrix that has these places."""
    if not n:
        return np.zeros(0, dtype=np.int64)
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
def factorise(factors: Factors, data: FloatArray) -> int:
    """Fill L and the pivots; the number of positive pivots, -1 where one is zero or not finite.

    Args:
        factors: of the pattern.
        data: (k,) the permuted upper triangle's entries by columns.
    """
    starts, rows, parents = factors.starts, factors.rows, factors.parents
    l_starts, l_rows, l_data = factors.l_starts, factors.l_rows, factors.l_data
    inverses = factors.inverses
    n = len(inverses)
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
            share = value / inverses[i]
            pivot -= share * value
            l_rows[filled[i]] = j
            l_data[filled[i]] = share
            filled[i] += 1
        if not (abs(pivot) > _LEAST_PIVOT and np.isfinite(pivot)):
            return -1
        inverses[j] = pivot
        if pivot > 0.0:
            positive += 1
    return positive


@njit(cache=True, error_model="numpy")
def substitute(factors: Factors, right: FloatArray, found: FloatArray, work: FloatArray) -> None:
    """Solve the system factorised last.

    Args:
        factors: of the matrix.
        right: (n,).
        found: (n,) the solution is written there; may be ``right`` itself.
        work: (n,) overwritten.
    """
    order, starts, rows, data = factors.order, factors.l_starts, factors.l_rows, factors.l_data
    inverses = factors.inverses
    n = len(order)
    for j in range(n):
        work[j] = right[order[j]]
    for j in range(n):
        value = work[j]
        for k in range(starts[j], starts[j + 1]):
            work[rows[k]] -= data[k] * value
    for j in range(n - 1, -1, -1):
        value = work[j] / inverses[j]
        for k in range(starts[j], starts[j + 1]):
            value -= data[k] * work[rows[k]]
        work[j] = value
        found[order[j]] = value
