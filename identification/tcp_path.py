"""The path of the TCP: where it runs, and how far points are from it."""

from __future__ import annotations

import numpy as np

from ..core.arrays import FloatArray, IntArray
from ..core.program.tool import Tool
from ..core.robot.kinematics.lean import inner, lean
from ..core.robot.model import Robot

_LEAF = 4
"""Pieces of a polyline that have a box in common."""


def tcp_positions(robot: Robot, tool: Tool, q: FloatArray) -> FloatArray:
    """TCP (T, 3) m in the world at configurations (T, N)."""
    rotation, position = robot.forward(q)
    return np.asarray(position + rotation @ np.array(tool.tcp.position))


def distance_to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    """Distances (P,) of points (P, 3) to a polyline with vertices (L, 3), exact."""
    moved = np.flatnonzero(np.any(np.diff(line, axis=0) != 0.0, axis=1))
    # A line that stands still is one piece without length.
    pieces = moved if len(moved) else np.zeros(1, dtype=np.int64)
    begin, end = line[pieces], line[np.minimum(pieces + 1, len(line) - 1)]
    distance = np.empty(len(points))
    low, high = _boxes(np.minimum(begin, end), np.maximum(begin, end))
    waiting = np.empty(len(low) + 1, dtype=np.int64)
    _fill_distances(np.ascontiguousarray(points), begin, end, low, high, waiting, distance)
    return distance


def _boxes(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Corners (2 M, 3) of boxes about pieces (L, 3 each) that follow each other.

    A binary tree: row 1 is about all, rows 2 k and 2 k + 1 are about the halves of row k, and rows
    from M on about `_LEAF` pieces each, or nothing.
    """
    count = -(-len(low) // _LEAF)
    leaves = 1 << (count - 1).bit_length()
    every = np.arange(0, len(low), _LEAF)
    lower, upper = np.full((2 * leaves, 3), np.inf), np.full((2 * leaves, 3), -np.inf)
    lower[leaves : leaves + count] = np.minimum.reduceat(low, every)
    upper[leaves : leaves + count] = np.maximum.reduceat(high, every)
    while leaves > 1:
        half = leaves // 2
        lower[half:leaves] = lower[leaves : 2 * leaves].reshape(half, 2, 3).min(axis=1)
        upper[half:leaves] = upper[leaves : 2 * leaves].reshape(half, 2, 3).max(axis=1)
        leaves = half
    return lower, upper


@inner
def _to_box(point: FloatArray, low: FloatArray, high: FloatArray, box: int) -> float:
    """The square of a point's distance to a box."""
    square = 0.0
    for i in range(3):
        away = max(low[box, i] - point[i], point[i] - high[box, i], 0.0)
        square += away * away
    return square


@inner
def _to_piece(point: FloatArray, begin: FloatArray, end: FloatArray, k: int) -> float:
    """The square of a point's distance to a straight piece."""
    along = length = square = 0.0
    for i in range(3):
        step = end[k, i] - begin[k, i]
        along += (point[i] - begin[k, i]) * step
        length += step * step
    share = min(max(along / length, 0.0), 1.0) if length > 0.0 else 0.0
    for i in range(3):
        away = point[i] - begin[k, i] - share * (end[k, i] - begin[k, i])
        square += away * away
    return square


@lean
def _fill_distances(
    points: FloatArray,
    begin: FloatArray,
    end: FloatArray,
    low: FloatArray,
    high: FloatArray,
    waiting: IntArray,
    distance: FloatArray,
) -> None:
    leaves, nearest = low.shape[0] // 2, 0
    for p in range(points.shape[0]):
        point = points[p]
        # Points follow each other, too: the piece next to the last one bounds the search.
        best, count = _to_piece(point, begin, end, nearest), 1
        waiting[0] = 1
        while count > 0:
            count -= 1
            box = waiting[count]
            if _to_box(point, low, high, box) >= best:
                continue
            if box < leaves:
                waiting[count], waiting[count + 1] = 2 * box, 2 * box + 1
                count += 2
                continue
            first = (box - leaves) * _LEAF
            for k in range(first, min(first + _LEAF, begin.shape[0])):
                square = _to_piece(point, begin, end, k)
                if square < best:
                    best, nearest = square, k
        distance[p] = np.sqrt(best)
