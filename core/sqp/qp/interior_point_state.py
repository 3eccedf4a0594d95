"""Where the interior point stands: residuals, and proofs that there is no solution. Compiled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray
from .interior_point_scaling import Scaled, values

_CERTIFICATE = 1e-8
_FAR = 1e3


class Iterate(NamedTuple):
    """An iterate, scaled.

    Args:
        d: (n,).
        y: (n + m,) multipliers of bounds and rows.
        slack, multiplier: (k,) of the sides, positive.
    """

    d: FloatArray
    y: FloatArray
    slack: FloatArray
    multiplier: FloatArray


class InteriorPointResiduals(NamedTuple):
    """What is left to be done, scaled.

    Args:
        value: (n + m,) of variables and rows.
        dual: (n,) slope of the Lagrangian.
        miss: (m,) what equal rows lack.
        primal: (k,) what slacks lack.
    """

    value: FloatArray
    dual: FloatArray
    miss: FloatArray
    primal: FloatArray


@njit(cache=True, error_model="numpy")
def residuals(qp: Scaled, point: Iterate, at: InteriorPointResiduals) -> tuple[float, float]:
    """Fill in the residuals and y of the sides; the largest in proportion to what it is part of,
    unscaled, and how large a gap counts as one, scaled."""
    n, m = len(qp.q), len(qp.target)
    y, unit = point.y, qp.unit
    values(qp, point.d, at.value)
    for j in range(n):
        y[j] = 0.0
    for i in range(m):
        if not qp.equal[i]:
            y[n + i] = 0.0
    for k in range(len(qp.place)):
        y[qp.place[k]] += qp.sign[k] * point.multiplier[k]
    dual, size, largest, objective = 0.0, 1.0, 1.0, 0.0
    for j in range(n):
        slope = 0.0
        for k in range(qp.P_starts[j], qp.P_starts[j + 1]):
            slope += qp.P[k] * point.d[qp.P_rows[k]]
        objective += (qp.q[j] + 0.5 * slope) * point.d[j]
        slope += qp.q[j] + y[j]
        for k in range(qp.A_starts[j], qp.A_starts[j + 1]):
            slope += qp.A[k] * y[n + qp.A_rows[k]]
        at.dual[j] = 0.0 if qp.fixed[j] else slope
        dual = max(dual, abs(at.dual[j]) / unit[j])
        size = max(size, abs(qp.q[j]) / (unit[j] * qp.cost))
    primal = 0.0
    for i in range(m):
        if qp.equal[i]:
            at.miss[i] = qp.target[i] - at.value[n + i]
            primal = max(primal, abs(at.miss[i]) * unit[n + i])
        size = max(size, abs(y[n + i]) / (unit[n + i] * qp.cost))
    for i in range(n + m):
        largest = max(largest, abs(at.value[i]) * unit[i])
    product = 0.0
    for k in range(len(qp.place)):
        i = qp.place[k]
        at.primal[k] = qp.sign[k] * (qp.bound[k] - at.value[i]) - point.slack[k]
        primal = max(primal, abs(at.primal[k]) * unit[i])
        product += point.slack[k] * point.multiplier[k]
    gap = max(qp.cost, abs(objective))
    left = max(primal / largest, dual / (qp.cost * size), product / gap)
    if not (np.isfinite(dual) and np.isfinite(primal) and np.isfinite(product)):
        left = np.inf
    return left, gap


@njit(cache=True, error_model="numpy")
def proves_infeasible(qp: Scaled, point: Iterate) -> bool:
    """Whether the multipliers alone contradict the sides: Aᵀy + z = 0 with a positive gap."""
    n = len(qp.q)
    y = point.y
    gap = 0.0
    for k in range(len(qp.place)):
        gap += qp.sign[k] * point.multiplier[k] * qp.bound[k]
    for i in range(len(qp.target)):
        if qp.equal[i]:
            gap += y[n + i] * qp.target[i]
    if gap >= 0.0:
        return False
    for j in range(n):
        if qp.fixed[j]:
            continue
        slope = y[j]
        for k in range(qp.A_starts[j], qp.A_starts[j + 1]):
            slope += qp.A[k] * y[n + qp.A_rows[k]]
        if abs(slope) > -_CERTIFICATE * gap:
            return False
    return True


@njit(cache=True, error_model="numpy")
def proves_unbounded(qp: Scaled, point: Iterate, at: InteriorPointResiduals) -> bool:
    """Whether the objective falls along d without end, and no side is in the way."""
    n = len(qp.q)
    largest = 0.0
    falls = 0.0
    for j in range(n):
        largest = max(largest, abs(point.d[j]) * qp.unit[j])
        falls -= qp.q[j] * point.d[j]
    if largest < _FAR or falls <= 0.0:
        return False
    slack = _CERTIFICATE * falls
    for k in range(len(qp.place)):
        if qp.sign[k] * at.value[qp.place[k]] > slack:
            return False
    for i in range(len(qp.target)):
        if qp.equal[i] and abs(at.value[n + i]) > slack:
            return False
    for j in range(n):
        slope = 0.0
        for k in range(qp.P_starts[j], qp.P_starts[j + 1]):
            slope += qp.P[k] * point.d[qp.P_rows[k]]
        if abs(slope) > slack:
            return False
    return True
