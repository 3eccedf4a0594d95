"""Which triangles of a part are painted: what the gun can see, and what a user selects or covers.

Selections are masks (F,) over triangles and combine with ``&``, ``|`` and ``~``;
`Part.with_painted` and `Part.masked` apply them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.errors import InputError
from .mesh_repair import face_normals, find_edges
from .part import SHARP, sharp_pairs
from .rays.rays import Rays

OPENING = np.deg2rad(60.0)
"""rad by which a gun turns from its main direction to reach what it does not see from there."""
LOOKS = 24
"""Directions from which it is tried."""
STEEPEST = np.deg2rad(80.0)
"""rad between the spray and a surface's normal at which it no longer counts as seen."""
NARROWEST = 5e-3
"""m; narrower strips are the edges of sheets, not surfaces to paint."""
SMALLEST = 0.01
"""Share of the painted area below which a separate patch was seen by chance, through a hole."""


def seen_from(
    vertices: FloatArray,
    faces: IntArray,
    rays: Rays,
    view: ArrayLike,
    opening: float = OPENING,
) -> BoolArray:
    """Triangles that a gun far away sees, looking along ``view`` or turned by up to ``opening``.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3), turned outward.
        rays: against all of the part.
        view: (3,) direction in which the gun looks.
        opening: rad.

    Returns:
        Mask (F,).
    """
    across = face_normals(vertices, faces)
    normals = across / np.linalg.norm(across, axis=1, keepdims=True)
    centres = vertices[faces].mean(axis=1)
    clearance = 1e-6 * float(np.ptp(vertices, axis=0).max())
    seen = np.zeros(len(faces), dtype=bool)
    for direction in directions_within(_unit(view), opening):
        open_to = np.flatnonzero(~seen & (normals @ direction < -np.cos(STEEPEST)))
        origins = centres[open_to] + clearance * normals[open_to]
        seen[open_to] = ~rays.first(origins, -direction).found
    return seen


def skin(
    vertices: FloatArray, faces: IntArray, rays: Rays, view: ArrayLike, opening: float = OPENING
) -> BoolArray:
    """The surface to paint of a closed part: what the gun sees, without edges of sheets and chance.

    The seen triangles are taken apart at sharp edges; of these patches, those narrower than
    `NARROWEST` (twice the area by the length of the border) go, and small ones that are left
    alone (`SMALLEST`).

    Args:
        vertices, faces, rays, view, opening: as in `seen_from`.

    Returns:
        Mask (F,).

    Raises:
        InputError: nothing is seen.
    """
    seen = seen_from(vertices, faces, rays, view, opening)
    wide = seen & ~_narrow(vertices, faces, seen)
    if wide.any():
        seen = wide
    if not seen.any():
        raise InputError(
            f"nothing of the part is seen along {np.asarray(view).tolist()}; "
            "check the direction from which it is painted"
        )
    areas = 0.5 * np.linalg.norm(face_normals(vertices, faces), axis=1)
    piece = patches(vertices, faces, seen, np.pi)
    share = np.bincount(piece[seen], areas[seen]) / areas[seen].sum()
    kept = seen.copy()
    kept[seen] = share[piece[seen]] >= min(SMALLEST, share.max())
    return kept


def patches(
    vertices: FloatArray, faces: IntArray, among: BoolArray, angle: float = SHARP
) -> IntArray:
    """(F,) numbers of connected pieces of the triangles in ``among``, cut where edges turn by more
    than an angle (rad); -1 elsewhere."""
    edges = find_edges(faces)
    joined = among[edges.pairs].all(axis=1)
    if angle < np.pi:
        joined &= ~sharp_pairs(vertices, faces, edges, angle)
    a, b = edges.pairs[joined].T
    n = len(faces)
    graph = coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(n, n))
    _, piece = connected_components(graph, directed=False)
    number = np.full(n, -1)
    number[among] = np.unique(piece[among], return_inverse=True)[1].ravel()
    return number


def grown_from(
    vertices: FloatArray, faces: IntArray, rays: Rays, point: ArrayLike, angle: float = SHARP
) -> BoolArray:
    """Triangles that one gets to from the one nearest to a point without crossing a sharp edge.

    Args:
        vertices, faces: of the part.
        rays: against it.
        point: (3,) m.
        angle: rad by which an edge turns that is sharp.
    """
    piece = patches(vertices, faces, np.ones(len(faces), dtype=bool), angle)
    at = rays.nearest(np.asarray(point, dtype=float).reshape(1, 3)).face[0]
    return np.asarray(piece == piece[at])


def within_box(vertices: FloatArray, faces: IntArray, low: ArrayLike, high: ArrayLike) -> BoolArray:
    """Triangles whose centres lie in a box between two corners (3,) m.

    Raises:
        InputError: the box is empty.
    """
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    if not (low <= high).all():
        raise InputError(f"a box from {low.tolist()} to {high.tolist()} holds nothing")
    centres = vertices[faces].mean(axis=1)
    return np.asarray(((centres >= low) & (centres <= high)).all(axis=1))


def facing(vertices: FloatArray, faces: IntArray, direction: ArrayLike, angle: float) -> BoolArray:
    """Triangles whose outward normals are within an angle (rad) of a direction (3,)."""
    across = face_normals(vertices, faces)
    cosine = across @ _unit(direction) / np.linalg.norm(across, axis=1)
    return np.asarray(cosine >= np.cos(angle))


def directions_within(axis: FloatArray, angle: float) -> FloatArray:
    """`LOOKS` unit vectors (N, 3) spread evenly within an angle (rad) of an axis, itself first.

    On a spiral that turns by the golden angle from one to the next.
    """
    k = np.arange(LOOKS)
    height = 1.0 - (1.0 - np.cos(angle)) * k / (LOOKS - 1)
    radius = np.sqrt(np.maximum(1.0 - height * height, 0.0))
    turn = np.pi * (3.0 - np.sqrt(5.0)) * k
    aside = np.linalg.svd(axis[None, :])[2][1:]
    flat = np.cos(turn)[:, None] * aside[0] + np.sin(turn)[:, None] * aside[1]
    return np.asarray(height[:, None] * axis + radius[:, None] * flat)


def _narrow(vertices: FloatArray, faces: IntArray, among: BoolArray) -> BoolArray:
    """(F,) whether a triangle belongs to a patch that is too narrow."""
    piece = patches(vertices, faces, among)
    edges = find_edges(faces)
    joined = (piece[edges.pairs[:, 0]] == piece[edges.pairs[:, 1]]) & among[edges.pairs[:, 0]]
    inner = np.zeros(len(edges.ends), dtype=bool)
    inner[edges.shared[joined & ~sharp_pairs(vertices, faces, edges, SHARP)]] = True
    span = np.linalg.norm(vertices[edges.ends[:, 0]] - vertices[edges.ends[:, 1]], axis=1) * ~inner
    border = span[edges.of_face].sum(axis=1)
    areas = 0.5 * np.linalg.norm(face_normals(vertices, faces), axis=1)
    if not among.any():
        return among
    around = np.bincount(piece[among], border[among])
    area = np.bincount(piece[among], areas[among])
    width = 2.0 * area / np.maximum(around, 1e-12)
    narrow = np.zeros(len(faces), dtype=bool)
    narrow[among] = width[piece[among]] < NARROWEST
    return narrow


def _unit(vector: ArrayLike) -> FloatArray:
    array = np.asarray(vector, dtype=float).reshape(3)
    length = float(np.linalg.norm(array))
    if not (np.isfinite(length) and length > 0.0):
        raise InputError(f"a direction is needed, not {array.tolist()}")
    return np.asarray(array / length)
