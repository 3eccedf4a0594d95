"""The interior point's linear system: symbolic work once, one numeric factorisation an iteration.

    [ H + Σ + δ,  Aᵀ ] [ dx ]   with the slacks' rows eliminated: D = 1/(Σₛ + δ) where a row has
    [ A,         −D  ] [ dy ]   limits apart, 0 for an equality

Rows are measured in units of √(Σₛ + δ) where that is below one, so that a limit that is far away
leaves a row of size one and not one of 1e12. The factorisation adds a small multiple of the
identity of either sign, which makes it possible without pivoting; refinement takes it out again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray
from ..algebra.ldl import Factors, factorise
from ..algebra.linear import EntryIndices, SaddleMatrices, SaddlePattern, refined
from ..algebra.matrices import SparseMatrix, Sparsity
from .iterate import InteriorIterate, InteriorLimits

_REGULARISATION = 1e-10
_EXACT = 1e-12


class SystemWeights(NamedTuple):
    """What limits add to the system.

    Args:
        sigma: (n + m,) multiplier over distance of variables and slacks, and δ.
        units: (m,) of the rows.
        exact: (n + m,) the diagonal but for H's own.
    """

    sigma: FloatArray
    units: FloatArray
    exact: FloatArray


class BarrierSystem:
    """Systems of one pair of patterns.

    Args:
        pattern: of H and A.
        H, A: their places.
        held: (n,) variables that do not move; their entries are left out.
    """

    def __init__(self, pattern: SaddlePattern, H: Sparsity, A: Sparsity, held: BoolArray) -> None:
        self._pattern = pattern
        self._in_H = ~(held[H.rows] | held[H.columns]) if held.any() else None
        self._in_A = ~held[A.columns] if held.any() else None

    def factorise(
        self,
        H: SparseMatrix,
        A: SparseMatrix,
        at: InteriorIterate,
        box: InteriorLimits,
        shift: float,
        slack: float,
        relative: bool,
    ) -> int:
        """Factorise; the number of positive pivots, of which as many as variables are right. -1
        where a pivot is zero or not finite.

        Args:
            H: (n, n), both triangles.
            A: (m, n).
            shift: δ.
            slack: what is subtracted from the rows' diagonal, for rows that depend on each other.
            relative: whether δ counts in the size of each variable.
        """
        return self.factorise_weighted(H, A, weights_of(at, box, shift, slack, relative))

    def factorise_weighted(self, H: SparseMatrix, A: SparseMatrix, weights: SystemWeights) -> int:
        """The same with weights as given."""
        self.weights = weights
        in_H, rows = H.data, A.data * self.weights.units[A.pattern.rows]
        if self._in_H is not None and self._in_A is not None:
            in_H, rows = in_H * self._in_H, rows * self._in_A
        P, B = H.pattern, A.pattern
        self._matrices = SaddleMatrices(P.starts, P.rows, in_H, B.starts, B.rows, rows)
        factors, places = self._pattern.factors, self._pattern.places
        return int(_factorised(self._matrices, factors, places, self.weights.exact))

    def solve(
        self, slope: FloatArray, rest: FloatArray, box: InteriorLimits
    ) -> tuple[FloatArray, float]:
        """The steps of variables and multipliers (n + m,), and what is left of the right side
        beside its size.

        Args:
            slope: (n + m,) of the barrier's Lagrangian.
            rest: (m,) c − s.
        """
        right = right_side(self.weights, slope, rest, box)
        found = np.zeros_like(right)
        left = refined(
            self._matrices, self._pattern.factors, self.weights.exact, right, found, _EXACT
        )
        found[len(right) - len(rest) :] *= self.weights.units
        return found, float(left)


@njit(cache=True, error_model="numpy")
def weights_of(
    at: InteriorIterate, box: InteriorLimits, shift: float, slack: float, relative: bool
) -> SystemWeights:
    k, m = len(at.v), len(at.y)
    n = k - m
    sigma, exact, units = np.empty(k), np.zeros(k), np.ones(m)
    for j in range(k):
        sigma[j] = shift / max(1.0, abs(at.v[j])) ** 2 if relative else shift
        if box.held[j]:
            exact[j] = 1.0 if j < n else -slack
            continue
        if np.isfinite(box.lower[j]):
            sigma[j] += at.low[j] / (at.v[j] - box.lower[j])
        if np.isfinite(box.upper[j]):
            sigma[j] += at.high[j] / (box.upper[j] - at.v[j])
        if j < n:
            exact[j] = sigma[j]
        elif sigma[j] < 1.0:
            units[j - n] = np.sqrt(sigma[j])
            exact[j] = -1.0 - slack
        else:
            exact[j] = -1.0 / sigma[j] - slack
    return SystemWeights(sigma, units, exact)


@njit(cache=True, error_model="numpy")
def right_side(
    weights: SystemWeights, slope: FloatArray, rest: FloatArray, box: InteriorLimits
) -> FloatArray:
    right = np.empty(len(slope))
    n = len(slope) - len(rest)
    for j in range(n):
        right[j] = 0.0 if box.held[j] else -slope[j]
    for i in range(len(rest)):
        k, unit = n + i, weights.units[i]
        if box.held[k]:
            right[k] = -rest[i]
        elif unit < 1.0:
            right[k] = -unit * rest[i] - (slope[k] / unit if unit > 0.0 else 0.0)
        else:
            right[k] = -rest[i] - slope[k] / weights.sigma[k]
    return right


@njit(cache=True, error_model="numpy")
def _factorised(
    matrices: SaddleMatrices, factors: Factors, places: EntryIndices, exact: FloatArray
) -> int:
    n = len(matrices.P_starts) - 1
    delta = _REGULARISATION
    data = np.zeros(len(factors.rows))
    for i in range(len(exact)):
        data[places.diagonal[i]] = exact[i] + (delta if i < n else -delta)
    for j in range(n):
        for k in range(matrices.P_starts[j], matrices.P_starts[j + 1]):
            if places.P[k] >= 0:
                data[places.P[k]] = matrices.P[k]
            elif matrices.P_rows[k] == j:
                data[places.diagonal[j]] += matrices.P[k]
    for k in range(len(matrices.A)):
        data[places.A[k]] = matrices.A[k]
    return int(factorise(factors, data))
