"""Compiled sums over cells of a course of what averages do there; see `averaging`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray


class Offsets(NamedTuple):
    """How far averages take joints off the path, at each of C cells of a course.

    Args:
        axis: (C, N), unit vectors: which way the path turns there.
        along: (C, 2), least (≤ 0) and greatest (≥ 0) way off the path along the axis.
        aside: (C, N), bounds of what is beside that.
    """

    axis: FloatArray
    along: FloatArray
    aside: FloatArray


class Cells(NamedTuple):
    """A course as the kernels need it.

    Args:
        theta: (C + 1,), by which nothing is faster.
        place: (C + 1,), ℓ.
        ahead: (C,), greatest speed, of what is averaged.
        least: (C,), what that is per ℓ at least.
        tangent, turn, uneven: (C, N).
        moves: (C,), which are no rests.
        parts: (C,), middles of rests, which part what is before from what comes.
    """

    theta: FloatArray
    place: FloatArray
    ahead: FloatArray
    least: FloatArray
    tangent: FloatArray
    turn: FloatArray
    uneven: FloatArray
    moves: NDArray[np.bool_]
    parts: NDArray[np.bool_]


@njit(cache=True, error_model="numpy")
def greatest_between(values: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    """(C,), the greatest of values (C,) from first (C,) up to before last (C,)."""
    out = np.zeros(first.size)
    for c in range(first.size):
        for k in range(first[c], last[c]):
            out[c] = max(out[c], values[k])
    return out


@njit(cache=True, error_model="numpy")
def tail(widths: FloatArray, order: int, c: float) -> float:
    """P(τ > c) (order 0) or E(τ − c)⁺ (1) of a sum τ of even distributions of these widths."""
    n = widths.size
    if n == 0:
        if order == 1:
            return max(-c, 0.0)
        return 1.0 if c < 0.0 else 0.0
    # By symmetry; with fewer terms, and so less rounding.
    x = abs(c)
    power, scale = n + order, 1.0
    for i in range(2, power + 1):
        scale *= i
    for i in range(n):
        scale *= widths[i]
    total = 0.0
    for signs in range(2**n):
        from_edge, sign = -x, 1.0
        for i in range(n):
            if (signs >> i) & 1:
                from_edge -= 0.5 * widths[i]
                sign = -sign
            else:
                from_edge += 0.5 * widths[i]
        if from_edge > 0.0:
            total += sign * from_edge**power
    found = max(total / scale, 0.0)
    if c >= 0.0:
        return found
    return 1.0 - found if order == 0 else found - c


@njit(cache=True, error_model="numpy")
def _reach(theta: FloatArray, half: float, b: int, side: int) -> int:
    """The last cell ahead (1) or behind (−1) that a kernel with its middle in cell b reaches."""
    middle = theta[b + 1] if side > 0 else theta[b]
    last = b
    while 0 <= last + side < theta.size - 1:
        edge = theta[last + 1] if side > 0 else theta[last]
        if side * (edge - middle) >= half:
            break
        last += side
    return last


@njit(cache=True, error_model="numpy")
def _ahead(cells: Cells, widths: FloatArray, b: int, last: int, side: int, out: FloatArray) -> None:
    """Write E(λ − ν)⁺ for ν in each cell from b to the last ahead (1), or of ν − λ behind (−1).

    The middle of the kernel may be anywhere in cell b: distances are from its nearer edge.
    """
    theta = cells.theta
    middle = theta[b + 1] if side > 0 else theta[b]
    edge = theta[b] if side > 0 else theta[b + 1]
    before = tail(widths, 1, side * (edge - middle))
    c = b
    while c != last + side:
        edge = theta[c + 1] if side > 0 else theta[c]
        after = tail(widths, 1, side * (edge - middle))
        out[c] = cells.ahead[c] * (before - after)
        before = after
        c += side
    c = last
    while c != b:
        out[c - side] += out[c]
        c -= side


@njit(cache=True, error_model="numpy")
def _places(cells: Cells, b: int, last: int, side: int, out: FloatArray) -> None:
    """Make of E(λ − ν)⁺ E(ℓ − ν)⁺ in each cell from b to the last.

    It is the sum of what the cells from ν's own on add; dℓ/dλ is at most the greatest from b on.
    """
    c = b
    while c != last:
        out[c] -= out[c + side]
        c += side
    slowest, c = math.inf, b
    while c != last + side:
        slowest = min(slowest, cells.least[c])
        out[c] /= slowest
        c += side
    c = last
    while c != b:
        out[c - side] += out[c]
        c -= side


@njit(cache=True, error_model="numpy")
def _around(
    cells: Cells, widths: FloatArray, half: float, b: int, out: FloatArray
) -> tuple[int, int, int, int]:
    """Write G in each cell about b; first and last cell that the kernel reaches, and first and
    last in which E Λ may be."""
    first, last = _reach(cells.theta, half, b, -1), _reach(cells.theta, half, b, 1)
    _ahead(cells, widths, b, first, -1, out)
    _places(cells, b, first, -1, out)
    back = out[b]
    _ahead(cells, widths, b, last, 1, out)
    _places(cells, b, last, 1, out)
    fore = out[b]
    out[b] = min(back, fore)
    low, high = b, b
    while low > 0 and cells.place[low] >= cells.place[b] - back:
        if low != b and cells.parts[low]:
            break
        low -= 1
    while high + 2 < cells.place.size and cells.place[high + 1] <= cells.place[b + 1] + fore:
        if high != b and cells.parts[high]:
            break
        high += 1
    return first, last, low, high


@njit(cache=True, error_model="numpy")
def bound_offsets(
    cells: Cells,
    widths: FloatArray,
    half: float,
    made: Offsets,
    earliest: IntArray,
    latest: IntArray,
) -> None:
    """Bound how far averages take joints off the path.

    Also written are first and last cell (C,) in which the kernel's middle may be when E Λ is in
    each.
    """
    count, size = cells.turn.shape
    G, turned = np.zeros(count), np.empty(size)
    for b in range(count):
        first, last, low, high = _around(cells, widths, half, b, G)
        turned[:] = 0.0
        for c in range(first, last + 1):
            for j in range(size):
                turned[j] += G[c] * cells.turn[c, j]
        for g in range(low, high + 1):
            made.axis[g] += turned
            earliest[g], latest[g] = min(earliest[g], b), max(latest[g], b)
    for g in range(count):
        length = math.sqrt(np.sum(made.axis[g] ** 2))
        if length > 0.0:
            made.axis[g] /= length
    for b in range(count):
        first, last, low, high = _around(cells, widths, half, b, G)
        for g in range(low, high + 1):
            if cells.moves[g]:
                least, most = _split(cells, made.axis[g], first, last, G, turned)
                _add_beyond(cells, low, high, G, turned)
                made.along[g, 0] = min(made.along[g, 0], least)
                made.along[g, 1] = max(made.along[g, 1], most)
                for j in range(size):
                    made.aside[g, j] = max(made.aside[g, j], turned[j])


@njit(cache=True, error_model="numpy")
def _add_beyond(cells: Cells, low: int, high: int, G: FloatArray, aside: FloatArray) -> None:
    """Add how far E Λ may be beyond the rests at which the cells from low to high end."""
    steepest = np.empty(aside.size)
    for rest, side in ((low, -1), (high, 1)):
        if cells.parts[rest]:
            steepest[:] = 0.0
            c, away = rest, 0.0
            while 0 <= c < cells.moves.size and away <= G[rest]:
                if cells.moves[c]:
                    for j in range(aside.size):
                        slope = abs(cells.tangent[c, j]) + abs(cells.turn[c, j])
                        steepest[j] = max(steepest[j], slope + cells.uneven[c, j])
                c += side
                near = cells.place[c] if side > 0 else cells.place[min(c + 1, cells.moves.size)]
                away = abs(near - cells.place[rest])
            for j in range(aside.size):
                aside[j] += G[rest] * steepest[j]


@njit(cache=True, error_model="numpy")
def _split(
    cells: Cells, axis: FloatArray, first: int, last: int, weight: FloatArray, aside: FloatArray
) -> tuple[float, float]:
    """Least and greatest ∫ w dq' along an axis, 0 ≤ w ≤ ``weight``; beside it, in ``aside``."""
    least = most = 0.0
    aside[:] = 0.0
    for c in range(first, last + 1):
        along = 0.0
        for j in range(axis.size):
            along += axis[j] * cells.turn[c, j]
        least += weight[c] * min(along, 0.0)
        most += weight[c] * max(along, 0.0)
        for j in range(axis.size):
            beside = abs(cells.turn[c, j] - along * axis[j]) + cells.uneven[c, j]
            aside[j] += weight[c] * beside
    return least, most


