"""The subproblem as the interior point wants it: sides one by one, scaled, compiled.

A vector over variables and rows has the n variables first, then the m rows; that is the order of
the systems too. What does not take part (fixed variables, rows without sides) is zero in place, so
that the pattern stays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray, IntArray

_INFINITE = 1e20
_EQUAL = 1e-13
_LEAST, _LARGEST = 1e-8, 1e8


class Data(NamedTuple):
    """A subproblem's arrays: see `QuadraticProgram`. Matrices are by columns."""

    P_starts: IntArray
    P_rows: IntArray
    P: FloatArray
    q: FloatArray
    A_starts: IntArray
    A_rows: IntArray
    A: FloatArray
    lower: FloatArray
    upper: FloatArray
    d_lower: FloatArray
    d_upper: FloatArray


class Scaled(NamedTuple):
    """A subproblem in units of its own.

    Args:
        P_starts, P_rows, P, A_starts, A_rows, A: matrices by columns.
        q: (n,).
        diagonal: (n,) of P.
        fixed: (n,) variables with one value.
        value: (n,) theirs, unscaled; zero elsewhere.
        equal: (m,) rows with one value.
        target: (m,) theirs.
        place: (k,) variable or row of each side.
        sign: (k,) 1 for upper sides, -1 for lower ones.
        bound: (k,) where each side is.
        unit: (n + m,) size of one unit of a variable's or row's value.
        cost: scaled objectives are unscaled ones times this.
    """

    P_starts: IntArray
    P_rows: IntArray
    P: FloatArray
    q: FloatArray
    A_starts: IntArray
    A_rows: IntArray
    A: FloatArray
    diagonal: FloatArray
    fixed: BoolArray
    value: FloatArray
    equal: BoolArray
    target: FloatArray
    place: IntArray
    sign: FloatArray
    bound: FloatArray
    unit: FloatArray
    cost: float


@njit(cache=True, error_model="numpy")
def scaled(data: Data) -> Scaled:
    """The subproblem in units in which no entry is large. Sides must not contradict each other."""
    n, m = len(data.q), len(data.lower)
    P, A, q = data.P.copy(), data.A.copy(), data.q.copy()
    lower = np.concatenate((data.d_lower, data.lower))
    upper = np.concatenate((data.d_upper, data.upper))
    single = np.empty(n + m, dtype=np.bool_)
    count = 0
    for i in range(n + m):
        gap = upper[i] - lower[i]
        single[i] = np.isfinite(gap) and gap <= _EQUAL * max(1.0, abs(lower[i]))
        if not single[i]:
            count += int(lower[i] > -_INFINITE) + int(upper[i] < _INFINITE)
    value = np.where(single[:n], data.d_lower, 0.0)
    _switch_off(data, P, A, q, single, lower, upper, value)
    unit = _units(data, P, A, m)
    cost = _cost(P, q, unit)
    diagonal = np.zeros(n)
    for j in range(n):
        q[j] *= cost * unit[j]
        for k in range(data.P_starts[j], data.P_starts[j + 1]):
            P[k] *= cost
            if data.P_rows[k] == j:
                diagonal[j] = P[k]
    place = np.empty(count, dtype=np.int64)
    sign, bound = np.empty(count), np.empty(count)
    side = 0
    for i in range(n + m):
        if not single[i] and lower[i] > -_INFINITE:
            place[side], sign[side], bound[side] = i, -1.0, lower[i] / unit[i]
            side += 1
        if not single[i] and upper[i] < _INFINITE:
            place[side], sign[side], bound[side] = i, 1.0, upper[i] / unit[i]
            side += 1
    equal = single[n:].copy()
    target = np.where(equal, lower[n:] / unit[n:], 0.0)
    return Scaled(
        data.P_starts,
        data.P_rows,
        P,
        q,
        data.A_starts,
        data.A_rows,
        A,
        diagonal,
        single[:n].copy(),
        value,
        equal,
        target,
        place,
        sign,
        bound,
        unit,
        cost,
    )


def contradictory(data: Data) -> bool:
    """Whether a lower side is above its upper one."""
    rows, bounds = data.lower > data.upper, data.d_lower > data.d_upper
    return bool(rows.any() or bounds.any())


@njit(cache=True, error_model="numpy")
def _switch_off(
    data: Data,
    P: FloatArray,
    A: FloatArray,
    q: FloatArray,
    single: BoolArray,
    lower: FloatArray,
    upper: FloatArray,
    value: FloatArray,
) -> None:
    """Take fixed variables and rows without sides out of P, A and q, in place."""
    n = len(q)
    for j in range(n):
        if single[j]:
            for k in range(data.P_starts[j], data.P_starts[j + 1]):
                q[data.P_rows[k]] += P[k] * value[j]
                P[k] = 0.0
            for k in range(data.A_starts[j], data.A_starts[j + 1]):
                i = n + data.A_rows[k]
                lower[i] -= A[k] * value[j]
                upper[i] -= A[k] * value[j]
                A[k] = 0.0
    for j in range(n):
        if single[j]:
            q[j] = 0.0
            continue
        for k in range(data.P_starts[j], data.P_starts[j + 1]):
            if single[data.P_rows[k]]:
                P[k] = 0.0
        for k in range(data.A_starts[j], data.A_starts[j + 1]):
            i = n + data.A_rows[k]
            if not (single[i] or lower[i] > -_INFINITE or upper[i] < _INFINITE):
                A[k] = 0.0


@njit(cache=True, error_model="numpy")
def _units(data: Data, P: FloatArray, A: FloatArray, m: int) -> FloatArray:
    """Scale P and A in place; the units (n + m,) of variables and rows.

    One sweep of Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices"
    (2001); more of them make tiny curvatures as large as weights, and the iteration longer.
    """
    n = len(data.q)
    largest = np.zeros(n + m)
    for j in range(n):
        for k in range(data.P_starts[j], data.P_starts[j + 1]):
            largest[j] = max(largest[j], abs(P[k]))
        for k in range(data.A_starts[j], data.A_starts[j + 1]):
            i = n + data.A_rows[k]
            size = abs(A[k])
            largest[j] = max(largest[j], size)
            largest[i] = max(largest[i], size)
    factor = np.ones(n + m)
    for i in range(n + m):
        if largest[i] > 0.0:
            factor[i] = 1.0 / np.sqrt(min(max(largest[i], _LEAST), _LARGEST))
    for j in range(n):
        for k in range(data.P_starts[j], data.P_starts[j + 1]):
            P[k] *= factor[j] * factor[data.P_rows[k]]
        for k in range(data.A_starts[j], data.A_starts[j + 1]):
            A[k] *= factor[j] * factor[n + data.A_rows[k]]
    factor[n:] = 1.0 / factor[n:]
    return factor


@njit(cache=True, error_model="numpy")
def _cost(P: FloatArray, q: FloatArray, unit: FloatArray) -> float:
    """What brings the largest of P and q to one."""
    largest = 0.0
    for k in range(len(P)):
        largest = max(largest, abs(P[k]))
    for j in range(len(q)):
        largest = max(largest, abs(q[j] * unit[j]))
    return 1.0 / min(max(largest, _LEAST), _LARGEST) if largest > 0.0 else 1.0


@njit(cache=True, error_model="numpy")
def values(qp: Scaled, d: FloatArray, found: FloatArray) -> None:
    """d and A d, written to ``found`` (n + m,)."""
    n = len(qp.q)
    found[n:] = 0.0
    for j in range(n):
        found[j] = d[j]
        for k in range(qp.A_starts[j], qp.A_starts[j + 1]):
            found[n + qp.A_rows[k]] += qp.A[k] * d[j]
