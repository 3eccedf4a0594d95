"""A trajectory problem as it is stated: with its start, and its optimum where one is known."""

from __future__ import annotations

from dataclasses import dataclass

from ...core.arrays import FloatArray
from .collocation import Collocation, Control, collocated, guess
from .separable import Separable


@dataclass(frozen=True)
class StatedTrajectory:
    """A problem with its start and its optimum.

    Args:
        problem: with its formulas.
        start: (n,).
        optimum: known, of the finest grid; NaN where none is.
    """

    problem: Separable
    start: FloatArray
    optimum: float


def stated(
    control: Control,
    nodes: FloatArray,
    parameters: list[float],
    optimum: float = float("nan"),
    scheme: Collocation = Collocation.TRAPEZOIDAL,
) -> StatedTrajectory:
    """A problem from a start: nodes (N, states + controls) and parameters."""
    return StatedTrajectory(
        collocated(control, len(nodes), scheme), guess(parameters, nodes), optimum
    )
