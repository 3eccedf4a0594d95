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
from ..algebra.matrices import LowRankSum, SparseMatrix, Sparsity
from .direction import FirstDerivatives, barrier_slopes, step_from
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


class LowRank(NamedTuple):
    """What of the Hessian is beside the factorised matrix, W C⁻¹ Wᵀ (Woodbury's formula).

    Args:
        wide: W (n + m, r).
        solved: (n + m, r) solutions of the factorised system for its columns.
        inverse: (r, r) of C + Wᵀ K⁻¹ W.
    """

    wide: FloatArray
    solved: FloatArray
    inverse: FloatArray


_NOTHING = LowRank(*(np.zeros((0, 0)) for _ in range(3)))


class BarrierSystem:
    """Systems of one pair of patterns.

    Args:
        pattern: of H and A.
        H, A: their places.
        held: (n,) variables that do not move; their entries are left out.
    """

    def __init__(self, pattern: SaddlePattern, H: Sparsity, A: Sparsity, held: BoolArray) -> None:
        self._pattern = pattern
        self._held = held
        data = np.zeros(H.size), np.zeros(A.size)
        self._matrices = SaddleMatrices(H.starts, H.rows, data[0], A.starts, A.rows, data[1])

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
        weights = weights_of(at, box, shift, slack, relative)
        return self.factorise_weighted(H, A, SystemWeights(*weights))

    def factorise_weighted(self, H: SparseMatrix, A: SparseMatrix, weights: SystemWeights) -> int:
        """The same with weights as given."""
        self.weights = weights
        self._beside = _NOTHING
        factors, places = self._pattern.factors, self._pattern.places
        positive = int(
            _factorised(self._matrices, H.data, A.data, self._held, factors, places, weights)
        )
        if isinstance(H, LowRankSum) and positive >= 0:
            self._beside = self._of_low_rank(H)
        return positive

    def _of_low_rank(self, H: LowRankSum) -> LowRank:
        """What takes H's part of low rank into account, by Woodbury's formula."""
        wide = np.zeros((len(self.weights.exact), H.wide.shape[1]))
        wide[: len(H.wide)] = np.where(self._held[:, None], 0.0, H.wide)
        solved = np.empty_like(wide)
        _columns(self._matrices, self._pattern.factors, self.weights.exact, wide, solved)
        inverse = np.asarray(np.linalg.inv(H.middle + wide.T @ solved), np.float64)
        return LowRank(wide, solved, inverse)

    def solve(
        self, slope: FloatArray, rest: FloatArray, box: InteriorLimits
    ) -> tuple[FloatArray, float]:
        """The steps of variables and multipliers (n + m,), and what is left of the right side
        beside its size.

        Args:
            slope: (n + m,) of the barrier's Lagrangian.
            rest: (m,) c − s.
        """
        factors, beside = self._pattern.factors, self._beside
        found, left = _solved(self._matrices, factors, self.weights, beside, slope, rest, box)
        return found, float(left)

    def step(
        self,
        at: InteriorIterate,
        box: InteriorLimits,
        derivatives: FirstDerivatives,
        slopes: FloatArray,
        rest: FloatArray,
        mu: float,
    ) -> tuple[InteriorIterate, float, float]:
        """Newton's step for the barrier's problem, the slope of objective and barrier along it, and
        what is left of the right side.

        Args:
            slopes: (n + m,) of the Lagrangian without the barrier.
            rest: (m,) c − s.
        """
        factors = self._pattern.factors
        *parts, along, left = _stepped(
            *(self._matrices, factors, self.weights, self._beside),
            *(at, box, derivatives, slopes, rest, mu),
        )
        return InteriorIterate(*parts), float(along), float(left)


@njit(cache=True, error_model="numpy")
def weights_of(
    at: InteriorIterate, box: InteriorLimits, shift: float, slack: float, relative: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """What `SystemWeights` takes."""
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
    return sigma, units, exact


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
    matrices: SaddleMatrices,
    H: FloatArray,
    A: FloatArray,
    held: BoolArray,
    factors: Factors,
    places: EntryIndices,
    weights: SystemWeights,
) -> int:
    """See `BarrierSystem.factorise`; the matrices are overwritten."""
    n = len(matrices.P_starts) - 1
    delta = _REGULARISATION
    data = np.zeros(len(factors.rows))
    for i in range(len(weights.exact)):
        data[places.diagonal[i]] = weights.exact[i] + (delta if i < n else -delta)
    for j in range(n):
        for k in range(matrices.P_starts[j], matrices.P_starts[j + 1]):
            i = matrices.P_rows[k]
            matrices.P[k] = 0.0 if held[i] or held[j] else H[k]
            if places.P[k] >= 0:
                data[places.P[k]] = matrices.P[k]
            elif i == j:
                data[places.diagonal[j]] += matrices.P[k]
        for k in range(matrices.A_starts[j], matrices.A_starts[j + 1]):
            matrices.A[k] = 0.0 if held[j] else A[k] * weights.units[matrices.A_rows[k]]
            data[places.A[k]] = matrices.A[k]
    return int(factorise(factors, data))


@njit(cache=True, error_model="numpy")
def _columns(
    matrices: SaddleMatrices,
    factors: Factors,
    exact: FloatArray,
    wide: FloatArray,
    solved: FloatArray,
) -> None:
    """Solutions for each column of ``wide`` (n + m, r), written to ``solved``."""
    found = np.zeros(len(wide))
    for k in range(wide.shape[1]):
        refined(matrices, factors, exact, wide[:, k].copy(), found, _EXACT)
        solved[:, k] = found


@njit(cache=True, error_model="numpy")
def _corrected(beside: LowRank, found: FloatArray) -> None:
    """From the solution without what is of low rank to that with it, in place."""
    rank = beside.wide.shape[1]
    along, share = np.zeros(rank), np.zeros(rank)
    for j in range(len(found) if rank else 0):
        for k in range(rank):
            along[k] += beside.wide[j, k] * found[j]
    for k in range(rank):
        for p in range(rank):
            share[k] += beside.inverse[k, p] * along[p]
    for j in range(len(found) if rank else 0):
        for k in range(rank):
            found[j] -= beside.solved[j, k] * share[k]


@njit(cache=True, error_model="numpy")
def _solved(
    matrices: SaddleMatrices,
    factors: Factors,
    weights: SystemWeights,
    beside: LowRank,
    slope: FloatArray,
    rest: FloatArray,
    box: InteriorLimits,
) -> tuple[FloatArray, float]:
    """See `BarrierSystem.solve`."""
    right = right_side(weights, slope, rest, box)
    found = np.zeros_like(right)
    left = refined(matrices, factors, weights.exact, right, found, _EXACT)
    _corrected(beside, found)
    n = len(right) - len(rest)
    for i in range(len(rest)):
        found[n + i] *= weights.units[i]
    return found, left


@njit(cache=True, error_model="numpy")
def _stepped(
    matrices: SaddleMatrices,
    factors: Factors,
    weights: SystemWeights,
    beside: LowRank,
    at: InteriorIterate,
    box: InteriorLimits,
    d: FirstDerivatives,
    slopes: FloatArray,
    rest: FloatArray,
    mu: float,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, float, float]:
    """See `BarrierSystem.step`."""
    slope = barrier_slopes(slopes, at, box, mu)
    found, left = _solved(matrices, factors, weights, beside, slope, rest, box)
    step, along = step_from(found, weights.sigma, slope, rest, d, at, box, mu)
    return step.v, step.y, step.low, step.high, along, left
