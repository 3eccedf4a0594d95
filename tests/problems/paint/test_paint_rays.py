"""Rays and nearest points against brute force, by both engines."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from flyby.core.arrays import FloatArray
from flyby.core.errors import InputError
from flyby.problems.paint.surface.rays.engine import RayEngine, make_rays
from flyby.validation.surfaces.sheets import saddle

ENGINES = [
    RayEngine.TREE,
    pytest.param(
        RayEngine.EMBREE,
        marks=pytest.mark.skipif(
            importlib.util.find_spec("embreex") is None, reason="embreex is not installed"
        ),
    ),
]


def soup(seed: int, count: int) -> tuple[FloatArray, NDArray[np.int64]]:
    """Random triangles, some of them with shared corners."""
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(2 * count + 1, 3))
    picked = np.array([rng.permutation(2 * count + 1)[:3] for _ in range(count)])
    return vertices, picked


def unit(vectors: FloatArray) -> FloatArray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def crossings(
    vertices: FloatArray,
    faces: NDArray[np.int64],
    origins: FloatArray,
    ways: FloatArray,
    beyond: float = 0.0,
) -> FloatArray:
    """(N, F) lengths at which rays cross the planes of triangles inside them; inf elsewhere.

    Triangles reach ``beyond`` their sides, as a share of their size.

    By Cramer's rule, and so by other arithmetic than the engines'.
    """
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    e, f = b - a, c - a
    s = origins[:, None] - a
    p = np.cross(ways[:, None], f)
    q = np.cross(s, e)
    below = np.einsum("fi,nfi->nf", e, p)
    u = np.einsum("nfi,nfi->nf", s, p) / below
    v = np.einsum("ni,nfi->nf", ways, q) / below
    t = np.einsum("fi,nfi->nf", f, q) / below
    inside = (u >= -beyond) & (v >= -beyond) & (u + v <= 1 + beyond)
    return np.where(inside & (t >= 0), t, np.inf)


def off_sides(
    vertices: FloatArray, faces: NDArray[np.int64], origins: FloatArray, ways: FloatArray
) -> NDArray[np.bool_]:
    """(N,), rays that graze no side so nearly that single precision, as embree's, may miss it."""
    more, less = (
        np.isfinite(crossings(vertices, faces, origins, ways, beyond)) for beyond in (1e-4, -1e-4)
    )
    return np.asarray((more == less).all(axis=1))


@pytest.mark.parametrize("engine", ENGINES)
@given(seed=st.integers(0, 10_000), count=st.integers(1, 60))
@settings(max_examples=25)
def test_first_hits_are_those_of_brute_force(engine: RayEngine, seed: int, count: int) -> None:
    vertices, faces = soup(seed, count)
    rng = np.random.default_rng(seed + 1)
    origins, ways = 2.0 * rng.normal(size=(60, 3)), unit(rng.normal(size=(60, 3)))
    clear = off_sides(vertices, faces, origins, ways)
    origins, ways = origins[clear], ways[clear]
    hits = make_rays(vertices, faces, engine).first(origins, ways)
    true = crossings(vertices, faces, origins, ways)
    distance = true.min(axis=1)
    assert (hits.found == np.isfinite(distance)).all()
    assert hits.distance[hits.found] == pytest.approx(distance[hits.found], abs=1e-9)
    assert (true.argmin(axis=1)[hits.found] == hits.face[hits.found]).all()
    on_ray = origins + np.where(hits.found, hits.distance, 0.0)[:, None] * ways
    assert hits.point[hits.found] == pytest.approx(on_ray[hits.found])
    assert np.isnan(hits.point[~hits.found]).all()


@pytest.mark.parametrize("engine", ENGINES)
@given(seed=st.integers(0, 10_000), count=st.integers(1, 60))
@settings(max_examples=25)
def test_sight_is_blocked_as_by_brute_force(engine: RayEngine, seed: int, count: int) -> None:
    vertices, faces = soup(seed, count)
    rng = np.random.default_rng(seed + 1)
    origins, targets = 2.0 * rng.normal(size=(60, 3)), rng.normal(size=(60, 3))
    length = np.linalg.norm(targets - origins, axis=1)
    nearest = crossings(vertices, faces, origins, unit(targets - origins)).min(axis=1)
    clear = np.abs(nearest - length) > 1e-3
    found = make_rays(vertices, faces, engine).blocked(origins, targets)
    assert (found == (nearest < length))[clear].all()


@given(seed=st.integers(0, 10_000), count=st.integers(1, 60))
@settings(max_examples=25)
def test_nearest_points_are_those_of_brute_force(seed: int, count: int) -> None:
    from trimesh.triangles import closest_point

    vertices, faces = soup(seed, count)
    points = 2.0 * np.random.default_rng(seed + 1).normal(size=(30, 3))
    found = make_rays(vertices, faces, RayEngine.TREE).nearest(points)
    each = closest_point(np.tile(vertices[faces], (30, 1, 1)), np.repeat(points, len(faces), 0))
    true = np.linalg.norm(each.reshape(30, -1, 3) - points[:, None], axis=2).min(axis=1)
    assert found.distance == pytest.approx(true, abs=1e-12)
    assert np.linalg.norm(found.point - points, axis=1) == pytest.approx(found.distance)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=20)
def test_no_ray_slips_through_between_triangles(seed: int) -> None:
    """Rays that aim at inner vertices and at middles of edges, where triangles meet."""
    part = saddle(0.7, 15)
    inner = np.abs(part.vertices[:, :2]).max(axis=1) < 0.499
    middles = 0.5 * (part.vertices[part.faces[:, 0]] + part.vertices[part.faces[:, 1]])
    middles = middles[np.abs(middles[:, :2]).max(axis=1) < 0.499]
    aims = np.concatenate([part.vertices[inner], middles])
    rng = np.random.default_rng(seed)
    origins = aims + np.array([*rng.uniform(-0.5, 0.5, 2), 1.5])
    ways = unit(aims - origins)
    # Rounded aims may miss a corner by 1e-16, and then must meet one of its triangles elsewhere.
    assert part.rays_by(RayEngine.TREE).first(origins, ways).found.all()


def test_a_point_on_the_surface_is_seen_from_above_and_not_from_below() -> None:
    part = saddle(0.7, 15)
    targets = part.vertices[::7]
    for engine in RayEngine:
        if engine is RayEngine.EMBREE and importlib.util.find_spec("embreex") is None:
            continue
        rays = part.rays_by(engine)
        assert not rays.blocked(np.array([[0.0, 0.0, 3.0]]), targets, gap=1e-4).any()
        inner = targets[np.abs(targets[:, :2]).max(axis=1) < 0.4]
        shifted = inner + np.array([0.0, 0.0, 0.01])
        assert rays.blocked(np.array([[0.0, 0.0, -3.0]]), shifted, gap=1e-4).all()


def test_rays_need_triangles() -> None:
    with pytest.raises(InputError, match="no triangles"):
        make_rays(np.zeros((3, 3)), np.empty((0, 3), dtype=np.int64))
