"""Circles for the point mass: the thesis (section 3.4) prints none, so these are ours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray

Place = tuple[float, float]
Disc = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Scene:
    """Where the point mass may go.

    Args:
        start, goal: (x, y), both at rest.
        circles: (x, y, radius) of each; they may overlap.
        lower, upper: corners of the square.
        way: corners of a free way from the start to the goal, both included: what a path planner
            would give.
    """

    start: Place
    goal: Place
    circles: tuple[Disc, ...]
    lower: Place = (0.0, 0.0)
    upper: Place = (10.0, 10.0)
    way: tuple[Place, ...] = ()

    @property
    def centres(self) -> FloatArray:
        """(K, 2)."""
        return np.array(self.circles).reshape(-1, 3)[:, :2]

    @property
    def radii(self) -> FloatArray:
        """(K,)."""
        return np.array(self.circles).reshape(-1, 3)[:, 2]


def _row(start: Place, end: Place, count: int, radius: float) -> tuple[Disc, ...]:
    """Overlapping circles from one place to another."""
    centres = np.linspace(start, end, count)
    return tuple((round(float(x), 6), round(float(y), 6), radius) for x, y in centres)


GARDEN = Scene(
    start=(1.0, 1.0),
    goal=(9.0, 9.0),
    circles=((3.0, 2.2, 1.0), (3.4, 5.2, 1.3), (6.3, 5.0, 1.2), (7.4, 8.3, 1.0)),
    way=((1.0, 1.0), (3.6, 0.8), (5.0, 3.4), (4.9, 6.7), (7.0, 6.9), (8.8, 7.4), (9.0, 9.0)),
)
"""Four separate circles, as on the left of figure 3.4."""

MAZE = Scene(
    start=(1.0, 3.0),
    goal=(9.0, 3.0),
    circles=(
        *_row((5.0, 0.25), (5.0, 6.95), 11, 0.35),  # a wall that leaves a way at its upper end
        (2.6, 6.2, 0.8),
        (7.6, 5.6, 0.9),
        (3.0, 1.4, 0.6),
    ),
    way=((1.0, 3.0), (3.9, 6.4), (5.0, 8.2), (6.2, 6.6), (6.4, 4.4), (9.0, 3.0)),
)
"""A wall of overlapping circles between start and goal, open above, as in figure 3.5."""

WALL = Scene(
    start=(1.0, 3.0),
    goal=(9.0, 3.0),
    circles=_row((5.0, 0.25), (5.0, 9.75), 15, 0.35),
)
"""The same wall right across the square: no way at all, as on the right of figure 3.4."""
