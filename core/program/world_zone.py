"""A space with an output that the controller itself sets while the TCP, or axes, are in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray


@dataclass(frozen=True)
class WorldZone:
    """A space with an output.

    Args:
        name: for messages.
        robot: whose TCP or axes are watched.
        signal: of the robot, that is set.
        inside: what it is while inside; outside it is the other.
        box: two corners in the world, m; None for none.
        ball: centre in the world and radius, m; None for none.
        cylinder: of the world's z axis: centre of one end, radius and height, m, which is below
            zero where the other end is below; None for none.
        axes, linear_axes: least and greatest value of axes by index, rad or m; those that a
            station file gives in mm by themselves.
    """

    name: str
    robot: str
    signal: str
    inside: bool = True
    box: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None
    ball: tuple[tuple[float, float, float], float] | None = None
    cylinder: tuple[tuple[float, float, float], float, float] | None = None
    axes: tuple[tuple[int, float, float], ...] = ()
    linear_axes: tuple[tuple[int, float, float], ...] = ()

    def depths(self, position: FloatArray, q: FloatArray) -> FloatArray:
        """How far inside the TCP at (T, 3) m in the world, and axes (T, N), are: (T, 1 + N).

        Below zero it is outside. None of them changes faster than what it is of: the first, m, than
        the TCP; the others, rad or m, than their axes.
        """
        found = np.full((len(position), 1 + q.shape[1]), np.inf)
        place = found[:, 0]
        if self.box is not None:
            one, other = np.array(self.box)
            low, high = np.minimum(one, other), np.maximum(one, other)
            np.minimum(place, np.minimum(position - low, high - position).min(axis=1), out=place)
        if self.ball is not None:
            centre, radius = self.ball
            off = np.linalg.norm(position - np.array(centre), axis=1)
            np.minimum(place, radius - off, out=place)
        if self.cylinder is not None:
            foot, radius, height = self.cylinder
            off = np.linalg.norm(position[:, :2] - np.array(foot[:2]), axis=1)
            np.minimum(place, radius - off, out=place)
            up = position[:, 2] - (foot[2] + min(height, 0.0))
            np.minimum(place, np.minimum(up, abs(height) - up), out=place)
        for index, least, greatest in (*self.axes, *self.linear_axes):
            own = np.minimum(q[:, index] - least, greatest - q[:, index])
            found[:, 1 + index] = np.minimum(found[:, 1 + index], own)
        return found

    def holds(self, position: FloatArray, q: FloatArray) -> NDArray[np.bool_]:
        """Whether the TCP at (T, 3) m in the world, and axes (T, N), are inside."""
        return np.asarray((self.depths(position, q) >= 0.0).all(axis=1))
