"""Sparse matrices of one pattern, filled again and again."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from ...arrays import FloatArray, IntArray


class MatrixEntries:
    """The places of a matrix's entries, in the order in which their values are worked out.

    Args:
        rows, columns: (k,) of each value; values at one place add up.
        shape: of the matrix.
    """

    def __init__(self, rows: IntArray, columns: IntArray, shape: tuple[int, int]) -> None:
        keys = columns.astype(np.int64) * shape[0] + rows
        places, at = np.unique(keys, return_inverse=True)
        self._at = at
        self._unique = len(places) == len(keys)
        self._order = np.argsort(at, kind="stable")
        indptr = np.searchsorted(places // shape[0], np.arange(shape[1] + 1))
        indices = (places % shape[0]).astype(np.int32)
        self._template = sparse.csc_array(
            (np.zeros(len(places)), indices, indptr.astype(np.int32)), shape=shape
        )
        self._template.has_canonical_format = True

    def matrix(self, values: FloatArray) -> sparse.csc_array:
        """The matrix with values (k,); its index arrays are shared with all others."""
        filled = object.__new__(sparse.csc_array)  # a fiftieth of the cost of one that is checked
        filled.__dict__.update(self._template.__dict__)
        filled.data = values[self._order] if self._unique else self._sums(values)
        return filled

    def _sums(self, values: FloatArray) -> FloatArray:
        """Values at one place added up."""
        return np.asarray(np.bincount(self._at, values, minlength=self._template.nnz), np.float64)
