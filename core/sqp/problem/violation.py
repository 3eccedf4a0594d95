"""How far values are outside of their limits."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray


def total(value: FloatArray, lower: FloatArray, upper: FloatArray) -> float:
    """Sum of the violations of ``lower ≤ value ≤ upper``."""
    return float(np.maximum(np.maximum(lower - value, value - upper), 0.0).sum())


def largest(value: FloatArray, lower: FloatArray, upper: FloatArray) -> float:
    """The largest violation; zero where there is none."""
    return float(np.maximum(lower - value, value - upper).max(initial=0.0))
