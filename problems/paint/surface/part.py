"""The part to be painted: a surface of triangles with what the thickness needs at its vertices."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.errors import InputError, Note
from ....core.spatial.pose import Pose
from .mesh_repair import MeshEdges, face_normals, find_edges
from .rays.engine import RayEngine, make_rays
from .rays.rays import Rays
from .samples import SurfaceSamples

SHARP = np.deg2rad(50.0)
"""rad; at edges that turn by more, vertices are doubled: each side has its own normal."""


@dataclass(frozen=True, eq=False)
class Part:
    """A triangulated part, in its own frame.

    Made by `Part.of_triangles`, `load_part` or the surfaces of `surfaces`.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3) indices of vertices, anticlockwise seen from the painted side.
        normals: (V, 3) unit vectors that point out of the part, to the gun.
        areas: (V,) m² that each vertex stands for: a third of its triangles' (D. Gleeson et al.,
            Generating Optimized Trajectories for Robotic Spray Painting, 2022, section V-B).
        painted: (V,) whether the vertex is to be painted; the others only stand in the way.
        name: of the part, for messages.
        notes: what a user should know about it.

    Raises:
        InputError: shapes that do not fit together, numbers that are not finite, or no vertex to
            paint.
    """

    vertices: FloatArray
    faces: IntArray
    normals: FloatArray
    areas: FloatArray
    painted: BoolArray
    name: str = "part"
    notes: tuple[Note, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        n = len(self.vertices)
        shapes = {
            "vertices": (self.vertices, float, (n, 3)),
            "faces": (self.faces, np.int64, (len(self.faces), 3)),
            "normals": (self.normals, float, (n, 3)),
            "areas": (self.areas, float, (n,)),
            "painted": (self.painted, np.bool_, (n,)),
        }
        for name, (value, kind, shape) in shapes.items():
            array: NDArray[Any] = np.array(value, dtype=kind)
            if array.shape != shape:
                raise InputError(f"{self.name}: {name} has the shape {array.shape}, not {shape}")
            if not np.isfinite(array).all():
                raise InputError(f"{self.name}: {name} has numbers that are not finite")
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        if not self.painted.any():
            raise InputError(f"{self.name}: there is nothing to paint on it")

    @classmethod
    def of_triangles(
        cls,
        vertices: FloatArray,
        faces: IntArray,
        painted_faces: BoolArray | None = None,
        name: str = "part",
        notes: tuple[Note, ...] = (),
    ) -> Self:
        """The part of triangles that are turned alike.

        Vertices are doubled where painted triangles meet others and along sharp edges (`SHARP`),
        so that normals and areas of painted vertices come from painted triangles alone.

        Args:
            vertices: (V, 3) m.
            faces: (F, 3).
            painted_faces: (F,) which to paint; None for all.
            name, notes: see the class.
        """
        vertices = np.asarray(vertices, dtype=float)
        faces = np.asarray(faces, dtype=np.int64)
        chosen = np.ones(len(faces), dtype=bool) if painted_faces is None else painted_faces
        vertices, faces = _doubled(vertices, faces, chosen)
        painted = np.zeros(len(vertices), dtype=bool)
        painted[faces[chosen]] = True
        return cls(
            vertices,
            faces,
            vertex_normals(vertices, faces),
            vertex_areas(vertices, faces),
            painted,
            name,
            notes,
        )

    @property
    def painted_faces(self) -> BoolArray:
        """(F,) whether the triangle is to be painted."""
        return np.asarray(self.painted[self.faces].all(axis=1))

    @property
    def painted_area(self) -> float:
        """m² to paint."""
        return float(self.areas[self.painted].sum())

    @property
    def total_area(self) -> float:
        """m² of the whole surface."""
        return float(self.areas.sum())

    @property
    def samples(self) -> SurfaceSamples:
        """What is painted, as the deposition takes it: the painted vertices in their order."""
        rows = self.painted
        return SurfaceSamples(self.vertices[rows], self.normals[rows], self.areas[rows])

    @property
    def facing(self) -> FloatArray:
        """(3,) mean direction of the painted surface's normals, not of unit length."""
        weights = (self.areas * self.painted)[:, None]
        return np.asarray((weights * self.normals).sum(axis=0) / self.painted_area)

    @cached_property
    def rays(self) -> Rays:
        """Rays against the whole part, by the fastest engine there is."""
        return make_rays(self.vertices, self.faces)

    def rays_by(self, engine: RayEngine) -> Rays:
        """Rays against the whole part by a given engine."""
        return make_rays(self.vertices, self.faces, engine)

    def moved(self, pose: Pose) -> Self:
        """The part in a frame in which its own one stands at ``pose``."""
        matrix = pose.matrix()
        rotation = matrix[:3, :3]
        return replace(
            self,
            vertices=self.vertices @ rotation.T + matrix[:3, 3],
            normals=self.normals @ rotation.T,
        )

    def with_painted(self, painted_faces: BoolArray) -> Self:
        """The part with other triangles (F,) to paint."""
        return self.of_triangles(self.vertices, self.faces, painted_faces, self.name, self.notes)

    def masked(self, covered_faces: BoolArray) -> Self:
        """The part with triangles (F,) taken from those to paint."""
        return self.with_painted(self.painted_faces & ~covered_faces)


