"""Small strictly convex subproblems with a diagonal Hessian, by the dual active-set method.

It begins at the minimum without constraints and takes them in one by one, the most violated first,
until none is violated; see Goldfarb and Idnani, "A numerically stable dual method for solving
strictly convex quadratic programs" (1983). A step costs as much as a product with the rows, and
about as many are needed as sides are active in the end: for some dozen variables it is a small
part of what an interior point takes, however many rows there are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray, IntArray

_VIOLATED = 1e-10
"""Distance beyond a side, in units of the Hessian, that counts; in proportion to what is there."""
_PARALLEL = 1e-11
"""Share of a side's normal that is left across the active ones; with less it depends on them."""
_STEPS = 20
"""Steps for every variable and row, at most."""


@dataclass(frozen=True, slots=True)
class DiagonalProgram:
    """minimise ½ Σ hⱼ dⱼ² + q·d subject to A d ≥ b, lower ≤ d ≤ upper.

    Args:
        h: (n,), above zero.
        q: (n,).
        A: (m, n).
        b: (m,).
        lower, upper: (n,), infinite where there are none.
    """

    h: FloatArray
    q: FloatArray
    A: FloatArray
    b: FloatArray
    lower: FloatArray
    upper: FloatArray


def minimum(program: DiagonalProgram) -> tuple[FloatArray, FloatArray] | None:
    """The solution d (n,), and the multipliers (m,), zero or more, of the rows; None where nothing
    is within all sides, or rounding errors kept the method from an end."""
    root = np.sqrt(program.h)
    ended, scaled, multipliers = _minimum(
        program.q / root,
        np.ascontiguousarray(program.A / root),
        program.b,
        program.lower * root,
        program.upper * root,
    )
    if not ended:
        return None
    d = np.clip(scaled / root, program.lower, program.upper)
    return d, multipliers


@njit(cache=True, error_model="numpy")
def _minimum(
    q: FloatArray, A: FloatArray, b: FloatArray, lower: FloatArray, upper: FloatArray
) -> tuple[bool, FloatArray, FloatArray]:
    """The same with a Hessian of one.

    Sides are numbered: rows, lower bounds, upper bounds. The active ones' normals are the columns
    of J[:, :k] R, with J (n, n) orthogonal and R (k, k) upper triangular.
    """
    m, n = A.shape
    x = -q
    J, R = np.eye(n), np.zeros((n, n))
    active, pushes, held = np.zeros(n, np.int64), np.zeros(n), np.zeros(m + 2 * n, np.bool_)
    sizes = np.empty(m)
    for i in range(m):
        sizes[i] = max(np.sqrt(np.dot(A[i], A[i])), 1e-300)
    multipliers = np.zeros(m)
    k = 0
    normal, across, back = np.empty(n), np.empty(n), np.empty(n)
    for _ in range(_STEPS * (n + m)):
        side, short = _most_violated(x, A, b, lower, upper, sizes, held)
        if side < 0:
            for i in range(k):
                if active[i] < m:
                    multipliers[active[i]] = pushes[i]
            return True, x, multipliers
        _write_normal(normal, side, A)
        size = sizes[side] if side < m else 1.0
        push = 0.0
        while True:
            for j in range(n):
                total = 0.0
                for i in range(n):
                    total += J[i, j] * normal[i]
                across[j] = total
            for i in range(k - 1, -1, -1):
                total = across[i]
                for j in range(i + 1, k):
                    total -= R[i, j] * back[j]
                back[i] = total / R[i, i]
            free = 0.0
            for j in range(k, n):
                free += across[j] ** 2
            # How far until a multiplier is zero, and until the side is reached.
            first, dual = -1, np.inf
            for i in range(k):
                if back[i] > 0.0 and pushes[i] < dual * back[i]:
                    first, dual = i, pushes[i] / back[i]
            whole = -short / free if free > (_PARALLEL * size) ** 2 else np.inf
            step = min(dual, whole)
            if not step < np.inf:
                return False, x, multipliers
            for i in range(k):
                pushes[i] = max(pushes[i] - step * back[i], 0.0)
            push += step
            if whole < np.inf:
                for i in range(n):
                    total = 0.0
                    for j in range(k, n):
                        total += J[i, j] * across[j]
                    x[i] += step * total
                short += step * free
            if whole <= dual:
                _take_in(J, R, across, k)
                active[k], pushes[k], held[side] = side, push, True
                k += 1
                break
            held[active[first]] = False
            k = _leave_out(J, R, active, pushes, k, first)
    return False, x, multipliers


