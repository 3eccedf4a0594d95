"""The quintic between two samples of a path that meets q, q' and q'' at both.

It is one in the share z, from 0 to 1, of their interval. With Δ the interval's length in ℓ, its
data are q, Δ q', Δ² q'' at the left sample, then at the right one.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray

_TABLE = np.array(
    [
        [1, 0, 0, -10, 15, -6],
        [0, 1, 0, -6, 8, -3],
        [0, 0, 0.5, -1.5, 1.5, -0.5],
        [0, 0, 0, 10, -15, 6],
        [0, 0, 0, -4, 7, -3],
        [0, 0, 0, 0.5, -1, 0.5],
    ]
)
"""Coefficients of the six basis functions, by powers of z."""
_POWERS = np.arange(6)


def basis(z: FloatArray | float) -> FloatArray:
    """(..., 6), what each of the data counts at shares z (...)."""
    return np.asarray(np.power.outer(np.asarray(z), _POWERS) @ _TABLE.T)


def coefficients(data: FloatArray) -> FloatArray:
    """(..., 6), the quintics with data (..., 6), by powers of z."""
    return np.asarray(data @ _TABLE)


def at(coefficients: FloatArray, z: FloatArray) -> FloatArray:
    """(K,), quintics (K, 6) at shares (K,): quicker than `basis` where many shares of one are
    asked for."""
    found = coefficients[:, 5]
    for power in range(4, -1, -1):
        found = found * z + coefficients[:, power]
    return found


def slopes(z: FloatArray | float) -> FloatArray:
    """(..., 6), derivative of `basis` by z."""
    rates = _POWERS[1:] * np.power.outer(np.asarray(z), _POWERS[:-1])
    return np.asarray(rates @ _TABLE[:, 1:].T)


def bends(z: FloatArray | float) -> FloatArray:
    """(..., 6), second derivative of `basis` by z."""
    rates = _POWERS[2:] * _POWERS[1:-1] * np.power.outer(np.asarray(z), _POWERS[:-2])
    return np.asarray(rates @ _TABLE[:, 2:].T)
