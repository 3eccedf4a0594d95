"""Rays and nearest points through a tree of boxes round the triangles, compiled.

A ray meets a triangle by the test of S. Woop, C. Benthin and I. Wald (Watertight ray/triangle
intersection, JCGT 2, 2013): no ray slips through between two triangles that share an edge, which on
a regular mesh rays aim at all the time. All in double precision.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .....core.arrays import FloatArray, IntArray
from .rays import Rays
from .tree import DEPTH, RayTree, build_tree

BATCH = 8192
"""Queries that are worth a thread of their own."""


class BvhRays(Rays):
    """Queries by the tree, in threads where there are many.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
    """

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        super().__init__(vertices, faces)
        self._tree = build_tree(self.vertices[self.faces])

    def _first(
        self, origins: FloatArray, directions: FloatArray, far: float
    ) -> tuple[IntArray, FloatArray]:
        face = np.empty(len(origins), dtype=np.int64)
        distance = np.empty(len(origins))

        def part(rows: slice) -> None:
            _first_hits(
                self._tree, origins[rows], directions[rows], far, face[rows], distance[rows]
            )

        _in_threads(part, len(origins))
        return face, distance

    def _any(self, origins: FloatArray, ways: FloatArray) -> NDArray[np.bool_]:
        found = np.empty(len(origins), dtype=np.bool_)

        def part(rows: slice) -> None:
            _any_hits(self._tree, origins[rows], ways[rows], found[rows])

        _in_threads(part, len(origins))
        return found

    def _nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        face = np.empty(len(points), dtype=np.int64)
        nearest = np.empty((len(points), 3))

        def part(rows: slice) -> None:
            _nearest_points(self._tree, points[rows], face[rows], nearest[rows])

        _in_threads(part, len(points))
        return face, nearest


def _in_threads(work: Callable[[slice], None], n: int) -> None:
    """Do work on batches of n rows, several at a time if there is enough of it."""
    batches = [slice(k, k + BATCH) for k in range(0, n, BATCH)]
    if len(batches) < 2:
        for rows in batches:
            work(rows)
        return
    workers = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1
    with ThreadPoolExecutor(max_workers=workers) as pool:
        list(pool.map(work, batches))


@njit(cache=True, error_model="numpy", nogil=True)
def _first_hits(
    tree: RayTree,
    origins: FloatArray,
    directions: FloatArray,
    far: float,
    face: IntArray,
    distance: FloatArray,
) -> None:
    stack = np.empty(2 * DEPTH, dtype=np.int64)
    for i in range(len(origins)):
        hit, t = trace(tree, origins[i], directions[i], far, stack, False)
        face[i] = tree.face[hit] if hit >= 0 else -1
        distance[i] = t if hit >= 0 else np.inf


@njit(cache=True, error_model="numpy", nogil=True)
def _any_hits(
    tree: RayTree,
    origins: FloatArray,
    ways: FloatArray,
    found: NDArray[np.bool_],
) -> None:
    stack = np.empty(2 * DEPTH, dtype=np.int64)
    for i in range(len(origins)):
        hit, _ = trace(tree, origins[i], ways[i], 1.0, stack, True)
        found[i] = hit >= 0


@njit(cache=True, error_model="numpy", nogil=True)
def trace(
    tree: RayTree,
    origin: FloatArray,
    direction: FloatArray,
    far: float,
    stack: IntArray,
    any_will_do: bool,
) -> tuple[int, float]:
    """Place in ``tree.face`` and distance of the first triangle in [0, far); -1 if none."""
    kx, ky, kz, sx, sy, sz = _shear(direction)
    ox, oy, oz = origin[0], origin[1], origin[2]
    ix, iy, iz = 1.0 / direction[0], 1.0 / direction[1], 1.0 / direction[2]
    best, nearest = -1, far
    stack[0] = 0
    stacked = 1
    while stacked > 0:
        stacked -= 1
        node = stack[stacked]
        if not _meets(tree.low[node], tree.high[node], ox, oy, oz, ix, iy, iz, nearest):
            continue
        other = tree.other[node]
        if other >= 0:
            if _is_before(tree, node + 1, other, direction):
                stack[stacked], stack[stacked + 1] = other, node + 1
            else:
                stack[stacked], stack[stacked + 1] = node + 1, other
            stacked += 2
            continue
        for k in range(tree.first[node], tree.first[node] + tree.held[node]):
            t = _cross(tree.corners[k], origin, kx, ky, kz, sx, sy, sz)
            if 0.0 <= t < nearest:
                best, nearest = k, t
                if any_will_do:
                    return best, nearest
    return best, nearest


@njit(cache=True, error_model="numpy", nogil=True)
def _is_before(tree: RayTree, a: int, b: int, direction: FloatArray) -> bool:
    """Whether the ray comes to the box of node a first, by the boxes' centres."""
    along = 0.0
    for axis in range(3):
        gap = tree.low[b, axis] + tree.high[b, axis] - tree.low[a, axis] - tree.high[a, axis]
        along += gap * direction[axis]
    return along >= 0.0


@njit(cache=True, error_model="numpy", nogil=True)
def _meets(
    low: FloatArray,
    high: FloatArray,
    ox: float,
    oy: float,
    oz: float,
    ix: float,
    iy: float,
    iz: float,
    far: float,
) -> bool:
    """Whether a ray meets a box before a distance.

    Along a side, 0 · ∞ gives NaN; such comparisons leave the interval as it is, which holds too
    much and never too little.
    """
    near = 0.0
    a, b = (low[0] - ox) * ix, (high[0] - ox) * ix
    if a > b:
        a, b = b, a
    near = a if a > near else near
    far = b if b < far else far
    a, b = (low[1] - oy) * iy, (high[1] - oy) * iy
    if a > b:
        a, b = b, a
    near = a if a > near else near
    far = b if b < far else far
    a, b = (low[2] - oz) * iz, (high[2] - oz) * iz
    if a > b:
        a, b = b, a
    near = a if a > near else near
    far = b if b < far else far
    return near <= far