@njit(cache=True, error_model="numpy")
def _most_violated(
    x: FloatArray,
    A: FloatArray,
    b: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    sizes: FloatArray,
    held: BoolArray,
) -> tuple[int, float]:
    """The side beyond which x is farthest, -1 if it is beyond none, and its room, below zero."""
    m, n = A.shape
    side, short, worst = -1, 0.0, 0.0
    for i in range(m):
        if not held[i]:
            room = np.dot(A[i], x) - b[i]
            far = room / sizes[i]
            if far < worst and far < -_VIOLATED * (1.0 + abs(b[i]) / sizes[i]):
                side, short, worst = i, room, far
    for j in range(n):
        for first, room, bound in (
            (m, x[j] - lower[j], lower[j]),
            (m + n, upper[j] - x[j], upper[j]),
        ):
            if room < worst and not held[first + j] and room < -_VIOLATED * (1.0 + abs(bound)):
                side, short, worst = first + j, room, room
    return side, short


@njit(cache=True, error_model="numpy")
def _write_normal(normal: FloatArray, side: int, A: FloatArray) -> None:
    m, n = A.shape
    if side < m:
        normal[:] = A[side]
        return
    normal[:] = 0.0
    normal[(side - m) % n] = 1.0 if side < m + n else -1.0


@njit(cache=True, error_model="numpy")
def _take_in(J: FloatArray, R: FloatArray, across: FloatArray, k: int) -> None:
    """Take in a normal, which is J ``across``."""
    n = len(across)
    for j in range(n - 1, k, -1):
        _turn(J, across, j - 1, j)
    for i in range(k + 1):
        R[i, k] = across[i]


@njit(cache=True, error_model="numpy")
def _turn(J: FloatArray, values: FloatArray, i: int, j: int) -> None:
    """Turn two columns of J so that the second has no part in what ``values`` says of both."""
    length = np.hypot(values[i], values[j])
    if length == 0.0 or values[j] == 0.0:
        return
    cosine, sine = values[i] / length, values[j] / length
    values[i], values[j] = length, 0.0
    for row in range(len(J)):
        one, other = J[row, i], J[row, j]
        J[row, i] = cosine * one + sine * other
        J[row, j] = cosine * other - sine * one


@njit(cache=True, error_model="numpy")
def _leave_out(
    J: FloatArray, R: FloatArray, active: IntArray, pushes: FloatArray, k: int, left: int
) -> int:
    """Leave out an active side; how many there are then."""
    for i in range(left, k - 1):
        active[i], pushes[i] = active[i + 1], pushes[i + 1]
        for row in range(i + 2):
            R[row, i] = R[row, i + 1]
    k -= 1
    for i in range(left, k):
        length = np.hypot(R[i, i], R[i + 1, i])
        if R[i + 1, i] == 0.0 or length == 0.0:
            continue
        cosine, sine = R[i, i] / length, R[i + 1, i] / length
        R[i, i], R[i + 1, i] = length, 0.0
        for j in range(i + 1, k):
            one, other = R[i, j], R[i + 1, j]
            R[i, j] = cosine * one + sine * other
            R[i + 1, j] = cosine * other - sine * one
        for row in range(len(J)):
            one, other = J[row, i], J[row, i + 1]
            J[row, i] = cosine * one + sine * other
            J[row, i + 1] = cosine * other - sine * one
    return k
