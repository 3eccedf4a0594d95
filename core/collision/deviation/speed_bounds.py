"""How fast limits let a motion pass the intervals between samples of a path, without ramps.

In an interval from ℓ₀ to ℓ₁ = ℓ₀ + Δ a motion is given by x₀ and x₁, its ℓ̇² at both ends: x is
linear between them and u = ℓ̈ = (x₁ − x₀) / (2 Δ) is constant. Ceilings and rows leave a convex
polygon of (x₀, x₁) with the origin in it, so that driving slower stays inside.

Between samples the path is a quintic in ℓ. So q' and q'' are polynomials, which lie in the convex
hull of their Bernstein coefficients (R. T. Farouki, "The Bernstein polynomial basis: a centennial
retrospective", 2012, section 4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ...motion.timing.stamping_kernels import StampRows
from ...motion.timing.timing import Timing

_LOOSER = 1e-9
"""Share by which limits are passed through rounding."""
_UNBOUNDED = 1e6
"""Times the greatest ceiling, where there is none."""


@dataclass(frozen=True)
class Allowed:
    """What K intervals of a path allow.

    Args:
        spacing: (K,), Δ.
        slope: (5, K, N), Bernstein coefficients of q'.
        bend: (4, K, N), of q''.
        most: (K + 1,), greatest ℓ̇² at each sample.
        first: how many intervals the path has before these.
    """

    spacing: FloatArray
    slope: FloatArray
    bend: FloatArray
    most: FloatArray
    first: int = 0

    @classmethod
    def of(
        cls, timing: Timing, most: FloatArray, first: int = 0, last: int | None = None
    ) -> Allowed:
        """What the intervals from one to before another of a path allow.

        Args:
            timing: of the path.
            most: (K + 1,), greatest ℓ̇² at each sample of it; see `greatest`.
            first, last: the intervals.
        """
        part = slice(first, len(timing.along.spacing) if last is None else last)
        bounds = most[part.start : part.stop + 1]
        return cls(timing.along.spacing[part], *coefficients(timing, part), bounds, first)


def greatest(timing: Timing) -> FloatArray:
    """(K + 1,), greatest ℓ̇² that the limits of a path allow at its samples, and its stamp has."""
    rows = timing.path_limits.rows
    known = np.isfinite(rows.ceiling)
    most = _UNBOUNDED * rows.ceiling[known].max(initial=1.0)
    ceiling = (1.0 + _LOOSER) * np.where(known, rows.ceiling, most)
    ceiling = np.maximum(ceiling, timing.stamp.x)
    _reach(rows.rows, rows.spacing, ceiling)
    return np.asarray(np.maximum(ceiling, timing.stamp.x))


def coefficients(timing: Timing, part: slice) -> tuple[FloatArray, FloatArray]:
    """Bernstein coefficients of q' (5, K, N) and q'' (4, K, N) on K intervals."""
    states, left = timing.along.states, timing.path.pieces.interval_samples[part]
    h = timing.along.spacing[part, None]
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
    return slope / h, 4.0 * np.diff(slope, axis=0) / (h * h)


@njit(cache=True, error_model="numpy")
def _reach(
    rows: StampRows,
    spacing: FloatArray,
    ceiling: FloatArray,
) -> None:
    """Lower the ceilings to what can be braked from, to what can be sped up to, and to both."""
    corners = np.empty((4 + 4 * rows.a.shape[2], 2))
    spare = np.empty_like(corners)
    for back in (0, 1, 0):
        for i in range(spacing.size):
            k = spacing.size - 1 - i if back == 0 else i
            size = _polygon(k, rows, spacing, ceiling, corners, spare)
            most = 0.0
            for v in range(size):
                most = max(most, corners[v, back])
            ceiling[k + back] = min(ceiling[k + back], (1.0 + _LOOSER) * most)


@njit(cache=True, error_model="numpy")
def _polygon(
    k: int,
    rows: StampRows,
    spacing: FloatArray,
    ceiling: FloatArray,
    here: FloatArray,
    spare: FloatArray,
) -> int:
    """Write the corners of one interval's polygon; how many there are."""
    a, b, lower, upper = rows
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
