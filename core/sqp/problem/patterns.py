"""Matrices from callables, brought to one sparsity pattern."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix, Sparsity, from_scipy
from .arrays import matrix
from .errors import NlpError
from .symmetry import Symmetry


class Pattern:
    """The entries that a callable's matrices may have.

    Args:
        name: of the callable, for messages.
        shape: of its matrices.
        growing: whether entries outside the pattern extend it; else they are an error.

    Attributes:
        symmetry: holds such matrices' triangles against each other.
    """

    def __init__(self, name: str, shape: tuple[int, int], growing: bool = False) -> None:
        self._name = name
        self._shape = shape
        self._growing = growing
        self.symmetry = Symmetry()
        self._known: Sparsity | None = None
        self._dense = False
        self._open = True

    @property
    def known(self) -> Sparsity | None:
        """The pattern; None before the first matrix."""
        return self._known

    def reopen(self) -> None:
        """Let the next matrix have a pattern of its own."""
        self._open = True

    def array(self, value: object) -> SparseMatrix:
        """The matrix ``value`` with this pattern; the first one makes it.

        Raises:
            NlpError: it is no matrix of real numbers, has another shape, or entries outside the
                pattern.
        """
        if self._known is not None and self._is_known(value):
            self._open = False
            return SparseMatrix(self._known, value.data.copy())  # type: ignore[attr-defined]
        found = matrix(self._name, value, self._shape)
        if isinstance(found, np.ndarray):
            return self._from_dense(found)
        return self._from_sparse(found)

    def _is_known(self, value: object) -> bool:
        """Whether it is a sparse matrix of the known pattern, which needs no conversion."""
        assert self._known is not None
        return (
            isinstance(value, sparse.csc_array | sparse.csc_matrix)
            and value.shape == self._shape
            and value.dtype == np.float64
            and self._known.equals(value.indices, value.indptr)
        )

    def _from_sparse(self, csc: sparse.csc_array) -> SparseMatrix:
        if self._known is not None and self._known.equals(csc.indices, csc.indptr):
            self._open = False
            return SparseMatrix(self._known, csc.data)
        found = from_scipy(csc)
        if self._known is None or self._open:
            self._known, self._dense, self._open = found.pattern, False, False
            return found
        return self._placed(self._known, found)

    def _from_dense(self, array: FloatArray) -> SparseMatrix:
        if self._known is None or (self._open and not self._dense):
            rows, columns = self._shape
            self._dense = True
            self._known = Sparsity(
                self._shape, np.tile(np.arange(rows), columns), np.arange(columns + 1) * rows
            )
        elif not self._dense:
            return self._placed(self._known, from_scipy(sparse.csc_array(array)))
        self._open = False
        return SparseMatrix(self._known, array.T.flatten())

    def _placed(self, known: Sparsity, found: SparseMatrix) -> SparseMatrix:
        """A matrix whose entries are among the pattern's."""
        height = self._shape[0]
        keys = known.columns * height + known.rows
        wanted = found.pattern.columns * height + found.pattern.rows
        at = np.searchsorted(keys, wanted)
        inside = at < len(keys)
        inside[inside] = keys[at[inside]] == wanted[inside]
        if not inside.all():
            if self._growing:
                return self._grown(known, found)
            first = int(np.flatnonzero(~inside)[0])
            row, column = int(found.pattern.rows[first]), int(found.pattern.columns[first])
            raise NlpError(
                f"{self._name}: entry ({row}, {column}) is outside the sparsity pattern of the "
                "first matrix: return the same pattern at every x, with explicit zeros"
            )
        data: FloatArray = np.zeros(len(keys))
        data[at] = found.data
        return SparseMatrix(known, data)

    def _grown(self, known: Sparsity, found: SparseMatrix) -> SparseMatrix:
        ones = [
            SparseMatrix(pattern, np.ones(pattern.size)).scipy()
            for pattern in (known, found.pattern)
        ]
        self._known = from_scipy(ones[0] + ones[1]).pattern
        return self._placed(self._known, found)
