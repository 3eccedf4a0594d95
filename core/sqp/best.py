"""The best point that a solution has seen."""

from __future__ import annotations

from dataclasses import dataclass

from ..arrays import FloatArray
from .problem.evaluation import Point
from .problem.optimality import OptimalityResiduals


@dataclass(slots=True)
class Best:
    """The best point seen: the least violated one; of those within the tolerance the nearest to
    a solution, or the lowest where none is near to one.

    Args:
        point: with derivatives.
        multipliers: (m,).
        objective: unscaled.
        at: residuals there.
        near: whether it may count as a solution where no better one is found.
    """

    point: Point
    multipliers: FloatArray
    objective: float
    at: OptimalityResiduals
    near: bool

    def beaten_by(self, other: Best, tolerance: float) -> bool:
        """Whether ``other`` is better."""
        mine, its = self.at.violation <= tolerance, other.at.violation <= tolerance
        if mine != its:
            return its
        if not its:
            return other.at.violation < self.at.violation
        if self.near != other.near:
            return other.near
        noise = 1e-12 * max(1.0, abs(other.objective))
        if self.near or abs(other.objective - self.objective) <= noise:
            return other.at.kkt < self.at.kkt
        return other.objective < self.objective
