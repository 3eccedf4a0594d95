"""Parts: normals, areas, what is painted, other resolutions, files."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from flyby.core.arrays import FloatArray
from flyby.core.errors import InputError
from flyby.core.spatial.pose import Pose
from flyby.problems.paint.surface.loading import load_part, make_part
from flyby.problems.paint.surface.mesh_repair import face_normals, find_edges
from flyby.problems.paint.surface.part import Part
from flyby.problems.paint.surface.rays.engine import RayEngine, make_rays
from flyby.problems.paint.surface.region import facing, grown_from, seen_from, within_box
from flyby.problems.paint.surface.resolution import coarsened, refined
from flyby.validation.surfaces import fender as fenders
from flyby.validation.surfaces.fender import fender
from flyby.validation.surfaces.sheets import plate, saddle, scanned, sloped, wavy

DOWN = (0.0, 0.0, -1.0)


def area(vertices: FloatArray, faces: NDArray[np.int64]) -> float:
    return float(0.5 * np.linalg.norm(face_normals(vertices, faces), axis=1).sum())


def of_mesh(mesh: trimesh.Trimesh) -> Part:
    return Part.of_triangles(np.array(mesh.vertices), np.array(mesh.faces))


def any_part(seed: int) -> Part:
    """A sheet of random triangles, partly painted."""
    rng = np.random.default_rng(seed)
    sheet = wavy(rng.uniform(0.0, 0.05), heading=rng.uniform(0, 3), across=int(rng.integers(3, 9)))
    return sheet.with_painted(rng.random(len(sheet.faces)) < 0.7)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=30)
def test_areas_of_painted_vertices_are_those_of_painted_triangles(seed: int) -> None:
    part = any_part(seed)
    triangles = 0.5 * np.linalg.norm(face_normals(part.vertices, part.faces), axis=1)
    assert part.total_area == pytest.approx(triangles.sum(), rel=1e-12)
    assert part.painted_area == pytest.approx(triangles[part.painted_faces].sum(), rel=1e-12)
    assert (part.painted[part.faces].any(axis=1) == part.painted_faces).all()
    assert part.samples.area == pytest.approx(part.painted_area)


def test_normals_of_a_sphere_are_its_radii() -> None:
    part = of_mesh(trimesh.creation.icosphere(subdivisions=4))
    assert part.normals == pytest.approx(part.vertices, abs=4e-3)


def test_sharp_edges_do_not_round_the_normals() -> None:
    part = of_mesh(trimesh.creation.box((1.0, 2.0, 3.0)))
    assert len(part.vertices) == 24
    assert np.sort(np.abs(part.normals), axis=1)[:, 2] == pytest.approx(np.ones(24))


def test_a_pose_carries_normals_and_leaves_areas() -> None:
    part = saddle(0.8, 9)
    turned = part.moved(Pose((1.0, 2.0, 3.0), (0.5, 0.5, 0.5, 0.5)))
    # That quaternion takes x to y, y to z and z to x.
    assert turned.vertices == pytest.approx(part.vertices[:, [2, 0, 1]] + [1.0, 2.0, 3.0])
    assert turned.normals == pytest.approx(part.normals[:, [2, 0, 1]])
    assert (turned.areas == part.areas).all()


def test_a_part_needs_something_to_paint() -> None:
    with pytest.raises(InputError, match="nothing to paint"):
        plate(3).with_painted(np.zeros(8, dtype=bool))


@given(seed=st.integers(0, 10_000), longest=st.floats(0.05, 0.5))
@settings(max_examples=20)
def test_refining_keeps_area_and_leaves_no_vertex_on_a_side(seed: int, longest: float) -> None:
    part = any_part(seed)
    vertices, faces, source = refined(part.vertices, part.faces, longest)
    edges = find_edges(faces)
    length = np.linalg.norm(vertices[edges.ends[:, 0]] - vertices[edges.ends[:, 1]], axis=1)
    assert length.max() <= longest
    assert area(vertices, faces) == pytest.approx(part.total_area, rel=1e-12)
    each = 0.5 * np.linalg.norm(face_normals(vertices, faces), axis=1)
    before = 0.5 * np.linalg.norm(face_normals(part.vertices, part.faces), axis=1)
    assert np.bincount(source, each, len(part.faces)) == pytest.approx(before, rel=1e-9)
    # The rim is as long as before: a vertex on the side of a triangle would add to it.
    assert rim(vertices, faces) == pytest.approx(rim(part.vertices, part.faces), rel=1e-9)
    assert (
        np.einsum(
            "fi,fi->f",
            face_normals(vertices, faces),
            face_normals(part.vertices, part.faces)[source],
        )
        > 0
    ).all()


def rim(vertices: FloatArray, faces: NDArray[np.int64]) -> float:
    edges = find_edges(faces)
    ends = edges.ends[edges.triangles == 1]
    return float(np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1).sum())


@given(seed=st.integers(0, 1000), count=st.integers(1, 300))
@settings(max_examples=20)
def test_coarsening_keeps_both_areas(seed: int, count: int) -> None:
    part = any_part(seed)
    coarse = coarsened(part, count, seed)
    assert coarse.total_area == pytest.approx(part.total_area, rel=1e-12)
    assert coarse.painted_area == pytest.approx(part.painted_area, rel=1e-12)
    assert len(coarse.vertices) <= len(part.vertices)
    if count >= len(part.vertices):
        assert coarse is part


def test_coarse_vertices_stand_for_about_equal_areas() -> None:
    coarse = coarsened(plate(81), 400)
    assert len(coarse.vertices) == 400
    assert coarse.areas.std() < 0.45 * coarse.areas.mean()
    assert coarse.areas.max() < 3.0 * coarse.areas.mean()
    assert area(coarse.vertices, coarse.faces) == pytest.approx(1.0, rel=0.1)
    assert (coarsened(plate(81), 400).vertices == coarse.vertices).all()


def test_the_fender_is_as_specified() -> None:
    part = fender(0.008)
    edges = find_edges(part.faces)
    ends = edges.ends[edges.triangles == 1]
    loops = trimesh.graph.connected_components(ends)
    spans = sorted(float(np.linalg.norm(np.ptp(part.vertices[k], axis=0))) for k in loops)
    assert len(spans) == 7
    assert spans[:4] == pytest.approx([0.016] * 4, rel=0.45)
    assert all(0.09 < span < 0.09 * math.sqrt(2.0) for span in spans[4:6])
    # Pappus: each piece of the section goes round the axle at its own radius.
    s = np.linspace(-fenders._PROFILE, fenders._PROFILE, 20_001)
    width, height = fenders._section(s)
    assert np.hypot(np.diff(width), np.diff(height)) == pytest.approx(np.diff(s), rel=1e-6)
    whole = np.trapezoid(fenders.ARCH_RADIUS + height, s) * fenders.ARCH_ANGLE
    holes = math.pi * (2 * 0.045**2 + 4 * 0.008**2)
    assert part.total_area == pytest.approx(whole - holes, rel=2e-3)
    axle = np.array([0.0, 0.0, -fenders.ARCH_RADIUS])
    assert (np.einsum("vi,vi->v", part.normals, part.vertices - axle) > 0).all()
    other = fender(0.008, seed=1)
    assert len(other.vertices) == pytest.approx(len(part.vertices), rel=0.01)
    assert not np.array_equal(other.vertices[200:300], part.vertices[200:300])


def test_surfaces_have_the_sizes_that_they_should() -> None:
    assert plate(51).total_area == pytest.approx(1.0)
    assert len(plate(201).vertices) >= 40_000
    bend = sloped(101)
    assert bend.total_area == pytest.approx(0.35 + 0.55 * math.radians(60.0), rel=1e-4)
    steep = np.degrees(np.arccos(bend.normals[:, 2]))
    assert steep.max() == pytest.approx(60.0, abs=0.5)
    curved = saddle(0.5, 101)
    at = curved.vertices
    assert at[:, 2] == pytest.approx(at[:, 0] ** 2 - at[:, 1] ** 2)
    assert np.ptp(wavy(0.015, across=101).vertices[:, 2]) == pytest.approx(0.03, rel=1e-2)


def test_a_scan_has_noise_and_gaps() -> None:
    true = plate(31)
    scan = scanned(true, 1e-3, 0.05, seed=3)
    assert scan.vertices[:, 2].std() == pytest.approx(1e-3, rel=0.1)
    assert len(scan.faces) == pytest.approx(0.95 * len(true.faces), rel=0.02)


def test_of_a_closed_sheet_only_the_seen_side_is_painted(tmp_path: Path) -> None:
    solid = trimesh.creation.box((0.6, 0.4, 0.002))
    part = make_part(np.array(solid.vertices), np.array(solid.faces), view=DOWN)
    assert part.painted_area == pytest.approx(0.24)
    assert part.normals[part.painted] == pytest.approx(
        np.tile((0, 0, 1.0), (part.painted.sum(), 1))
    )
    assert part.total_area == pytest.approx(2 * 0.24 + 2 * 0.002 * 1.0)
    assert any("closed solid" in note.message for note in part.notes)
    file = tmp_path / "sheet.stl"
    solid.export(file)
    loaded = load_part(file, "m", DOWN)
    assert loaded.painted_area == pytest.approx(0.24, rel=1e-6)


def test_the_inside_of_a_box_with_a_hole_is_not_seen() -> None:
    outer = trimesh.creation.box((0.6, 0.6, 0.3))
    inner = trimesh.creation.box((0.56, 0.56, 0.26))
    inner.invert()
    both = trimesh.util.concatenate([outer, inner])
    vertices, faces, _ = refined(np.array(both.vertices), np.array(both.faces), 0.1)
    seen = seen_from(vertices, faces, make_rays(vertices, faces, RayEngine.TREE), DOWN)
    centres = vertices[faces].mean(axis=1)
    assert seen[centres[:, 2] > 0.149].all()
    hollow = (np.abs(centres) < [0.29, 0.29, 0.14]).all(axis=1)
    assert hollow.sum() > 100
    assert not seen[hollow].any()
    assert not seen[centres[:, 2] < -0.149].any()


def test_regions_are_selected_and_covered() -> None:
    box = of_mesh(trimesh.creation.box((1.0, 1.0, 1.0)))
    rays = box.rays_by(RayEngine.TREE)
    top = grown_from(box.vertices, box.faces, rays, (0.1, 0.2, 0.6))
    assert (top == facing(box.vertices, box.faces, (0, 0, 2.0), 0.1)).all()
    assert box.with_painted(top).painted_area == pytest.approx(1.0)
    assert box.masked(top).painted_area == pytest.approx(5.0)
    fine = plate(21)
    half = within_box(fine.vertices, fine.faces, (-1, -1, -1), (0, 1, 1))
    assert fine.masked(half).painted_area == pytest.approx(0.5)
    with pytest.raises(InputError, match="holds nothing"):
        within_box(fine.vertices, fine.faces, (0, 0, 1), (1, 1, 0))


@pytest.mark.parametrize(
    ("size", "units", "said"),
    [
        (450.0, "m", "probably mm"),
        (450.0, None, "probably mm"),
        (0.4, "mm", "were taken for mm"),
    ],
)
def test_an_unlikely_unit_is_doubted(
    tmp_path: Path, size: float, units: str | None, said: str
) -> None:
    file = tmp_path / "part.stl"
    trimesh.creation.box((size, size, 0.1 * size)).export(file)
    part = load_part(file, units, DOWN, longest_edge=100.0)
    assert any(said in note.message for note in part.notes)
    good = load_part(file, "mm" if size > 1.0 else "m", DOWN, longest_edge=100.0)
    assert not any("units" in note.message for note in good.notes)


def test_files_that_are_no_parts_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"missing.stl: cannot be read: No such file"):
        load_part(tmp_path / "missing.stl")
    text = tmp_path / "text.stl"
    text.write_text("no mesh at all")
    with pytest.raises(InputError, match=r"text.stl"):
        load_part(text)
    with pytest.raises(InputError, match="one of m, cm, mm, in"):
        file = tmp_path / "part.ply"
        trimesh.creation.box().export(file)
        load_part(file, "furlong")


def test_normals_in_the_file_turn_an_open_sheet(tmp_path: Path) -> None:
    sheet = saddle(1.0, 5)
    mesh = trimesh.Trimesh(
        sheet.vertices, sheet.faces[:, ::-1], vertex_normals=np.array(sheet.normals), process=False
    )
    file = tmp_path / "sheet.ply"
    mesh.export(file, vertex_normal=True)
    assert (load_part(file, "m").normals[:, 2] > 0).all()
    bare = tmp_path / "bare.ply"
    mesh.export(bare, vertex_normal=False)
    assert (load_part(bare, "m").normals[:, 2] < 0).all()
