"""Compiled sweeps of the time stamp: back over reachable speeds, forth at the greatest speed.

One interval has the unknowns y = x_k and z = x_{k+1} of the squared path speed x = σ̇². The path
acceleration u = (z - y) / (2Δ) is constant in it, so the row ``lower ≤ a u + b x_e ≤ upper`` at
end e is a pair of half-planes p y + q z ≤ h, with w = 1 / (2Δ) and c = a w:

    left end   p = b - c,  q = c          right end   p = -c,  q = b + c

The half-plane of row r at end e has the code ``2 * (e * R + r) + side``, side 0 for ``lower`` and
1 for ``upper``; the bounds that are no rows have the negative codes below.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner, lean
from .stamping_polygon import ROUNDING, greatest_sum

CEILING = -1
"""x_k ≤ ceiling_k."""
NEXT = -2
"""x_{k+1} ≤ top_{k+1}, from which the end can be reached."""
SLOWEST = -3
"""x_{k+1} ≥ SLOWDOWN x_k, or ≥ 0 if knot k + 1 is a stop."""
FASTEST = -4
"""x_k ≥ SLOWDOWN x_{k+1}, or ≥ 0 if knot k is a stop."""
NONE = -5
"""No half-plane."""

# Without the last two bounds a row may send x to zero between two stops, where no path leaves.
SLOWDOWN = 1e-6


class StampRows(NamedTuple):
    """Rows of K intervals, (K, 2, R) each; see `stamping.StampLimits`."""

    a: FloatArray
    b: FloatArray
    lower: FloatArray
    upper: FloatArray


@lean
def first_unsound(
    spacing: FloatArray, ceiling: FloatArray, rows: StampRows
) -> tuple[int, int, int]:
    """What is first among values that the sweeps are not made for; -1 where all are sound.

    Returns:
        Indices: of the first length that is not positive and finite; of the first ceiling that is
        not at least zero; of the first row, counted flat, that is not finite or forbids u = x = 0.
    """
    length = knot = -1
    for k in range(spacing.shape[0]):
        if not (spacing[k] > 0.0 and spacing[k] < np.inf):
            length = k
            break
    for k in range(ceiling.shape[0]):
        if not ceiling[k] >= 0.0:
            knot = k
            break
    a, b, lower, upper = rows
    for k in range(a.shape[0]):
        for end in range(2):
            for r in range(a.shape[2]):
                # 0 · v is 0 for a finite v only.
                finite = a[k, end, r] * 0.0 + b[k, end, r] * 0.0 == 0.0
                if not (finite & (lower[k, end, r] <= 0.0) & (upper[k, end, r] >= 0.0)):
                    return length, knot, (2 * k + end) * a.shape[2] + r
    return length, knot, -1


@njit(cache=True, error_model="numpy")
def fill_joint_limits(
    dq: FloatArray,
    velocity: FloatArray,
    acceleration_lower: FloatArray,
    acceleration_upper: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    ceiling: FloatArray,
) -> None:
    """Write the bounds of ``stamping.joint_limits``; ``ceiling`` comes full of zeros."""
    inverse = 1.0 / velocity
    for k in range(dq.shape[0]):
        for end in range(2):
            fastest = ceiling[k + end]
            for j in range(dq.shape[2]):
                lower[k, end, j] = acceleration_lower[j]
                upper[k, end, j] = acceleration_upper[j]
                fastest = max(fastest, abs(dq[k, end, j]) * inverse[j])
            ceiling[k + end] = fastest
    for k in range(ceiling.shape[0]):
        ceiling[k] = 1.0 / (ceiling[k] * ceiling[k])


@inner
def half_plane(
    code: int,
    k: int,
    w: float,
    rows: StampRows,
) -> tuple[float, float, float]:
    """(p, q, h) of a row's half-plane p y + q z ≤ h in interval k."""
    a, b, lower, upper = rows
    i = code >> 1
    end = 1 if i >= a.shape[2] else 0
    r = i - end * a.shape[2]
    c = a[k, end, r] * w
    p, q = (-c, b[k, end, r] + c) if end else (b[k, end, r] - c, c)
    if code & 1:
        return p, q, upper[k, end, r]
    return -p, -q, -lower[k, end, r]


