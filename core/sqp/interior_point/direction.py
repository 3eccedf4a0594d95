"""Slopes of the barrier's Lagrangian, steps, and how far a point is from a solution."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from .iterate import InteriorIterate, InteriorLimits

_LARGE = 100.0
"""Mean multiplier from which on residuals count in proportion (Wächter and Biegler, equation 5)."""


class FirstDerivatives(NamedTuple):
    """First derivatives.

    Args:
        g: (n,) of the objective.
        starts, rows, data: of the Jacobian, by columns.
    """

    g: FloatArray
    starts: IntArray
    rows: IntArray
    data: FloatArray


class Errors(NamedTuple):
    """How far a point is from a solution, scaled down where multipliers are large.

    Args:
        dual: largest slope of the Lagrangian.
        primal: largest violation.
        least, largest, total: of the products of multiplier and distance.
        scale: of the products.
    """

    dual: float
    primal: float
    least: float
    largest: float
    total: float
    scale: float


@njit(cache=True, error_model="numpy")
def lagrangian_slopes(at: InteriorIterate, d: FirstDerivatives) -> FloatArray:
    """Slopes (n + m,) of f + y·(c − s)."""
    n, m = len(d.g), len(at.y)
    found = np.empty(n + m)
    for j in range(n):
        total = d.g[j]
        for k in range(d.starts[j], d.starts[j + 1]):
            total += d.data[k] * at.y[d.rows[k]]
        found[j] = total
    for i in range(m):
        found[n + i] = -at.y[i]
    return found


@njit(cache=True, error_model="numpy")
def barrier_slopes(
    plain: FloatArray, at: InteriorIterate, box: InteriorLimits, mu: float
) -> FloatArray:
    """Slopes (n + m,) of the Lagrangian and the barrier; those of what is held are zero."""
    found = plain.copy()
    for k in range(len(found)):
        if box.held[k]:
            found[k] = 0.0
            continue
        if np.isfinite(box.lower[k]):
            found[k] -= mu / (at.v[k] - box.lower[k])
        if np.isfinite(box.upper[k]):
            found[k] += mu / (box.upper[k] - at.v[k])
    return found


@njit(cache=True, error_model="numpy")
def largest_change(change: FloatArray, v: FloatArray) -> float:
    """The largest change of values (k,), each in its size or in one."""
    found = 0.0
    for k in range(len(v)):
        found = max(found, abs(change[k]) / max(1.0, abs(v[k])))
    return found


@njit(cache=True, error_model="numpy")
def step_from(
    found: FloatArray,
    sigma: FloatArray,
    slope: FloatArray,
    rest: FloatArray,
    d: FirstDerivatives,
    at: InteriorIterate,
    box: InteriorLimits,
    mu: float,
) -> tuple[InteriorIterate, float]:
    """The whole step from that of variables and multipliers, and the slope of objective and
    barrier along it.

    Args:
        found: (n + m,).
        sigma: (n + m,) of the system.
        slope: (n + m,) barrier's.
        rest: (m,) c − s.
    """
    n, m = len(d.g), len(rest)
    v, y, low, high = np.zeros(n + m), found[n:].copy(), np.zeros(n + m), np.zeros(n + m)
    change = rest.copy()
    along = 0.0
    for j in range(n):
        v[j] = 0.0 if box.held[j] else found[j]
        along += d.g[j] * v[j]
        for k in range(d.starts[j], d.starts[j + 1]):
            change[d.rows[k]] += d.data[k] * v[j]
    for i in range(m):
        k = n + i
        if not box.held[k]:
            v[k] = change[i] if sigma[k] < 1.0 else (y[i] - slope[k]) / sigma[k]
    for k in range(n + m):
        if box.held[k]:
            continue
        if np.isfinite(box.lower[k]):
            gap = at.v[k] - box.lower[k]
            low[k] = mu / gap - at.low[k] - at.low[k] / gap * v[k]
            along -= mu / gap * v[k]
        if np.isfinite(box.upper[k]):
            gap = box.upper[k] - at.v[k]
            high[k] = mu / gap - at.high[k] + at.high[k] / gap * v[k]
            along += mu / gap * v[k]
    return InteriorIterate(v, y, low, high), along


@njit(cache=True, error_model="numpy")
def errors_at(
    at: InteriorIterate, box: InteriorLimits, d: FirstDerivatives, rest: FloatArray
) -> tuple[FloatArray, float, float, float, float, float, float]:
    """Slopes (n + m,) of the Lagrangian at a point, and what `Errors` takes.

    Args:
        rest: (m,) c − s.
    """
    slopes = lagrangian_slopes(at, d)
    dual, primal = 0.0, 0.0
    least, largest, total = np.inf, 0.0, 0.0
    sizes, count = 0.0, 0
    for i in range(len(rest)):
        primal = max(primal, abs(rest[i]))
        sizes += abs(at.y[i])
    for k in range(len(slopes)):
        if box.held[k]:
            continue
        slope = slopes[k] - at.low[k] + at.high[k]
        dual = max(dual, abs(slope))
        for side in range(2):
            limit = box.lower[k] if side == 0 else box.upper[k]
            if np.isfinite(limit):
                pressing = at.low[k] if side == 0 else at.high[k]
                product = abs(at.v[k] - limit) * pressing
                least, largest = min(least, product), max(largest, product)
                total += product
                sizes += pressing
                count += 1
    if count == 0:
        least = 0.0
    scale = max(_LARGE, sizes / max(1, count + len(rest))) / _LARGE
    return slopes, dual / scale, primal, least, largest, total, scale
