"""A fender with bends, flanges and holes as a test part, made by formulas."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...problems.paint.surface.part import Part

CROWN_RADIUS, CROWN_WIDTH = 1.2, 0.42
"""m: the crown's arc and its chord."""
BEND_RADIUS, BEND_ANGLE = 0.045, math.radians(75.0)
"""m and rad: both sides are bent down."""
FLANGE = 0.03
"""m behind each bend."""
ARCH_RADIUS, ARCH_ANGLE = 0.65, math.radians(110.0)
"""m and rad: the middle of the crown is swept along an arch about the axle, which lies along y."""
LAMP_DIAMETER, LAMP_ANGLE = 0.09, math.radians(35.0)
"""m, and rad along the arch to both sides: two holes in the middle of the crown."""
BOLT_DIAMETER, BOLT_ANGLE = 0.016, math.radians(30.0)
"""m, and rad along the arch to both sides: two holes in the middle of each flange."""
JITTER = 0.15
"""Share of the spacing by which inner vertices are moved at random."""

_HALF_CROWN = math.asin(0.5 * CROWN_WIDTH / CROWN_RADIUS)
_BEND_START = CROWN_RADIUS * _HALF_CROWN
_FLANGE_START = _BEND_START + BEND_RADIUS * BEND_ANGLE
_PROFILE = _FLANGE_START + FLANGE
"""m along the profile from its middle to its end."""


def fender(spacing: float = 0.01, seed: int = 0) -> Part:
    """The fender, open below, its crown on top at the origin.

    Args:
        spacing: m between vertices.
        seed: of the irregular places of inner vertices.

    Raises:
        InputError: the spacing is too wide for the bends.
    """
    if not 0.0 < spacing <= 0.6 * BEND_RADIUS:
        raise InputError(f"spacing: above 0 and at most {0.6 * BEND_RADIUS} m, not {spacing}")
    places = _places(spacing, np.random.default_rng(seed))
    faces = Delaunay(places).simplices.astype(np.int64)
    faces = faces[~_in_hole(places[faces].mean(axis=1))]
    a, b, c = np.moveaxis(places[faces], 1, 0)
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    # (profile, arch) = (y, x) seen from above: anticlockwise there is clockwise here.
    faces = np.where((twice > 0.0)[:, None], faces[:, ::-1], faces)
    faces = faces[np.abs(twice) > 1e-4 * spacing * spacing]
    used, index = np.unique(faces, return_inverse=True)
    return Part.of_triangles(_in_space(places[used]), index.reshape(-1, 3), name="fender")


def hole_centres() -> tuple[tuple[float, float, float], ...]:
    """Profile and arch coordinates (m) of the holes' centres, and their radii."""
    bolt = 0.5 * (_FLANGE_START + _PROFILE)
    lamps = [(0.0, k * LAMP_ANGLE * ARCH_RADIUS, 0.5 * LAMP_DIAMETER) for k in (-1, 1)]
    bolts = [
        (side * bolt, k * BOLT_ANGLE * ARCH_RADIUS, 0.5 * BOLT_DIAMETER)
        for side in (-1, 1)
        for k in (-1, 1)
    ]
    return (*lamps, *bolts)


def _section(s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Width and height (<= 0) at a length s along the profile from its middle, m."""
    length, side = np.abs(s), np.sign(s)
    turn = np.minimum(length / CROWN_RADIUS, _HALF_CROWN)
    width = CROWN_RADIUS * np.sin(turn)
    height = CROWN_RADIUS * (np.cos(turn) - 1.0)
    bent = np.clip((length - _BEND_START) / BEND_RADIUS, 0.0, BEND_ANGLE)
    width += BEND_RADIUS * (np.sin(_HALF_CROWN + bent) - np.sin(_HALF_CROWN)) * (bent > 0.0)
    height += BEND_RADIUS * (np.cos(_HALF_CROWN + bent) - np.cos(_HALF_CROWN)) * (bent > 0.0)
    beyond = np.maximum(length - _FLANGE_START, 0.0)
    width += beyond * math.cos(_HALF_CROWN + BEND_ANGLE)
    height -= beyond * math.sin(_HALF_CROWN + BEND_ANGLE)
    return side * width, height


def _in_space(places: FloatArray) -> FloatArray:
    """Points (N, 3) m at places (N, 2): profile and arch, m."""
    width, height = _section(places[:, 0])
    turn = places[:, 1] / ARCH_RADIUS
    reach = ARCH_RADIUS + height
    return np.stack([reach * np.sin(turn), width, reach * np.cos(turn) - ARCH_RADIUS], axis=1)


def _stretch(s: FloatArray) -> FloatArray:
    """True length of the arch where the profile stands at s, by that in the middle."""
    return 1.0 + _section(s)[1] / ARCH_RADIUS


def _places(spacing: float, rng: np.random.Generator) -> FloatArray:
    """Vertices in profile and arch coordinates: rims, hole edges, and a grid between."""
    arch = 0.5 * ARCH_RADIUS * ARCH_ANGLE
    s = np.linspace(-_PROFILE, _PROFILE, math.ceil(2.0 * _PROFILE / spacing) + 1)
    a = np.linspace(-arch, arch, math.ceil(2.0 * arch / spacing) + 1)
    grid = np.stack(np.meshgrid(s, a, indexing="ij"), axis=-1)
    inner = np.zeros(grid.shape[:2], dtype=bool)
    inner[1:-1, 1:-1] = True
    grid[inner] += rng.uniform(-JITTER, JITTER, (inner.sum(), 2)) * spacing
    points = grid.reshape(-1, 2)
    rings = []
    for centre_s, centre_a, radius in hole_centres():
        count = max(16, math.ceil(2.0 * math.pi * radius / spacing))
        angle = 2.0 * math.pi * np.arange(count) / count
        ring_s = centre_s + radius * np.cos(angle)
        rings.append(np.stack([ring_s, centre_a + radius * np.sin(angle) / _stretch(ring_s)], 1))
        side = 2.0 * math.pi * radius / count
        points = points[_from_hole(points, centre_s, centre_a) > radius + 0.6 * min(side, spacing)]
    return np.concatenate([points, *rings])


def _from_hole(points: FloatArray, centre_s: float, centre_a: float) -> FloatArray:
    """Distance (N,) m of places from a hole's centre."""
    across = (points[:, 1] - centre_a) * _stretch(points[:, 0])
    return np.asarray(np.hypot(points[:, 0] - centre_s, across))


def _in_hole(points: FloatArray) -> NDArray[np.bool_]:
    inside = np.zeros(len(points), dtype=bool)
    for centre_s, centre_a, radius in hole_centres():
        inside |= _from_hole(points, centre_s, centre_a) < radius
    return inside
