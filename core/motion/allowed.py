"""What the limits of a path allow between two samples of it, at any speed.

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
from dataclasses import dataclass

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


@dataclass(frozen=True)
class Linear:
    """Polynomials that are linear in x₀ and x₁.

    Args:
        left, right: (C, K, D), factors of x₀ and x₁ in the C Bernstein coefficients.
    """

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
        corners: (K, V, 2), corners (x₀, x₁) of the polygons; the origin where there are fewer.
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
        rows = timing.path_limits.rows
        known = np.isfinite(rows.ceiling)
        most = _UNBOUNDED * rows.ceiling[known].max(initial=1.0)
        ceiling = np.where(known, rows.ceiling, most)
        room = 5 + 4 * rows.a.shape[2]
        corners = np.zeros((len(rows.spacing), room, 2))
        count = np.zeros(len(rows.spacing), dtype=np.int64)
        _polygons(*rows.rows, rows.spacing, ceiling, timing.stamp.x, corners, count)
        corners = corners[:, : int(count.max(initial=1))]
        points, slope, bend = coefficients(timing)
        return cls(rows.spacing, points, slope, bend, corners, count)

    @property
    def fastest(self) -> FloatArray:
        """(K,), greatest x."""
        return np.asarray(self.corners.max(axis=(1, 2)))

    @property
    def velocities(self) -> FloatArray:
        """(K, N), bounds of |q̇|."""
        return np.asarray(np.abs(self.slope).max(axis=0) * np.sqrt(self.fastest)[:, None])

    @property
    def accelerations(self) -> Linear:
        """q̈, as polynomials of fourth degree."""
        push = self.slope / (2.0 * self.spacing[:, None])
        share = np.arange(5)[:, None, None] / 4.0
        left, right = -push, push.copy()
        left[:4] += (1.0 - share[:4]) * self.bend
        right[1:] += share[1:] * self.bend
        return Linear(left, right)

    def greatest(self, what: Linear, size: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """(K, …), what a convex size (C, K, …) of polynomials (C, K, D) does not exceed."""
        found = size(np.zeros_like(what.left)).max(axis=0)
        for v in range(self.corners.shape[1]):
            on = np.flatnonzero(self.count > v)
            left, right = self.corners[on, v, 0, None], self.corners[on, v, 1, None]
            values = what.left[:, on] * left + what.right[:, on] * right
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
    spare = np.empty_like(corners[0])
    for k in range(spacing.size):
        here = corners[k]
        right, top = (1.0 + _LOOSER) * ceiling[k], (1.0 + _LOOSER) * ceiling[k + 1]
        here[0] = 0.0, 0.0
        here[1] = right, 0.0
        here[2] = right, top
        here[3] = 0.0, top
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
        here[size] = x[k], x[k + 1]
        here[size + 1 :] = 0.0
        count[k] = size + 1


@njit(cache=True, error_model="numpy")
def _cut(
    corners: FloatArray, size: int, p: float, q: float, most: float, spare: FloatArray
) -> int:
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
