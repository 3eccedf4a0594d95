"""Symmetric linear systems: definiteness, and solutions of saddle-point systems."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray, IntArray
from . import dense
from .ldl import Factors, Ldl, factorise, substitute
from .matrices import SparseMatrix, Sparsity

_REGULARISATION = 1e-9
_REFINEMENTS = 10
_EXACT = 1e-13
_KEPT = 5


class Definiteness:
    """Tells whether symmetric matrices (n, n) of one pattern are positive definite."""

    def __init__(self) -> None:
        self._pattern: Sparsity | None = None

    def holds(self, matrix: SparseMatrix) -> bool:
        """Whether ``matrix``, which stores both triangles and its diagonal, is."""
        pattern = matrix.pattern
        if dense.is_dense(pattern):
            return dense.positive_definite(matrix)
        if self._pattern is not pattern:
            self._pattern = pattern
            self._upper = np.flatnonzero(pattern.rows <= pattern.columns)
            rows, columns = pattern.rows[self._upper], pattern.columns[self._upper]
            self._ldl = Ldl(pattern.shape[0], rows, columns)
        return self._ldl.factorise(matrix.data[self._upper]) and (
            self._ldl.positive == pattern.shape[0]
        )


class EntryIndices(NamedTuple):
    """Where entries of [P, Aᵀ; A, D] go in the data that `factorise` takes.

    Args:
        P: (entries of P,) of the upper triangle without its diagonal; -1 elsewhere.
        A: (entries of A,).
        diagonal: (n + m,) of the whole.
    """

    P: IntArray
    A: IntArray
    diagonal: IntArray


class SaddlePattern:
    """What is worked out once for matrices [P, Aᵀ; A, D] of two patterns.

    Args:
        P: (n, n), both triangles.
        A: (m, n).

    Attributes:
        factors: of the last such matrix.
        places: where entries go.
    """

    def __init__(self, P: Sparsity, A: Sparsity) -> None:
        self._P, self._A = P, A
        m, n = A.shape
        upper = np.flatnonzero(P.rows < P.columns)
        diagonal = np.arange(n + m)
        rows = np.concatenate([P.rows[upper], A.columns, diagonal])
        columns = np.concatenate([P.columns[upper], A.rows + n, diagonal])
        ldl = Ldl(n + m, rows, columns)
        self.factors = ldl.factors
        ends = np.cumsum([len(upper), A.size])
        of_P, of_A, of_diagonal = np.split(ldl.places, ends)
        places = np.full(P.size, -1)
        places[upper] = of_P
        self.places = EntryIndices(places, of_A, of_diagonal)

    def is_of(self, P: Sparsity, A: Sparsity) -> bool:
        """Whether it is of these patterns."""
        return self._P is P and self._A is A


class SaddlePatterns:
    """The patterns used last: those of subproblems, of elastic ones and of restoration."""

    def __init__(self) -> None:
        self._known: list[SaddlePattern] = []

    def of(self, P: Sparsity, A: Sparsity) -> SaddlePattern:
        """What belongs to these patterns."""
        for known in self._known:
            if known.is_of(P, A):
                return known
        self._known = [SaddlePattern(P, A), *self._known[: _KEPT - 1]]
        return self._known[0]


class Saddle:
    """Solves equality-constrained quadratic programs.

    Rows and variables that do not take part are switched off in place, so that the pattern, and
    with it the symbolic factorisation, stays.

    Args:
        patterns: keeps symbolic factorisations, others' too; None for its own.
        regularisation: share of P's size by which the factorised system is shifted; more where P
            is not semidefinite.

    Attributes:
        convex: whether the last P curves upwards along the active rows and fixed variables.
    """

    def __init__(
        self, patterns: SaddlePatterns | None = None, regularisation: float = _REGULARISATION
    ) -> None:
        self._patterns = patterns or SaddlePatterns()
        self._regularisation = regularisation
        self.convex = False

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
        if dense.is_dense(P.pattern):
            of_dense = dense.saddle(P, q, A, rows, target, fixed, values)
            self.convex = of_dense is not None  # others are not factorised
            return of_dense
        pattern = self._patterns.of(P.pattern, A.pattern)
        n = len(q)
        found = np.empty(n + len(target))
        positive = _solve(
            (P.pattern.starts, P.pattern.rows, P.data),
            (A.pattern.starts, A.pattern.rows, A.data),
            (q, target),
            (fixed, values),
            rows,
            pattern.factors,
            pattern.places,
            self._regularisation,
            found,
        )
        self.convex = bool(positive == n)
        return (found[:n], found[n:]) if positive >= 0 else None


class SaddleMatrices(NamedTuple):
    """P (n, n), both triangles, and A (m, n) by columns."""

    P_starts: IntArray
    P_rows: IntArray
    P: FloatArray
    A_starts: IntArray
    A_rows: IntArray
    A: FloatArray


@njit(cache=True, error_model="numpy")
def _solve(
    P: tuple[IntArray, IntArray, FloatArray],
    A: tuple[IntArray, IntArray, FloatArray],
    sides: tuple[FloatArray, FloatArray],
    fixed: tuple[BoolArray, FloatArray],
    rows: BoolArray,
    factors: Factors,
    places: EntryIndices,
    regularisation: float,
    found: FloatArray,
) -> int:
    """See `Saddle.solve`. Number of positive pivots, -1 without a solution.

    Args:
        P, A: starts, rows and data of either.
        sides: q (n,) and the rows' targets (m,).
        fixed: (n,) variables, and their values.
        rows: (m,) active ones.
        factors, places: of their pattern.
        regularisation: share of P's size.
        found: (n + m,) the solution is written there.
    """
    matrices = SaddleMatrices(P[0], P[1], P[2].copy(), A[0], A[1], A[2].copy())
    n, m = len(sides[0]), len(sides[1])
    right, exact = np.empty(n + m), np.empty(n + m)
    active = np.empty(n + m, dtype=np.bool_)
    size = 1.0
    for value in matrices.P:
        size = max(size, abs(value))
    delta = regularisation * size
    data = np.zeros(len(factors.rows))
    for i in range(n + m):
        active[i] = not fixed[0][i] if i < n else rows[i - n]
        right[i] = sides[0][i] if i < n else sides[1][i - n]
        sign = 1.0 if i < n else -1.0
        exact[i] = 0.0 if active[i] else sign
        data[places.diagonal[i]] = sign * (delta if active[i] else 1.0)
    _switch_off(matrices, right, active, fixed[1])
    for j in range(n):
        for k in range(matrices.P_starts[j], matrices.P_starts[j + 1]):
            if places.P[k] >= 0:
                data[places.P[k]] = matrices.P[k]
            elif matrices.P_rows[k] == j:
                data[places.diagonal[j]] += matrices.P[k]
    for k in range(len(matrices.A)):
        data[places.A[k]] = matrices.A[k]
    positive = int(factorise(factors, data))
    if positive < 0 or not refined(matrices, factors, exact, right, found, _EXACT) < np.inf:
        return -1
    return positive


@njit(cache=True, error_model="numpy")
def _switch_off(
    matrices: SaddleMatrices, right: FloatArray, active: BoolArray, values: FloatArray
) -> None:
    """Take what is not active out of the matrices; q and targets become the right side."""
    n = len(values)
    taken = np.zeros(len(right))
    for j in range(n):
        value = 0.0 if active[j] else values[j]
        for k in range(matrices.P_starts[j], matrices.P_starts[j + 1]):
            i = matrices.P_rows[k]
            taken[i] += matrices.P[k] * value
            if not (active[i] and active[j]):
                matrices.P[k] = 0.0
        for k in range(matrices.A_starts[j], matrices.A_starts[j + 1]):
            i = n + matrices.A_rows[k]
            taken[i] += matrices.A[k] * value
            if not (active[i] and active[j]):
                matrices.A[k] = 0.0
    for j in range(n):
        right[j] = -(right[j] + taken[j]) if active[j] else values[j]
    for i in range(n, len(right)):
        right[i] = right[i] - taken[i] if active[i] else 0.0


@njit(cache=True, error_model="numpy")
def refined(
    matrices: SaddleMatrices,
    factors: Factors,
    exact: FloatArray,
    right: FloatArray,
    found: FloatArray,
    share: float,
) -> float:
    """The solution of the exact system by those of the shifted one.

    Args:
        matrices: of the exact one.
        factors: of the shifted one.
        exact: (n + m,) its diagonal but for P's own.
        right: (n + m,).
        found: (n + m,) the solution is written there.
        share: of the right side's size, but at least of one, that may be left.

    Returns:
        The share that is left; infinite where there is no finite solution.
    """
    if not len(right):
        return 0.0
    work, better = np.empty_like(right), np.empty_like(right)
    left, step = np.empty_like(right), np.empty_like(right)
    size_right = max(1.0, _largest(right))
    enough = share * size_right
    substitute(factors, right, better, work)
    before = np.inf
    for count in range(_REFINEMENTS + 1):
        _left(matrices, exact, right, better, left)
        size = _largest(left)
        if count == 0 and not np.isfinite(size):
            return np.inf
        if not size < before:
            break
        for i in range(len(found)):
            found[i] = better[i]
        before = size
        if size <= enough:
            break
        substitute(factors, left, step, work)
        for i in range(len(better)):
            better[i] += step[i]
    return before / size_right if np.isfinite(_largest(found)) else np.inf


@njit(cache=True, error_model="numpy")
def _largest(values: FloatArray) -> float:
    """Size of the largest entry; not a number where one is not finite."""
    # Loops, here and above: NumPy's expressions take ten times as long to compile.
    found = 0.0
    for value in values:
        if not np.isfinite(value):
            return np.nan
        found = max(found, abs(value))
    return found


@njit(cache=True, error_model="numpy")
def _left(
    matrices: SaddleMatrices,
    exact: FloatArray,
    right: FloatArray,
    found: FloatArray,
    left: FloatArray,
) -> None:
    """What is left of the right side, written to ``left``."""
    n = len(matrices.P_starts) - 1
    for i in range(len(left)):
        left[i] = 0.0
    for j in range(n):
        for k in range(matrices.P_starts[j], matrices.P_starts[j + 1]):
            left[matrices.P_rows[k]] += matrices.P[k] * found[j]
    for j in range(n):
        total = 0.0
        for k in range(matrices.A_starts[j], matrices.A_starts[j + 1]):
            i = n + matrices.A_rows[k]
            total += matrices.A[k] * found[i]
            left[i] += matrices.A[k] * found[j]
        left[j] += total
    for i in range(len(right)):
        left[i] = right[i] - (exact[i] * found[i] + left[i])