@inner
def bound_normal(code: int, ceiling: float, following: float) -> tuple[float, float]:
    """(p, q) of a bound that is no row; ``following`` bounds z."""
    if code == CEILING:
        return 1.0, 0.0
    if code == NEXT:
        return 0.0, 1.0
    if code == SLOWEST:
        return (SLOWDOWN if following > 0.0 else 0.0), -1.0
    return -1.0, (SLOWDOWN if ceiling > 0.0 else 0.0)


@inner
def _rows_hold(
    k: int,
    w: float,
    y: float,
    z: float,
    rows: StampRows,
) -> bool:
    """Whether all rows of interval k hold at (y, z), up to rounding: a scan without branches."""
    a, b, lower, upper = rows
    u = (z - y) * w
    size = (z + y) * w * ROUNDING
    size_y, size_z = y * ROUNDING, z * ROUNDING
    violated = 0
    for r in range(a.shape[2]):
        value = a[k, 0, r] * u + b[k, 0, r] * y
        slack = abs(a[k, 0, r]) * size + abs(b[k, 0, r]) * size_y
        violated |= (value - slack > upper[k, 0, r]) | (value + slack < lower[k, 0, r])
    for r in range(a.shape[2]):
        value = a[k, 1, r] * u + b[k, 1, r] * z
        slack = abs(a[k, 1, r]) * size + abs(b[k, 1, r]) * size_z
        violated |= (value - slack > upper[k, 1, r]) | (value + slack < lower[k, 1, r])
    return violated == 0


@inner
def _fill_polygon(
    k: int,
    w: float,
    rows: StampRows,
    ceiling: float,
    following: float,
    planes: FloatArray,
) -> None:
    """Write the half-planes of interval k to ``planes`` (4R + 4, 3), each at its code."""
    a, b, lower, upper = rows
    for r in range(a.shape[2]):
        for end in range(2):
            c = a[k, end, r] * w
            p, q = (-c, b[k, end, r] + c) if end else (b[k, end, r] - c, c)
            code = 2 * (end * a.shape[2] + r)
            planes[code, 0], planes[code, 1], planes[code, 2] = -p, -q, -lower[k, end, r]
            planes[code + 1, 0], planes[code + 1, 1], planes[code + 1, 2] = p, q, upper[k, end, r]
    for code in range(FASTEST, 0):
        planes[code, 0], planes[code, 1] = bound_normal(code, ceiling, following)
        planes[code, 2] = 0.0
    planes[CEILING, 2] = ceiling
    planes[NEXT, 2] = following


@inner
def _first_pair(planes: FloatArray) -> tuple[int, int]:
    """Two half-planes of a polygon that bound y + z together: where the walk begins."""
    following = planes[NEXT, 2]
    if planes[CEILING, 2] < np.inf:
        return CEILING, NEXT
    best, least = NONE, np.inf
    for code in range(planes.shape[0] + FASTEST):
        p, q, h = planes[code, 0], planes[code, 1], planes[code, 2]
        if p > 0.0 and (h - q * following) / p < least:
            best, least = code, (h - q * following) / p
    if best == NONE:
        return NONE, NONE
    return best, (NEXT if planes[best, 1] <= planes[best, 0] else SLOWEST)


@inner
def _guess(
    code: int,
    k: int,
    w: float,
    rows: StampRows,
    ceiling: float,
    following: float,
) -> tuple[float, int]:
    """y where a row meets z = ``following``, if it bounds y + z there and below the ceiling.

    The row that held in the interval after this one mostly holds here too.
    """
    if code >= 0:
        p, q, h = half_plane(code, k, w, rows)
        if p > 0.0 and q <= p and h - q * following <= ceiling * p:
            return (h - q * following) / p, code
    return ceiling, CEILING


