"""Subproblems by an interior point of our own, compiled, on our own LDLᵀ factorisation.

What depends on the patterns only (ordering, elimination tree, places) is worked out once for each
pair of patterns; a subproblem is then one call of compiled code. A guess of the multipliers, which
each iteration of the outer method has, saves a part of the iterations.
"""

from __future__ import annotations

import numpy as np

from ..algebra.linear import SaddlePatterns
from .interior_point_kernels import (
    FAILED,
    INEXACT,
    INFEASIBLE,
    SOLVED,
    UNBOUNDED,
    minimise,
)
from .interior_point_scaling import Data, contradictory, scaled
from .problem import QpSolution, QpStatus, QuadraticProgram, failed

_STATUS = {
    SOLVED: QpStatus.SOLVED,
    INEXACT: QpStatus.INEXACT,
    INFEASIBLE: QpStatus.INFEASIBLE,
    UNBOUNDED: QpStatus.UNBOUNDED,
    FAILED: QpStatus.FAILED,
}
_NO_GUESS = np.zeros(0)


class InteriorPointBackend:
    """The interior point.

    Args:
        accuracy: of residuals and of products of slack and multiplier, in proportion to the size of
            values and multipliers.
        iterations: at most.

    Attributes:
        taken: iterations of the last subproblem.
    """

    name = "interior_point"
    worth = 30

    def __init__(self, accuracy: float = 1e-9, iterations: int = 60) -> None:
        self._accuracy = accuracy
        self._iterations = iterations
        self._patterns = SaddlePatterns()
        self.taken = 0

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        """See `Backend.solve`; of a guess, the multipliers count."""
        data = Data(
            qp.P.pattern.starts,
            qp.P.pattern.rows,
            qp.P.data,
            qp.q,
            qp.A.pattern.starts,
            qp.A.pattern.rows,
            qp.A.data,
            qp.lower,
            qp.upper,
            qp.d_lower,
            qp.d_upper,
        )
        self.taken = 0
        if contradictory(data):
            return failed(qp, QpStatus.INFEASIBLE)
        pattern = self._patterns.of(qp.P.pattern, qp.A.pattern)
        problem = scaled(data)
        n, m = len(qp.q), len(qp.lower)
        unit = problem.cost * problem.unit
        guess = _NO_GUESS if warm is None else unit * np.concatenate([warm.z, warm.y])
        d, y = np.zeros(n), np.zeros(n + m)
        for begin in (guess, _NO_GUESS) if len(guess) else (_NO_GUESS,):
            code, taken = minimise(
                problem,
                pattern.factors,
                pattern.places,
                begin,
                self._accuracy,
                self._iterations,
                d,
                y,
            )
            self.taken += taken
            status = _STATUS[code]
            if status not in (QpStatus.FAILED, QpStatus.INEXACT):
                break
        if status not in (QpStatus.SOLVED, QpStatus.INEXACT):
            return failed(qp, status)
        d = np.where(problem.fixed, problem.value, d * problem.unit[:n])
        multipliers = y / unit
        rows, bounds = multipliers[n:], multipliers[:n]
        if problem.fixed.any():
            slope = qp.P @ d + qp.q + qp.A.transposed_times(rows)
            bounds = np.where(problem.fixed, -slope, bounds)
        return QpSolution(status, d, rows, bounds)
