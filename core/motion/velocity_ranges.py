"""How much velocities change within reach of averages, compiled; see `averaging`."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@njit(cache=True, error_model="numpy")
def velocity_ranges(
    theta: FloatArray,
    interval: IntArray,
    speed: FloatArray,
    half: float,
    earliest: IntArray,
    latest: IntArray,
    slope: FloatArray,
    matrix: FloatArray,
    about: FloatArray,
) -> FloatArray:
    """(C, N), the ranges of A (q̇ − d ℓ̇) on cells that averages with E Λ in each reach.

    Args:
        theta: (C + 1,) s, as `Course` has it.
        interval, speed: (C,), likewise.
        half: s, what averages reach to either side of their middle.
        earliest, latest: (C,), cells in which the middle may be.
        slope: (D, K, N), Bernstein coefficients of dq/dℓ in K intervals.
        matrix: (C, N, N), A.
        about: (C, N), d.
    """
    count, size = about.shape
    out, least, most = np.zeros((count, size)), np.empty(size), np.empty(size)
    ends = np.empty((2, size))
    for g in range(count):
        if latest[g] < 0 or interval[g] < 0:
            continue
        low, high = earliest[g], latest[g]
        while low > 0 and theta[low] > theta[earliest[g]] - half:
            low -= 1
        while high + 1 < count and theta[high + 1] < theta[latest[g] + 1] + half:
            high += 1
        # What is still is within reach too, or the more range for nothing.
        least[:], most[:] = 0.0, 0.0
        before = -1
        for c in range(low, high + 1):
            k = interval[c]
            if k < 0:
                continue
            if k != before:
                _ends(slope[:, k], matrix[g], about[g], ends)
                before = k
            for i in range(size):
                least[i] = min(least[i], speed[c] * ends[0, i])
                most[i] = max(most[i], speed[c] * ends[1, i])
        out[g] = most - least
    return out


@njit(cache=True, error_model="numpy")
def _ends(slope: FloatArray, matrix: FloatArray, about: FloatArray, ends: FloatArray) -> None:
    """Write least and greatest A (q' − d) (2, N) of one interval."""
    size = about.size
    for i in range(size):
        ends[0, i], ends[1, i] = np.inf, -np.inf
        for c in range(slope.shape[0]):
            total = 0.0
            for j in range(size):
                total += matrix[i, j] * (slope[c, j] - about[j])
            ends[0, i], ends[1, i] = min(ends[0, i], total), max(ends[1, i], total)
