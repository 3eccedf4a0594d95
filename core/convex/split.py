"""Meshes that are far from convex, in convex parts that enclose them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from .cover import cover
from .decomposition import NotSplitError, approximate_parts

HOLLOW = 0.1
"""Share of its hull's volume that a mesh has to leave free to be far from convex; and that parts
have to save to take the hull's place."""


@dataclass(frozen=True)
class Split:
    """A mesh in convex parts.

    Args:
        parts: corners (K, 3) m of parts whose union holds the mesh's surface; one where it is
            as good as convex or cannot be split.
        lacks: why a mesh that is far from convex is not split, and what helps; None if it is.
    """

    parts: tuple[FloatArray, ...]
    lacks: str | None = None


def split(vertices: FloatArray, faces: NDArray[np.int64]) -> Split:
    """Convex parts round a mesh; the mesh's corners alone where these are enough.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
    """
    used = vertices[np.unique(faces)] if len(faces) else vertices
    whole = hull_volume(used)
    if whole <= 0.0 or not len(faces):
        return Split((used,))
    own = _volume(vertices, faces)
    if own is not None and own >= (1.0 - HOLLOW) * whole:
        return Split((used,))
    told = "its convex hull is larger by an unknown volume"
    if own is not None:
        told = f"its convex hull has {whole / own:.3g} times its volume"
    try:
        proposed = tuple(part.tobytes() for part in _floats(approximate_parts(vertices, faces)))
        parts = _covered(*_bytes_of(vertices, faces), proposed)
    except NotSplitError as error:
        return Split((used,), f"{told}; {error}")
    if not parts or sum(map(hull_volume, parts)) > (1.0 - HOLLOW) * whole:
        return Split((used,))
    return Split(tuple(parts))


@lru_cache(maxsize=16)
def _covered(corners: bytes, triangles: bytes, proposed: tuple[bytes, ...]) -> list[FloatArray]:
    """Convex parts that enclose a mesh: several scenes ask for those of one tool."""
    vertices = np.frombuffer(corners).reshape(-1, 3)
    faces = np.frombuffer(triangles, dtype=np.int64).reshape(-1, 3)
    return cover(vertices, faces, [np.frombuffer(part).reshape(-1, 3) for part in proposed])


def _bytes_of(vertices: FloatArray, faces: NDArray[np.int64]) -> tuple[bytes, bytes]:
    return np.asarray(vertices, dtype=float).tobytes(), np.asarray(faces, np.int64).tobytes()


def _floats(parts: Sequence[FloatArray]) -> Iterator[FloatArray]:
    return (np.asarray(part, dtype=float) for part in parts)


def hull_volume(points: FloatArray) -> float:
    """m³ of the convex hull of points (K, 3); 0 where it is flat."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0


def _volume(vertices: FloatArray, faces: NDArray[np.int64]) -> float | None:
    """m³ inside; None for a surface that is not closed, or turned inside out somewhere."""
    import trimesh

    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.merge_vertices()
    return float(abs(mesh.volume)) if mesh.is_watertight and mesh.is_winding_consistent else None
