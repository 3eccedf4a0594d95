"""The robust loss: square for small residuals, linear for large ones.

ρ(r) = δ² (√(1 + (r/δ)²) − 1), the pseudo-Huber loss. A residual enters the least-squares problem as
φ(r) = sign(r) √(2 ρ(r)), so that ½ φ² = ρ and Gauss–Newton minimises the robust sum itself.
"""

from __future__ import annotations

import numpy as np

from ...core.arrays import FloatArray

BEND = 2.0
"""δ: weighted residuals beyond it count linearly."""


def loss(r: FloatArray) -> FloatArray:
    """ρ(r)."""
    z = r / BEND
    return np.asarray(BEND**2 * (z * z / (1.0 + np.sqrt(1.0 + z * z))))


def influence(r: FloatArray) -> FloatArray:
    """ρ′(r), what a residual pulls with."""
    return np.asarray(r / np.sqrt(1.0 + (r / BEND) ** 2))


def curvature(r: FloatArray) -> FloatArray:
    """ρ″(r)."""
    return np.asarray((1.0 + (r / BEND) ** 2) ** -1.5)


def square_root(r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """φ(r) and φ′(r)."""
    root = np.sqrt(1.0 + (r / BEND) ** 2)
    # √(2 ρ) = |r| √(2 / (1 + root)), without the difference of two near numbers.
    phi = r * np.sqrt(2.0 / (1.0 + root))
    return phi, np.sqrt(0.5 * (1.0 + root)) / root
