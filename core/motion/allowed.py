"""What the limits of a path allow between two samples of it, at any speed, without ramps.

In an interval from ℓ₀ to ℓ₁ = ℓ₀ + Δ a motion is given by x₀ and x₁, its ℓ̇² at both ends: x is
linear between them and u = ℓ̈ = (x₁ − x₀) / (2 Δ) is constant. Ceilings and rows leave a convex
polygon of (x₀, x₁) with the origin in it, so that driving slower stays inside. Its corners bound
all that is convex in both.

Between samples the path is a quintic in ℓ. So accelerations q' u + q'' x are polynomials of fourth
degree, whose Bernstein coefficients are linear in (x₀, x₁); they lie in the coefficients' convex
hull (R. T. Farouki, "The Bernstein polynomial basis: a centennial retrospective", 2012, section 4).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .limits import interval_samples
from .timing import Timing

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_LOOSER = 1e-9
"""Share by which limits are passed through rounding."""
_UNBOUNDED = 1e6
"""Times the greatest ceiling, where there is none."""


class Linear(NamedTuple):
    """Polynomials that are linear in u, x₀ and x₁.

    Args:
        push, left, right: (C, K, D), factors of u, x₀ and x₁ in the C Bernstein coefficients.
    """

    push: FloatArray
    left: FloatArray
    right: FloatArray


@dataclass(frozen=True)
class Allowed:
    """What K intervals of a path allow.

    Args:
        spacing: (K,), Δ.
        points: (6, K, N), Bernstein coefficients of q.
        slope: (5, K, N), of q'.
        bend: (4, K, N), of q''.
        corners: (K, V, 3), corners (u, x₀, x₁) of what is allowed; the origin behind them.
        count: (K,), how many there are.
    """

    spacing: FloatArray
    points: FloatArray
    slope: FloatArray
    bend: FloatArray
    corners: FloatArray
    count: IntArray

    @classmethod
    def of(cls, timing: Timing) -> Allowed:
        """What the limits of a path allow, and what its stamp does."""
        rows, states = timing.path_limits.rows, coefficients(timing)
        known = np.isfinite(rows.ceiling)
        most = _UNBOUNDED * rows.ceiling[known].max(initial=1.0)
        ceiling = (1.0 + _LOOSER) * np.where(known, rows.ceiling, most)
        ceiling = np.maximum(ceiling, timing.stamp.x)
        room = 5 + 4 * rows.a.shape[2]
        ends = np.zeros((len(rows.spacing), room, 2))
        count = np.zeros(len(rows.spacing), dtype=np.int64)
        _reach(*rows.rows, rows.spacing, ceiling, ends)
        _polygons(*rows.rows, rows.spacing, ceiling, timing.stamp.x, ends, count)
        ends = ends[:, : int(count.max(initial=1))]
        push = (ends[:, :, 1] - ends[:, :, 0]) / (2.0 * rows.spacing[:, None])
        corners = np.concatenate([push[:, :, None], ends], axis=2)
        return cls(rows.spacing, *states, corners, count)

    def where_time_runs(self, rate: float) -> Allowed:
        """What is allowed where time runs at a rate: x and u go with its square."""
        return replace(self, corners=rate**2 * self.corners)

    @property
    def fastest(self) -> FloatArray:
        """(K,), greatest x."""
        return np.asarray(self.corners[:, :, 1:].max(axis=(1, 2)))

    @property
    def velocities(self) -> FloatArray:
        """(K, N), bounds of |q̇|."""
        return np.asarray(np.abs(self.slope).max(axis=0) * np.sqrt(self.fastest)[:, None])

    @property
    def accelerations(self) -> Linear:
        """q̈, as polynomials of fourth degree."""
        share = np.arange(5)[:, None, None] / 4.0
        left, right = np.zeros_like(self.slope), np.zeros_like(self.slope)
        left[:4] = (1.0 - share[:4]) * self.bend
        right[1:] = share[1:] * self.bend
        return Linear(self.slope, left, right)

    def greatest(self, what: Linear, size: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """(K, …), what a convex size (C, K, …) of polynomials (C, K, D) does not exceed."""
        found = size(np.zeros_like(what.left)).max(axis=0)
        for v in range(self.corners.shape[1]):
            on = np.flatnonzero(self.count > v)
            u, before, after = (self.corners[on, v, part, None] for part in range(3))
            values = what.push[:, on] * u
            values += what.left[:, on] * before + what.right[:, on] * after
            found[on] = np.maximum(found[on], size(values).max(axis=0))
        return np.asarray(found)


def coefficients(timing: Timing) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Bernstein coefficients of q (6, K, N), q' (5, K, N) and q'' (4, K, N) on K intervals."""
    states, left = timing.along.states, interval_samples(timing.path.pieces)
    h = timing.along.spacing[:, None]
    q0, q1 = states.q[left], states.q[left + 1]
    v0, v1 = h * states.dq[left], h * states.dq[left + 1]
    a0, a1 = h * h * states.ddq[left], h * h * states.ddq[left + 1]
    points = np.stack(
        [
            q0,
            q0 + v0 / 5.0,
            q0 + 2.0 * v0 / 5.0 + a0 / 20.0,
            q1 - 2.0 * v1 / 5.0 + a1 / 20.0,
            q1 - v1 / 5.0,
            q1,
        ]
    )
    slope = 5.0 * np.diff(points, axis=0)
    return points, slope / h, 4.0 * np.diff(slope, axis=0) / (h * h)


