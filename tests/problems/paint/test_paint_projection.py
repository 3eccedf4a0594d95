"""Pseudo-projection: where points come to lie, and with which direction."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.problems.paint.initial.guide import Guide
from flyby.problems.paint.initial.plan import SweepPlan
from flyby.problems.paint.initial.projection import Projector, SprayFrames, cluster_mean
from flyby.problems.paint.surface.part import Part
from flyby.validation.surfaces.sheets import grid_faces, plate, saddle, scanned

DOWN = np.array([0.0, 0.0, -1.0])


def projector(part: Part, plan: SweepPlan) -> Projector:
    return Projector(Guide(part, plan.holes), plan, DOWN)


def above(x: FloatArray, y: FloatArray, z: float) -> SprayFrames:
    """Frames looking down, with tangents along x."""
    n = len(x)
    point = np.stack([x, y, np.full(n, z)], axis=1)
    return SprayFrames(point, np.tile((1.0, 0.0, 0.0), (n, 1)), np.tile(DOWN, (n, 1)))


def slope(angle: float) -> Part:
    """A metre of plane, rising along y at an angle (rad)."""
    flat = plate(11)
    x, y, _ = flat.vertices.T
    points = np.stack([x, y * math.cos(angle), y * math.sin(angle)], axis=1)
    return Part.of_triangles(points, flat.faces)


@given(angle=st.floats(-1.2, 1.2), height=st.floats(0.6, 2.0), seed=st.integers(0, 999))
@settings(max_examples=40)
def test_points_move_along_the_line_of_projection_onto_the_slope(
    angle: float, height: float, seed: int
) -> None:
    """Inside, near the edge and beyond it alike: the extension of a plane is the plane."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(-0.59, 0.59, 12)
    y = rng.uniform(-0.49, 0.49, 12) * math.cos(angle)
    found = projector(slope(angle), SweepPlan(0.18)).project(above(x, y, height), math.inf)
    assert found.feasible.all()
    assert (found.inside == (np.abs(x) < 0.5)).all()
    expected = np.stack([x, y, y * math.tan(angle)], axis=1)
    assert found.frames.point == pytest.approx(expected, abs=1e-9)
    normal = np.array([0.0, math.sin(angle), -math.cos(angle)])
    assert found.frames.spray == pytest.approx(np.tile(normal, (12, 1)), abs=1e-9)


def test_the_papers_formula_would_miss_by_67_mm() -> None:
    """p + d ñ from 0.5 m above a slope of 30°, against the point below p on that slope."""
    angle, d = math.radians(30.0), 0.5
    p = np.array([[0.0, 0.0, d]])
    found = projector(slope(angle), SweepPlan(0.18)).project(above(p[:, 0], p[:, 1], d))
    assert not found.feasible.any()
    far = projector(slope(angle), SweepPlan(0.18)).project(above(p[:, 0], p[:, 1], d), math.inf)
    literal = p + d * far.frames.spray
    normal = far.frames.spray[0]
    assert abs((literal[0] - far.frames.point[0]) @ normal) == pytest.approx(0.067, abs=1e-3)


@given(overhang=st.floats(0.0, 0.2), beyond=st.floats(0.0, 0.3), side=st.integers(0, 3))
@settings(max_examples=40)
def test_feasible_is_what_hangs_over_by_less_than_allowed(
    overhang: float, beyond: float, side: int
) -> None:
    assume(abs(overhang - beyond) >= 1e-4 and beyond >= 1e-9)
    place = [(0.5 + beyond, 0.1), (-0.5 - beyond, 0.1), (0.1, 0.5 + beyond), (0.1, -0.5 - beyond)]
    x, y = place[side]
    plan = SweepPlan(0.18, overhang=overhang)
    found = projector(plate(21), plan).project(above(np.array([x]), np.array([y]), 0.05))
    assert found.feasible[0] == (beyond < overhang)
    assert not found.inside[0]


