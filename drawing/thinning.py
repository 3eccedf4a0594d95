"""Meshes with fewer triangles, for drawing."""

from __future__ import annotations

import numpy as np

from ..core.arrays import FloatArray, IntArray


def clustered(vertices: FloatArray, faces: IntArray, cells: int) -> tuple[FloatArray, IntArray]:
    """A mesh on a grid: points of one cube become their mean.

    Points of one cube that face to opposite sides stay two, so that thin walls stay walls.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        cells: into so many cubes the longest side is cut.
    """
    edge = float(np.ptp(vertices, axis=0).max()) / cells
    keys = np.hstack(
        [
            np.round(vertices / edge).astype(np.int64),
            (_facing(vertices, faces) > 0.0).astype(np.int64),
        ]
    )
    _, owner, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    owner = owner.ravel()
    merged = np.stack(
        [np.bincount(owner, vertices[:, k], len(count)) / count for k in range(3)], axis=1
    )
    named = owner[faces]
    corners = np.sort(named, axis=1)
    kept = (corners[:, 0] < corners[:, 1]) & (corners[:, 1] < corners[:, 2])
    _, first = np.unique(corners[kept], axis=0, return_index=True)
    return merged, named[kept][np.sort(first)]


def _facing(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Where the surface at each point faces (V, 3): the sum of its triangles' normals."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    found = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(found, faces[:, k], normals)
    return found
