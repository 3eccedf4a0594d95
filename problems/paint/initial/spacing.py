"""How far sweeps lie apart on the surface, and how uneven the coat gets by it."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....core.arrays import FloatArray
from ..spray.footprint import Footprint
from ..spray.strokes import section, spread
from .sweep import Sweep

PLACES = 400
"""Places across a sweep at which the coat is worked out."""


class Ripple(NamedTuple):
    """The coat of many parallel strokes on a plane, by its mean.

    Args:
        least, most: thickness.
        deviation: standard deviation.
    """

    least: float
    most: float
    deviation: float

    @property
    def half_range(self) -> float:
        """± by which the thickness is off its mean, as a share of it."""
        return max(1.0 - self.least, self.most - 1.0)


def predicted_ripple(footprint: Footprint, distance: float, sweep_width: float) -> Ripple:
    """What parallel strokes a sweep width apart give on a plane at constant speed.

    T(y) = Σ g(y - k w) over all k, g the section of a stroke. Elliptic footprints have their long
    axis across the strokes, so that their section is that of the symmetric one by the aspect a:
    ∫ f(√(y² + a² x²)) dx = ∫ f(√(y² + u²)) du / a.

    Args:
        footprint: of the gun.
        distance: of the TCP from the plane, m.
        sweep_width: w, m.
    """
    footprint = replace(footprint, aspect=1.0)
    radius = stroke_radius(footprint, distance)
    y = sweep_width * (np.arange(PLACES) + 0.5) / PLACES
    reach = int(np.ceil(radius / sweep_width)) + 1
    away = np.abs(y[:, None] - sweep_width * np.arange(-reach, reach + 1))
    within = away < radius
    thickness = np.zeros_like(away)
    thickness[within] = section(footprint, away[within], distance, 1.0)
    total = thickness.sum(axis=1)
    total /= total.mean()
    return Ripple(float(total.min()), float(total.max()), float(total.std()))


def stroke_radius(footprint: Footprint, distance: float) -> float:
    """Half the width (m) of a stroke on a plane at a distance (m) of the TCP."""
    return footprint.radius * spread(footprint, distance)


def spacings(sweeps: list[Sweep]) -> FloatArray:
    """Distances (N,) m on the surface from waypoints to the sweep before, where it is beside them.

    As the arc over the chord whose ends have these normals; waypoints whose nearest point is the
    other sweep's end do not count.
    """
    found = [np.empty(0)]
    for one, two in pairwise(sweeps):
        found.append(_to_polyline(two, one))
    return np.concatenate(found)


def _to_polyline(sweep: Sweep, other: Sweep) -> FloatArray:
    points = sweep.frames.point
    start, way = other.frames.point[:-1], np.diff(other.frames.point, axis=0)
    square = np.maximum(np.einsum("mi,mi->m", way, way), 1e-24)
    share = np.einsum("nmi,mi->nm", points[:, None] - start, way) / square
    held = np.clip(share, 0.0, 1.0)
    gap = points[:, None] - start - held[..., None] * way
    length = np.linalg.norm(gap, axis=2)
    nearest = np.argmin(length, axis=1)
    rows = np.arange(len(points))
    at = share[rows, nearest]
    last = len(start) - 1
    beside = ((nearest > 0) | (at >= -1e-6)) & ((nearest < last) | (at <= 1.0 + 1e-6))
    spray = other.frames.spray
    mixed = (1.0 - held[rows, nearest])[:, None] * spray[nearest]
    mixed = mixed + held[rows, nearest][:, None] * spray[nearest + 1]
    mixed /= np.linalg.norm(mixed, axis=1, keepdims=True)
    cosine = np.einsum("ni,ni->n", mixed, sweep.frames.spray)
    half = 0.5 * np.arccos(np.clip(cosine, -1.0, 1.0))
    arc = np.where(half > 1e-4, half / np.maximum(np.sin(half), 1e-4), 1.0)
    return np.asarray((length[rows, nearest] * arc)[beside])
