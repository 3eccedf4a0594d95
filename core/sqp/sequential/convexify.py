"""Convex subproblems from indefinite Hessians.

QP back ends need a Hessian that is positive semidefinite everywhere; at a solution it need be so
only along the active constraints. Adding ρ aaᵀ for each constraint active in the subproblem
changes nothing there: with a·d = r at its solution, ρ/2 (a·d − r)² is zero with zero gradient. So
the step stays Newton's, and convergence fast. Only where that is not enough is the diagonal
raised.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ..algebra.linear import Definiteness
from ..algebra.matrices import SparseMatrix, Sparsity

_SLACK = 1e-9
"""Share of a row's size by which a Hessian may fall short of being semidefinite."""
_WEIGHTS = (10.0, 1e3, 1e5)
_FIRST_SHARE = 1e-3
_GROW, _SHRINK = 3.0, 9.0
_DENSE_ROW = 60
"""Entries of a row from which on its outer product is not formed in large problems."""


@dataclass(slots=True)
class ActiveSet:
    """What is expected to hold as an equality after the step.

    Args:
        rows: (m,) constraints.
        row_change: (m,) J d there.
        side: (m,) 1 where they are held from above, -1 from below, 0 for equalities.
        variables: (n,) variables on their bounds.
    """

    rows: BoolArray
    row_change: FloatArray
    side: FloatArray
    variables: BoolArray


@dataclass(slots=True)
class ConvexModel:
    """A convex stand-in for H, q.

    Args:
        P: (n, n), positive semidefinite.
        q: (n,) its gradient.
        weights: (m,) ρ of the rows.
        active: the guess that they rest on.
        curved: whether H itself is semidefinite, and has an entry in every row.
    """

    P: SparseMatrix
    q: FloatArray
    weights: FloatArray
    active: ActiveSet
    curved: bool

    def multipliers(self, y: FloatArray, change: FloatArray) -> FloatArray:
        """Multipliers (m,) of the model with H from those with P: ρ (a·d − r) more, which is zero
        for rows that are active as expected. Rows that would push the wrong way, or beyond all
        others, are not active.

        Args:
            y: (m,).
            change: (m,) J d.
        """
        pull = self.weights * (change - self.active.row_change)
        wrong = (y + pull) * self.active.side < 0
        far = np.abs(pull) > max(1.0, float(np.abs(y).max(initial=0.0)))
        return np.where(wrong | far, y, y + pull)


class Convexifier:
    """Makes Hessians convex, and remembers what it took.

    Attributes:
        shift: the largest amount by which the last diagonal was raised.
    """

    def __init__(self) -> None:
        self._plain = _Sum()
        self._weighted = _Sum()
        self.forget()

    def forget(self) -> None:
        """Begin a solution: what it took so far does not count."""
        self.shift = 0.0
        self._last_share = 0.0
        self._level = 0

    def convex(
        self, H: SparseMatrix, q: FloatArray, J: SparseMatrix, active: ActiveSet
    ) -> ConvexModel:
        """A convex model of H, q.

        Args:
            H: (n, n), symmetric.
            q: (n,) gradient of the objective.
            J: (m, n).
            active: the guess.
        """
        scale = H.largest()
        self.shift = 0.0
        sums = _row_sums(H)
        slack = _SLACK * np.where(sums > 0, sums, scale)
        P = self._plain.of(H, None, 0.0)
        if scale == 0.0 or self._plain.definite(self._plain.raised(P, slack)):
            curved = bool((sums > 0.0).all())
            return ConvexModel(P, q, np.zeros(len(active.rows)), active, curved)
        for level in range(self._level, len(_WEIGHTS)):
            weights = _row_weights(J, active, _WEIGHTS[level] * scale)
            P = self._of_active(H, J, weights, active, _WEIGHTS[level] * scale, slack)
            if self._weighted.definite(P):
                self._level = level
                return _model(P, q, J, weights, active)
        self._level = 0
        return _model(self._raised(self._weighted, P, sums), q, J, weights, active)

    def cautious(self, H: SparseMatrix, q: FloatArray, active: ActiveSet) -> ConvexModel:
        """A convex model by the diagonal alone, which expects nothing to be active: its step
        descends from a feasible point, whatever the guess was worth.

        Args:
            H: (n, n), symmetric.
            q: (n,) gradient of the objective.
            active: the guess that is not to count.
        """
        P = self._raised(self._plain, self._plain.of(H, None, 0.0), _row_sums(H))
        return ConvexModel(P, q, np.zeros(len(active.rows)), active, False)

    def _of_active(
        self,
        H: SparseMatrix,
        J: SparseMatrix,
        weights: FloatArray,
        active: ActiveSet,
        weight: float,
        slack: FloatArray,
    ) -> SparseMatrix:
        diagonal = np.where(active.variables, weight, 0.0) + slack
        return self._weighted.of(H, J, diagonal, weights)

    def _raised(self, total: _Sum, P: SparseMatrix, sums: FloatArray) -> SparseMatrix:
        """P with a raised diagonal, each entry in proportion to the size of its row of H.

        A Hessian whose negative curvature sits in the coupling of one variable with many others (a
        final time, say) would need a large multiple of the identity; of its rows' sums a share
        of one is always enough.
        """
        share = max(_FIRST_SHARE, self._last_share / _SHRINK)
        while True:
            found = total.raised(P, share * sums)
            if share >= 1.0 or total.definite(found):
                break
            share = min(1.0, share * _GROW)
        self._last_share = share
        self.shift = share * float(sums.max())
        return found


