"""Rays through Intel's Embree, by the optional package ``embreex``.

Embree works in single precision, so the mesh is laid round the origin first. It tells which
triangle a ray meets; where, is worked out again in double precision.
"""

from __future__ import annotations

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from .....core.arrays import FloatArray, IntArray
from .bvh import BvhRays
from .rays import Rays

_BEYOND = 1.0 + 1e-5
"""How much farther Embree looks than asked: rounding to single precision must not cost a hit."""


class EmbreeRays(Rays):
    """Queries by Embree; nearest points, which it does not know, by the tree.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
    """

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        super().__init__(vertices, faces)
        used = self.vertices[self.faces].reshape(-1, 3)
        self._centre = 0.5 * (used.min(axis=0) + used.max(axis=0))
        self._scene = EmbreeScene()
        # The scene keeps a pointer to the mesh, not the mesh.
        self._mesh = TriangleMesh(
            self._scene,
            np.ascontiguousarray(self.vertices - self._centre, dtype=np.float32),
            np.ascontiguousarray(self.faces, dtype=np.int32),
        )
        a, b, c = np.moveaxis(self.vertices[self.faces], 1, 0)
        self._corner, self._across = a, np.cross(b - a, c - a)
        self._tree: BvhRays | None = None

    def _first(
        self, origins: FloatArray, directions: FloatArray, far: float
    ) -> tuple[IntArray, FloatArray]:
        face = self._run(origins, directions, far * _BEYOND, "INTERSECT")
        found = face >= 0
        a, n = self._corner[face], self._across[face]
        along = np.einsum("ij,ij->i", directions, n)
        height = np.einsum("ij,ij->i", a - origins, n)
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = np.maximum(height / along, 0.0)
        found &= distance < far
        return np.where(found, face, -1), np.where(found, distance, np.inf)

    def _any(self, origins: FloatArray, ways: FloatArray) -> NDArray[np.bool_]:
        return np.asarray(self._run(origins, ways, 1.0, "OCCLUDED") >= 0)

    def _nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        if self._tree is None:
            self._tree = BvhRays(self.vertices, self.faces)
        return self._tree._nearest(points)

    def _run(self, origins: FloatArray, directions: FloatArray, far: float, query: str) -> IntArray:
        if len(origins) == 0:
            return np.empty(0, dtype=np.int64)
        reach = np.full(len(origins), min(far, 1e30), dtype=np.float32)
        found = self._scene.run(
            (origins - self._centre).astype(np.float32),
            directions.astype(np.float32),
            dists=reach,
            query=query,
        )
        return np.asarray(found, dtype=np.int64)
