"""The path of the TCP: where it runs, and how far points are from it."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..core.arrays import FloatArray
from ..core.program.tool import Tool
from ..core.robot.model import Robot

_CHUNK = 1024
"""Points looked at together; bounds the memory for pairs of points and pieces."""


def tcp_positions(robot: Robot, tool: Tool, q: FloatArray) -> FloatArray:
    """TCP (T, 3) m in the world at configurations (T, N)."""
    rotation, position = robot.forward(q)
    return np.asarray(position + rotation @ np.array(tool.tcp.position))


def distance_to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    """Distances (P,) of points (P, 3) to a polyline with vertices (L, 3).

    Exact: a piece that comes nearer than the nearest vertex has its middle within that vertex'
    distance plus half the piece's own length.
    """
    moved = np.linalg.norm(np.diff(line, axis=0), axis=1) > 0
    line = line[np.concatenate([[True], moved])]
    distance = np.asarray(cKDTree(line).query(points)[0], dtype=float)
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    # Pieces of similar lengths together: a few long ones must not widen the search for all.
    octaves = np.floor(np.log2(lengths))
    for octave in np.unique(octaves):
        pieces = np.flatnonzero(octaves == octave)
        _lower_by_pieces(distance, points, line[pieces], line[pieces + 1])
    return distance


def _lower_by_pieces(
    distance: FloatArray, points: FloatArray, begin: FloatArray, end: FloatArray
) -> None:
    """Lower the distances (P,) of points to those from straight pieces, where these are nearer."""
    middles = cKDTree(0.5 * (begin + end))
    half = 0.5 * float(np.linalg.norm(end - begin, axis=1).max())
    for first in range(0, len(points), _CHUNK):
        rows = np.arange(first, min(first + _CHUNK, len(points)))
        near = middles.query_ball_point(points[rows], (distance[rows] + half) * (1 + 1e-12))
        counts = np.array([len(found) for found in near])
        if not counts.any():
            continue
        piece = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
        point = np.repeat(rows, counts)
        a = begin[piece]
        step, away = end[piece] - a, points[point] - a
        share = np.clip(np.sum(away * step, axis=1) / np.sum(step * step, axis=1), 0.0, 1.0)
        np.minimum.at(distance, point, np.linalg.norm(away - share[:, None] * step, axis=1))
