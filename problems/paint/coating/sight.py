"""Which points of a part the gun sees from each segment of a trajectory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import BoolArray, FloatArray
from ..spray.footprint import Footprint
from ..spray.trajectory import PaintTrajectory
from ..surface.part import Part

GAP = 1e-4
"""m next to a point where nothing counts as in the way: the surface's own triangles."""
_AT_ONCE = 500_000


def sight(part: Part, footprint: Footprint, trajectory: PaintTrajectory) -> BoolArray:
    """(V, S) whether anything of the part stands between the middle of a segment and a point.

    Points that face away, or lie outside of the gun's cone, count as seen: no paint gets there
    anyway, and no ray is traced.

    Args:
        part: its painted vertices are the points, all its triangles stand in the way.
        footprint: for the cone.
        trajectory: in the part's frame.
    """
    samples = part.samples
    points, normals = samples.points, samples.normals
    eye = 0.5 * (trajectory.position[1:] + trajectory.position[:-1])
    nozzle = trajectory.nozzle[1:] + trajectory.nozzle[:-1]
    nozzle /= np.linalg.norm(nozzle, axis=1, keepdims=True)
    seen = np.ones((len(points), len(eye)), dtype=np.bool_)
    wait: list[tuple[NDArray[np.int64], int]] = []
    count = 0
    for segment in np.flatnonzero(trajectory.flow > 0.0):
        met = _met(points, normals, eye[segment], nozzle[segment], footprint)
        wait.append((met, int(segment)))
        count += len(met)
        if count > _AT_ONCE:
            _trace(part, points, eye, wait, seen)
            wait, count = [], 0
    _trace(part, points, eye, wait, seen)
    return seen


def _met(
    points: FloatArray,
    normals: FloatArray,
    eye: FloatArray,
    nozzle: FloatArray,
    footprint: Footprint,
) -> NDArray[np.int64]:
    """Points in the gun's cone that face it; the cone is taken wider, for a segment's ends."""
    way = points - eye + footprint.source_distance * nozzle
    along = way @ nozzle
    off = np.einsum("ij,ij->i", way, way) - along**2
    opening = 1.3 * footprint.radius / footprint.reach
    facing = np.einsum("ij,ij->i", normals, points - eye) < 0.0
    return np.flatnonzero(facing & (along > 0.0) & (off < (opening * along) ** 2))


def _trace(
    part: Part,
    points: FloatArray,
    eye: FloatArray,
    wait: list[tuple[NDArray[np.int64], int]],
    seen: BoolArray,
) -> None:
    if not wait:
        return
    point = np.concatenate([met for met, _ in wait])
    segment = np.concatenate([np.full(len(met), k) for met, k in wait])
    if len(point):
        seen[point, segment] = ~part.rays.blocked(eye[segment], points[point], GAP)
