"""The motion of a point mass between samples: arcs of parabolas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Arcs:
    """Quadratic Bézier curves, one after the other, each driven in the same time.

    Under a constant force the motion of an interval of length h is
    p(s) = (1 − s)² p₀ + 2 s (1 − s) p₁ + s² p₂ with p₁ = p₀ + h v₀/2 and s = t/h.

    Args:
        controls: (M, 3, 2) p₀, p₁ and p₂ of each.
        time: of all of them together.
    """

    controls: FloatArray
    time: float

    def points(self, per_arc: int) -> FloatArray:
        """Places along the motion, the end included: (M · per_arc + 1, 2)."""
        s = np.arange(per_arc) / per_arc
        basis = np.column_stack([(1.0 - s) ** 2, 2.0 * s * (1.0 - s), s**2])
        inside = np.einsum("sk,mkd->msd", basis, self.controls).reshape(-1, 2)
        return np.vstack([inside, self.controls[-1:, 2]])
