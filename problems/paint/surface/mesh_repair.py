"""Triangles as they come from files, made fit for painting.

Equal points become one, triangles without area and repeated ones go, and all triangles of a
connected piece are turned alike: outward where the piece is closed, else towards the gun, or as
the file says. What was done stands in notes; doing it again changes nothing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.errors import InputError, Note

WELD = 1e-7
"""Points nearer than this share of the mesh's size are one."""
FLAT = 1e-14
"""Triangles of less area than this share of the mesh's size squared are none."""


class Repaired(NamedTuple):
    """A mesh fit for painting.

    Args:
        vertices: (V, 3) m, all of them used.
        faces: (F, 3), anticlockwise seen from the painted side.
        notes: what was done, and what is odd.
    """

    vertices: FloatArray
    faces: IntArray
    notes: tuple[Note, ...]


class MeshEdges(NamedTuple):
    """The edges of a mesh.

    Args:
        ends: (E, 2) vertices, the smaller index first.
        triangles: (E,) number of them at each.
        pairs: (P, 2) triangles that share an edge which no other triangle has.
        shared: (P,) index of that edge.
        alike: (P,) whether both are turned alike.
        of_face: (F, 3) edges of each triangle, from corner k to k + 1.
    """

    ends: IntArray
    triangles: IntArray
    pairs: IntArray
    shared: IntArray
    alike: BoolArray
    of_face: IntArray


def repair(
    vertices: FloatArray,
    faces: IntArray,
    name: str = "mesh",
    view: ArrayLike | None = None,
    normals: FloatArray | None = None,
) -> Repaired:
    """Make a mesh fit for painting.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        name: of the mesh, for messages.
        view: (3,) direction in which the gun looks at the part; open sheets are turned against it.
        normals: (V, 3) of the vertices as the file has them, for open sheets where there is no
            view; zero or NaN where one is missing.

    Raises:
        InputError: there are no triangles, points are not finite, indices are out of range, or a
            sheet has only one side (a Möbius strip) and no view tells which way to paint it.
    """
    vertices = np.array(vertices, dtype=float).reshape(-1, 3)
    faces = np.array(faces, dtype=np.int64).reshape(-1, 3)
    _check(vertices, faces, name)
    notes: list[Note] = []
    vertices, faces, normals = _cleaned(vertices, faces, normals, name, notes)
    edges = find_edges(faces)
    _note_crowded(vertices, edges, name, notes)
    faces = _turned(vertices, faces, edges, name, _unit(view), normals, notes)
    used = np.unique(faces)
    return Repaired(vertices[used], np.searchsorted(used, faces), tuple(notes))


