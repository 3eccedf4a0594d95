"""What a body is made of: the simple convex shapes, convex polytopes, and triangle meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...robot.shape import Box, Capsule, Cylinder, Sphere


@dataclass(frozen=True, slots=True, eq=False)
class Polytope:
    """The convex hull of corner points.

    Args:
        vertices: (V, 3) m, the corners.
        faces: (F, 3), triangles as indices of corners, outward by the right-hand rule.
    """

    vertices: FloatArray
    faces: NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class TriangleMesh:
    """A surface that is not convex: there are distances to it, but no depths into it.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3), triangles as indices of vertices.
        closed: whether it has an inside.
    """

    vertices: FloatArray
    faces: NDArray[np.int64]
    closed: bool


Solid = Sphere | Capsule | Cylinder | Box | Polytope | TriangleMesh


class SolidExtent(NamedTuple):
    """A box along the axes of a solid's own frame that holds it.

    Args:
        centre: (3,) m.
        half: (3,) m, half the edges.
        radius: m, of the sphere about ``centre`` that holds the solid.
    """

    centre: FloatArray
    half: FloatArray
    radius: float


def extent(solid: Solid) -> SolidExtent:
    """The box and the sphere that hold a solid."""
    origin = np.zeros(3)
    match solid:
        case Sphere(radius):
            return SolidExtent(origin, np.full(3, radius), radius)
        case Capsule(radius, length):
            half = 0.5 * length + radius
            return SolidExtent(origin, np.array([radius, radius, half]), half)
        case Cylinder(radius, length):
            half = 0.5 * length
            return SolidExtent(
                origin, np.array([radius, radius, half]), float(np.hypot(radius, half))
            )
        case Box(size):
            edges = 0.5 * np.array(size)
            return SolidExtent(origin, edges, float(np.linalg.norm(edges)))
    lowest, highest = solid.vertices.min(axis=0), solid.vertices.max(axis=0)
    centre = 0.5 * (lowest + highest)
    radius = float(np.linalg.norm(solid.vertices - centre, axis=1).max())
    return SolidExtent(centre, 0.5 * (highest - lowest), radius)


def core_radius(solid: Solid) -> float:
    """m by which a sphere or capsule is grown from its core (a point, a segment); else 0."""
    return solid.radius if isinstance(solid, Sphere | Capsule) else 0.0


def inner_points(solid: Solid) -> FloatArray:
    """Points (K, 3) of the solid, at least one of every connected part.

    A solid whose surface stays clear of a closed surface is inside it where one of them is.
    """
    if isinstance(solid, TriangleMesh):
        return solid.vertices[_one_of_each_part(solid)]
    if isinstance(solid, Polytope):
        return solid.vertices[:1]
    return np.zeros((1, 3))


def _one_of_each_part(mesh: TriangleMesh) -> NDArray[np.int64]:
    parts = connected_parts(mesh.faces, len(mesh.vertices))
    return np.array([mesh.faces[part[0], 0] for part in parts])


def connected_parts(faces: NDArray[np.int64], count: int) -> list[NDArray[np.int64]]:
    """Rows of ``faces`` (F, 3) that hang together by common corners, part by part.

    Args:
        faces: indices of corners.
        count: number of corners.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs = np.concatenate([faces[:, :2], faces[:, 1:]])
    edges = coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    _, label = connected_components(edges, directed=False)
    of_face = label[faces[:, 0]]
    return [np.flatnonzero(of_face == part) for part in np.unique(of_face)]
