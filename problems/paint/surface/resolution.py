"""Finer and coarser triangulations of a part.

Thickness is known at vertices, so they must lie closer together than the footprint changes; the
optimisation wants few of them and the judging many. Both ways keep the area to the last digits.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from ....core.arrays import FloatArray, IntArray
from ....core.errors import InputError
from .mesh_repair import find_edges
from .part import Part

ROUNDS = 8
"""How often clusters are formed anew round their centres."""
MOST_VERTICES = 4_000_000
"""A refined mesh has no more, or the spacing is a mistake."""


def refined(
    vertices: FloatArray, faces: IntArray, longest: float
) -> tuple[FloatArray, IntArray, IntArray]:
    """Triangles cut until no edge is longer than a length.

    All triangles at an edge cut it in its middle, so that none is left with a vertex on its side;
    the surface stays the same.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        longest: m.

    Returns:
        Vertices, the given ones first; faces; and of which given face each is a part.

    Raises:
        InputError: the length is not above zero, or far too small for this mesh.
    """
    if not longest > 0.0:
        raise InputError(f"longest: a length above zero is needed, not {longest!r}")
    source = np.arange(len(faces))
    while True:
        edges = find_edges(faces)
        span = vertices[edges.ends[:, 0]] - vertices[edges.ends[:, 1]]
        long = np.linalg.norm(span, axis=1) > longest
        if not long.any():
            return vertices, faces, source
        if len(vertices) + long.sum() > MOST_VERTICES:
            raise InputError(
                f"edges of {longest:g} m would need more than {MOST_VERTICES} vertices; "
                "check the part's units and the spacing"
            )
        middle = np.full(len(edges.ends), -1)
        middle[long] = len(vertices) + np.arange(long.sum())
        vertices = np.concatenate([vertices, vertices[edges.ends[long]].mean(axis=1)])
        faces, source = _cut(vertices, faces, source, middle[edges.of_face])


def _cut(
    vertices: FloatArray, faces: IntArray, source: IntArray, middle: IntArray
) -> tuple[IntArray, IntArray]:
    """Triangles cut at the middles (F, 3) of their edges; -1 where an edge stays whole."""
    cuts = (middle >= 0).sum(axis=1)
    parts, sources = [faces[cuts == 0]], [source[cuts == 0]]
    # Turned so that edge 0 (from corner 0 to 1) is the one cut, or the one left whole.
    first = np.where(cuts == 1, np.argmax(middle >= 0, axis=1), np.argmin(middle >= 0, axis=1))
    turn = (np.arange(3) + first[:, None]) % 3
    a, b, c = np.take_along_axis(faces, turn, axis=1).T
    ab, bc, ca = np.take_along_axis(middle, turn, axis=1).T
    # Two cuts leave a quadrangle a, b, bc, ca: along its shorter diagonal.
    span = [np.linalg.norm(vertices[p] - vertices[q], axis=1) for p, q in ((a, bc), (b, ca))]
    short = span[0] <= span[1]
    patterns = [
        (cuts == 1, [(a, ab, c), (ab, b, c)]),
        (cuts == 2, [(c, ca, bc)]),
        ((cuts == 2) & short, [(a, b, bc), (a, bc, ca)]),
        ((cuts == 2) & ~short, [(a, b, ca), (b, bc, ca)]),
        (cuts == 3, [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]),
    ]
    for wanted, triangles in patterns:
        for triangle in triangles:
            parts.append(np.stack(triangle, axis=1)[wanted])
            sources.append(source[wanted])
    return np.concatenate(parts), np.concatenate(sources)


def coarsened(part: Part, vertices: int, seed: int = 0) -> Part:
    """The part with about so many vertices, each in the place and with the area of a cluster.

    Clusters are the cells round centres that are moved to the middle of their cells (Lloyd's
    algorithm on the mesh's edges), as S. Valette and J.-M. Chassery use them (Approximated
    centroidal Voronoi diagrams for uniform polygonal mesh coarsening, Computer Graphics Forum 23,
    2004). Vertices are some of the given ones, with their normals; painted and other vertices share
    no cluster. Triangles join clusters that meet at a given one: they show the surface coarsely.

    Args:
        part: the part.
        vertices: wanted.
        seed: of the first centres.

    Raises:
        InputError: the number is not positive.
    """
    if vertices < 1:
        raise InputError(f"vertices: at least one is needed, not {vertices}")
    if vertices >= len(part.vertices):
        return part
    graph = _lengths(part)
    centres = _drawn(part, graph, vertices, seed)
    cluster = _nearest_centre(graph, centres)
    for _ in range(ROUNDS):
        centres = _middles(part, cluster, len(centres))
        cluster = _nearest_centre(graph, centres)
    faces = cluster[part.faces]
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    faces = faces[whole]
    if len(faces):
        faces = faces[np.sort(np.unique(np.sort(faces, axis=1), axis=0, return_index=True)[1])]
    return replace(
        part,
        vertices=part.vertices[centres],
        faces=faces,
        normals=part.normals[centres],
        areas=np.asarray(np.bincount(cluster, part.areas, len(centres)), dtype=float),
        painted=part.painted[centres],
    )


def _lengths(part: Part) -> csr_array:
    """Graph of the mesh's edges with their lengths; painted vertices have none to others."""
    ends = find_edges(part.faces).ends
    ends = ends[part.painted[ends[:, 0]] == part.painted[ends[:, 1]]]
    length = np.linalg.norm(part.vertices[ends[:, 0]] - part.vertices[ends[:, 1]], axis=1)
    n = len(part.vertices)
    return csr_array((np.maximum(length, 1e-12), (ends[:, 0], ends[:, 1])), shape=(n, n))


def _drawn(part: Part, graph: csr_array, count: int, seed: int) -> IntArray:
    """First centres, drawn by area, and one for every piece of the mesh that got none."""
    rng = np.random.default_rng(seed)
    weights = np.maximum(part.areas, 1e-12 * part.areas.max())
    drawn = rng.choice(len(weights), count, replace=False, p=weights / weights.sum())
    pieces, piece = connected_components(graph, directed=False)
    missed = np.setdiff1d(np.arange(pieces), piece[drawn])
    first = np.unique(piece, return_index=True)[1]
    return np.sort(np.concatenate([drawn, first[missed]]))


def _nearest_centre(graph: csr_array, centres: IntArray) -> IntArray:
    """(V,) index of the centre that is nearest along edges."""
    _, _, source = dijkstra(
        graph, directed=False, indices=centres, min_only=True, return_predecessors=True
    )
    number = np.full(graph.shape[0], -1)
    number[centres] = np.arange(len(centres))
    return np.asarray(number[source])


def _middles(part: Part, cluster: IntArray, count: int) -> IntArray:
    """Of each cluster the vertex nearest to its centre of area."""
    total = np.maximum(np.bincount(cluster, part.areas, count), np.finfo(float).tiny)
    centre = np.stack(
        [np.bincount(cluster, part.areas * part.vertices[:, k], count) / total for k in range(3)],
        axis=1,
    )
    off = np.linalg.norm(part.vertices - centre[cluster], axis=1)
    order = np.lexsort((off, cluster))
    return order[np.searchsorted(cluster[order], np.arange(count))]
