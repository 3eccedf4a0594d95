"""Subproblems by Clarabel: interior point, accurate; symbolic work kept per sparsity pattern."""

from __future__ import annotations

from dataclasses import dataclass

import clarabel
import numpy as np
from scipy import sparse

from ...arrays import BoolArray, FloatArray, IntArray
from ..algebra.matrices import Sparsity
from .problem import QpSolution, QpStatus, QuadraticProgram, failed

_SOLVED = ("Solved", "AlmostSolved")
_INFEASIBLE = ("PrimalInfeasible", "AlmostPrimalInfeasible")
_UNBOUNDED = ("DualInfeasible", "AlmostDualInfeasible")


@dataclass(slots=True)
class _Layout:
    """How rows and bounds become cones: equalities first, then upper sides, then lower ones.

    Args:
        signature: which sides are there.
        matrix: the cones' rows; its data are replaced.
        take: which entry of (A's data, 1) each of its entries is.
        sign: of each entry.
        sides: index into (rows, bounds) of each cone row.
        row_sign: 1 for equalities and upper sides, -1 for lower ones.
        equalities: how many rows are.
    """

    signature: bytes
    matrix: sparse.csc_matrix
    take: IntArray
    sign: FloatArray
    sides: IntArray
    row_sign: FloatArray
    equalities: int


class ClarabelBackend:
    """Clarabel.

    Args:
        accuracy: tolerance on gap and feasibility.
    """

    name = "clarabel"
    worth = 30

    def __init__(self, accuracy: float = 1e-9) -> None:
        self._settings = clarabel.DefaultSettings()
        self._settings.verbose = False
        self._settings.presolve_enable = False
        self._settings.tol_gap_abs = accuracy
        self._settings.tol_gap_rel = accuracy
        self._settings.tol_feas = accuracy
        self._settings.max_iter = 200
        self._P: Sparsity | None = None
        self._A: Sparsity | None = None
        self._upper = np.zeros(0, dtype=np.int64)
        self._layout: _Layout | None = None
        self._solver: clarabel.DefaultSolver | None = None

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        """See `Backend.solve`; an interior point cannot use a guess."""
        lower = np.concatenate([qp.lower, qp.d_lower])
        upper = np.concatenate([qp.upper, qp.d_upper])
        layout = self._ready(qp, lower, upper)
        right = np.where(layout.row_sign > 0, upper[layout.sides], -lower[layout.sides])
        entries = np.append(qp.A.data, 1.0)
        data = layout.sign * entries[layout.take]
        if self._solver is None:
            layout.matrix.data = data
            cones = [clarabel.ZeroConeT(layout.equalities)] if layout.equalities else []
            rest = len(right) - layout.equalities
            if rest:
                cones.append(clarabel.NonnegativeConeT(rest))
            triangle = sparse.csc_matrix(sparse.triu(qp.P.scipy(), format="csc"))
            self._solver = clarabel.DefaultSolver(
                triangle, qp.q, layout.matrix, right, cones, self._settings
            )
        else:
            self._solver.update(P=qp.P.data[self._upper], q=qp.q, A=data, b=right)
        found = self._solver.solve()
        return self._solution(qp, layout, found)

    def _solution(
        self, qp: QuadraticProgram, layout: _Layout, found: clarabel.DefaultSolution
    ) -> QpSolution:
        name = str(found.status)
        d = np.array(found.x)
        if name in _INFEASIBLE:
            return failed(qp, QpStatus.INFEASIBLE)
        if name in _UNBOUNDED:
            return failed(qp, QpStatus.UNBOUNDED)
        if name not in _SOLVED or not np.isfinite(d).all():
            self._solver = None
            return failed(qp)
        multipliers = np.zeros(len(qp.lower) + len(qp.q))
        np.add.at(multipliers, layout.sides, layout.row_sign * np.array(found.z))
        rows = len(qp.lower)
        return QpSolution(QpStatus.SOLVED, d, multipliers[:rows], multipliers[rows:])

    def _ready(self, qp: QuadraticProgram, lower: FloatArray, upper: FloatArray) -> _Layout:
        equal = lower == upper
        below, above = np.isfinite(lower) & ~equal, np.isfinite(upper) & ~equal
        signature = np.packbits(np.concatenate([equal, above, below])).tobytes()
        patterns_hold = self._P is qp.P.pattern and self._A is qp.A.pattern
        if not patterns_hold:
            self._P, self._A = qp.P.pattern, qp.A.pattern
            self._upper = np.flatnonzero(self._P.rows <= self._P.columns)
        if not patterns_hold or self._layout is None or self._layout.signature != signature:
            self._layout = _make_layout(qp.A.pattern, equal, above, below, signature)
            self._solver = None
        return self._layout


def _make_layout(
    A: Sparsity, equal: BoolArray, above: BoolArray, below: BoolArray, signature: bytes
) -> _Layout:
    m, n = A.shape
    first = np.concatenate([np.flatnonzero(equal), np.flatnonzero(above)])
    second = np.flatnonzero(below)
    sides = np.concatenate([first, second])
    row_sign = np.concatenate([np.ones(len(first)), -np.ones(len(second))])
    # The rows of A, then those of the identity for the bounds.
    rows = np.concatenate([A.rows, m + np.arange(n)])
    columns = np.concatenate([A.columns, np.arange(n)])
    entries = np.minimum(np.arange(len(rows)), A.size)
    places, taken, across = [], [], []
    for chosen, offset in ((first, 0), (second, len(first))):
        place = np.full(m + n, -1)
        place[chosen] = offset + np.arange(len(chosen))
        kept = place[rows] >= 0
        places.append(place[rows[kept]])
        taken.append(entries[kept])
        across.append(columns[kept])
    down, right = np.concatenate(places), np.concatenate(across)
    order = np.lexsort((down, right))
    starts = np.searchsorted(right[order], np.arange(n + 1))
    take = np.concatenate(taken)[order]
    indices = down[order].astype(np.int32)
    matrix = sparse.csc_matrix(
        (np.ones(len(take)), indices, starts.astype(np.int32)), shape=(len(sides), n)
    )
    return _Layout(
        signature, matrix, take, row_sign[indices], sides, row_sign, int(np.count_nonzero(equal))
    )
