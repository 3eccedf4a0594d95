"""Convex solids made smaller all round.

How deep a convex solid goes into a mesh is not known; whether it would touch it if it were so much
smaller is.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError
from ...robot.shape import Box, Capsule, Cylinder, Sphere
from .convex import hull
from .solid import Polytope, Solid, TriangleMesh

_LEFT = 0.2
"""Share of a thin solid's thickness that is left at least."""


def shrink(solid: Solid, by: float) -> Solid:
    """What is left of a convex solid where ``by`` m are taken off all round.

    Of thin ones less is taken, so that something is left: what is taken off is never more than
    ``by``.
    """
    match solid:
        case Sphere(radius):
            return Sphere(max(radius - by, _LEFT * radius))
        case Capsule(radius, length):
            return Capsule(max(radius - by, _LEFT * radius), length)
        case Cylinder(radius, length):
            by = min(by, 0.5 * (1.0 - _LEFT) * min(2.0 * radius, length))
            return Cylinder(radius - by, length - 2.0 * by)
        case Box(size):
            by = min(by, 0.5 * (1.0 - _LEFT) * min(size))
            x, y, z = (edge - 2.0 * by for edge in size)
            return Box((x, y, z))
        case TriangleMesh():
            raise TypeError("a mesh is not convex")
    return _shrink_polytope(solid, by)


def _shrink_polytope(solid: Polytope, by: float) -> Polytope:
    from scipy.spatial import HalfspaceIntersection

    corners = solid.vertices[solid.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    kept = sizes > 0.0
    normals = normals[kept] / sizes[kept, None]
    # Faces of rounded corners: all corners are behind them.
    offsets = (normals @ solid.vertices.T).max(axis=1)
    middle, inner = _inner_ball(normals, offsets)
    by = min(by, (1.0 - _LEFT) * inner)
    planes = np.column_stack([normals, by - offsets])
    return hull(HalfspaceIntersection(planes, middle).intersections)


def _inner_ball(normals: FloatArray, offsets: FloatArray) -> tuple[FloatArray, float]:
    """Middle (3,) and radius of the largest ball within half-spaces n · x ≤ offset."""
    from scipy.optimize import linprog

    rows = np.column_stack([normals, np.ones(len(normals))])
    bounds = [(None, None)] * 3 + [(0.0, None)]
    found = linprog([0.0, 0.0, 0.0, -1.0], rows, offsets, bounds=bounds).x
    if found is None:
        raise InputError("a convex part has no inside")
    return found[:3], float(found[3])
