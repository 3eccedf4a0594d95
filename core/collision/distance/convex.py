"""Convex pieces of meshes, where a depth is wanted and not only a distance.

Only convex solids have a depth when they overlap. A mesh of convex parts is taken apart into
them. A tool's parts that are far from convex are split into convex ones that enclose them, others
are filled up to their hulls, and a note says how much that adds; an obstacle keeps its surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...cell.geometry import Mesh
from ...convex.split import split
from ...errors import InputError, Note
from .solid import Polytope, Solid, TriangleMesh, connected_parts

FILLED = 1e-6
"""Share of its hull's volume that a part may lack to pass as convex: rounding of mesh files."""
DENT = 1e-3
"""Depth of what is surely a dent, by the part's size."""
MOST_PARTS = 24
"""Meshes of more parts than these are not taken apart."""
MOST_NEIGHBOURS = 200
"""Corners that one corner is joined to; coal takes 255."""
HAIR = 1e-9
"""m by which a corner of more edges is drawn apart."""
_TRIES = 4
THIN = 1e-6
"""Half the thickness that a flat part's hull is given, by the part's size."""


class _Part(NamedTuple):
    """A connected part of a mesh, its hull, and whether it fills its hull."""

    hull: Polytope
    closed: bool
    volume: float
    hull_volume: float

    @property
    def convex(self) -> bool:
        return self.closed and self.hull_volume - self.volume <= FILLED * self.hull_volume


def tool_solids(name: str, mesh: Mesh) -> tuple[list[Solid], list[Note]]:
    """A tool's mesh as convex solids that enclose it, and what they add to it.

    Raises:
        InputError: the mesh cannot be used.
    """
    rows = _part_rows(mesh)
    parts = [_part(mesh.vertices, mesh.faces[row]) for row in rows]
    notes = list(mesh.notes)
    if all(part.convex for part in parts):
        return [part.hull for part in parts], notes
    solids: list[Solid] = []
    lacks = None
    for part, row in zip(parts, rows, strict=True):
        if part.convex:
            solids.append(part.hull)
            continue
        made = split(mesh.vertices, mesh.faces[row])
        lacks = lacks or made.lacks
        solids += [part.hull] if len(made.parts) < 2 else [hull(points) for points in made.parts]
    remedy = "a mesh of convex parts is used as it is" if lacks is None else lacks
    notes.append(Note(f"{_filled(name, mesh, parts, solids)}; {remedy}"))
    return solids, notes


def _filled(name: str, mesh: Mesh, parts: list[_Part], solids: list[Solid]) -> str:
    more = "larger by an unknown volume, since the mesh is not closed"
    if all(part.closed for part in parts):
        volume = sum(part.volume for part in parts)
        hulls = sum(_volume(one.vertices, one.faces) for one in solids if isinstance(one, Polytope))
        more = f"{100.0 * (hulls / volume - 1.0):.3g} % larger in volume"
    what = "their hulls stand for it"
    if len(solids) > len(parts):
        what = f"{len(solids)} convex parts that enclose it stand for it"
    return f"tool {name!r}: {mesh.file} is not made of convex parts; {what}, {more}"


def obstacle_solids(mesh: Mesh) -> tuple[list[Solid], list[Note]]:
    """An obstacle's mesh as convex solids if its parts are convex and closed, else its surface.

    Raises:
        InputError: the mesh cannot be used.
    """
    notes = list(mesh.notes)
    closed = is_closed(mesh.faces)
    rows = _part_rows(mesh)
    if closed and not any(_is_dented(mesh.vertices, mesh.faces[row]) for row in rows):
        parts = [_part(mesh.vertices, mesh.faces[row]) for row in rows]
        hulls = [part.hull for part in parts]
        if all(part.convex for part in parts) and not _any_nested(hulls):
            return list(hulls), notes
    return [TriangleMesh(mesh.vertices, mesh.faces, closed)], notes


def is_closed(faces: NDArray[np.int64]) -> bool:
    """Whether every edge belongs to an even number of triangles: the surface has an inside."""
    start = faces.ravel().astype(np.int64)
    end = np.roll(faces, -1, axis=1).ravel()
    key = np.minimum(start, end) * (int(faces.max()) + 1) + np.maximum(start, end)
    key.sort()
    turns = np.flatnonzero(np.diff(key, prepend=-1, append=-1))
    return bool((np.diff(turns) % 2 == 0).all())


def _part_rows(mesh: Mesh) -> list[NDArray[np.int64]]:
    """Rows of the faces, part by part; all in one where there are too many parts."""
    rows = connected_parts(mesh.faces, len(mesh.vertices))
    return rows if len(rows) <= MOST_PARTS else [np.arange(len(mesh.faces))]


def _any_nested(parts: list[Polytope]) -> bool:
    """Whether the box round one part lies in that round another: the one may be a hollow."""
    lowest = np.array([part.vertices.min(axis=0) for part in parts])
    highest = np.array([part.vertices.max(axis=0) for part in parts])
    within = (lowest[:, None] >= lowest).all(-1) & (highest[:, None] <= highest).all(-1)
    return bool(within.sum() > len(parts))