@given(seed=st.integers(0, 999), radius=st.floats(0.4, 3.0))
@settings(max_examples=20)
def test_frames_are_orthonormal_and_look_at_the_surface(seed: int, radius: float) -> None:
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(-0.55, 0.55, (2, 20))
    part = saddle(radius, 31)
    found = projector(part, SweepPlan(0.18)).project(above(x, y, 0.0), math.inf)
    t, n = (values[found.feasible] for values in found.frames[1:])
    assert np.linalg.norm(t, axis=1) == pytest.approx(np.ones(len(t)), abs=1e-12)
    assert np.linalg.norm(n, axis=1) == pytest.approx(np.ones(len(n)), abs=1e-12)
    assert np.einsum("ij,ij->i", t, n) == pytest.approx(np.zeros(len(t)), abs=1e-12)
    inner = found.inside & (np.abs(x) < 0.4) & (np.abs(y) < 0.4)
    true = np.stack([x / radius, -y / radius, -np.ones(20)], axis=1)
    true /= np.linalg.norm(true, axis=1, keepdims=True)
    # Normals of a saddle average to the one in the middle.
    assert found.frames.spray[inner] == pytest.approx(true[inner], abs=5e-3)
    z = (x**2 - y**2) / (2 * radius)
    assert found.frames.point[inner, 2] == pytest.approx(z[inner], abs=1e-3)


def test_smoothing_takes_the_noise_of_a_scan_out_of_the_directions() -> None:
    part = scanned(plate(61), 5e-4, 0.0, seed=1)
    x, y = np.random.default_rng(2).uniform(-0.4, 0.4, (2, 200))
    tilt = {}
    for radius in (0.0, 0.06):
        found = projector(part, SweepPlan(0.18, smoothing_radius=radius)).project(above(x, y, 0.0))
        tilt[radius] = np.arccos(-found.frames.spray[:, 2]).mean()
    assert tilt[0.06] < 0.5 * tilt[0.0]


def test_an_outlier_does_not_turn_the_mean() -> None:
    good = np.array([[0.1, 0.0, 1.0], [-0.1, 0.0, 1.0], [0.0, 0.1, 1.0], [0.0, -0.1, 1.0]])
    good /= np.linalg.norm(good, axis=1, keepdims=True)
    wild = np.array([[1.0, 0.0, 0.0]])
    used = np.ones((1, 5), dtype=bool)
    up = np.array([[0.0, 0.0, 1.0]])
    for normals in (np.concatenate([good, wild]), np.concatenate([wild, good])):
        assert cluster_mean(normals[None], used) == pytest.approx(up)
    unused = used.copy()
    unused[0, 1:] = False
    assert cluster_mean(np.concatenate([wild, good])[None], unused) == pytest.approx(wild)


def test_small_holes_are_closed_and_large_ones_are_not() -> None:
    flat = plate(41)
    centres = flat.vertices[flat.faces].mean(axis=1)
    small = np.hypot(centres[:, 0] + 0.2, centres[:, 1]) < 0.06
    large = np.hypot(centres[:, 0] - 0.2, centres[:, 1]) < 0.2
    kept = flat.faces[~(small | large)]
    used, index = np.unique(kept, return_inverse=True)
    part = Part.of_triangles(flat.vertices[used], index.reshape(-1, 3))
    met = Guide(part, 0.15).meet(
        np.array([[-0.2, 0.0, 0.1], [0.2, 0.0, 0.1]]), np.tile(DOWN, (2, 1)), math.inf
    )
    assert met.found.tolist() == [True, False]
    assert met.point[0] == pytest.approx([-0.2, 0.0, 0.0])


@pytest.mark.parametrize("reach", [0.5, math.inf])
def test_edges_are_found_where_they_are(reach: float) -> None:
    guide = Guide(plate(11), 0.1)
    points = np.array([[0.45, 0.1, 0.2], [0.53, 0.1, 0.2]])
    ways = np.tile(np.array([[1.0, 0, 0], [-1.0, 0, 0], [0, 1.0, 0]]), (2, 1, 1))
    lengths = guide.edge_distances(
        points, np.tile(DOWN, (2, 1)), ways, np.array([True, False]), 0.1, reach
    )
    expected = np.array([[0.05, np.inf, np.inf], [np.inf, 0.03, np.inf]])
    assert lengths == pytest.approx(expected, abs=1e-6)


def test_an_under_side_is_not_met() -> None:
    turned = Part.of_triangles(plate(5).vertices, grid_faces(5, 5)[:, ::-1])
    assert not Guide(turned, 0.1).meet(np.zeros((1, 3)), DOWN[None], math.inf).found.any()