@njit(cache=True, error_model="numpy")
def _polygons(
    a: FloatArray,
    b: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    spacing: FloatArray,
    ceiling: FloatArray,
    x: FloatArray,
    corners: FloatArray,
    count: IntArray,
) -> None:
    """Write the corners of each interval's polygon, and the stamp behind them."""
    for k in range(spacing.size):
        size = _polygon(k, a, b, lower, upper, spacing, ceiling, corners[k])
        corners[k, size] = x[k], x[k + 1]
        corners[k, size + 1 :] = 0.0
        count[k] = size + 1


@njit(cache=True, error_model="numpy")
def _reach(
    a: FloatArray,
    b: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    spacing: FloatArray,
    ceiling: FloatArray,
    corners: FloatArray,
) -> None:
    """Lower the ceilings to what can be braked from, and then to what can be sped up to."""
    for back in range(2):
        for i in range(spacing.size):
            k = spacing.size - 1 - i if back == 0 else i
            size = _polygon(k, a, b, lower, upper, spacing, ceiling, corners[k])
            most = 0.0
            for v in range(size):
                most = max(most, corners[k, v, back])
            ceiling[k + back] = min(ceiling[k + back], (1.0 + _LOOSER) * most)


@njit(cache=True, error_model="numpy")
def _polygon(
    k: int,
    a: FloatArray,
    b: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    spacing: FloatArray,
    ceiling: FloatArray,
    here: FloatArray,
) -> int:
    """Write the corners of one interval's polygon; how many there are."""
    spare = np.empty_like(here)
    here[0] = 0.0, 0.0
    here[1] = ceiling[k], 0.0
    here[2] = ceiling[k], ceiling[k + 1]
    here[3] = 0.0, ceiling[k + 1]
    size = 4
    for end in range(2):
        for r in range(a.shape[2]):
            push = a[k, end, r] / (2.0 * spacing[k])
            p = -push + (b[k, end, r] if end == 0 else 0.0)
            q = push + (b[k, end, r] if end == 1 else 0.0)
            if upper[k, end, r] < np.inf:
                size = _cut(here, size, p, q, (1.0 + _LOOSER) * upper[k, end, r], spare)
            if lower[k, end, r] > -np.inf:
                size = _cut(here, size, -p, -q, -(1.0 + _LOOSER) * lower[k, end, r], spare)
    return size


@njit(cache=True, error_model="numpy")
def _cut(corners: FloatArray, size: int, p: float, q: float, most: float, spare: FloatArray) -> int:
    """Leave of a convex polygon what has p x₀ + q x₁ ≤ most; the number of its corners."""
    kept = 0
    for i in range(size):
        j = (i + 1) % size
        here = most - p * corners[i, 0] - q * corners[i, 1]
        there = most - p * corners[j, 0] - q * corners[j, 1]
        if here >= 0.0:
            spare[kept] = corners[i]
            kept += 1
        if (here >= 0.0) != (there >= 0.0):
            share = here / (here - there)
            spare[kept] = corners[i] + share * (corners[j] - corners[i])
            kept += 1
    corners[:kept] = spare[:kept]
    return kept
