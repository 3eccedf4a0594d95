"""The interior point's linear system, compiled: [P + ρ + W, Aᵀ; A, −δ − 1/W] with the sides' W."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ..algebra.ldl import Factors, factorise, substitute
from ..algebra.linear import EntryIndices
from .interior_point_scaling import Scaled

_LINEAR = 1e-11


class System(NamedTuple):
    """The linear system and its solution.

    Args:
        factors, places: of the pattern.
        data: entries, as `factorise` takes them.
        diagonal, right, step, left, work: (n + m,).
        weight, push: (n + m,) of the eliminated sides.
        change: (n + m,) of the values.
        slack, multiplier, product: (k,) steps of the sides, and what their products are to gain.
    """

    factors: Factors
    places: EntryIndices
    data: FloatArray
    diagonal: FloatArray
    right: FloatArray
    step: FloatArray
    left: FloatArray
    work: FloatArray
    weight: FloatArray
    push: FloatArray
    change: FloatArray
    slack: FloatArray
    multiplier: FloatArray
    product: FloatArray


@njit(cache=True, error_model="numpy")
def factorised(qp: Scaled, system: System, rho: float, delta: float) -> bool:
    n = len(qp.q)
    diagonal, weight = system.diagonal, system.weight
    for j in range(n):
        diagonal[j] = 1.0 if qp.fixed[j] else qp.diagonal[j] + rho + weight[j]
    for i in range(len(qp.target)):
        pull = weight[n + i]
        if qp.equal[i]:
            diagonal[n + i] = -delta
        else:
            diagonal[n + i] = -1.0 if pull == 0.0 else -1.0 / pull
    for i in range(len(diagonal)):
        system.data[system.places.diagonal[i]] = diagonal[i]
    return bool(factorise(system.factors, system.data) >= 0)


@njit(cache=True, error_model="numpy")
def solved(qp: Scaled, system: System, refinements: int) -> None:
    """The system's solution, with the rounding of the factorisation taken out."""
    n = len(qp.q)
    right, step, left = system.right, system.step, system.left
    substitute(system.factors, right, step, system.work)
    for _ in range(refinements):
        size, error = 0.0, 0.0
        for i in range(len(right)):
            left[i] = right[i] - system.diagonal[i] * step[i]
            size = max(size, abs(right[i]))
        for j in range(n):
            total = 0.0
            for k in range(qp.P_starts[j], qp.P_starts[j + 1]):
                if qp.P_rows[k] != j:
                    total += qp.P[k] * step[qp.P_rows[k]]
            for k in range(qp.A_starts[j], qp.A_starts[j + 1]):
                total += qp.A[k] * step[n + qp.A_rows[k]]
                left[n + qp.A_rows[k]] -= qp.A[k] * step[j]
            left[j] -= total
        for i in range(len(left)):
            error = max(error, abs(left[i]))
        if error <= _LINEAR * size:
            return
        substitute(system.factors, left, left, system.work)
        for i in range(len(step)):
            step[i] += left[i]


@njit(cache=True, error_model="numpy")
def make_system(qp: Scaled, factors: Factors, places: EntryIndices) -> System:
    size, sides = len(qp.unit), len(qp.place)
    data = np.zeros(len(factors.rows))
    for k in range(len(qp.P)):
        if places.P[k] >= 0:
            data[places.P[k]] = qp.P[k]
    for k in range(len(qp.A)):
        data[places.A[k]] = qp.A[k]
    return System(
        factors,
        places,
        data,
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(sides),
        np.zeros(sides),
        np.zeros(sides),
    )
