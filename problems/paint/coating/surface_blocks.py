"""Points of a surface in compact groups, so that what a cone cannot reach is passed over."""

from __future__ import annotations

import numpy as np

from ....core.arrays import FloatArray, IntArray
from ..surface.samples import SurfaceSamples
from .kernels import PointGroups

GROUP = 32
"""Points of a group, at most."""


def grouped(samples: SurfaceSamples) -> tuple[PointGroups, IntArray]:
    """The groups, and the index (V,) in ``samples`` of each of their points.

    Groups come by halving the longest extent again and again; neighbours in the list are
    neighbours in space.
    """
    order, sizes = _halved(samples.points)
    starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
    points = np.ascontiguousarray(samples.points[order])
    centres, radii = np.empty((len(sizes), 3)), np.empty(len(sizes))
    for g in range(len(sizes)):
        part = points[starts[g] : starts[g + 1]]
        centres[g] = 0.5 * (part.min(axis=0) + part.max(axis=0))
        radii[g] = np.linalg.norm(part - centres[g], axis=1).max()
    normals = np.ascontiguousarray(samples.normals[order])
    return PointGroups(points, normals, starts, centres, radii), order


def _halved(points: FloatArray) -> tuple[IntArray, list[int]]:
    """Order (V,) of points, and the sizes of the groups in it."""
    leaves: list[IntArray] = []
    waiting: list[IntArray] = [np.arange(len(points))]
    while waiting:
        part = waiting.pop()
        if len(part) <= GROUP:
            leaves.append(part)
            continue
        inside = points[part]
        axis = int(np.argmax(np.ptp(inside, axis=0)))
        half = len(part) // 2
        split = part[np.argpartition(inside[:, axis], half)]
        waiting += [split[half:], split[:half]]
    return np.concatenate(leaves), [len(leaf) for leaf in leaves]
