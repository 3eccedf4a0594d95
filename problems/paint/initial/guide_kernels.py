"""Lines against the guide's triangles, compiled: meetings, and searches for edges."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ....core.arrays import BoolArray, FloatArray, IntArray
from ..surface.rays.bvh import trace
from ..surface.rays.tree import DEPTH, RayTree


@njit(cache=True, error_model="numpy", nogil=True)
def meet_lines(
    tree: RayTree,
    faces: IntArray,
    normals: FloatArray,
    points: FloatArray,
    directions: FloatArray,
    reach: float,
    back: FloatArray,
    least: float,
    found: BoolArray,
    point: FloatArray,
    normal: FloatArray,
) -> None:
    """Where lines meet the surface; see `Guide.meet`.

    Args:
        tree: of the triangles.
        faces: (F, 3) of the mesh.
        normals: (V, 3) at its vertices.
        points, directions: (N, 3) the lines.
        reach: m; inf to look from before the surface.
        back: (N,) m by which to step back for that.
        least: product of a line's direction and the inward normal from which on a meeting counts.
        found, point, normal: (N), (N, 3), (N, 3), filled in; NaN where nothing is met.
    """
    stack = np.empty(2 * DEPTH, dtype=np.int64)
    for i in range(len(points)):
        k, t = _meet(tree, points[i], directions[i], reach, back[i], least, stack)
        found[i] = k >= 0
        if k < 0:
            point[i], normal[i] = np.nan, np.nan
            continue
        for axis in range(3):
            point[i, axis] = points[i, axis] + t * directions[i, axis]
        _interpolate(tree.corners[k], normals, faces[tree.face[k]], point[i], normal[i])


@njit(cache=True, error_model="numpy", nogil=True)
def find_edges_along(
    tree: RayTree,
    points: FloatArray,
    directions: FloatArray,
    ways: FloatArray,
    inside: BoolArray,
    farthest: float,
    reach: float,
    back: FloatArray,
    drift: FloatArray,
    least: float,
    steps: int,
    halvings: int,
    lengths: FloatArray,
) -> None:
    """Lengths after which points on ways come onto the surface or leave it.

    Args:
        tree: of the triangles.
        points, directions: (N, 3).
        ways: (N, K, 3).
        inside: (N,) whether the points lie on the surface.
        farthest: m.
        reach, back: as in `meet_lines`.
        drift: (N, K) what a metre along the way adds to ``back``.
        least: as in `meet_lines`.
        steps: of the search.
        halvings: of the step in which the edge lies.
        lengths: (N, K) filled in; inf where nothing changes.
    """
    stack = np.empty(2 * DEPTH, dtype=np.int64)
    place = np.empty(3)
    for i in range(len(points)):
        for k in range(ways.shape[1]):
            low, high = 0.0, math.inf
            for step in range(1, steps + 1):
                length = farthest * step / steps
                for axis in range(3):
                    place[axis] = points[i, axis] + length * ways[i, k, axis]
                b = back[i] + length * drift[i, k]
                if (_meet(tree, place, directions[i], reach, b, least, stack)[0] >= 0) != inside[i]:
                    high = length
                    break
                low = length
            lengths[i, k] = high
            if math.isinf(high):
                continue
            for _ in range(halvings):
                middle = 0.5 * (low + high)
                for axis in range(3):
                    place[axis] = points[i, axis] + middle * ways[i, k, axis]
                b = back[i] + middle * drift[i, k]
                if (_meet(tree, place, directions[i], reach, b, least, stack)[0] >= 0) != inside[i]:
                    high = middle
                else:
                    low = middle
            lengths[i, k] = high


@njit(cache=True, error_model="numpy", nogil=True)
def _meet(
    tree: RayTree,
    point: FloatArray,
    direction: FloatArray,
    reach: float,
    back: float,
    least: float,
    stack: IntArray,
) -> tuple[int, float]:
    """Place in the tree and length along the direction of a meeting from the painted side."""
    if math.isinf(reach):
        k, t = trace(tree, point - back * direction, direction, reach, stack, False)
        t -= back
    else:
        k, t = trace(tree, point, direction, reach, stack, False)
        behind, length = trace(tree, point, -direction, min(reach, t), stack, False)
        if behind >= 0:
            k, t = behind, -length
    if k < 0:
        return -1, t
    c = tree.corners[k]
    x = (c[1, 1] - c[0, 1]) * (c[2, 2] - c[0, 2]) - (c[1, 2] - c[0, 2]) * (c[2, 1] - c[0, 1])
    y = (c[1, 2] - c[0, 2]) * (c[2, 0] - c[0, 0]) - (c[1, 0] - c[0, 0]) * (c[2, 2] - c[0, 2])
    z = (c[1, 0] - c[0, 0]) * (c[2, 1] - c[0, 1]) - (c[1, 1] - c[0, 1]) * (c[2, 0] - c[0, 0])
    along = x * direction[0] + y * direction[1] + z * direction[2]
    if -along < least * math.sqrt(x * x + y * y + z * z):
        return -1, t
    return k, t


@njit(cache=True, error_model="numpy", nogil=True)
def _interpolate(
    corners: FloatArray,
    normals: FloatArray,
    face: IntArray,
    point: FloatArray,
    normal: FloatArray,
) -> None:
    """The unit normal at a point of a triangle, between those of its corners."""
    d00 = d01 = d11 = d20 = d21 = 0.0
    for i in range(3):
        ab, ac = corners[1, i] - corners[0, i], corners[2, i] - corners[0, i]
        ap = point[i] - corners[0, i]
        d00 += ab * ab
        d01 += ab * ac
        d11 += ac * ac
        d20 += ap * ab
        d21 += ap * ac
    below = d00 * d11 - d01 * d01
    v = min(max((d11 * d20 - d01 * d21) / below, 0.0), 1.0)
    w = min(max((d00 * d21 - d01 * d20) / below, 0.0), 1.0 - v)
    square = 0.0
    for i in range(3):
        normal[i] = (
            (1.0 - v - w) * normals[face[0], i] + v * normals[face[1], i] + w * normals[face[2], i]
        )
        square += normal[i] ** 2
    length = math.sqrt(square)
    for i in range(3):
        normal[i] /= length
