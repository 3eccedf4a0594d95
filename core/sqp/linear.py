"""Symmetric linear systems: definiteness, and solutions of saddle-point systems."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .ldl import Ldl
from .matrices import FloatArray, IntArray, SparseMatrix, Sparsity

BoolArray = NDArray[np.bool_]

_REGULARISATION = 1e-9
_REFINEMENTS = 4
_EXACT = 1e-13


class Definiteness:
    """Tells whether symmetric matrices (n, n) of one pattern are positive definite."""

    def __init__(self) -> None:
        self._pattern: Sparsity | None = None

    def holds(self, matrix: SparseMatrix) -> bool:
        """Whether ``matrix``, which stores both triangles and its diagonal, is."""
        pattern = matrix.pattern
        if self._pattern is not pattern:
            self._pattern = pattern
            self._upper = np.flatnonzero(pattern.rows <= pattern.columns)
            rows, columns = pattern.rows[self._upper], pattern.columns[self._upper]
            self._ldl = Ldl(pattern.shape[0], rows, columns)
        return self._ldl.factorise(matrix.data[self._upper]) and (
            self._ldl.positive == pattern.shape[0]
        )


class Saddle:
    """Solves equality-constrained quadratic programs of one pattern.

    Rows and variables that do not take part are switched off in place, so that the pattern, and
    with it the symbolic factorisation, stays.
    """

    def __init__(self) -> None:
        self._P: Sparsity | None = None
        self._A: Sparsity | None = None

    def solve(
        self,
        P: SparseMatrix,
        q: FloatArray,
        A: SparseMatrix,
        rows: BoolArray,
        target: FloatArray,
        fixed: BoolArray,
        values: FloatArray,
    ) -> tuple[FloatArray, FloatArray] | None:
        """Minimise ½ d·P d + q·d with A d = target on ``rows`` and d = values on ``fixed``.

        Args:
            P: (n, n) positive semidefinite.
            q: (n,).
            A: (m, n); active rows may depend on each other if their targets agree.
            rows: (m,) active rows.
            target: (m,).
            fixed: (n,) variables.
            values: (n,).

        Returns:
            d (n,) and the multipliers of the rows (m,), zero on inactive ones; None if the
            factorisation breaks down.
        """
        if self._P is not P.pattern or self._A is not A.pattern:
            self._remember(P.pattern, A.pattern)
        n = len(q)
        pinned = np.where(fixed, values, 0.0)
        free = (~fixed).astype(np.float64)
        active = rows.astype(np.float64)
        p = SparseMatrix(P.pattern, P.data * free[P.pattern.rows] * free[P.pattern.columns])
        a = SparseMatrix(A.pattern, A.data * active[A.pattern.rows] * free[A.pattern.columns])
        upper = pinned - free * (q + P @ pinned)
        lower = active * (np.where(rows, target, 0.0) - A @ pinned)
        delta = _REGULARISATION * max(1.0, P.largest())
        exact = np.concatenate([1.0 - free, active - 1.0])
        diagonal = exact + np.concatenate([free * delta, -active * delta])
        diagonal[self._p_rows] += p.data[self._p_diagonal]
        data = np.concatenate([p.data[self._p_upper], a.data, diagonal])
        if not self._ldl.factorise(data):
            return None

        def times(b: FloatArray) -> FloatArray:
            found = exact * b
            found[:n] += p @ b[:n] + a.transposed_times(b[n:])
            found[n:] += a @ b[:n]
            return found

        found = _refined(times, self._ldl.solve, np.concatenate([upper, lower]))
        return None if found is None else (found[:n], found[n:])

    def _remember(self, P: Sparsity, A: Sparsity) -> None:
        """Where the entries of P and A go in the upper triangle of the whole matrix."""
        self._P, self._A = P, A
        m, n = A.shape
        self._p_upper: IntArray = np.flatnonzero(P.rows < P.columns)
        self._p_diagonal: IntArray = np.flatnonzero(P.rows == P.columns)
        self._p_rows: IntArray = P.rows[self._p_diagonal]
        diagonal = np.arange(n + m)
        rows = np.concatenate([P.rows[self._p_upper], A.columns, diagonal])
        columns = np.concatenate([P.columns[self._p_upper], A.rows + n, diagonal])
        self._ldl = Ldl(n + m, rows, columns)


def _refined(times, solve, right: FloatArray) -> FloatArray | None:  # type: ignore[no-untyped-def]
    """The solution of the exact system by those of the shifted one."""
    found = solve(right)
    error = right - times(found)
    size = float(np.abs(error).max(initial=0.0))
    enough = _EXACT * max(1.0, float(np.abs(right).max(initial=0.0)))
    for _ in range(_REFINEMENTS):
        if not np.isfinite(size):
            return None
        if size <= enough:
            break
        better = found + solve(error)
        left = right - times(better)
        left_size = float(np.abs(left).max(initial=0.0))
        if not left_size < size:
            break
        found, error, size = better, left, left_size
    return np.asarray(found) if np.isfinite(found).all() else None
