"""Subproblems by OSQP: first order (ADMM), warm started, set up once per sparsity pattern."""

from __future__ import annotations

import numpy as np
import osqp
from scipy import sparse

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix, Sparsity
from .problem import QpSolution, QpStatus, QuadraticProgram, failed

_INFINITY = 1e30
_LEAST_ITERATIONS, _WORK = 2000, 4_000_000
"""Iterations, and their number times rows and variables, after which a subproblem is not worth
more: those of large problems cost as much as an iteration of another method."""
_STATUS = {
    "solved": QpStatus.SOLVED,
    "solved inaccurate": QpStatus.INEXACT,
    "maximum iterations reached": QpStatus.INEXACT,
    "primal infeasible": QpStatus.INFEASIBLE,
    "dual infeasible": QpStatus.UNBOUNDED,
}


class OsqpBackend:
    """OSQP.

    Args:
        accuracy: absolute and relative tolerance of its residuals.
        iterations: at most, per subproblem; fewer for large ones.
    """

    name = "osqp"
    worth = 30

    def __init__(self, accuracy: float = 1e-8, iterations: int = 20_000) -> None:
        self._accuracy = accuracy
        self._iterations = iterations
        self._solver: osqp.OSQP | None = None
        self._P: Sparsity | None = None
        self._A: Sparsity | None = None
        self._upper = np.zeros(0, dtype=np.int64)
        self._rows = np.zeros(0, dtype=np.int64)
        self._stacked: sparse.csc_matrix | None = None

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        """See `Backend.solve`."""
        lower = np.clip(np.concatenate([qp.lower, qp.d_lower]), -_INFINITY, _INFINITY)
        upper = np.clip(np.concatenate([qp.upper, qp.d_upper]), -_INFINITY, _INFINITY)
        try:
            solver = self._ready(qp, lower, upper)
        except (osqp.OSQPException, ValueError):
            self._solver = None  # P is indefinite by rounding, or numbers are too large
            return failed(qp)
        if warm is not None:
            solver.warm_start(x=warm.d, y=np.concatenate([warm.y, warm.z]))
        found = solver.solve(raise_error=False)
        status = _STATUS.get(found.info.status, QpStatus.FAILED)
        solved = status in (QpStatus.SOLVED, QpStatus.INEXACT)
        if not solved or found.x is None or not np.isfinite(found.x).all():
            self._solver = None  # what it carries over would spoil the next one
            return failed(qp, QpStatus.FAILED if solved else status)
        rows = len(qp.lower)
        return QpSolution(status, np.array(found.x), found.y[:rows].copy(), found.y[rows:].copy())

    def _ready(self, qp: QuadraticProgram, lower: FloatArray, upper: FloatArray) -> osqp.OSQP:
        """The solver with the data of ``qp``: updated where the pattern holds, else set up."""
        holds = self._solver is not None and self._P is qp.P.pattern and self._A is qp.A.pattern
        if not holds:
            self._remember(qp)
        assert self._stacked is not None
        self._stacked.data[self._rows] = qp.A.data
        if holds:
            assert self._solver is not None
            self._solver.update(
                q=qp.q, l=lower, u=upper, Px=qp.P.data[self._upper], Ax=self._stacked.data
            )
            return self._solver
        self._solver = osqp.OSQP()
        self._solver.setup(
            sparse.csc_matrix(sparse.triu(qp.P.scipy(), format="csc")),
            qp.q,
            self._stacked,
            lower,
            upper,
            verbose=False,
            eps_abs=self._accuracy,
            eps_rel=self._accuracy,
            eps_prim_inf=1e-8,
            eps_dual_inf=1e-8,
            max_iter=max(_LEAST_ITERATIONS, min(self._iterations, _WORK // len(lower))),
            polishing=False,
            check_termination=10,
            warm_starting=True,
        )
        return self._solver

    def _remember(self, qp: QuadraticProgram) -> None:
        """Where the entries of P and A go."""
        n = len(qp.q)
        self._P, self._A = qp.P.pattern, qp.A.pattern
        self._upper = np.flatnonzero(self._P.rows <= self._P.columns)
        marked = SparseMatrix(self._A, np.arange(1.0, self._A.size + 1)).scipy()
        unit = sparse.csc_array(sparse.eye_array(n, format="csc")) * -1.0
        stacked = sparse.csc_matrix(sparse.vstack([marked, unit], format="csc"))
        stacked.sort_indices()
        self._rows = np.flatnonzero(stacked.data > 0)
        assert np.array_equal(stacked.data[self._rows], marked.data)
        stacked.data[stacked.data < 0] = 1.0
        self._stacked = stacked