def _is_dented(vertices: FloatArray, faces: NDArray[np.int64]) -> bool:
    """Whether the planes of some of the faces have corners far off on both sides: not convex.

    It saves the hull of most meshes that are not convex.
    """
    points = vertices[np.unique(faces)]
    a, b, c = np.moveaxis(vertices[faces[:: max(1, len(faces) // 32)]], 1, 0)
    across = np.cross(b - a, c - a)
    height = (points @ across.T - np.einsum("fi,fi->f", a, across)) / np.maximum(
        np.linalg.norm(across, axis=1), np.finfo(float).tiny
    )
    both = np.minimum(height.max(axis=0), -height.min(axis=0))
    return bool(both.max() > DENT * np.ptp(points, axis=0).max())


def _part(vertices: FloatArray, faces: NDArray[np.int64]) -> _Part:
    points = vertices[np.unique(faces)]
    solid = hull(points)
    return _Part(
        solid, is_closed(faces), abs(_volume(vertices, faces)), _volume(solid.vertices, solid.faces)
    )


def _volume(vertices: FloatArray, faces: NDArray[np.int64]) -> float:
    """m³ inside a closed surface with outward triangles, by the divergence theorem."""
    a, b, c = np.moveaxis(vertices[faces] - vertices[faces[0, 0]], 1, 0)
    return float(np.einsum("fi,fi->", a, np.cross(b, c))) / 6.0


def hull(points: FloatArray) -> Polytope:
    """The convex hull of points (V, 3); flat ones are given a thickness.

    No corner has more neighbours than collision libraries take: flat facets are cut so that edges
    spread over their corners, and a corner of more edges (the tip of a cone) is drawn apart by a
    hair, outward.

    Raises:
        InputError: all points coincide, or thousands of edges meet again and again.
    """
    for _ in range(_TRIES):
        solid = _hull_of(points)
        # On a closed surface a corner has as many neighbours as triangles.
        degree = np.bincount(solid.faces.ravel())
        crowded = np.flatnonzero(degree > MOST_NEIGHBOURS)
        if not len(crowded):
            return solid
        points = _drawn_apart(solid.vertices, crowded, degree)
    raise InputError("too many edges of a mesh meet at one corner; it needs fewer facets")


def _hull_of(points: FloatArray) -> Polytope:
    from scipy.spatial import ConvexHull, QhullError

    try:
        found = ConvexHull(points)
    except QhullError:
        points = _thickened(points)
        try:
            found = ConvexHull(points)
        except QhullError as error:
            raise InputError(
                "a mesh, or a part of one, has no extent: all its corner points coincide"
            ) from error
    used, index = np.unique(found.simplices, return_inverse=True)
    vertices = np.ascontiguousarray(points[used])
    faces = _spread(vertices, index.reshape(-1, 3).astype(np.int64), found.equations)
    return Polytope(vertices, faces)


def _spread(
    vertices: FloatArray, faces: NDArray[np.int64], planes: FloatArray
) -> NDArray[np.int64]:
    """Triangles (F, 3) outward, of which those in one plane meet in no corner by the hundred.

    Args:
        vertices: (V, 3) m.
        faces: triangles of a hull.
        planes: (F, 4) the plane of each; equal for those that were cut from one facet.
    """
    _, facet, size = np.unique(planes, axis=0, return_inverse=True, return_counts=True)
    facet = facet.ravel()
    large = size[facet] >= MOST_NEIGHBOURS // 2
    kept, normals = faces[~large], planes[~large, :3]
    a, b, c = np.moveaxis(vertices[kept], 1, 0)
    inward = np.einsum("fi,fi->f", np.cross(b - a, c - a), normals) < 0.0
    kept[inward] = kept[inward][:, ::-1]
    cut = [kept]
    for one in np.unique(facet[large]):
        rows = np.flatnonzero(facet == one)
        cut.append(_halved(_ring(vertices, np.unique(faces[rows]), planes[rows[0], :3])))
    return np.concatenate(cut)


def _ring(
    vertices: FloatArray, corners: NDArray[np.int64], normal: FloatArray
) -> NDArray[np.int64]:
    """Corners of a facet in their order about its normal."""
    out = vertices[corners] - vertices[corners].mean(axis=0)
    x = out[0] - (out[0] @ normal) * normal
    y = np.cross(normal, x)
    return corners[np.argsort(np.arctan2(out @ y, out @ x))]


def _halved(ring: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles (K - 2, 3) of a convex polygon, halved again and again: no corner is in many."""
    made, open_ = [], [(0, len(ring) - 1)]
    while open_:
        first, last = open_.pop()
        if last - first > 1:
            middle = (first + last) // 2
            made.append((first, middle, last))
            open_ += [(first, middle), (middle, last)]
    return np.asarray(ring[np.array(made)])


def _drawn_apart(
    vertices: FloatArray, crowded: NDArray[np.int64], degree: NDArray[np.int64]
) -> FloatArray:
    """The corners with a ring of corners in place of each of the crowded ones."""
    made = [np.delete(vertices, crowded, axis=0)]
    for corner in crowded:
        tip = vertices[corner]
        # Across the way in, so that the tip lies in the middle of the ring: nothing is cut off.
        _, _, ways = np.linalg.svd((tip - vertices.mean(axis=0))[None])
        turn = np.linspace(0.0, 2.0 * np.pi, 3 + 4 * int(degree[corner]) // MOST_NEIGHBOURS)[:-1]
        made.append(tip + HAIR * np.column_stack([np.cos(turn), np.sin(turn)]) @ ways[1:])
    return np.concatenate(made)


def _thickened(points: FloatArray) -> FloatArray:
    """Points in a plane (or a line) with copies on all sides, near by the points' size."""
    reach = THIN * float(np.ptp(points, axis=0).max())
    steps = np.concatenate([np.eye(3), -np.eye(3)]) * reach
    return np.asarray((points[:, None] + steps).reshape(-1, 3))
