"""A tree of boxes round triangles, built where the surface area heuristic expects the least work.

I. Wald, On fast construction of SAH-based bounding volume hierarchies, 2007: with bins.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from .....core.arrays import FloatArray, IntArray

LEAF = 4
"""Triangles in a leaf, at most, unless their centres coincide."""
BINS = 16
"""Places at which a node may be split, along its longest side."""
DEPTH = 64
"""Levels of the tree, at most; deeper ones become leaves."""
PAD = 1e-12
"""By which boxes are grown, as a share of the mesh's size: rounding must not hide a triangle."""


class RayTree(NamedTuple):
    """Nodes in depth-first order: a node's first child stands right behind it.

    Args:
        low, high: (N, 3) m, the boxes.
        other: (N,) index of the second child; -1 for a leaf.
        first, held: (N,) a leaf's range, by its start and number, in `corners`.
        corners: (F, 3, 3) m, triangles in the order of the leaves.
        face: (F,) their indices in the mesh.
    """

    low: FloatArray
    high: FloatArray
    other: IntArray
    first: IntArray
    held: IntArray
    corners: FloatArray
    face: IntArray


def build_tree(corners: FloatArray) -> RayTree:
    """The tree of triangles (F, 3, 3) m."""
    corners = np.ascontiguousarray(corners, dtype=float)
    low, high = corners.min(axis=1), corners.max(axis=1)
    pad = PAD * max(
        float(np.abs(corners).max()), float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    )
    nodes = 2 * len(corners)
    tree = RayTree(
        np.empty((nodes, 3)),
        np.empty((nodes, 3)),
        np.full(nodes, -1, dtype=np.int64),
        np.zeros(nodes, dtype=np.int64),
        np.zeros(nodes, dtype=np.int64),
        corners,
        np.arange(len(corners)),
    )
    used = _split_nodes(tree, low - pad, high + pad, corners.mean(axis=1))
    return RayTree(
        tree.low[:used],
        tree.high[:used],
        tree.other[:used],
        tree.first[:used],
        tree.held[:used],
        np.ascontiguousarray(corners[tree.face]),
        tree.face,
    )


@njit(cache=True, error_model="numpy")
def _split_nodes(tree: RayTree, low: FloatArray, high: FloatArray, middle: FloatArray) -> int:
    """Fill the tree depth first; number of nodes. Ranges of ``tree.face`` are sorted in place."""
    begin = np.empty(2 * DEPTH, dtype=np.int64)
    end = np.empty(2 * DEPTH, dtype=np.int64)
    level = np.empty(2 * DEPTH, dtype=np.int64)
    parent = np.empty(2 * DEPTH, dtype=np.int64)
    begin[0], end[0], level[0], parent[0] = 0, len(tree.face), 0, -1
    stacked, node = 1, 0
    while stacked > 0:
        stacked -= 1
        first, last, depth = begin[stacked], end[stacked], level[stacked]
        if parent[stacked] >= 0:
            tree.other[parent[stacked]] = node
        _bound(tree, node, low, high, first, last)
        cut = first
        if last - first > LEAF and depth < DEPTH - 1:
            cut = _cut(tree.face, low, high, middle, first, last)
        if cut == first:
            tree.first[node], tree.held[node] = first, last - first
        else:
            begin[stacked], end[stacked], level[stacked] = cut, last, depth + 1
            parent[stacked] = node
            stacked += 1
            begin[stacked], end[stacked], level[stacked] = first, cut, depth + 1
            parent[stacked] = -1
            stacked += 1
        node += 1
    return node


@njit(cache=True, error_model="numpy")
def _bound(
    tree: RayTree, node: int, low: FloatArray, high: FloatArray, first: int, last: int
) -> None:
    for axis in range(3):
        lowest, highest = np.inf, -np.inf
        for k in range(first, last):
            lowest = min(lowest, low[tree.face[k], axis])
            highest = max(highest, high[tree.face[k], axis])
        tree.low[node, axis], tree.high[node, axis] = lowest, highest


@njit(cache=True, error_model="numpy")
def _cut(
    order: IntArray, low: FloatArray, high: FloatArray, middle: FloatArray, first: int, last: int
) -> int:
    """Sort a range of triangles to both sides of the best cut and give its place; first if none."""
    axis, start, extent = 0, 0.0, 0.0
    for a in range(3):
        lowest, highest = np.inf, -np.inf
        for k in range(first, last):
            lowest = min(lowest, middle[order[k], a])
            highest = max(highest, middle[order[k], a])
        if highest - lowest > extent:
            axis, start, extent = a, lowest, highest - lowest
    if extent <= 0.0:
        return first
    scale = BINS * (1.0 - 1e-12) / extent
    at = _best_bin(order, low, high, middle, first, last, axis, start, scale)
    i, j = first, last - 1
    while i <= j:
        if int((middle[order[i], axis] - start) * scale) <= at:
            i += 1
        else:
            order[i], order[j] = order[j], order[i]
            j -= 1
    return i


@njit(cache=True, error_model="numpy")
def _best_bin(
    order: IntArray,
    low: FloatArray,
    high: FloatArray,
    middle: FloatArray,
    first: int,
    last: int,
    axis: int,
    start: float,
    scale: float,
) -> int:
    """Bin behind which to cut: least sum of boxes' areas times their triangles."""
    count = np.zeros(BINS, dtype=np.int64)
    box = np.empty((BINS, 6))
    box[:, :3], box[:, 3:] = np.inf, -np.inf
    for k in range(first, last):
        f = order[k]
        b = int((middle[f, axis] - start) * scale)
        count[b] += 1
        for a in range(3):
            box[b, a] = min(box[b, a], low[f, a])
            box[b, 3 + a] = max(box[b, 3 + a], high[f, a])
    after = np.empty(BINS)
    _gather(box[::-1], count[::-1], after)
    before = np.empty(BINS)
    _gather(box, count, before)
    best, at = np.inf, 0
    for b in range(BINS - 1):
        cost = before[b] + after[BINS - 2 - b]
        if cost < best:
            best, at = cost, b
    return at


@njit(cache=True, error_model="numpy")
def _gather(box: FloatArray, count: IntArray, cost: FloatArray) -> None:
    """Area times number of all bins up to each; infinite where there are none."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    number = 0
    for b in range(BINS):
        number += count[b]
        for a in range(3):
            low[a] = min(low[a], box[b, a])
            high[a] = max(high[a], box[b, 3 + a])
        if number == 0:
            cost[b] = np.inf
        else:
            x, y, z = high[0] - low[0], high[1] - low[1], high[2] - low[2]
            cost[b] = number * (x * y + y * z + z * x)
