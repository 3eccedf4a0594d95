"""Convex parts that enclose a mesh by construction.

The surface is cut into pieces, each of which goes to one part: the part becomes the convex hull of
its own corners and of all its pieces. So each point of the surface is in a part, whatever parts
were given; how good they are decides only how much the hulls add.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray

CLOSE = 1e-3
"""By the mesh's extent: farther a piece need not stick out of a part to be cut further."""
FINEST = 0.004
"""By the mesh's extent: pieces with no longer edges are not cut further."""
_CHUNK = 2_000_000
"""Numbers worked on at once."""


def cover(
    vertices: FloatArray, faces: NDArray[np.int64], parts: Sequence[FloatArray]
) -> list[FloatArray]:
    """Corners of convex parts whose union holds the surface of a mesh.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        parts: corners (K, 3) of parts that are about where the mesh is; flat ones are passed over.

    Returns:
        Corners of as many parts or fewer; empty where no part has a volume.
    """
    planes = [(part, found) for part in parts if (found := _planes(part)) is not None]
    if not planes:
        return []
    extent = float(np.ptp(vertices, axis=0).max())
    taken: list[list[FloatArray]] = [[part] for part, _ in planes]
    triangles = vertices[faces]
    while len(triangles):
        out = np.stack([_outside(triangles, found) for _, found in planes], axis=-1)
        worst = out.max(axis=1)
        best = worst.argmin(axis=1)
        # Where the corners by themselves stick out as far, cutting does not help.
        alone = out.min(axis=2).max(axis=1)
        edges = triangles - np.roll(triangles, -1, axis=1)
        lengths = np.linalg.norm(edges, axis=2)
        good = worst.min(axis=1) <= alone + CLOSE * extent
        good |= lengths.max(axis=1) <= FINEST * extent
        for k in range(len(planes)):
            corners = triangles[good & (best == k)].reshape(-1, 3)
            if len(corners):
                taken[k].append(np.unique(corners, axis=0))
        triangles = _halved(triangles[~good], lengths[~good].argmax(axis=1))
    return [_hull_corners(np.concatenate(points)) for points in taken]


def _halved(triangles: FloatArray, longest: NDArray[np.int64]) -> FloatArray:
    """Triangles (T, 3, 3) cut at the middle of the edge from corner ``longest`` to the next."""
    rows = np.arange(len(triangles))
    a, b, c = (triangles[rows, (longest + k) % 3] for k in range(3))
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


def _planes(points: FloatArray) -> FloatArray | None:
    """Outward normals and offsets (F, 4) of the hull of points; None where it is flat."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return np.asarray(np.unique(ConvexHull(points).equations, axis=0))
    except (QhullError, ValueError):
        return None


def _hull_corners(points: FloatArray) -> FloatArray:
    from scipy.spatial import ConvexHull

    corners = np.sort(ConvexHull(points).vertices)
    return np.asarray(points[corners], dtype=float)


def _outside(triangles: FloatArray, planes: FloatArray) -> FloatArray:
    """How far (T, 3) m the corners of triangles are beyond the planes of a part, 0 inside."""
    points = triangles.reshape(-1, 3)
    rows = max(1, _CHUNK // len(planes))
    found = [
        (points[k : k + rows] @ planes[:, :3].T + planes[:, 3]).max(axis=1)
        for k in range(0, len(points), rows)
    ]
    return np.asarray(np.maximum(np.concatenate(found), 0.0).reshape(-1, 3))