def find_edges(faces: IntArray) -> MeshEdges:
    """The edges of triangles (F, 3)."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    ends, edge = np.unique(
        np.stack([np.minimum(start, end), np.maximum(start, end)], axis=1),
        axis=0,
        return_inverse=True,
    )
    edge = edge.ravel()
    count = np.bincount(edge, minlength=len(ends))
    order = np.argsort(edge, kind="stable")
    first = np.concatenate(([0], np.cumsum(count)[:-1]))[count == 2]
    one, two = order[first], order[first + 1]
    pairs = np.stack([one // 3, two // 3], axis=1)
    alike = start[one] != start[two]
    return MeshEdges(ends, count, pairs, np.flatnonzero(count == 2), alike, edge.reshape(-1, 3))


def _check(vertices: FloatArray, faces: IntArray, name: str) -> None:
    if len(faces) == 0:
        raise InputError(f"{name}: the mesh has no triangles")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError(f"{name}: triangles refer to points that are not there")
    lost = np.flatnonzero(~np.isfinite(vertices[faces]).all(axis=(1, 2)))
    if len(lost):
        raise InputError(
            f"{name}: {len(lost)} triangles have points that are not finite numbers, "
            f"the first is triangle {lost[0]}"
        )


def _cleaned(
    vertices: FloatArray,
    faces: IntArray,
    normals: FloatArray | None,
    name: str,
    notes: list[Note],
) -> tuple[FloatArray, IntArray, FloatArray | None]:
    """The mesh without what is there twice or is nothing, until there is no more of it."""
    empty = repeated = 0
    while True:
        points, given = len(vertices), len(faces)
        vertices, faces, normals = _welded(vertices, faces, normals)
        kept = _has_area(vertices, faces)
        faces, empty = faces[kept], empty + int((~kept).sum())
        kept = _is_first(faces)
        faces, repeated = faces[kept], repeated + int((~kept).sum())
        if len(faces) == 0:
            raise InputError(f"{name}: no triangle has any area")
        if (points, given) == (len(vertices), len(faces)):
            break
    if empty:
        notes.append(Note(f"{name}: {empty} triangles without area were left out"))
    if repeated:
        notes.append(Note(f"{name}: {repeated} repeated triangles were left out"))
    return vertices, faces, normals


def _welded(
    vertices: FloatArray, faces: IntArray, normals: FloatArray | None
) -> tuple[FloatArray, IntArray, FloatArray | None]:
    """The mesh with equal points made one; the first of them stays as it is."""
    used = np.unique(faces)
    corner = vertices[used].min(axis=0)
    size = float(np.ptp(vertices[used], axis=0).max())
    step = max(WELD * size, np.finfo(float).tiny)
    keys = np.rint((vertices[used] - corner) / step).astype(np.int64)
    _, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    new = np.zeros(len(vertices), dtype=np.int64)
    # In the order of the file, so that a mesh without equal points keeps its numbering.
    rank = np.empty(len(first), dtype=np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    new[used] = rank[which.ravel()]
    kept = used[np.sort(first)]
    return vertices[kept], new[faces], None if normals is None else normals[kept]


def face_normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Normals (F, 3) of triangles, as long as twice their areas."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    return np.cross(b - a, c - a)


def _has_area(vertices: FloatArray, faces: IntArray) -> BoolArray:
    """(F,) whether a triangle has any, next to the size of the mesh."""
    size = float(np.ptp(vertices, axis=0).max())
    double = np.linalg.norm(face_normals(vertices, faces), axis=1)
    return np.asarray(double > 2.0 * FLAT * size * size)


def _is_first(faces: IntArray) -> BoolArray:
    """(F,) whether no triangle before has the same vertices."""
    first = np.zeros(len(faces), dtype=bool)
    first[np.unique(np.sort(faces, axis=1), axis=0, return_index=True)[1]] = True
    return first


def _note_crowded(vertices: FloatArray, edges: MeshEdges, name: str, notes: list[Note]) -> None:
    crowded = np.flatnonzero(edges.triangles > 2)
    if len(crowded):
        x, y, z = vertices[edges.ends[crowded[0]]].mean(axis=0)
        notes.append(
            Note(
                f"{name}: the mesh is not manifold: {len(crowded)} edges belong to more than two "
                f"triangles, the first near ({x:.4g}, {y:.4g}, {z:.4g}) m; the surface counts as "
                "cut there, and each piece is turned on its own"
            )
        )


def _turned(
    vertices: FloatArray,
    faces: IntArray,
    edges: MeshEdges,
    name: str,
    view: FloatArray | None,
    normals: FloatArray | None,
    notes: list[Note],
) -> IntArray:
    """Triangles turned alike, piece by piece."""
    flip, piece, twisted = _flips(len(faces), edges)
    across = face_normals(vertices, faces)
    if twisted.any():
        if view is None:
            x, y, z = vertices[faces[np.flatnonzero(twisted)[0], 0]]
            raise InputError(
                f"{name}: the surface near ({x:.4g}, {y:.4g}, {z:.4g}) m has only one side, as a "
                "Möbius strip has; say from where it is painted, or cut it"
            )
        flip = np.where(twisted, across @ view > 0.0, flip)
        notes.append(
            Note(
                f"{name}: {int(twisted.sum())} triangles form a surface with only one side; each "
                "is turned towards the gun on its own"
            )
        )
    wrong = _wrong_pieces(vertices, faces, edges, flip, piece, view, normals)
    flip ^= wrong[piece] & ~twisted
    if flip.any():
        notes.append(Note(f"{name}: {int(flip.sum())} of {len(faces)} triangles were turned round"))
    return np.where(flip[:, None], faces[:, ::-1], faces)


def _flips(n: int, edges: MeshEdges) -> tuple[BoolArray, IntArray, BoolArray]:
    """Which of n triangles to turn so that pieces are turned alike; pieces; one-sided ones.

    On the double cover, where each triangle stands twice, once turned round, and neighbours that
    agree are joined, a piece falls apart into its two sides.
    """
    a, b = edges.pairs.T
    other = np.where(edges.alike, 0, n)
    rows = np.concatenate([a, a + n])
    columns = np.concatenate([b + other, (b + n - other)])
    ones = np.ones(len(rows), dtype=np.int8)
    graph = coo_array((ones, (rows, columns)), shape=(2 * n, 2 * n))
    _, side = connected_components(graph, directed=False)
    given, turned = side[:n].astype(np.int64), side[n:].astype(np.int64)
    # Of a piece's two sides, that which turns fewer triangles.
    _, piece = np.unique(np.minimum(given, turned), return_inverse=True)
    piece = piece.ravel()
    flip = given > turned
    pieces = np.bincount(piece)
    most = np.bincount(piece, weights=flip) > 0.5 * pieces
    return flip ^ most[piece], piece, given == turned


def _wrong_pieces(
    vertices: FloatArray,
    faces: IntArray,
    edges: MeshEdges,
    flip: BoolArray,
    piece: IntArray,
    view: FloatArray | None,
    normals: FloatArray | None,
) -> BoolArray:
    """Which pieces look the wrong way as a whole."""
    sign = np.where(flip, -1.0, 1.0)
    across = face_normals(vertices, faces) * sign[:, None]
    corners = vertices[faces] - vertices.mean(axis=0)
    volume = np.einsum("fi,fi->f", corners[:, 0], across)
    outward = np.bincount(piece, weights=volume)
    inner = np.bincount(piece[edges.pairs[:, 0]], minlength=len(outward))
    open_piece = 3 * np.bincount(piece) != 2 * inner
    wrong = np.asarray(outward < 0.0)
    if view is not None:
        agreed = -(across @ view)
    elif normals is not None:
        agreed = np.einsum("fi,fi->f", np.nan_to_num(normals)[faces].sum(axis=1), across)
    else:
        return np.asarray(wrong & ~open_piece)
    facing = np.bincount(piece, weights=agreed)
    # What faces no way at all, rounding aside, is closed but for edges of many triangles.
    clear = np.abs(facing) > 1e-9 * np.bincount(piece, weights=np.linalg.norm(across, axis=1))
    return np.asarray(np.where(open_piece & clear, facing < 0.0, wrong))


def _unit(vector: ArrayLike | None) -> FloatArray | None:
    if vector is None:
        return None
    array = np.asarray(vector, dtype=float).reshape(3)
    length = float(np.linalg.norm(array))
    if not (np.isfinite(length) and length > 0.0):
        raise InputError(f"view: a direction is needed, not {array.tolist()}")
    return array / length
