"""Limits of torque as rows of the stamp: |a u + b x + h| ≤ most (1 - fade x), two rows a joint."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray


class Shares(NamedTuple):
    """Shares of torque along a path, T = a u + b x + h and |T| ≤ 1 - fade x, (S, L) each."""

    a: FloatArray
    b: FloatArray
    h: FloatArray
    fade: FloatArray


def torque_rows(
    shares: Shares, ends: IntArray, most: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Rows a, b, lower and upper (K, 2, 2 L), the lower sides before the upper ones.

    Where less torque is programmed, that much less is left beside the weight.

    Args:
        shares: (S, L), what the path takes.
        ends: (K, 2), samples at both ends of each interval.
        most: (K,), the share of the limit that may be used.
    """
    most = most[:, None, None]
    a, b, held, fade = (part[ends] for part in shares)
    none = np.full(held.shape, np.inf)
    return (
        np.concatenate([a, a], axis=2),
        np.concatenate([b - most * fade, b + most * fade], axis=2),
        np.concatenate([-most * (1 + held), -none], axis=2),
        np.concatenate([none, most * (1 - held)], axis=2),
    )
