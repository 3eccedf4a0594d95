"""What a step shows of the Lagrangian's curvature, damped so that a quasi-Newton matrix stays
definite (Powell; Nocedal and Wright, "Numerical Optimization", procedure 18.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from .evaluation import Point
from .optimality import lagrangian_slope

_DAMPING = 0.2
_ROUNDING = 1e-14
_STILL = 1e-28
"""Squared length of a step that shows nothing."""


@dataclass(frozen=True, slots=True)
class ObservedStep:
    """A step and what the Lagrangian's slope changed by along it.

    Args:
        s: (n,) the step.
        y: (n,) the change of slope.
        noise: of s·y, by rounding of the slopes.
    """

    s: FloatArray
    y: FloatArray
    noise: float

    @property
    def curvature(self) -> float:
        """s·y."""
        return float(self.s @ self.y)

    @property
    def size(self) -> float:
        """s·s."""
        return float(self.s @ self.s)

    def damped(self, Bs: FloatArray) -> FloatArray | None:
        """The change of slope (n,) that the matrix B is to have along the step; None where
        differences of rounded slopes would teach nothing, or 0/0.

        Args:
            Bs: (n,) what it has.
        """
        expected, curvature = float(self.s @ Bs), self.curvature
        theta = 1.0
        if curvature < _DAMPING * expected:
            theta = (1.0 - _DAMPING) * expected / (expected - curvature)
        r = theta * self.y + (1.0 - theta) * Bs
        return r if min(expected, float(self.s @ r)) > self.noise else None


def observed(old: Point, new: Point, multipliers: FloatArray) -> ObservedStep | None:
    """The step between two points with derivatives; None where it is too short to show anything.

    Args:
        multipliers: (m,) scaled.
    """
    s = new.x - old.x
    if float(s @ s) < _STILL:
        return None
    before = lagrangian_slope(old.g, old.J, multipliers)
    after = lagrangian_slope(new.g, new.J, multipliers)
    noise = _ROUNDING * float(np.abs(s) @ (np.abs(after) + np.abs(before)))
    return ObservedStep(s, after - before, noise)
