"""Meshes made by formula: closed surfaces of as many triangles as are asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.cell.geometry import Mesh, Triangles

Place = tuple[float, float]


def plate(
    height: Callable[[FloatArray, FloatArray], FloatArray],
    lower: Place,
    upper: Place,
    grid: float,
    thickness: float,
) -> Mesh:
    """A plate under a surface z = height(x, y).

    Args:
        height: of the upper side, m.
        lower, upper: corners of the plate seen from above, m.
        grid: longest edge of the squares that are cut into triangles, m.
        thickness: m, straight down.
    """
    counts = [int(np.ceil((b - a) / grid - 1e-9)) for a, b in zip(lower, upper, strict=True)]
    spans = [np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, counts, strict=True)]
    x, y = np.meshgrid(*spans, indexing="ij")
    top = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    below = top - [0.0, 0.0, thickness]
    upper_side = _squares(np.arange(len(top)).reshape(x.shape))
    lower_side = upper_side[:, ::-1] + len(top)
    rim = _rim(np.arange(len(top)).reshape(x.shape))
    ahead = np.roll(rim, -1)
    n = len(top)
    side = np.concatenate(
        [np.stack([rim, rim + n, ahead + n], axis=1), np.stack([rim, ahead + n, ahead], axis=1)]
    )
    return made(
        "plate", np.concatenate([top, below]), np.concatenate([upper_side, lower_side, side])
    )


def tube(name: str, rings: FloatArray) -> Mesh:
    """A closed surface through rings of points, a flat or pointed cap at either end.

    Args:
        name: of the mesh.
        rings: (A, B, 3) m, A rings of B points; the first and the last one are seen whole from
            their middle. It has 2·A·B triangles.
    """
    count, around, _ = rings.shape
    index = np.arange(count * around).reshape(count, around)
    side = _squares(np.concatenate([index, index[:, :1]], axis=1))
    bottom, top = count * around, count * around + 1
    caps = [
        np.stack([np.full(around, bottom), index[0], np.roll(index[0], -1)], axis=1),
        np.stack([np.full(around, top), np.roll(index[-1], -1), index[-1]], axis=1),
    ]
    ends = [rings[0].mean(axis=0), rings[-1].mean(axis=0)]
    vertices = np.concatenate([rings.reshape(-1, 3), ends])
    faces = np.concatenate([side, *caps])
    return made(name, vertices, faces if _volume(vertices, faces) > 0 else faces[:, ::-1])


def _volume(vertices: FloatArray, faces: IntArray) -> float:
    """Signed volume inside, m³ (divergence theorem); negative if the triangles face inwards."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("fi,fi->", a, np.cross(b, c)) / 6.0)


def made(name: str, vertices: FloatArray, faces: IntArray) -> Mesh:
    """The mesh of points (V, 3) m and triangles (F, 3)."""
    return Mesh(Path(f"{name}.stl"), "m", Triangles(vertices, faces))


def _squares(index: IntArray) -> IntArray:
    """Triangles (F, 3) of a grid of points (A, B), anticlockwise as (first axis, second axis)."""
    a, b = index[:-1, :-1].ravel(), index[1:, :-1].ravel()
    c, d = index[1:, 1:].ravel(), index[:-1, 1:].ravel()
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def _rim(index: IntArray) -> IntArray:
    """The grid's outermost points once round, anticlockwise."""
    return np.concatenate([index[:-1, 0], index[-1, :-1], index[:0:-1, -1], index[0, :0:-1]])
