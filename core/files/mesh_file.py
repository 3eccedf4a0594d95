"""Mesh files, read by trimesh from what the one door for files lets in."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from .reading import check_unpacked, read_bytes

MOST_BYTES = 200_000_000
"""Of a mesh file, and of what a compressed one unpacks to: four million triangles of STL."""
MOST_NUMBERS = 50_000_000
"""In one array that a glTF file claims to have."""
MOST_TRIANGLES = 4_000_000
"""Of all copies of all meshes of a file."""
MOST_EXTENT = 1e4
"""m; nothing near a robot is as long, and squares of lengths beyond would lose all digits."""
MESH_UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 25.4e-3}
"""Metres in one unit of a mesh file."""
_ARCHIVES = {".3mf", ".zae", ".3dxml"}
_COUNT = re.compile(rb'"count"\s*:\s*(\d+)')


def read_scene(file: Path) -> Any:
    """The meshes in a file as a `trimesh.Scene`, nothing cleaned up.

    Raises:
        InputError: it cannot be read as a mesh, is of no known kind, or is larger than the bounds
            of this module.
    """
    import trimesh
    from trimesh.exchange.load import mesh_formats

    kind = file.suffix.lower()
    if kind.removeprefix(".") not in mesh_formats():
        known = ", ".join(f".{one}" for one in sorted(mesh_formats()))
        raise InputError(f"{file}: is no mesh file by its name; known: {known}")
    data = read_bytes(file, MOST_BYTES)
    _check_claims(file, kind, data)
    try:
        with np.errstate(all="ignore"):
            scene = trimesh.load_scene(
                io.BytesIO(data),
                file_type=kind.removeprefix("."),
                resolver=_Beside(file.parent) if kind == ".gltf" else None,
                process=False,
            )
    except InputError:
        raise
    except Exception as error:  # each format's parser raises its own kinds
        raise InputError(
            f"{file}: cannot be read as a mesh: {_told(error)}; export it as STL or PLY"
        ) from error
    _check_copies(file, scene)
    return scene


def check_extent(file: Path | str, vertices: Any) -> None:
    """Refuse corner points (V, 3) m that are no place, or farther apart than anything is.

    Raises:
        InputError: naming the file.
    """
    if not np.isfinite(vertices).all():
        raise InputError(f"{file}: the mesh has corner points that are not finite numbers")
    if np.abs(vertices).max(initial=0.0) > MOST_EXTENT:
        raise InputError(
            f"{file}: the mesh reaches {np.abs(vertices).max():.3g} m from its origin; at most "
            f"{MOST_EXTENT:g} m are taken: check its units, or the file"
        )


class _Beside(Mapping[str, bytes]):
    """Files of a glTF's own folder, read as all others are."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __getitem__(self, name: str) -> bytes:
        if Path(name).name != name:
            raise InputError(f"{self._folder / name}: a mesh takes files of its own folder alone")
        return read_bytes(self._folder / name, MOST_BYTES)

    def get(self, name: str, default: Any = None) -> Any:
        """What trimesh asks by."""
        return self[name]

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


def _check_claims(file: Path, kind: str, data: bytes) -> None:
    """Refuse a small file that would be a large mesh."""
    if kind in _ARCHIVES:
        try:
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                check_unpacked(file, archive.infolist(), MOST_BYTES)
        except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
            raise InputError(
                f"{file}: cannot be read as a mesh: {error}; export it as STL or PLY"
            ) from None
    if kind in (".glb", ".gltf"):
        for found in _COUNT.finditer(data):
            if len(found[1]) > 15 or int(found[1]) > MOST_NUMBERS:
                raise InputError(
                    f"{file}: claims to have an array of {found[1][:20].decode()} numbers; at most "
                    f"{MOST_NUMBERS:,} are read"
                )


def _check_copies(file: Path, scene: Any) -> None:
    count = 0
    for node in scene.graph.nodes_geometry:
        count += len(getattr(scene.geometry[scene.graph[node][1]], "faces", ()))
        if count > MOST_TRIANGLES:
            raise InputError(
                f"{file}: has more than {MOST_TRIANGLES:,} triangles, the most that are read; "
                "make the mesh coarser"
            )


def _told(error: Exception) -> str:
    return f"{type(error).__name__}: {str(error)[:200]}"
