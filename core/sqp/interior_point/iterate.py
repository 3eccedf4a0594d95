"""Where the interior point is: variables and slacks, multipliers, and the limits of either."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray

_PUSH = 1e-2
"""Least distance from a bound at the start: of the bound's size, and of the range (Wächter and
Biegler, section 3.6)."""
_LARGEST_RATIO = 1e10
"""By which a multiplier may differ from μ over its distance (section 3.5)."""


class InteriorLimits(NamedTuple):
    """Limits of the variables and of a slack for each row.

    Args:
        lower, upper: (n + m,).
        held: (n + m,) fixed variables and slacks of equalities, which do not move.
    """

    lower: FloatArray
    upper: FloatArray
    held: BoolArray


class InteriorIterate(NamedTuple):
    """A point of the interior and its multipliers.

    Args:
        v: (n + m,) variables, slacks.
        y: (m,) of c(x) = s.
        low, high: (n + m,) of the limits; zero where there is none.
    """

    v: FloatArray
    y: FloatArray
    low: FloatArray
    high: FloatArray

    def copy(self) -> InteriorIterate:
        """One that may be changed."""
        return InteriorIterate(self.v.copy(), self.y.copy(), self.low.copy(), self.high.copy())


@njit(cache=True, error_model="numpy")
def push_inside(v: FloatArray, box: InteriorLimits, share: float) -> None:
    """Move values (n + m,) into the interior, what is held to its place.

    Args:
        v: changed in place.
        share: 1 for the usual distance, less for a smaller one.
    """
    push = _PUSH * share
    for k in range(len(v)):
        lower, upper = box.lower[k], box.upper[k]
        if box.held[k]:
            v[k] = lower
            continue
        below, above = push * max(1.0, abs(lower)), push * max(1.0, abs(upper))
        if np.isfinite(lower) and np.isfinite(upper):
            below = min(below, push * (upper - lower))
            above = min(above, push * (upper - lower))
        if np.isfinite(lower):
            v[k] = max(v[k], lower + below)
        if np.isfinite(upper):
            v[k] = min(v[k], upper - above)


@njit(cache=True, error_model="numpy")
def keep_near(at: InteriorIterate, box: InteriorLimits, mu: float, ratio: float) -> None:
    """Bring the limits' multipliers to within a ratio of μ over their distance; in place."""
    for k in range(len(at.v)):
        if box.held[k]:
            continue
        if np.isfinite(box.lower[k]):
            centre = mu / (at.v[k] - box.lower[k])
            at.low[k] = min(max(at.low[k], centre / ratio), centre * ratio)
        if np.isfinite(box.upper[k]):
            centre = mu / (box.upper[k] - at.v[k])
            at.high[k] = min(max(at.high[k], centre / ratio), centre * ratio)


@njit(cache=True, error_model="numpy")
def advance(
    at: InteriorIterate,
    step: InteriorIterate,
    box: InteriorLimits,
    v: FloatArray,
    share: float,
    dual: float,
    mu: float,
) -> None:
    """Take a step, in place.

    Args:
        v: (n + m,) the values after it.
        share, dual: of the step that the rows' and the limits' multipliers take.
    """
    for i in range(len(at.y)):
        at.y[i] += share * step.y[i]
    for k in range(len(v)):
        at.v[k] = v[k]
        at.low[k] += dual * step.low[k]
        at.high[k] += dual * step.high[k]
    keep_near(at, box, mu, _LARGEST_RATIO)


@njit(cache=True, error_model="numpy")
def longest(
    at: InteriorIterate, step: InteriorIterate, box: InteriorLimits, keep: float
) -> tuple[float, float]:
    """The largest shares of a step that values and multipliers may take without losing more than
    ``keep`` of their distance from the limits."""
    primal, dual = 1.0, 1.0
    for k in range(len(at.v)):
        if box.held[k]:
            continue
        if np.isfinite(box.lower[k]):
            if step.v[k] < 0.0:
                primal = min(primal, keep * (box.lower[k] - at.v[k]) / step.v[k])
            if step.low[k] < 0.0:
                dual = min(dual, -keep * at.low[k] / step.low[k])
        if np.isfinite(box.upper[k]):
            if step.v[k] > 0.0:
                primal = min(primal, keep * (box.upper[k] - at.v[k]) / step.v[k])
            if step.high[k] < 0.0:
                dual = min(dual, -keep * at.high[k] / step.high[k])
    return primal, dual


@njit(cache=True, error_model="numpy")
def after(at: InteriorIterate, step: InteriorIterate, share: float) -> FloatArray:
    """The values (n + m,) after a share of a step."""
    found = np.empty_like(at.v)
    for k in range(len(found)):
        found[k] = at.v[k] + share * step.v[k]
    return found


@njit(cache=True, error_model="numpy")
def merit(v: FloatArray, box: InteriorLimits, c: FloatArray) -> tuple[float, float]:
    """Violation Σ |c − s|, and the barrier −Σ log of distances; infinite outside."""
    theta, barrier = 0.0, 0.0
    n = len(v) - len(c)
    for i in range(len(c)):
        theta += abs(c[i] - v[n + i])
    for k in range(len(v)):
        if box.held[k]:
            continue
        if np.isfinite(box.lower[k]):
            gap = v[k] - box.lower[k]
            barrier -= np.log(gap) if gap > 0.0 else -np.inf
        if np.isfinite(box.upper[k]):
            gap = box.upper[k] - v[k]
            barrier -= np.log(gap) if gap > 0.0 else -np.inf
    return theta, barrier