@njit(cache=True, error_model="numpy")
def bound_ramp(
    cells: Cells, widths: FloatArray, half: float, turned: FloatArray, off: FloatArray
) -> None:
    """Write how far (C, N) a mean of joints over a ramp is from those of the mean place."""
    count, size = turned.shape
    back, fore = np.zeros(count), np.zeros(count)
    for b in range(count):
        first, last = _reach(cells.theta, half, b, -1), _reach(cells.theta, half, b, 1)
        _ahead(cells, widths, b, first, -1, back)
        _ahead(cells, widths, b, last, 1, fore)
        back[b] = min(back[b], fore[b])
        for c in range(first, last + 1):
            G = fore[c] if c > b else back[c]
            for j in range(size):
                off[b, j] += G * turned[c, j]


@njit(cache=True, error_model="numpy")
def bound_means(
    theta: FloatArray,
    widths: FloatArray,
    half: float,
    earliest: IntArray,
    latest: IntArray,
    values: FloatArray,
    out: FloatArray,
) -> None:
    """Write the greatest means (C, D) of values (C, D) with E Λ in each cell."""
    for g in range(values.shape[0]):
        if latest[g] >= 0:
            _mean_at(theta, widths, half, earliest[g], latest[g], values, out[g])


@njit(cache=True, error_model="numpy")
def _mean_at(
    theta: FloatArray,
    widths: FloatArray,
    half: float,
    earliest: int,
    latest: int,
    values: FloatArray,
    out: FloatArray,
) -> None:
    """Write the greatest mean (D,) of values (C, D) with the kernel's middle in some cells."""
    most = values[earliest].copy()
    for c in range(earliest, latest + 1):
        most = np.maximum(most, values[c])
    for side in (-1, 1):
        _add_mean(theta, widths, half, earliest, latest, side, values, most, out)


