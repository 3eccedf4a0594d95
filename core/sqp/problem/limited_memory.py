"""Limited-memory BFGS in compact form: a multiple of the identity and a few columns.

    B = σ I − W M⁻¹ Wᵀ,   W = [σ S, Y],   M = [ σ SᵀS,  L ]
                                              [ Lᵀ,    −D ]

S and Y (n, k) are the last steps and what the Lagrangian's slope changed by along them, D the
diagonal of SᵀY and L what is below it (Byrd, Nocedal and Schnabel, "Representations of quasi-Newton
matrices and their use in limited memory methods", 1994). Powell's damping keeps B definite.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..algebra.matrices import LowRankSum, SparseMatrix, identity
from .damped_update import observed
from .evaluation import Point

_MEMORY = 12
_LEAST, _LARGEST = 1e-8, 1e8
"""Range of σ."""


class LimitedMemory:
    """The Lagrangian's Hessian as the last steps show it.

    Args:
        n: number of variables.
    """

    measured = False

    def __init__(self, n: int) -> None:
        self._pattern = identity(n)
        self._sigma = 1.0
        self._steps: list[FloatArray] = []
        self._changes: list[FloatArray] = []

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        """(n, n), a sum of σ I and what is of low rank."""
        diagonal = SparseMatrix(self._pattern, np.full(self._pattern.size, self._sigma))
        if not self._steps:
            return diagonal
        return LowRankSum(diagonal, *self._compact())

    def _compact(self) -> tuple[FloatArray, FloatArray]:
        """W (n, 2 k) and −M (2 k, 2 k)."""
        S, Y = np.array(self._steps).T, np.array(self._changes).T
        SY = S.T @ Y
        lower, diagonal = np.tril(SY, -1), np.diag(np.diag(SY))
        M = np.block([[self._sigma * (S.T @ S), lower], [lower.T, -diagonal]])
        return np.hstack([self._sigma * S, Y]), -M

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        """A step was taken."""
        step = observed(old, new, multipliers)
        if step is None:
            return
        if not self._steps and step.curvature > 0.0:
            self._sigma = min(max(step.curvature / step.size, _LEAST), _LARGEST)
        r = step.damped(self._times(step.s))
        if r is None:
            return
        self._steps = [*self._steps[1 - _MEMORY :], step.s]
        self._changes = [*self._changes[1 - _MEMORY :], r]
        self._sigma = min(max(float(step.s @ r) / step.size, _LEAST), _LARGEST)

    def _times(self, s: FloatArray) -> FloatArray:
        """B s (n,)."""
        if not self._steps:
            return self._sigma * s
        W, negative = self._compact()
        return np.asarray(self._sigma * s + W @ np.linalg.solve(negative, W.T @ s))

    def restart(self, diagonal: FloatArray) -> None:
        """Forget all steps; a positive diagonal (n,) says how large curvatures are."""
        self._sigma = min(max(float(np.median(diagonal)), _LEAST), _LARGEST)
        self._steps, self._changes = [], []
