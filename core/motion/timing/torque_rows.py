"""Limits of torque as rows of the stamp: |a u + b x + h| ≤ most (1 - fade x), two rows a joint."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean


class Shares(NamedTuple):
    """Shares of torque along a path, T = a u + b x + h and |T| ≤ 1 - fade x, (S, L) each."""

    a: FloatArray
    b: FloatArray
    h: FloatArray
    fade: FloatArray


def torque_rows(
    shares: Shares,
    ends: IntArray,
    most: FloatArray,
    rows: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
    first: int,
) -> None:
    """Write rows a, b, lower and upper, the lower sides before the upper ones.

    Where less torque is programmed, that much less is left beside the weight.

    Args:
        shares: (S, L), what the path takes.
        ends: (K, 2), samples at both ends of each interval.
        most: (K,), the share of the limit that may be used.
        rows: (K, 2, R) each, R at least ``first`` and 2 L more.
        first: where the rows begin.
    """
    _fill(*shares, ends, most, *rows, first)


@lean
def _fill(
    by_u: FloatArray,
    by_x: FloatArray,
    held: FloatArray,
    fade: FloatArray,
    ends: IntArray,
    most: FloatArray,
    a: FloatArray,
    b: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    first: int,
) -> None:
    count = held.shape[1]
    for k in range(most.size):
        for e in range(2):
            s = ends[k, e]
            for j in range(count):
                low, high = first + j, first + count + j
                lost = most[k] * fade[s, j]
                a[k, e, low] = a[k, e, high] = by_u[s, j]
                b[k, e, low], b[k, e, high] = by_x[s, j] - lost, by_x[s, j] + lost
                lower[k, e, low], upper[k, e, low] = -most[k] * (1.0 + held[s, j]), np.inf
                lower[k, e, high], upper[k, e, high] = -np.inf, most[k] * (1.0 - held[s, j])
