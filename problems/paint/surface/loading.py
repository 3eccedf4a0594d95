"""Parts from mesh files: read, repaired, their unit doubted, and what is painted found."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ....core.arrays import FloatArray, IntArray
from ....core.door import given
from ....core.errors import InputError, Note
from ....core.files.mesh_file import MESH_UNITS, check_extent, read_scene
from .mesh_repair import find_edges, repair
from .part import Part
from .rays.engine import RayEngine, make_rays
from .region import skin
from .resolution import refined

PLAUSIBLE_SIZE = (0.01, 20.0)
"""m, longest side of what is painted by robots; beyond, the unit is probably wrong."""
_STILL = np.eye(4)
COARSE = 0.05
"""m; thickness is not known between vertices that are farther apart."""


def load_part(
    file: Path | str,
    units: str | None = None,
    view: ArrayLike | None = None,
    longest_edge: float = COARSE,
) -> Part:
    """The part in a mesh file (STL, PLY, OBJ, OFF, GLB, 3MF and what else trimesh reads).

    An open sheet is painted on the side that faces the gun, all of it. Of a closed solid the skin
    is painted that the gun can see (`region.skin`); the rest only stands in the way.

    Args:
        file: the file.
        units: of its numbers, a key of `MESH_UNITS`; None for what the file says, else m.
        view: (3,) direction in which the gun looks at the part. Without it the triangles of open
            sheets face the way the file has them, and of closed solids all of the surface is
            painted.
        longest_edge: m; longer edges are cut.

    Raises:
        InputError: the file cannot be read as a mesh, has no triangles, or is no usable surface;
            or nothing of it is seen.
    """
    file = Path(file)
    mesh = _read(file)
    scale, notes = _scale(file, mesh, units)
    vertices = np.array(mesh.vertices, dtype=float) * scale
    faces = np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
    check_extent(file, vertices)
    return make_part(vertices, faces, file.name, view, longest_edge, _file_normals(mesh), notes)


def make_part(
    vertices: FloatArray,
    faces: IntArray,
    name: str = "part",
    view: ArrayLike | None = None,
    longest_edge: float = COARSE,
    normals: FloatArray | None = None,
    notes: tuple[Note, ...] = (),
) -> Part:
    """The part of any triangles: repaired, cut to size, what is painted found.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        name: for messages.
        view, longest_edge: as in `load_part`.
        normals: (V, 3) of the vertices, if known; see `repair`.
        notes: what is known about the part already.

    Raises:
        InputError: as `repair` and `skin`.
    """
    mended = repair(vertices, faces, name, view, normals)
    vertices, faces, _ = refined(mended.vertices, mended.faces, longest_edge)
    notes = (*notes, *_size_notes(name, vertices), *mended.notes)
    painted = np.ones(len(faces), dtype=bool)
    if view is not None and _is_closed(mended.faces):
        painted = skin(vertices, faces, make_rays(vertices, faces, RayEngine.TREE), view)
        share = 100.0 * _area(vertices, faces[painted]) / _area(vertices, faces)
        notes = (*notes, Note(f"{name}: a closed solid; the gun sees {share:.0f} % of its surface"))
    return Part.of_triangles(vertices, faces, painted, name, notes)


def _read(file: Path) -> Any:
    """The file's triangles as one `trimesh.Trimesh`, as they stand there."""
    import trimesh

    scene = read_scene(file)
    meshes = [one for one in scene.geometry.values() if isinstance(one, trimesh.Trimesh)]
    # One mesh where it stands keeps the normals that its file gives it.
    single = len(meshes) == 1 and np.allclose(scene.graph[scene.graph.nodes_geometry[0]][0], _STILL)
    mesh = meshes[0] if single else scene.to_mesh() if meshes else None
    if mesh is None or len(mesh.faces) == 0:
        raise InputError(f"{file}: there are no triangles in it; export the part as STL or PLY")
    return mesh


def _file_normals(mesh: Any) -> FloatArray:
    """Normals (V, 3) as the file has them; where it has none, those of its triangles."""
    with np.errstate(all="ignore"):
        return np.array(mesh.vertex_normals, dtype=float)


def _scale(file: Path, mesh: Any, units: str | None) -> tuple[float, tuple[Note, ...]]:
    """Metres in one unit of the file, and doubts about it."""
    if units is not None and units not in MESH_UNITS:
        raise InputError(f"{file}: a mesh's units are one of {', '.join(MESH_UNITS)}")
    said = {"millimeter": "mm", "meter": "m", "centimeter": "cm", "inch": "in", "inches": "in"}
    declared = said.get(str(mesh.units).rstrip("s"), said.get(str(mesh.units), mesh.units))
    if units is None and declared in MESH_UNITS:
        return MESH_UNITS[declared], ()
    if units is not None and declared in MESH_UNITS and declared != units:
        note = f"{file.name}: the file says that its unit is {declared}, it is read as {units}"
        return MESH_UNITS[units], (Note(note),)
    return MESH_UNITS[units or "m"], ()


def _size_notes(name: str, vertices: FloatArray) -> tuple[Note, ...]:
    """Whether the part has a size that parts have."""
    size = float(np.ptp(vertices, axis=0).max())
    least, most = PLAUSIBLE_SIZE
    if size > most:
        likely = "mm" if size * 1e-3 > least else "another unit"
        return (
            Note(
                f"{name}: the part is {size:.4g} m long; its numbers are probably {likely}, and "
                f"were taken for m: read it with {given('units', 'mm')} for {size:.4g} mm"
            ),
        )
    if size < least:
        return (
            Note(
                f"{name}: the part is only {1e3 * size:.3g} mm long; its numbers are probably m, "
                "or inches, and were taken for mm: check its units"
            ),
        )
    return ()


def _is_closed(faces: IntArray) -> bool:
    """Whether triangles surround something: no edge has an odd number of them."""
    return bool((find_edges(faces).triangles % 2 == 0).all())


def _area(vertices: FloatArray, faces: IntArray) -> float:
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