@njit(cache=True, error_model="numpy", nogil=True)
def _shear(direction: FloatArray) -> tuple[int, int, int, float, float, float]:
    """Axes with the ray's largest component last, and the shear that lays the ray along it."""
    kz = 0
    for axis in range(1, 3):
        if abs(direction[axis]) > abs(direction[kz]):
            kz = axis
    kx, ky = (kz + 1) % 3, (kz + 2) % 3
    if direction[kz] < 0.0:
        kx, ky = ky, kx
    scale = 1.0 / direction[kz]
    return kx, ky, kz, direction[kx] * scale, direction[ky] * scale, scale


@njit(cache=True, error_model="numpy", nogil=True)
def _cross(
    corners: FloatArray,
    origin: FloatArray,
    kx: int,
    ky: int,
    kz: int,
    sx: float,
    sy: float,
    sz: float,
) -> float:
    """Distance at which the ray crosses a triangle; NaN if it does not."""
    az, bz, cz = (
        corners[0, kz] - origin[kz],
        corners[1, kz] - origin[kz],
        corners[2, kz] - origin[kz],
    )
    ax, ay = corners[0, kx] - origin[kx] - sx * az, corners[0, ky] - origin[ky] - sy * az
    bx, by = corners[1, kx] - origin[kx] - sx * bz, corners[1, ky] - origin[ky] - sy * bz
    cx, cy = corners[2, kx] - origin[kx] - sx * cz, corners[2, ky] - origin[ky] - sy * cz
    u, v, w = cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax
    if (u < 0.0 or v < 0.0 or w < 0.0) and (u > 0.0 or v > 0.0 or w > 0.0):
        return math.nan
    total = u + v + w
    if total == 0.0:
        return math.nan
    distance: float = sz * (u * az + v * bz + w * cz) / total
    return distance


@njit(cache=True, error_model="numpy", nogil=True)
def _nearest_points(tree: RayTree, points: FloatArray, face: IntArray, nearest: FloatArray) -> None:
    stack = np.empty(2 * DEPTH, dtype=np.int64)
    gaps = np.empty(2 * DEPTH)
    found = np.empty(3)
    for i in range(len(points)):
        best, least = -1, np.inf
        stack[0], gaps[0] = 0, 0.0
        stacked = 1
        while stacked > 0:
            stacked -= 1
            node = stack[stacked]
            if gaps[stacked] >= least:
                continue
            other = tree.other[node]
            if other >= 0:
                a, b = _gap(tree, node + 1, points[i]), _gap(tree, other, points[i])
                nearer, farther = (node + 1, other) if a <= b else (other, node + 1)
                stack[stacked], gaps[stacked] = farther, max(a, b)
                stack[stacked + 1], gaps[stacked + 1] = nearer, min(a, b)
                stacked += 2
                continue
            for k in range(tree.first[node], tree.first[node] + tree.held[node]):
                square = nearest_on_triangle(tree.corners[k], points[i], found)
                if square < least:
                    best, least = k, square
                    nearest[i] = found
        face[i] = tree.face[best]


@njit(cache=True, error_model="numpy", nogil=True)
def _gap(tree: RayTree, node: int, point: FloatArray) -> float:
    """Square of the distance to a node's box."""
    square = 0.0
    for axis in range(3):
        outside = max(tree.low[node, axis] - point[axis], point[axis] - tree.high[node, axis], 0.0)
        square += outside * outside
    return square


@njit(cache=True, error_model="numpy", nogil=True)
def nearest_on_triangle(corners: FloatArray, point: FloatArray, found: FloatArray) -> float:
    """Write the triangle's point (3,) nearest to a point; square of their distance.

    By the regions of Voronoi of C. Ericson (Real-Time Collision Detection, 2005, section 5.1.5).
    """
    d1 = d2 = d3 = d4 = d5 = d6 = 0.0
    for i in range(3):
        ab, ac = corners[1, i] - corners[0, i], corners[2, i] - corners[0, i]
        d1 += ab * (point[i] - corners[0, i])
        d2 += ac * (point[i] - corners[0, i])
        d3 += ab * (point[i] - corners[1, i])
        d4 += ac * (point[i] - corners[1, i])
        d5 += ab * (point[i] - corners[2, i])
        d6 += ac * (point[i] - corners[2, i])
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    v, w = 0.0, 0.0
    if d1 <= 0.0 and d2 <= 0.0:
        pass
    elif d3 >= 0.0 and d4 <= d3:
        v = 1.0
    elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v = d1 / (d1 - d3)
    elif d6 >= 0.0 and d5 <= d6:
        w = 1.0
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        w = d2 / (d2 - d6)
    elif va <= 0.0 and d4 >= d3 and d5 >= d6:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        v = 1.0 - w
    else:
        v, w = vb / (va + vb + vc), vc / (va + vb + vc)
    square = 0.0
    for i in range(3):
        at = corners[0, i] + v * (corners[1, i] - corners[0, i])
        found[i] = at + w * (corners[2, i] - corners[0, i])
        square += (point[i] - found[i]) ** 2
    return square
