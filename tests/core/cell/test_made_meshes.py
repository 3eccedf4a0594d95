"""Meshes that code has made, beside those that are read from files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from flyby.core.cell.geometry import Mesh, Triangles
from flyby.core.errors import InputError

CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def made(vertices=CORNERS, faces=FACES, units: str = "m") -> Mesh:
    return Mesh(Path("tetrahedron.stl"), units, Triangles(vertices, faces))


def test_its_numbers_are_those_given_in_metres() -> None:
    mesh = made(units="mm")
    np.testing.assert_allclose(mesh.vertices, 1e-3 * CORNERS)
    np.testing.assert_array_equal(mesh.faces, FACES)
    assert not any("watertight" in note.message for note in mesh.notes)


def test_it_is_a_value() -> None:
    assert made() == made() and hash(made()) == hash(made())
    assert made() != made(2 * CORNERS)
    assert made() != made(faces=FACES[::-1])
    with pytest.raises(ValueError, match="read-only"):
        made().vertices[0, 0] = 1.0


def test_later_changes_to_the_arrays_do_not_reach_it() -> None:
    corners = CORNERS.copy()
    mesh = made(corners)
    corners[0] = 9.0
    np.testing.assert_allclose(mesh.vertices, CORNERS)


def test_holes_are_noted_and_nonsense_is_refused() -> None:
    (note,) = made(faces=FACES[1:]).notes
    assert "tetrahedron.stl: the mesh is not watertight" in note.message
    with pytest.raises(InputError, match="has no triangles"):
        _ = made(faces=np.empty((0, 3))).vertices
    with pytest.raises(InputError, match="not finite"):
        _ = made(np.where(CORNERS == 1.0, np.nan, CORNERS)).vertices
