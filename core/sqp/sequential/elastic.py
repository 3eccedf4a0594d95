"""Subproblems whose constraints may be violated at a price, for linearisations that contradict
each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..algebra.matrices import SparseMatrix, Sparsity
from ..qp.problem import QpSolution, QpStatus, QuadraticProgram
from ..qp.subproblems import Subproblems


class Elastic:
    """Solves elastic subproblems: minimise the objective of one plus a price times the sum of its
    rows' violations, the bounds on d kept.

    Args:
        subproblems: the back ends.
    """

    def __init__(self, subproblems: Subproblems) -> None:
        self._subproblems = subproblems
        self._P: Sparsity | None = None
        self._A: Sparsity | None = None

    def solve(self, qp: QuadraticProgram, price: float) -> QpSolution:
        """The solution's y are the multipliers with which rows push, at most ``price``."""
        if self._P is not qp.P.pattern or self._A is not qp.A.pattern:
            self._remember(qp.P.pattern, qp.A.pattern)
        m, n = qp.A.shape
        ones = np.ones(m)
        whole = replace(
            qp,
            P=SparseMatrix(self._whole_P, qp.P.data),
            q=np.concatenate([qp.q, np.full(2 * m, price)]),
            A=SparseMatrix(self._whole_A, np.concatenate([qp.A.data, ones, -ones])),
            d_lower=np.concatenate([qp.d_lower, np.zeros(2 * m)]),
            d_upper=np.concatenate([qp.d_upper, np.full(2 * m, np.inf)]),
        )
        found = self._subproblems.solve(whole)
        if found.status is not QpStatus.SOLVED:
            return QpSolution(found.status, np.zeros(n), np.zeros(m), np.zeros(n))
        d = np.clip(found.d[:n], qp.d_lower, qp.d_upper)
        return QpSolution(QpStatus.SOLVED, d, found.y, found.z[:n])

    def _remember(self, P: Sparsity, A: Sparsity) -> None:
        """The patterns with two slacks more for each row."""
        self._P, self._A = P, A
        m, n = A.shape
        ends = np.full(2 * m, P.size)
        self._whole_P = Sparsity((n + 2 * m, n + 2 * m), P.rows, np.concatenate([P.starts, ends]))
        slacks = np.arange(m)
        rows = np.concatenate([A.rows, slacks, slacks])
        starts = np.concatenate([A.starts, A.size + 1 + np.arange(2 * m)])
        self._whole_A = Sparsity((m, n + 2 * m), rows, starts)
