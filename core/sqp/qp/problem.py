"""The quadratic subproblem, and what a back end is.

    minimise ½ d·P d + q·d   subject to   lower ≤ A d ≤ upper,   d_lower ≤ d ≤ d_upper

with P positive semidefinite. Multipliers have the signs of the NLP's: at a solution
P d + q + Aᵀ y + z = 0, with y, z ≥ 0 at upper and ≤ 0 at lower bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import Protocol

import numpy as np

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix


class QpStatus(Enum):
    """How a subproblem ended."""

    SOLVED = auto()
    INEXACT = auto()
    """The back end gave up short of its tolerance; its active set may still be the right one."""
    INFEASIBLE = auto()
    UNBOUNDED = auto()
    FAILED = auto()


@dataclass(slots=True)
class QuadraticProgram:
    """A subproblem. P and A keep their sparsity pattern from one to the next.

    Args:
        P: (n, n), both triangles.
        q: (n,).
        A: (m, n).
        lower, upper: (m,).
        d_lower, d_upper: (n,).
    """

    P: SparseMatrix
    q: FloatArray
    A: SparseMatrix
    lower: FloatArray
    upper: FloatArray
    d_lower: FloatArray
    d_upper: FloatArray


@dataclass(slots=True)
class QpSolution:
    """A solution.

    Args:
        status: how it ended; the rest only counts if it was solved.
        d: (n,).
        y: (m,) multipliers of the rows.
        z: (n,) multipliers of the bounds.
    """

    status: QpStatus
    d: FloatArray
    y: FloatArray
    z: FloatArray


class Backend(Protocol):
    """Solves subproblems one after the other, and keeps what it can between them.

    Attributes:
        name: of the back end.
        worth: linear systems that may be solved to save asking it, from a guess of what is active.
    """

    name: str
    worth: int

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        """The solution of ``qp``.

        Args:
            warm: a guess, for back ends that can use one.
        """
        ...


def failed(qp: QuadraticProgram, status: QpStatus = QpStatus.FAILED) -> QpSolution:
    """No solution."""
    return QpSolution(status, np.zeros(len(qp.q)), np.zeros(len(qp.lower)), np.zeros(len(qp.q)))


def in_units(qp: QuadraticProgram, unit: float) -> QuadraticProgram:
    """The subproblem of d / unit with its objective divided by unit; the multipliers stay."""
    return QuadraticProgram(
        SparseMatrix(qp.P.pattern, qp.P.data * unit),
        qp.q,
        qp.A,
        qp.lower / unit,
        qp.upper / unit,
        qp.d_lower / unit,
        qp.d_upper / unit,
    )
