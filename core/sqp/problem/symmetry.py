"""A check that Hessians come with both triangles."""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray, IntArray
from ..algebra.matrices import SparseMatrix, Sparsity
from .errors import NlpError

_ASYMMETRY = 1e-2
"""Share of the largest entry by which two that should be equal may differ: Hessians by differences
are symmetric to 1e-4 or so."""


class Symmetry:
    """Checks matrices, most of which have one pattern."""

    def __init__(self) -> None:
        self._pattern: Sparsity | None = None

    def check(self, name: str, matrix: SparseMatrix) -> None:
        """Hold entries against those of the other triangle.

        Raises:
            NlpError: one triangle is empty and the other is not, or they differ.
        """
        if self._pattern is not matrix.pattern:
            self._remember(matrix.pattern)
        pattern, data = matrix.pattern, matrix.data
        if _mirrored(data, self._places, self._found):
            return
        other = np.where(self._found, data[self._places], 0.0)
        below = pattern.rows > pattern.columns
        above = pattern.rows < pattern.columns
        if not data[below].any() or not data[above].any():
            raise NlpError(f"{name} gave one triangle only: return both")
        apart = np.abs(data - other)
        worst = int(np.argmax(apart))
        if apart[worst] > _ASYMMETRY * matrix.largest():
            row, column = int(pattern.rows[worst]), int(pattern.columns[worst])
            raise NlpError(
                f"{name} is not symmetric: {data[worst]:g} at ({row}, {column}), "
                f"{other[worst]:g} at ({column}, {row})"
            )

    def _remember(self, pattern: Sparsity) -> None:
        """Where each entry's counterpart is."""
        self._pattern = pattern
        n = pattern.shape[0]
        if pattern.full:
            self._places = np.arange(n * n).reshape(n, n).T.ravel()
            self._found = np.ones(n * n, dtype=np.bool_)
            return
        keys = pattern.columns * n + pattern.rows
        wanted = pattern.rows * n + pattern.columns
        places = np.minimum(np.searchsorted(keys, wanted), max(len(keys) - 1, 0))
        self._places = places
        self._found = keys[places] == wanted if len(keys) else np.zeros(0, dtype=np.bool_)


@njit(cache=True, error_model="numpy")
def _mirrored(data: FloatArray, places: IntArray, found: BoolArray) -> bool:
    """Whether each entry equals its counterpart, or zero where there is none."""
    same, count = True, 0
    while same and count < len(data):
        same = data[count] == (data[places[count]] if found[count] else 0.0)
        count += 1
    return same