@njit(cache=True, error_model="numpy")
def bound_veer(
    cells: Cells,
    speed: FloatArray,
    widths: FloatArray,
    half: float,
    earliest: IntArray,
    latest: IntArray,
    out: FloatArray,
) -> None:
    """Write bounds (C, N) of means of |q̇ − d ℓ̇|."""
    count, size = cells.turn.shape
    theta, values = cells.theta, np.zeros((count, size))
    for g in range(count):
        if latest[g] < 0 or not cells.moves[g]:
            continue
        low, high = earliest[g], latest[g]
        while low > 0 and theta[low] > theta[earliest[g]] - half:
            low -= 1
        while high + 1 < count and theta[high + 1] < theta[latest[g] + 1] + half:
            high += 1
        for c in range(low, high + 1):
            for j in range(size):
                off = abs(cells.tangent[c, j] - cells.tangent[g, j])
                off += abs(cells.turn[c, j]) + cells.uneven[c, j]
                values[c, j] = off * speed[c]
        _mean_at(theta, widths, half, earliest[g], latest[g], values, out[g])


@njit(cache=True, error_model="numpy")
def _add_mean(
    theta: FloatArray,
    widths: FloatArray,
    half: float,
    earliest: int,
    latest: int,
    side: int,
    values: FloatArray,
    most: FloatArray,
    out: FloatArray,
) -> None:
    """Add what one side of the kernel takes of values, which are ``most`` at its middle."""
    most = most.copy()
    middle, c = (theta[latest + 1], latest + 1) if side > 0 else (theta[earliest], earliest - 1)
    before = 0.5
    while 0 <= c < values.shape[0]:
        edge = theta[c] if side > 0 else theta[c + 1]
        away = side * (edge - middle)
        if away >= half:
            break
        after = tail(widths, 0, away)
        for j in range(most.size):
            out[j] += (before - after) * most[j]
            most[j] = max(most[j], values[c, j])
        before = after
        c += side
    for j in range(most.size):
        out[j] += before * most[j]