def vertex_areas(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """(V,) m²: a third of the area of each vertex's triangles."""
    third = np.linalg.norm(face_normals(vertices, faces), axis=1) / 6.0
    return np.bincount(faces.ravel(), np.repeat(third, 3), len(vertices)).astype(float)


def vertex_normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """(V, 3) unit normals: of the triangles, weighted by their angles at the vertex.

    So the way in which a face is cut into triangles does not matter (G. Thürmer, C. Wüthrich,
    Computing vertex normals from polygonal facets, J. Graphics Tools 3, 1998). Where they cancel,
    one triangle's normal stands for all.
    """
    across = face_normals(vertices, faces)
    length = np.linalg.norm(across, axis=1, keepdims=True)
    unit = across / np.maximum(length, np.finfo(float).tiny)
    sides = np.roll(vertices[faces], -1, axis=1) - vertices[faces]
    sides /= np.maximum(np.linalg.norm(sides, axis=2, keepdims=True), np.finfo(float).tiny)
    cosine = -np.einsum("fki,fki->fk", sides, np.roll(sides, 1, axis=1))
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    total = np.zeros((len(vertices), 3))
    for axis in range(3):
        weights = (angle * unit[:, axis, None]).ravel()
        total[:, axis] = np.bincount(faces.ravel(), weights, len(vertices))
    norm = np.linalg.norm(total, axis=1)
    single = np.zeros((len(vertices), 3))
    single[:, 2] = 1.0
    single[faces.ravel()] = np.repeat(unit, 3, axis=0)
    return np.where(norm[:, None] > 1e-9, total / np.maximum(norm, 1e-9)[:, None], single)


def sharp_pairs(vertices: FloatArray, faces: IntArray, edges: MeshEdges, angle: float) -> BoolArray:
    """Which of the edges' pairs of triangles turn by more than an angle (rad)."""
    across = face_normals(vertices, faces)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), np.finfo(float).tiny)
    one, two = across[edges.pairs[:, 0]], across[edges.pairs[:, 1]]
    return np.asarray(np.einsum("pi,pi->p", one, two) < np.cos(angle))


def _doubled(
    vertices: FloatArray, faces: IntArray, chosen: BoolArray
) -> tuple[FloatArray, IntArray]:
    """The mesh with a copy of each vertex for every group of its triangles that belong together.

    A vertex's triangles belong together if one gets from one to the other through edges at that
    vertex that are neither sharp nor a border of what is painted.
    """
    edges = find_edges(faces)
    cut = sharp_pairs(vertices, faces, edges, SHARP)
    cut |= chosen[edges.pairs[:, 0]] != chosen[edges.pairs[:, 1]]
    pairs, ends = edges.pairs[~cut], edges.ends[edges.shared[~cut]]
    joined = []
    for side in range(2):
        at = ends[:, side, None]
        corners = [3 * pairs[:, k] + np.argmax(faces[pairs[:, k]] == at, axis=1) for k in range(2)]
        joined.append(np.stack(corners))
    one, two = np.concatenate(joined, axis=1)
    n = 3 * len(faces)
    graph = coo_array((np.ones(len(one), dtype=np.int8), (one, two)), shape=(n, n))
    _, group = connected_components(graph, directed=False)
    _, first, which = np.unique(group, return_index=True, return_inverse=True)
    # Copies in the order of the vertices they come from: a mesh without cuts stays as it is.
    source = faces.ravel()[first]
    order = np.argsort(source, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return vertices[source[order]], rank[which.ravel()].reshape(-1, 3)
