"""Levenberg's damping of the model's Hessian.

Far from a solution the multipliers, and with them the Hessian, say little, and an undamped model
whose objective is linear (a final time) goes to wherever the linearised constraints let it. The
diagonal is raised by a multiple of the Lagrangian's slope over the size of the variable: no unit
changes it, it holds each variable's own step to a share of its size, and it vanishes with the
slope, so that Newton's convergence stays (Li, Fukushima, Qi and Yamashita, "Regularized Newton
methods for convex minimization problems with singular solutions", 2004).
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray

_FIRST = 10.0
_DECAY, _GROWTH = 0.3, 10.0
_LEAST, _LARGEST = 1e-4, 1e4
_SHORT = 0.25


class Damping:
    """The damping of one solution; it decays as steps succeed.

    Attributes:
        level: multiple of slope over size.
    """

    def __init__(self) -> None:
        self.level = _FIRST

    def diagonal(self, slope: FloatArray, sizes: FloatArray) -> FloatArray:
        """What the diagonal is raised by (n,).

        Args:
            slope: (n,) of the Lagrangian, bounds included.
            sizes: (n,) of the variables.
        """
        return self.level * np.abs(slope) / sizes

    def taken(self, length: float) -> None:
        """This share of a step was taken."""
        if length == 1.0:
            self.level = self.level * _DECAY if self.level > _LEAST else 0.0
        elif length <= _SHORT:
            self.level = min(_LARGEST, max(_LEAST, _GROWTH * self.level))
