"""Shapes of tools and obstacles; meshes are read when they are asked for, and checked then."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..errors import InputError, Note
from ..files.mesh_file import MESH_UNITS, check_extent, read_scene
from ..robot.shape import Shape
from ..spatial.pose import IDENTITY, Pose, Vector3

PLAUSIBLE_EXTENT = (5e-3, 20.0)
"""m; beyond, the unit is probably wrong."""
_USUAL_EXTENT = 0.5
"""m, of what stands in a cell."""
_NOTHING = 1e-12
_FLAT = 1e-9
"""Area of a triangle over the square of a side below which it is none."""


@dataclass(frozen=True)
class Triangles:
    """The content of a mesh that code has made; equal if all numbers are.

    Args:
        vertices: corner points (V, 3), in the mesh's units.
        faces: (F, 3) indices of ``vertices``, anticlockwise seen from outside.
    """

    vertices: FloatArray = field(compare=False)
    faces: NDArray[np.int64] = field(compare=False)
    digest: str = field(init=False, repr=False)

    def __post_init__(self) -> None:
        vertices = np.array(self.vertices, dtype=float).reshape(-1, 3)
        faces = np.array(self.faces, dtype=np.int64).reshape(-1, 3)
        for array in (vertices, faces):
            array.flags.writeable = False
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)
        content = vertices.tobytes() + faces.tobytes()
        object.__setattr__(self, "digest", sha256(content).hexdigest())


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh in a file, or one that code has made.

    Args:
        file: the mesh file; for a mesh made by code where it would stand, for messages.
        units: of its numbers, a key of `MESH_UNITS`.
        triangles: the content of a mesh made by code; None to read it from the file.

    Raises:
        InputError: the unit is unknown.
    """

    file: Path
    units: str
    triangles: Triangles | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        if self.units not in MESH_UNITS:
            raise InputError(f"{self.file}: a mesh's units are one of {', '.join(MESH_UNITS)}")

    @property
    def vertices(self) -> FloatArray:
        """Corner points (V, 3) m in the mesh's own frame.

        Raises:
            InputError: the file is no mesh, is empty or holds numbers that are not finite.
        """
        return self._content[0]

    @property
    def faces(self) -> NDArray[np.int64]:
        """Triangles (F, 3) as indices of `vertices`; raises as `vertices`."""
        return self._content[1]

    @property
    def notes(self) -> tuple[Note, ...]:
        """What is odd about the mesh without making it unusable; raises as `vertices`."""
        return self._content[2]

    @cached_property
    def _content(self) -> tuple[FloatArray, NDArray[np.int64], tuple[Note, ...]]:
        mesh = _load(self.file) if self.triangles is None else _made(self.triangles)
        vertices = np.array(mesh.vertices, dtype=float) * MESH_UNITS[self.units]
        faces = np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
        if len(faces) == 0:
            raise InputError(f"{self.file}: the mesh has no triangles")
        check_extent(self.file, vertices)
        if not _has_surface(vertices, faces):
            raise InputError(
                f"{self.file}: the mesh has no surface: the corners of each of its triangles lie "
                "on a line"
            )
        vertices.flags.writeable = False
        faces.flags.writeable = False
        return vertices, faces, tuple(self._oddities(bool(mesh.is_watertight), vertices))

    def _oddities(self, watertight: bool, vertices: FloatArray) -> list[Note]:
        notes = []
        if not watertight:
            notes.append(Note(f"{self.file}: the mesh is not watertight: its inside reads as free"))
        if self._doubt(vertices) is not None:
            notes.append(Note(f"{self.file}: {self._doubt(vertices)}"))
        return notes

    @property
    def doubt(self) -> str | None:
        """Why its unit is probably another one; None where nothing speaks for that."""
        return self._doubt(self.vertices)

    def _doubt(self, vertices: FloatArray) -> str | None:
        extent = float(np.ptp(vertices, axis=0).max())
        shortest, longest = PLAUSIBLE_EXTENT
        if shortest <= extent <= longest:
            return None
        numbers = max(extent, _NOTHING) / MESH_UNITS[self.units]
        unit = min(
            MESH_UNITS, key=lambda unit: abs(math.log(numbers * MESH_UNITS[unit] / _USUAL_EXTENT))
        )
        other = "" if unit == self.units else f": with units = {unit!r} it would be "
        size = "" if unit == self.units else f"{numbers * MESH_UNITS[unit]:.3g} m"
        return f"in {self.units} it is {extent:.3g} m long; check its units{other}{size}"


@dataclass(frozen=True, slots=True)
class Geometry:
    """A shape at its place.

    Args:
        shape: a mesh or a simple convex shape.
        placement: the shape's frame in the frame of what it belongs to.
    """

    shape: Mesh | Shape
    placement: Pose = IDENTITY

    @property
    def box(self) -> tuple[Vector3, Vector3]:
        """Its lowest and highest corner, m in the shape's own frame, of the box round it.

        Raises:
            InputError: the mesh cannot be used.
        """
        if isinstance(self.shape, Mesh):
            ends = self.shape.vertices.min(axis=0), self.shape.vertices.max(axis=0)
        else:
            half = 0.5 * np.array(self.shape.size)
            ends = -half, half
        (a, b, c), (d, e, f) = (end.tolist() for end in ends)
        return (a, b, c), (d, e, f)

    @property
    def corners(self) -> FloatArray:
        """(8, 3) m in the shape's own frame, of the box round it along the axes.

        Raises:
            InputError: the mesh cannot be used.
        """
        ends = self.box
        return np.array([[ends[k >> axis & 1][axis] for axis in range(3)] for k in range(8)])


def _made(triangles: Triangles) -> Any:
    """The `trimesh.Trimesh` of triangles, nothing cleaned up."""
    import trimesh

    return trimesh.Trimesh(triangles.vertices, triangles.faces, process=False)


def _has_surface(vertices: FloatArray, faces: NDArray[np.int64]) -> bool:
    """Whether any triangle is more than a line or a point."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    doubled = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.maximum(np.linalg.norm(b - a, axis=1), np.linalg.norm(c - a, axis=1))
    return bool((doubled > _FLAT * longest**2).any())


def _load(file: Path) -> Any:
    """The file's triangles as one `trimesh.Trimesh`, equal corner points merged.

    trimesh drops points that are not finite when it cleans up, so it does not clean up here
    before they are looked for.
    """
    scene = read_scene(file)
    try:
        with np.errstate(all="ignore"):
            mesh = scene.to_mesh()
    except Exception as error:  # whatever is odd about how its meshes stand
        raise InputError(f"{file}: cannot be read as a mesh: {error!r}") from error
    if np.isfinite(mesh.vertices).all():
        with np.errstate(all="ignore"):  # of lengths that are refused next
            mesh.merge_vertices()
    return mesh
