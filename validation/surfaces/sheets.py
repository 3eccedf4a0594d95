"""Test surfaces: plates, saddles, waves, a slope and a fender, made by formulas, all open sheets.

All are seen from above (the gun looks along -z) and have their middle near the origin.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.errors import InputError
from ...problems.paint.surface.part import Part

SIDE = 1.0
"""m, of the square surfaces."""
SLOPE_FLAT, SLOPE_RADIUS, SLOPE_END = 0.35, 0.55, math.radians(60.0)
"""m, m and rad: the sloped panel's flat and the arc behind it."""

Height = Callable[[FloatArray, FloatArray], FloatArray]


def plate(across: int = 51, side: float = SIDE) -> Part:
    """A flat square.

    Args:
        across: vertices along a side.
        side: m.
    """
    return _sheet(lambda x, y: 0.0 * x, across, side, f"plate {side:g} m")


def saddle(radius: float, across: int = 51, side: float = SIDE) -> Part:
    """z = (x² - y²) / 2R over a square: curved with ±1/R in its middle.

    Args:
        radius: R, m.
        across: vertices along a side.
        side: m, of the square.
    """
    return _sheet(
        lambda x, y: (x * x - y * y) / (2.0 * radius), across, side, f"saddle R {radius:g} m"
    )


def wavy(
    amplitude: float,
    wave: float = 0.5,
    heading: float = 0.0,
    across: int = 51,
    side: float = SIDE,
) -> Part:
    """A corrugated square: z = a sin(2π u / λ) with u along the heading.

    Args:
        amplitude: a, m.
        wave: λ, m.
        heading: rad from x to the direction in which the waves follow each other.
        across: vertices along a side.
        side: m, of the square.
    """

    def height(x: FloatArray, y: FloatArray) -> FloatArray:
        u = x * math.cos(heading) + y * math.sin(heading)
        return amplitude * np.sin(2.0 * math.pi * u / wave)

    return _sheet(height, across, side, f"wavy {1e3 * amplitude:g} mm")


def sloped(across: int = 51, side: float = SIDE) -> Part:
    """A panel flat at first, along y, that then bends down to 60° on an arc of R 0.55 m.

    Args:
        across: vertices along a side.
        side: m, width of the panel, along x.
    """
    x, s = _grid(across, 1.0)
    along = (s + 0.5) * (SLOPE_FLAT + SLOPE_RADIUS * SLOPE_END)
    turn = np.maximum(along - SLOPE_FLAT, 0.0) / SLOPE_RADIUS
    y = np.minimum(along, SLOPE_FLAT) + SLOPE_RADIUS * np.sin(turn) - 0.5 * side
    z = SLOPE_RADIUS * (np.cos(turn) - 1.0)
    return Part.of_triangles(
        np.stack([x * side, y, z], axis=1), grid_faces(across, across), name="sloped panel"
    )


def scanned(part: Part, noise: float, lost: float, seed: int) -> Part:
    """A part as a scanner gives it: heights with noise, triangles missing here and there.

    Args:
        part: the true one.
        noise: m, standard deviation along the normals.
        lost: share of triangles missing, in 0..1.
        seed: of the noise.
    """
    rng = np.random.default_rng(seed)
    moved = part.vertices + rng.normal(0.0, noise, (len(part.vertices), 1)) * part.normals
    kept = rng.random(len(part.faces)) >= lost
    faces = part.faces[kept]
    used, index = np.unique(faces, return_inverse=True)
    return Part.of_triangles(
        moved[used], index.reshape(-1, 3), part.painted_faces[kept], f"{part.name}, scanned"
    )


def grid_faces(rows: int, columns: int) -> IntArray:
    """Triangles (F, 3) of a grid of vertices, rows one after the other, diagonals in turn.

    Diagonals that alternate do not favour a direction.
    """
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b = index[:-1, :-1].ravel(), index[1:, :-1].ravel()
    c, d = index[1:, 1:].ravel(), index[:-1, 1:].ravel()
    i, j = np.divmod(np.arange(len(a)), columns - 1)
    even = ((i + j) % 2 == 0)[:, None]
    one = np.where(even, np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    two = np.where(even, np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    return np.stack([one, two], axis=1).reshape(-1, 3)


def _sheet(height: Height, across: int, side: float, name: str) -> Part:
    """z over a square, seen from above."""
    x, y = _grid(across, side)
    vertices = np.stack([x, y, height(x, y)], axis=1)
    return Part.of_triangles(vertices, grid_faces(across, across), name=name)


def _grid(across: int, side: float) -> tuple[FloatArray, FloatArray]:
    if across < 2:
        raise InputError(f"across: at least 2 vertices, not {across}")
    line = np.linspace(-0.5 * side, 0.5 * side, across)
    x, y = np.meshgrid(line, line, indexing="ij")
    return x.ravel(), y.ravel()
