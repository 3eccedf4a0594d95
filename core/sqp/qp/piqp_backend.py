"""Subproblems by PIQP: a proximal interior point; an optional extra of the package."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...arrays import BoolArray
from ...errors import InputError
from ..algebra.matrices import SparseMatrix, Sparsity
from .problem import (
    QpSolution,
    QpStatus,
    QuadraticProgram,
    failed,
)

_INFINITY = 1e30


class PiqpBackend:
    """PIQP.

    Args:
        accuracy: absolute and relative tolerance.

    Raises:
        InputError: the package ``piqp`` is not installed.
    """

    name = "piqp"
    worth = 30

    def __init__(self, accuracy: float = 1e-9) -> None:
        try:
            self._module: Any = importlib.import_module("piqp")
        except ImportError:
            raise InputError(
                "the back end piqp needs the package piqp: install flyby[piqp]"
            ) from None
        self._accuracy = accuracy
        self._solver: Any = None
        self._P: Sparsity | None = None
        self._A: Sparsity | None = None
        self._equal: BoolArray = np.zeros(0, dtype=np.bool_)
        self._parts: list[sparse.csc_matrix] = []
        self._take: list[NDArray[np.int64]] = []

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        """See `Backend.solve`; an interior point cannot use a guess."""
        equal = qp.lower == qp.upper
        holds = self._solver is not None and self._holds(qp, equal)
        if not holds:
            self._remember(qp, equal)
        data = self._data(qp, equal)
        if holds:
            self._solver.update(**data)
        else:
            self._solver = self._module.SparseSolver()
            settings = self._solver.settings
            settings.eps_abs = settings.eps_rel = self._accuracy
            settings.eps_duality_gap_abs = settings.eps_duality_gap_rel = self._accuracy
            settings.verbose = False
            self._solver.setup(**data)
        status = self._solver.solve()
        module = self._module
        if status == module.PIQP_PRIMAL_INFEASIBLE:
            return failed(qp, QpStatus.INFEASIBLE)
        if status == module.PIQP_DUAL_INFEASIBLE:
            return failed(qp, QpStatus.UNBOUNDED)
        found = self._solver.result
        if status != module.PIQP_SOLVED or not np.isfinite(found.x).all():
            self._solver = None
            return failed(qp)
        y = np.zeros(len(qp.lower))
        y[equal] = found.y
        y[~equal] = found.z_u - found.z_l
        return QpSolution(QpStatus.SOLVED, np.array(found.x), y, found.z_bu - found.z_bl)

    def _holds(self, qp: QuadraticProgram, equal: BoolArray) -> bool:
        return (
            self._P is qp.P.pattern
            and self._A is qp.A.pattern
            and np.array_equal(self._equal, equal)
        )

    def _remember(self, qp: QuadraticProgram, equal: BoolArray) -> None:
        self._P, self._A, self._equal = qp.P.pattern, qp.A.pattern, equal
        numbers = np.arange(self._A.size, dtype=np.float64)
        by_row = SparseMatrix(self._A, numbers).scipy().tocsr()
        parts = (by_row[np.flatnonzero(equal)], by_row[np.flatnonzero(~equal)])
        self._parts = [sparse.csc_matrix(part) for part in parts]
        for part in self._parts:
            part.sort_indices()
        self._take = [part.data.astype(np.int64) for part in self._parts]

    def _data(self, qp: QuadraticProgram, equal: BoolArray) -> dict[str, object]:
        for part, take in zip(self._parts, self._take, strict=True):
            part.data = qp.A.data[take]
        free = ~equal
        return {
            "P": qp.P.scipy(),
            "c": qp.q,
            "A": self._parts[0],
            "b": qp.lower[equal],
            "G": self._parts[1],
            "h_l": np.maximum(qp.lower[free], -_INFINITY),
            "h_u": np.minimum(qp.upper[free], _INFINITY),
            "x_l": np.maximum(qp.d_lower, -_INFINITY),
            "x_u": np.minimum(qp.d_upper, _INFINITY),
        }
