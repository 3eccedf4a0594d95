"""Limits of torque as rows of the stamp: |a u + b x + h| ≤ most (1 - fade x), two rows a joint."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray, IntArray
from ..gradients.stamping_adjoint import StampGradient
from .torque import Shares


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


def pull_torque_rows(
    shares: Shares, ends: IntArray, most: FloatArray, bar: StampGradient
) -> tuple[Shares, FloatArray]:
    """Reverse of `torque_rows`, whose rows are the last of the stamp's.

    Returns:
        The gradients of the shares and of ``most`` (K,).
    """
    count = shares.h.shape[1]
    held, fade, below = shares.h[ends], shares.fade[ends], slice(-2 * count, -count)
    a_bar = bar.a[:, :, below] + bar.a[:, :, -count:]
    b_bar = bar.b[:, :, below] + bar.b[:, :, -count:]
    more = bar.b[:, :, -count:] - bar.b[:, :, below]
    lower, upper = bar.lower[:, :, below], bar.upper[:, :, -count:]
    most_bar = np.sum(upper * (1 - held) - lower * (1 + held) + more * fade, axis=(1, 2))
    most = most[:, None, None]
    out = Shares(*(np.zeros_like(part) for part in shares))
    for part, seed in zip(out, (a_bar, b_bar, -most * (upper + lower), most * more), strict=True):
        np.add.at(part, ends, seed)
    return out, np.asarray(most_bar)
