"""Dense counterparts of `linear`, by LAPACK: for matrices that have an entry almost everywhere.

A sparse factorisation of a full matrix does the same arithmetic one number at a time; blocked it
takes a tenth of the time.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dpotrf, dpotrs

from ...arrays import BoolArray, FloatArray
from .matrices import SparseMatrix, Sparsity

LEAST_SIZE = 100
_LEAST_SHARE = 0.3
_REGULARISATION = 1e-9
_REFINEMENTS = 20
_EXACT = 1e-13


def is_dense(pattern: Sparsity) -> bool:
    """Whether matrices (n, n) of this pattern are better treated as full ones."""
    n = pattern.shape[0]
    return n >= LEAST_SIZE and pattern.size >= _LEAST_SHARE * n * n


def array_of(matrix: SparseMatrix) -> FloatArray:
    """The full array."""
    pattern = matrix.pattern
    rows, columns = pattern.shape
    if pattern.size == rows * columns:
        return np.asarray(matrix.data.reshape(columns, rows).T)
    found = np.zeros(pattern.shape)
    found[pattern.rows, pattern.columns] = matrix.data
    return found


class Cholesky:
    """A factorisation of a symmetric positive definite array (n, n).

    Raises:
        LinAlgError: it is not.
    """

    def __init__(self, array: FloatArray) -> None:
        # By columns, which LAPACK takes as they are; the matrix is its own transpose.
        by_columns = array if array.flags.f_contiguous else array.T
        self._factor, info = dpotrf(by_columns, lower=True, clean=False)
        if info:
            raise LinAlgError(f"pivot {info} is not positive")

    def solve(self, right: FloatArray) -> FloatArray:
        """The solution for one right side (n,) or several (n, k)."""
        if not right.size:
            return np.zeros_like(right)
        return np.asarray(dpotrs(self._factor, right, lower=True)[0].reshape(right.shape))


def positive_definite(matrix: SparseMatrix) -> bool:
    """Whether a symmetric matrix is."""
    try:
        Cholesky(array_of(matrix))
    except LinAlgError:
        return False
    return bool(np.isfinite(matrix.data).all())


class _Reduced:
    """The saddle-point system of free variables and active rows, regularised and factorised.

    Raises:
        LinAlgError: it cannot be.
    """

    def __init__(self, P: FloatArray, B: FloatArray, delta: float) -> None:
        self._P, self._B = P, B
        shifted = P.copy(order="F")
        shifted[np.diag_indices(len(P))] += delta
        self._curvature = Cholesky(shifted)
        self._spread = self._curvature.solve(B.T)
        self._rows = Cholesky(B @ self._spread + delta * np.eye(len(B))) if len(B) else None

    def _approximate(self, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray]:
        d = self._curvature.solve(first)
        if self._rows is None:
            return d, np.zeros(0)
        y = self._rows.solve(self._B @ d - second)
        return d - self._spread @ y, y

    def solve(self, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray] | None:
        """P d + Bᵀ y = first, B d = second, refined; None if it is not finite."""
        d, y = self._approximate(first, second)
        enough = _EXACT * max(1.0, float(np.abs(first).max()), float(np.abs(second).max(initial=0)))
        left = np.inf
        best = d, y
        for _ in range(_REFINEMENTS + 1):
            rest = first - self._P @ d - self._B.T @ y, second - self._B @ d
            size = max(float(np.abs(rest[0]).max()), float(np.abs(rest[1]).max(initial=0.0)))
            if not size < left:
                break
            best, left = (d, y), size
            if size <= enough:
                break
            step = self._approximate(*rest)
            d, y = d + step[0], y + step[1]
        return best if np.isfinite(left) else None


def saddle(
    P: SparseMatrix,
    q: FloatArray,
    A: SparseMatrix,
    rows: BoolArray,
    target: FloatArray,
    fixed: BoolArray,
    values: FloatArray,
) -> tuple[FloatArray, FloatArray] | None:
    """See `linear.Saddle.solve`."""
    full = array_of(P)
    free = np.flatnonzero(~fixed)
    d = np.where(fixed, values, 0.0)
    y = np.zeros(len(target))
    if not len(free):
        return d, y
    across = sparse.csr_array(A.scipy())[:, free]
    active = np.flatnonzero(rows & (abs(across).sum(axis=1) > 0.0))  # others cannot be met
    B = across[active].toarray()
    delta = _REGULARISATION * max(1.0, P.largest())
    try:
        reduced = _Reduced(full if len(free) == len(q) else full[np.ix_(free, free)], B, delta)
    except LinAlgError:
        return None
    found = reduced.solve(-(q + P @ d)[free], (target - A @ d)[active])
    if found is None:
        return None
    d[free], y[active] = found
    return d, y