@lean
def sweep_back(
    spacing: FloatArray,
    rows: StampRows,
    ceiling: FloatArray,
    x_end: float,
    planes: FloatArray,
    top: FloatArray,
    partner: FloatArray,
    pair: IntArray,
) -> int:
    """Squared speeds from which the end can be reached, one knot after the other.

    Writes ``top`` (K + 1,) and ``partner`` (K,): where x_k + x_{k+1} is greatest while x_{k+1} is
    at most ``top[k + 1]``; ``pair`` (K, 2): the half-planes that meet there. ``planes`` (4R + 4, 3)
    is room for half-planes. Returns the knot whose speed nothing bounds, -1 if there is none.
    """
    count = spacing.shape[0]
    top[count] = min(float(ceiling[count]), x_end)
    row = NONE
    for k in range(count - 1, -1, -1):
        w = 0.5 / spacing[k]
        z, j = top[k + 1], NEXT
        y, i = _guess(row, k, w, rows, ceiling[k], z)
        near = z * SLOWDOWN <= y and y * SLOWDOWN <= z
        if not (near and _rows_hold(k, w, y, z, rows)):
            _fill_polygon(k, w, rows, ceiling[k], z, planes)
            if i == CEILING:
                i, j = _first_pair(planes)
            if i == NONE:
                return k
            y, z, i, j = greatest_sum(planes, i, j)
            y, z = min(max(y, 0.0), ceiling[k]), min(max(z, 0.0), top[k + 1])
            # The walk counts from zero; the bounds' codes count back from the end.
            i = i - planes.shape[0] if i >= planes.shape[0] + FASTEST else i
            j = j - planes.shape[0] if j >= planes.shape[0] + FASTEST else j
        top[k] = y
        partner[k] = z
        pair[k, 0], pair[k, 1] = i, j
        if i >= 0 or j >= 0:
            row = i if i >= 0 else j
    return -1


@inner
def _farthest(
    guess: int,
    k: int,
    w: float,
    y: float,
    rows: StampRows,
    following: float,
) -> tuple[float, int]:
    """max z from x_k = y in interval k, and the half-plane that stops it there."""
    z, source = following, NEXT
    if guess >= 0:
        p, q, h = half_plane(guess, k, w, rows)
        if q > 0.0 and h - p * y < q * z:
            z, source = max((h - p * y) / q, 0.0), guess
    if _rows_hold(k, w, y, z, rows):
        return z, source
    for code in range(4 * rows.a.shape[2]):
        p, q, h = half_plane(code, k, w, rows)
        excess = p * y + q * z - h
        if q > 0.0 and excess > ROUNDING * (abs(p * y) + q * z):
            z, source = max((h - p * y) / q, 0.0), code
    return z, source


@inner
def _limit(y: float, top: float, source: int, i: int, j: int) -> int:
    """Which half-plane holds the speed down in an interval (see ``Stamp.limit``)."""
    if source >= 0:
        return source
    if y < top:
        return NEXT
    if i >= 0:
        return i
    return j if j >= 0 and i != CEILING else CEILING


@lean
def sweep_forth(
    spacing: FloatArray,
    rows: StampRows,
    x_start: float,
    top: FloatArray,
    partner: FloatArray,
    pair: IntArray,
    x: FloatArray,
    t: FloatArray,
    source: IntArray,
    limit: IntArray,
) -> int:
    """Greatest squared speed at each knot, one after the other, and the times.

    Writes ``x`` and ``t`` (K + 1,), ``source`` (K,): the half-plane that gave x_{k+1}, and
    ``limit`` (K,). Returns the interval in which the path stands still, -1 if there is none.
    """
    x[0] = min(x_start, float(top[0]))
    t[0] = 0.0
    row = NONE
    root = np.sqrt(x[0])
    for k in range(spacing.shape[0]):
        y = x[k]
        z, code = top[k + 1], NEXT
        # From (top, partner) the path follows the sweep back, as long as that has z = following.
        if y < top[k] or partner[k] < z:
            z, code = _farthest(row, k, 0.5 / spacing[k], y, rows, z)
            row = code
        # The polygon is convex and holds the origin and (top, partner), so this much is allowed:
        # rounding in a row that barely depends on z cannot throw the speed to zero.
        if y > 0.0:
            z = max(float(z), float(partner[k] * (y / top[k])))
        x[k + 1] = z
        source[k] = code
        limit[k] = _limit(y, top[k], code, pair[k, 0], pair[k, 1])
        following = np.sqrt(z)
        if not root + following > 0.0:
            return k
        t[k + 1] = t[k] + 2.0 * spacing[k] / (root + following)
        root = following
    return -1
