"""How far two driven paths are from each other at most."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

_NEIGHBOURS = 8
"""Nearest corners of the other path whose edges are looked at."""


def greatest_distance(one: FloatArray, other: FloatArray) -> float:
    """The greatest distance of a point of either path from the whole of the other one, m.

    It is the Hausdorff distance of the polylines through both: what is driven at another time or
    speed counts nothing, what goes elsewhere does.

    Args:
        one, other: points (M, 3), (N, 3) m in the order in which they are driven.
    """
    return max(_from(one, other), _from(other, one))


def _from(points: FloatArray, path: FloatArray) -> float:
    """The greatest distance of points from a polyline; points alike in a row count once."""
    from scipy.spatial import cKDTree

    corners = _distinct(path)
    points = _distinct(points)
    if len(corners) == 1:
        return float(np.linalg.norm(points - corners[0], axis=1).max())
    count = min(_NEIGHBOURS, len(corners))
    _, near = cKDTree(corners).query(points, k=count)
    near = np.reshape(near, (len(points), count))
    edges = np.concatenate([np.clip(near - 1, 0, None), np.clip(near, None, len(corners) - 2)], 1)
    start, along = corners[edges], corners[edges + 1] - corners[edges]
    offset = points[:, None] - start
    squared = np.maximum((along**2).sum(-1), np.finfo(float).tiny)
    share = np.clip((offset * along).sum(-1) / squared, 0.0, 1.0)
    distances = np.linalg.norm(offset - share[..., None] * along, axis=-1)
    return float(distances.min(axis=1).max())


def _distinct(points: FloatArray) -> FloatArray:
    """Points without those that repeat the one before."""
    moved = np.any(np.diff(points, axis=0) != 0.0, axis=1)
    return np.asarray(points[np.concatenate([[True], moved])])
