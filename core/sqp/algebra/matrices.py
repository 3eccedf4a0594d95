"""Sparse matrices whose pattern is an object of its own.

In one solution patterns stay while data change. Whatever is worked out from a pattern (places,
orderings, a back end's set-up) is kept as long as the pattern is the same object; arithmetic on
SciPy's matrices, which check their indices each time, would cost more than the solution itself.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray
from scipy import sparse

from ...arrays import FloatArray, IntArray


class Sparsity:
    """The places of a matrix's entries, by columns, rows ascending in each.

    Args:
        shape: rows and columns of the matrix.
        rows: (k,) row of each entry.
        starts: (columns + 1,) first entry of each column.

    Attributes:
        columns: (k,) column of each entry.
    """

    __slots__ = ("columns", "rows", "shape", "starts")

    def __init__(self, shape: tuple[int, int], rows: ArrayLike, starts: ArrayLike) -> None:
        self.shape = shape
        self.rows: IntArray = np.array(rows, dtype=np.int64)
        self.starts: IntArray = np.array(starts, dtype=np.int64)
        self.columns: IntArray = np.repeat(
            np.arange(shape[1], dtype=np.int64), np.diff(self.starts)
        )

    @property
    def size(self) -> int:
        """Number of entries."""
        return len(self.rows)

    @property
    def full(self) -> bool:
        """Whether every place has an entry: then entry k stands at row k % rows."""
        return self.size == self.shape[0] * self.shape[1]

    def equals(self, rows: NDArray[np.integer], starts: NDArray[np.integer]) -> bool:
        """Whether these are the same places."""
        return bool(_same(self.starts, starts) and _same(self.rows, rows))


class SparseMatrix:
    """Entries at the places of a pattern.

    Args:
        pattern: the places.
        data: (k,).
    """

    __slots__ = ("data", "pattern")

    def __init__(self, pattern: Sparsity, data: FloatArray) -> None:
        self.pattern = pattern
        self.data = data

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.pattern.shape

    def __matmul__(self, x: FloatArray) -> FloatArray:
        """The product with a vector (columns,): (rows,)."""
        p = self.pattern
        return np.asarray(_times(p.shape[0], p.starts, p.rows, self.data, x))

    def transposed_times(self, y: FloatArray) -> FloatArray:
        """The product of the transposed matrix with a vector (rows,): (columns,)."""
        p = self.pattern
        return np.asarray(_transposed_times(p.starts, p.rows, self.data, y))

    def absolute(self) -> SparseMatrix:
        """The sizes of the entries."""
        return SparseMatrix(self.pattern, np.abs(self.data))

    def largest(self) -> float:
        """Size of the largest entry."""
        return float(np.abs(self.data).max(initial=0.0))

    def row_sizes(self) -> FloatArray:
        """Size of each row's largest entry (rows,)."""
        found = np.zeros(self.shape[0])
        _raise_rows(self.pattern.rows, self.data, found)
        return found

    def scipy(self) -> sparse.csc_matrix:
        """A SciPy matrix of 32-bit indices, as the back ends want it; it shares the data."""
        p = self.pattern
        indices, starts = p.rows.astype(np.int32), p.starts.astype(np.int32)
        return sparse.csc_matrix((self.data, indices, starts), shape=p.shape)


class LowRankSum(SparseMatrix):
    """A matrix of a pattern, its own entries, and a product of low rank beside them:
    entries + W C⁻¹ Wᵀ.

    Args:
        entries: (n, n).
        wide: W (n, r).
        middle: C (r, r), symmetric.
    """

    __slots__ = ("middle", "wide")

    def __init__(self, entries: SparseMatrix, wide: FloatArray, middle: FloatArray) -> None:
        super().__init__(entries.pattern, entries.data)
        self.wide = wide
        self.middle = middle


def from_scipy(matrix: sparse.sparray | sparse.spmatrix) -> SparseMatrix:
    """A matrix with a pattern of its own."""
    found = sparse.csc_array(matrix, dtype=np.float64)
    if not found.has_canonical_format:
        found = found.copy()
        found.sum_duplicates()
    rows, columns = found.shape
    return SparseMatrix(
        Sparsity((rows, columns), found.indices, found.indptr), np.array(found.data)
    )


def empty(columns: int) -> SparseMatrix:
    """A matrix without rows."""
    return SparseMatrix(Sparsity((0, columns), [], np.zeros(columns + 1)), np.zeros(0))


def identity(n: int) -> Sparsity:
    """The pattern of a diagonal (n, n)."""
    return Sparsity((n, n), np.arange(n), np.arange(n + 1))


@njit(cache=True, error_model="numpy")
def _same(mine: IntArray, other: IntArray) -> bool:
    same, count = len(mine) == len(other), 0
    while same and count < len(mine):
        same, count = mine[count] == other[count], count + 1
    return same


@njit(cache=True, error_model="numpy")
def _raise_rows(rows: IntArray, data: FloatArray, found: FloatArray) -> None:
    for k in range(len(data)):
        found[rows[k]] = max(found[rows[k]], abs(data[k]))


@njit(cache=True, error_model="numpy")
def _times(
    size: int, starts: IntArray, rows: IntArray, data: FloatArray, x: FloatArray
) -> FloatArray:
    found = np.zeros(size)
    for j in range(len(starts) - 1):
        for k in range(starts[j], starts[j + 1]):
            found[rows[k]] += data[k] * x[j]
    return found


@njit(cache=True, error_model="numpy")
def _transposed_times(
    starts: IntArray, rows: IntArray, data: FloatArray, y: FloatArray
) -> FloatArray:
    found = np.zeros(len(starts) - 1)
    for j in range(len(starts) - 1):
        total = 0.0
        for k in range(starts[j], starts[j + 1]):
            total += data[k] * y[rows[k]]
        found[j] = total
    return found
