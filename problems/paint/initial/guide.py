"""The surface that guides the gun: what is painted, its small holes closed."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ....core.arrays import BoolArray, FloatArray, IntArray
from ..surface.mesh_repair import face_normals
from ..surface.part import Part
from ..surface.rays.tree import build_tree
from .guide_kernels import find_edges_along, meet_lines

STEPS = 16
"""Steps of the search for an edge."""
HALVINGS = 20
"""How often the step in which the edge lies is halved."""
STEEPEST_FAR, STEEPEST_NEAR = math.radians(80.0), math.radians(70.0)
"""rad between a line and the surface's normal beyond which nothing is met: from before the whole
surface, and from near it, where what is steeper is a corner, and the surface ends there."""

FARTHEST_TURN = math.cos(math.radians(100.0))
"""Least product of the gun's direction and the view: sweeps do not run round to the far side."""


class Meeting(NamedTuple):
    """Where lines meet the guide.

    Args:
        found: (N,) whether they do, on the side that is painted.
        point: (N, 3) m; NaN elsewhere.
        normal: (N, 3) unit vectors out of the surface, interpolated; NaN elsewhere.
    """

    found: BoolArray
    point: FloatArray
    normal: FloatArray


class Guide:
    """The painted surface with holes closed, for projections along lines.

    Rays are traced by the compiled tree, in double precision, whatever else is installed: curves
    do not depend on it.

    Args:
        part: the part.
        hole_size: m; holes up to this size are closed, except the longest border of each piece.
        view: (3,) unit vector along which the gun looks at the part; what faces farther away than
            `FARTHEST_TURN` is left out. None to leave out nothing.

    ``size`` is the length (m) of its box's diagonal.
    """

    def __init__(self, part: Part, hole_size: float, view: FloatArray | None = None) -> None:
        chosen = part.painted_faces
        if view is not None:
            across = face_normals(part.vertices, part.faces)
            away = across @ view > -FARTHEST_TURN * np.linalg.norm(across, axis=1)
            chosen = chosen & ~away if (chosen & ~away).any() else chosen
        faces = part.faces[chosen]
        used = np.unique(faces)
        faces = np.searchsorted(used, faces)
        self.vertices, self.faces, self.normals = _closed(
            part.vertices[used], faces, part.normals[used], hole_size
        )
        self._tree = build_tree(self.vertices[self.faces])
        self.size = float(np.linalg.norm(np.ptp(self.vertices, axis=0)))
        self._far = 2.0 * self.size + 1.0
        self._middle = 0.5 * (self.vertices.min(axis=0) + self.vertices.max(axis=0))

    def meet(self, points: FloatArray, directions: FloatArray, reach: float) -> Meeting:
        """Where the lines through points (N, 3) along unit directions (N, 3) meet the surface.

        Args:
            points, directions: the lines; directions point from the gun to the surface.
            reach: m from the points within which the nearest meeting counts; inf for the meeting
                that comes first on the way from the gun.
        """
        points, directions = np.ascontiguousarray(points), np.ascontiguousarray(directions)
        n = len(points)
        met = Meeting(np.empty(n, dtype=np.bool_), np.empty((n, 3)), np.empty((n, 3)))
        back = self._back(points, directions)
        meet_lines(
            self._tree,
            self.faces,
            self.normals,
            points,
            directions,
            reach,
            back,
            _least(reach),
            *met,
        )
        return met

    def edge_distances(
        self,
        points: FloatArray,
        normals: FloatArray,
        ways: FloatArray,
        inside: BoolArray,
        farthest: float,
        reach: float,
    ) -> FloatArray:
        """Lengths (N, K) m along ways after which points come onto the surface or leave it.

        By steps and then by halving, looking along the normals; inf where nothing changes within
        ``farthest`` m.

        Args:
            points: (N, 3) m.
            normals: (N, 3) unit directions from the gun to the surface.
            ways: (N, K, 3) unit vectors.
            inside: (N,) whether the points lie on the surface.
            farthest: m.
            reach: as in `meet`.
        """
        lengths = np.empty(ways.shape[:2])
        find_edges_along(
            self._tree,
            np.ascontiguousarray(points),
            np.ascontiguousarray(normals),
            np.ascontiguousarray(ways),
            np.ascontiguousarray(inside),
            farthest,
            reach,
            self._back(points, normals),
            np.einsum("nki,ni->nk", ways, normals),
            _least(reach),
            STEPS,
            HALVINGS,
            lengths,
        )
        return lengths

    def _back(self, points: FloatArray, directions: FloatArray) -> FloatArray:
        """(N,) m from points back to where nothing of the surface is behind."""
        return np.asarray(np.einsum("ij,ij->i", points - self._middle, directions) + self._far)


def _least(reach: float) -> float:
    return math.cos(STEEPEST_FAR if math.isinf(reach) else STEEPEST_NEAR)


def _closed(
    vertices: FloatArray, faces: IntArray, normals: FloatArray, hole_size: float
) -> tuple[FloatArray, IntArray, FloatArray]:
    """The surface with fans of triangles over its small holes."""
    # Vertices doubled at sharp edges are one here: a crease is no hole.
    _, first, same = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    same = first[same.ravel()]
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    n = len(vertices)
    key = np.minimum(same[start], same[end]) * n + np.maximum(same[start], same[end])
    _, back, count = np.unique(key, return_inverse=True, return_counts=True)
    rim = count[back.ravel()] == 1
    start, end = start[rim], end[rim]
    for loop in _loops(same[start], same[end], _pieces(same[faces], n), vertices, hole_size):
        middle = vertices[start[loop]].mean(axis=0)
        mean = normals[start[loop]].sum(axis=0)
        length = float(np.linalg.norm(mean))
        if length < 1e-9:
            continue
        fan = np.stack([end[loop], start[loop], np.full(len(loop), len(vertices))], axis=1)
        vertices = np.concatenate([vertices, middle[None]])
        normals = np.concatenate([normals, mean[None] / length])
        faces = np.concatenate([faces, fan])
    return vertices, faces, normals


def _pieces(faces: IntArray, n: int) -> IntArray:
    """(V,) number of the connected piece to which each vertex belongs."""
    rows, columns = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1])


def _loops(
    start: IntArray, end: IntArray, piece: IntArray, vertices: FloatArray, hole_size: float
) -> list[IntArray]:
    """Rows of the rim's edges that run round holes up to a size."""
    if len(start) == 0:
        return []
    n = len(vertices)
    graph = coo_array((np.ones(len(start), dtype=np.int8), (start, end)), shape=(n, n))
    _, label = connected_components(graph, directed=False)
    span = np.linalg.norm(vertices[end] - vertices[start], axis=1)
    length = np.bincount(label[start], span, label.max() + 1)
    found: list[tuple[IntArray, int, float]] = []
    longest: dict[int, float] = {}
    for loop in np.unique(label[start]):
        rows = np.flatnonzero(label[start] == loop)
        simple = len(np.unique(start[rows])) == len(rows) == len(np.unique(end[rows]))
        of = int(piece[start[rows[0]]])
        longest[of] = max(longest.get(of, 0.0), float(length[loop]))
        size = float(np.linalg.norm(np.ptp(vertices[start[rows]], axis=0)))
        if simple and size <= hole_size * math.sqrt(2.0):
            found.append((rows, of, float(length[loop])))
    return [rows for rows, of, around in found if around < longest[of]]
