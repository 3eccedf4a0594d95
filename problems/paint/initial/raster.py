"""Parallel lines over the rectangle into which the part projects: step 1 of section IV-A."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ..surface.part import Part
from .guide import Guide
from .plan import SweepPlan
from .projection import SprayFrames

MOST_SEGMENTS = 1500
"""A raster has no more: six variables for each make full matrices of 0.65 GB."""
FLAT = 1e-9
"""Least extent of what is painted, seen along the view."""


class Rectangle(NamedTuple):
    """The rectangle R on the plane P.

    Args:
        centre: (3,) m.
        along, across: (3,) unit vectors: along the sweeps, and from one to the next.
        spray: (3,) unit vector from the gun to the part, the normal of P.
        length, width: m along and across.
    """

    centre: FloatArray
    along: FloatArray
    across: FloatArray
    spray: FloatArray
    length: float
    width: float

    @property
    def crossed(self) -> Rectangle:
        """The same rectangle for sweeps at right angles."""
        return self._replace(
            along=self.across, across=-self.along, length=self.width, width=self.length
        )


def rectangle_round(part: Part, guide: Guide, plan: SweepPlan) -> Rectangle:
    """The rectangle that what is painted projects into.

    Raises:
        InputError: the painted surface has no mean direction and no view is given, the heading is
            along the view, or what is painted is seen edge-on.
    """
    spray = view_of(part, plan)
    u, v = np.linalg.svd(spray[None, :])[2][1:]
    flat = guide.vertices @ np.stack([u, v], axis=1)
    if plan.heading is None:
        along = _long_side(flat, u, v)
    else:
        heading = np.asarray(plan.heading, dtype=float)
        along = heading - (heading @ spray) * spray
        if np.linalg.norm(along) < 1e-6 * np.linalg.norm(heading):
            raise InputError("SweepPlan.heading: sweeps cannot run along the view of the gun")
        along = along / np.linalg.norm(along)
    across = np.cross(spray, along)
    places = guide.vertices @ np.stack([along, across, spray], axis=1)
    low, high = places.min(axis=0), places.max(axis=0)
    if (high - low)[:2].min() <= FLAT:
        raise InputError(f"{part.name}: seen along the view, what is painted has no extent")
    middle = 0.5 * (low + high)
    middle[2] = low[2]
    centre = middle[0] * along + middle[1] * across + middle[2] * spray
    return Rectangle(centre, along, across, spray, float(high[0] - low[0]), float(high[1] - low[1]))


def raster(rectangle: Rectangle, plan: SweepPlan) -> list[SprayFrames]:
    """Lines along the rectangle, the sweep width apart and in its middle, all in one direction.

    There are as many as it takes for no point to be farther than half a sweep width from one; each
    goes beyond the rectangle by the overhang.

    Raises:
        InputError: there would be more than `MOST_SEGMENTS`.
    """
    count = sweep_count(rectangle.width, plan.sweep_width)
    length = rectangle.length + 2.0 * plan.overhang
    segments = math.ceil(length / plan.longest_segment * (1.0 - 1e-6))
    if count * segments > MOST_SEGMENTS:
        raise InputError(
            f"{count} sweeps of {segments} segments would be needed for a surface of "
            f"{rectangle.length:.4g} by {rectangle.width:.4g} m, and {MOST_SEGMENTS} segments are "
            "the most: check the part's units, the sweep width and the longest segment, or paint "
            "it in pieces"
        )
    along = np.linspace(-0.5 * length, 0.5 * length, segments + 1)
    across = plan.sweep_width * (np.arange(count) - 0.5 * (count - 1))
    tangent = np.tile(rectangle.along, (segments + 1, 1))
    spray = np.tile(rectangle.spray, (segments + 1, 1))
    return [
        SprayFrames(
            rectangle.centre + along[:, None] * rectangle.along + a * rectangle.across,
            tangent,
            spray,
        )
        for a in across
    ]


def sweep_count(width: float, sweep_width: float) -> int:
    """Sweeps that a surface of a width needs."""
    return max(1, math.ceil(width / sweep_width - 1e-6))


def view_of(part: Part, plan: SweepPlan) -> FloatArray:
    """(3,) unit vector along which the gun looks at the part.

    Raises:
        InputError: what is painted has no mean direction, and no view is given.
    """
    if plan.view is not None:
        view = np.asarray(plan.view, dtype=float)
        return np.asarray(view / np.linalg.norm(view))
    mean = part.facing
    if np.linalg.norm(mean) < 0.1:
        raise InputError(
            f"{part.name}: what is painted faces all ways; say by a view from where the gun looks "
            "at it, and paint it in several coats if one view does not see all"
        )
    return np.asarray(-mean / np.linalg.norm(mean))


def _long_side(flat: FloatArray, u: FloatArray, v: FloatArray) -> FloatArray:
    """Direction of the longer side of the smallest rectangle round points (N, 2).

    One of its sides lies along the convex hull (H. Freeman, R. Shapira, Determining the
    minimum-area encasing rectangle for an arbitrary closed curve, Comm. ACM 18, 1975).
    """
    try:
        hull = flat[ConvexHull(flat).vertices]
    except QhullError:
        return u  # all in a line: the caller sees it
    sides = np.roll(hull, -1, axis=0) - hull
    sides = sides[np.linalg.norm(sides, axis=1) > 0.0]
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    normals = np.stack([-sides[:, 1], sides[:, 0]], axis=1)
    along, across = np.ptp(hull @ sides.T, axis=0), np.ptp(hull @ normals.T, axis=0)
    best = int(np.argmin(np.round(along * across / (along * across).max(), 9)))
    side = sides[best] if along[best] >= across[best] * (1.0 - 1e-9) else normals[best]
    way = side[0] * u + side[1] * v
    # Of the two ends, and of equal sides, that nearest to the frame's axes: not left to rounding.
    if abs(along[best] - across[best]) <= 1e-6 * along[best]:
        other = normals[best][0] * u + normals[best][1] * v
        way = max((way, other), key=lambda w: round(float(np.abs(w).max() + 1e-3 * abs(w[0])), 6))
    return np.asarray(way if way[int(np.argmax(np.abs(np.round(way, 6))))] > 0.0 else -way)
