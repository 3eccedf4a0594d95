"""Repair: what it mends, what it tells, and that it does nothing twice."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray, IntArray
from flyby.core.errors import InputError
from flyby.problems.paint.surface.mesh_repair import face_normals, find_edges, repair
from flyby.validation.surfaces.sheets import saddle, wavy


def area(vertices: FloatArray, faces: IntArray) -> float:
    return float(0.5 * np.linalg.norm(face_normals(vertices, faces), axis=1).sum())


def torn(vertices: FloatArray, faces: IntArray, seed: int) -> tuple[FloatArray, IntArray]:
    """The same surface as a bad file has it: corners apart, some turned, repeated or empty."""
    rng = np.random.default_rng(seed)
    points = vertices[faces].reshape(-1, 3)
    new = np.arange(len(points)).reshape(-1, 3)
    turned = rng.random(len(new)) < 0.3
    new[turned] = new[turned][:, ::-1]
    again = new[rng.integers(0, len(new), 5)][:, [1, 2, 0]]
    empty = new[rng.integers(0, len(new), 5)][:, [0, 0, 1]]
    return points, rng.permutation(np.concatenate([new, again, empty]))


@given(seed=st.integers(0, 10_000), closed=st.booleans())
@settings(max_examples=25)
def test_a_torn_surface_becomes_whole_and_stays_so(seed: int, closed: bool) -> None:
    if closed:
        solid = trimesh.creation.icosphere(subdivisions=1)
        vertices, faces = np.array(solid.vertices), np.array(solid.faces)
    else:
        sheet = wavy(0.03, across=7)
        vertices, faces = sheet.vertices, sheet.faces
    once = repair(*torn(vertices, faces, seed), view=(0.0, 0.0, -1.0))
    assert len(once.vertices) == len(vertices)
    assert len(once.faces) == len(faces)
    assert area(once.vertices, once.faces) == pytest.approx(area(vertices, faces), rel=1e-12)
    assert find_edges(once.faces).alike.all()
    across = face_normals(once.vertices, once.faces)
    outward = once.vertices[once.faces].mean(axis=1) if closed else np.array([[0.0, 0.0, 1.0]])
    assert (np.einsum("fi,fi->f", across, np.broadcast_to(outward, across.shape)) > 0).all()
    assert {"repeated", "without area", "turned round"} == {
        word
        for word in ("repeated", "without area", "turned round")
        if any(word in note.message for note in once.notes)
    }
    twice = repair(once.vertices, once.faces, view=(0.0, 0.0, -1.0))
    assert (twice.vertices == once.vertices).all()
    assert (twice.faces == once.faces).all()
    assert not twice.notes


@given(seed=st.integers(0, 10_000), size=st.floats(1e-6, 1e-2))
@settings(max_examples=30)
def test_repair_of_any_triangles_is_idempotent(seed: int, size: float) -> None:
    """Points so near together that merging them brings others together."""
    rng = np.random.default_rng(seed)
    vertices = np.concatenate([rng.random((6, 3)), rng.random((10, 3)) * size * 1e-4])
    faces = np.array([rng.permutation(16)[:3] for _ in range(25)])
    try:
        once = repair(vertices, faces, view=(0.3, 0.2, -1.0))
    except InputError:
        return
    twice = repair(once.vertices, once.faces, view=(0.3, 0.2, -1.0))
    assert (twice.vertices == once.vertices).all()
    assert np.array_equal(twice.faces, once.faces)


def test_an_open_sheet_faces_the_gun_or_what_the_file_says() -> None:
    sheet = saddle(1.0, 5)
    faces = sheet.faces[:, ::-1]
    given_up = repair(sheet.vertices, faces)
    assert (given_up.faces == faces).all()
    by_view = repair(sheet.vertices, faces, view=(0.0, 0.0, -1.0))
    by_file = repair(sheet.vertices, faces, normals=np.array(sheet.normals))
    for turned in (by_view, by_file):
        assert (face_normals(turned.vertices, turned.faces)[:, 2] > 0).all()
    lost = np.array(sheet.normals)
    lost[::2] = np.nan
    mended = repair(sheet.vertices, faces, normals=lost)
    assert (face_normals(mended.vertices, mended.faces)[:, 2] > 0).all()


def moebius(count: int = 24) -> tuple[FloatArray, IntArray]:
    """A strip with half a twist."""
    angle = 2 * np.pi * np.arange(count) / count
    radial = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    across = np.cos(angle / 2)[:, None] * radial + np.sin(angle / 2)[:, None] * np.array(
        [0, 0, 1.0]
    )
    vertices = np.concatenate([radial + 0.2 * across, radial - 0.2 * across])
    faces = []
    for k in range(count):
        a, b = k, k + count
        c, d = (k + 1, k + 1 + count) if k + 1 < count else (count, 0)
        faces += [(a, b, c), (c, b, d)]
    return vertices, np.array(faces)


def test_a_one_sided_strip_is_refused_unless_the_gun_tells_its_side() -> None:
    vertices, faces = moebius()
    with pytest.raises(InputError, match="only one side"):
        repair(vertices, faces)
    turned = repair(vertices, faces, view=(0.0, 0.0, -1.0))
    assert (face_normals(turned.vertices, turned.faces)[:, 2] >= -1e-12).all()
    assert any("only one side" in note.message for note in turned.notes)


def test_edges_of_three_triangles_are_told_with_their_place() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0.1], [0.5, 0, 1.0]])
    faces = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    notes = repair(vertices, faces).notes
    assert any("not manifold: 1 edges" in n.message and "(0.5, 0, 0)" in n.message for n in notes)


@pytest.mark.parametrize(
    ("vertices", "faces", "said"),
    [
        ([[0, 0, 0]], np.empty((0, 3)), "no triangles"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]], "not there"),
        ([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]], "not finite"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]], "no triangle has any area"),
    ],
)
def test_what_is_no_surface_is_refused(vertices: object, faces: object, said: str) -> None:
    with pytest.raises(InputError, match=said):
        repair(np.array(vertices, dtype=float), np.array(faces, dtype=np.int64))