def _row_sums(H: SparseMatrix) -> FloatArray:
    """Sum of the sizes of each row's entries (n,)."""
    sums = np.zeros(H.shape[0])
    np.add.at(sums, H.pattern.rows, np.abs(H.data))
    return sums


def _row_weights(J: SparseMatrix, active: ActiveSet, weight: float) -> FloatArray:
    """ρ of each row, so that rows of any size count alike; zero for inactive ones."""
    if not J.shape[0]:
        return np.zeros(0)
    squares = np.bincount(J.pattern.rows, J.data**2, minlength=J.shape[0])
    return np.where(active.rows, weight / np.maximum(squares, 1e-24), 0.0)


def _model(
    P: SparseMatrix, q: FloatArray, J: SparseMatrix, weights: FloatArray, active: ActiveSet
) -> ConvexModel:
    pulled = J.transposed_times(weights * active.row_change) if len(weights) else 0.0
    return ConvexModel(P, q - pulled, weights, active, False)


def raised(P: SparseMatrix, diagonal: FloatArray) -> SparseMatrix:
    """P, which stores its diagonal, with this (n,) added to it."""
    pattern = P.pattern
    return SparseMatrix(
        pattern, P.data + np.where(pattern.rows == pattern.columns, diagonal[pattern.rows], 0.0)
    )


class _Sum:
    """H + Jᵀ diag(w) J + diag(v) of fixed patterns, as data moved to known places."""

    def __init__(self) -> None:
        self._H: Sparsity | None = None
        self._J: Sparsity | None = None
        self.definite = Definiteness().holds

    def of(
        self,
        H: SparseMatrix,
        J: SparseMatrix | None,
        diagonal: FloatArray | float,
        weights: FloatArray | None = None,
    ) -> SparseMatrix:
        """The sum."""
        if self._H is not H.pattern or (J is not None and self._J is not J.pattern):
            self._remember(H.pattern, None if J is None else J.pattern)
        data = np.zeros(self._pattern.size)
        data[self._h_places] = H.data
        data[self._diagonal] += diagonal
        if J is not None and weights is not None and len(self._places):
            entries = J.data
            products = weights[self._rows] * entries[self._first] * entries[self._second]
            data += np.bincount(self._places, products, minlength=len(data))
        return SparseMatrix(self._pattern, data)

    def raised(self, P: SparseMatrix, diagonal: FloatArray | float) -> SparseMatrix:
        """A sum with a raised diagonal."""
        data = P.data.copy()
        data[self._diagonal] += diagonal
        return SparseMatrix(self._pattern, data)

    def _remember(self, H: Sparsity, J: Sparsity | None) -> None:
        self._H, self._J = H, J
        n = H.shape[0]
        none = np.zeros(0, dtype=np.int64)
        h_keys = H.columns * n + H.rows
        diagonal = np.arange(n, dtype=np.int64) * (n + 1)
        self._rows, self._first, self._second = (none, none, none) if J is None else _pairs(J)
        products = none if J is None else J.columns[self._first] * n + J.columns[self._second]
        if H.full:  # keys are places
            self._pattern = H
            self._h_places, self._diagonal, self._places = h_keys, diagonal, products
            return
        union = np.unique(np.concatenate([h_keys, diagonal, products]))
        starts = np.searchsorted(union // n, np.arange(n + 1))
        self._pattern = Sparsity((n, n), union % n, starts)
        self._h_places, self._diagonal, self._places = (
            np.searchsorted(union, keys) for keys in (h_keys, diagonal, products)
        )


def _pairs(J: Sparsity) -> tuple[IntArray, IntArray, IntArray]:
    """All pairs of entries that stand in one row: row, first and second entry of J's data."""
    order = np.lexsort((J.columns, J.rows))
    counts = np.bincount(J.rows, minlength=J.shape[0])
    if J.shape[1] > 4 * _DENSE_ROW:
        kept = counts[J.rows[order]] <= _DENSE_ROW
        order = order[kept]
        counts = np.where(counts <= _DENSE_ROW, counts, 0)
    starts = np.concatenate([[0], np.cumsum(counts)])
    per_entry = np.repeat(counts, counts)
    first = np.repeat(np.arange(len(order)), per_entry)
    rows = np.repeat(np.arange(J.shape[0]), counts**2)
    within = np.arange(len(first)) - np.repeat(
        np.concatenate([[0], np.cumsum(per_entry)[:-1]]) if len(per_entry) else [], per_entry
    ).astype(np.int64)
    second = starts[rows] + within
    return rows, order[first], order[second]
