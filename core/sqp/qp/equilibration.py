"""Subproblems in units that make their matrices' rows alike.

Variables and rows of sizes far apart cost back ends and the regularised systems of `linear` their
accuracy. Ruiz's scaling ("A scaling algorithm to equilibrate both rows and columns norms in
matrices", 2001) of [P, Aᵀ; A, 0] brings the largest entry of every row and column near to 1; its
factors are rounded to powers of two, so that no number is rounded by it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ..algebra.matrices import SparseMatrix
from .problem import QpSolution, QuadraticProgram

_SWEEPS = 4
_FAR_APART = 1e4
"""Ratio of rows' sizes up to which a subproblem stays as it is."""
_ROUNDING = 1e-14
"""Share of a column's largest entry below which a row's entry counts as none: what rounding leaves
of a row that is zero would else be blown up, and its sides with it."""


@dataclass(slots=True)
class Units:
    """Units of a subproblem.

    Args:
        variables: (n,) d = variables times the scaled one.
        rows: (m,) likewise of the multipliers; the scaled rows are rows times the unscaled ones.
    """

    variables: FloatArray
    rows: FloatArray

    def scaled(self, qp: QuadraticProgram) -> QuadraticProgram:
        """The subproblem in these units."""
        d, e, P, A = self.variables, self.rows, qp.P, qp.A
        return QuadraticProgram(
            SparseMatrix(P.pattern, P.data * d[P.pattern.rows] * d[P.pattern.columns]),
            qp.q * d,
            SparseMatrix(A.pattern, A.data * e[A.pattern.rows] * d[A.pattern.columns]),
            qp.lower * e,
            qp.upper * e,
            qp.d_lower / d,
            qp.d_upper / d,
        )

    def scaled_guess(self, warm: QpSolution | None) -> QpSolution | None:
        """A guess in these units."""
        if warm is None:
            return None
        d, e = self.variables, self.rows
        return replace(warm, d=warm.d / d, y=warm.y / e, z=warm.z * d)

    def unscaled(self, found: QpSolution) -> QpSolution:
        """A solution in these units, as one of the subproblem itself."""
        d, e = self.variables, self.rows
        return replace(found, d=found.d * d, y=found.y * e, z=found.z / d)


def units_of(qp: QuadraticProgram) -> Units | None:
    """Units that make rows alike; None where they are already."""
    P, A = np.abs(qp.P.data), np.abs(qp.A.data)
    d, e = np.ones(len(qp.q)), np.ones(len(qp.lower))
    columns, _ = _largest(qp, P, A, d, e)
    least = _ROUNDING * columns[qp.A.pattern.columns]
    A = np.where(least < A, A, 0.0)
    for sweep in range(_SWEEPS):
        columns, rows = _largest(qp, P, A, d, e)
        if sweep == 0 and _alike(np.concatenate([columns, rows])):
            return None
        d *= _roots(columns)
        e *= _roots(rows)
    return Units(np.exp2(np.rint(np.log2(d))), np.exp2(np.rint(np.log2(e))))


def _largest(
    qp: QuadraticProgram, P: FloatArray, A: FloatArray, d: FloatArray, e: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The largest entries of the columns of P and A (n,) and of the rows of A (m,), scaled."""
    of_P, of_A = qp.P.pattern, qp.A.pattern
    columns, rows = np.zeros(len(d)), np.zeros(len(e))
    _raise_to_largest(of_P.starts, of_P.rows, P, d, d, columns, np.zeros(len(d)))
    _raise_to_largest(of_A.starts, of_A.rows, A, e, d, columns, rows)
    return columns, rows


@njit(cache=True, error_model="numpy")
def _raise_to_largest(
    starts: IntArray,
    rows: IntArray,
    data: FloatArray,
    of_rows: FloatArray,
    of_columns: FloatArray,
    columns: FloatArray,
    across: FloatArray,
) -> None:
    """Raise what is known of a matrix's columns, and of its rows (``across``), to its largest
    entries, scaled."""
    for j in range(len(columns)):
        for k in range(starts[j], starts[j + 1]):
            size = data[k] * of_rows[rows[k]] * of_columns[j]
            columns[j] = max(columns[j], size)
            across[rows[k]] = max(across[rows[k]], size)


def _alike(sizes: FloatArray) -> bool:
    there = sizes[sizes > 0]
    return len(there) == 0 or float(there.max()) <= _FAR_APART * float(there.min())


def _roots(sizes: FloatArray) -> FloatArray:
    return 1.0 / np.sqrt(np.where(sizes > 0, sizes, 1.0))
