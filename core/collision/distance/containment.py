"""Whether a body lies inside a closed mesh: surfaces that stay apart may still be nested.

A ray from a point leaves a closed surface more often than it enters it if the point is inside.
Counted with signs, parts that overlap are solid and cavities are not. Where the triangles are
not turned alike, signs mean nothing: then an odd number of crossings counts as inside. The
triangles are turned so that the ray runs along z; a ray that passes near an edge is given up for
one in another direction.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...spatial.rotation import matrix_from_rotation_vector
from .engine import BodyPoses
from .solid import Solid, TriangleMesh, inner_points

TURNS = np.array([[0.3, 0.2, 0.1], [1.1, -0.7, 0.5], [-0.4, 1.9, 0.8], [2.1, 0.6, -1.3]])
"""Rotation vectors of the rays' frames; no face of a made thing is likely to lie along them."""
NEAR = 1e-9
"""Share of a triangle's projected size within which a crossing is too near to its edge."""


class Nesting:
    """Which of a scene's bodies lie inside which closed meshes.

    Args:
        solids: of all bodies.
    """

    def __init__(self, solids: Sequence[Solid]) -> None:
        self._insides = [
            Inside(solid) if isinstance(solid, TriangleMesh) and solid.closed else None
            for solid in solids
        ]
        self._points = [inner_points(solid) for solid in solids]

    def nested(self, a: int, b: int, places: BodyPoses) -> bool:
        """Whether body a or b lies in the other, given that their surfaces are apart."""
        return self._holds(a, b, places) or self._holds(b, a, places)

    def _holds(self, outer: int, inner: int, places: BodyPoses) -> bool:
        if self._insides[outer] is None:
            return False
        points = self._points[inner] @ places.rotation[inner].T + places.translation[inner]
        return self.inside(outer, points, places)

    def inside(self, body: int, points: FloatArray, places: BodyPoses) -> bool:
        """Whether one of the points (K, 3) m in the world is inside a body's closed mesh."""
        inside = self._insides[body]
        if inside is None:
            return False
        R, p = places.rotation[body], places.translation[body]
        return inside.holds((points - p) @ R)


class Inside:
    """The inside of a closed mesh."""

    def __init__(self, mesh: TriangleMesh) -> None:
        self._turns = matrix_from_rotation_vector(TURNS)
        self._oriented = is_oriented(mesh.faces)
        corners = mesh.vertices[mesh.faces]
        self._corners = [np.ascontiguousarray(corners @ turn.T) for turn in self._turns]
        self._lowest = mesh.vertices.min(axis=0)
        self._highest = mesh.vertices.max(axis=0)

    def holds(self, points: FloatArray) -> bool:
        """Whether one of the points (K, 3) m, in the mesh's frame, is inside."""
        boxed = ((points >= self._lowest) & (points <= self._highest)).all(axis=1)
        return any(self._holds(point) for point in points[boxed])

    def _holds(self, point: FloatArray) -> bool:
        out = odd = 0
        for turn, corners in zip(self._turns, self._corners, strict=True):
            clear, out, count = _crossings(corners, turn @ point)
            odd = count % 2
            if clear:
                break
        return bool(out if self._oriented else odd)


def is_oriented(faces: NDArray[np.int64]) -> bool:
    """Whether all triangles (F, 3) are turned alike: none runs along an edge as another does."""
    start, end = faces.ravel().astype(np.int64), np.roll(faces, -1, axis=1).ravel()
    key = np.sort(start * (int(faces.max()) + 1) + end)
    return bool((np.diff(key) > 0).all())


@njit(cache=True, error_model="numpy")
def _crossings(corners: FloatArray, point: FloatArray) -> tuple[bool, int, int]:
    """How often the ray from a point along +z crosses triangles (F, 3, 3).

    Returns:
        False if it passes too near to an edge to tell; crossings outward less those inward;
        all crossings.
    """
    x, y, z = point[0], point[1], point[2]
    out, count = 0, 0
    for f in range(corners.shape[0]):
        ax, ay = corners[f, 0, 0] - x, corners[f, 0, 1] - y
        bx, by = corners[f, 1, 0] - x, corners[f, 1, 1] - y
        cx, cy = corners[f, 2, 0] - x, corners[f, 2, 1] - y
        if min(ax, bx, cx) > 0.0 or max(ax, bx, cx) < 0.0:
            continue
        if min(ay, by, cy) > 0.0 or max(ay, by, cy) < 0.0:
            continue
        u, v, w = bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx
        near = NEAR * (abs(u) + abs(v) + abs(w))
        if min(u, v, w) < -near and max(u, v, w) > near:
            continue
        if min(abs(u), abs(v), abs(w)) <= near:
            return False, out, count
        height = u * corners[f, 0, 2] + v * corners[f, 1, 2] + w * corners[f, 2, 2]
        if height / (u + v + w) > z:
            count += 1
            out += 1 if u + v + w > 0.0 else -1
    return True, out, count
