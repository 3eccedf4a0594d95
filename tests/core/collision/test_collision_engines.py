"""Closed forms, coal and fcl against analytic cases, their own witnesses and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.collision.distance.answers import Distances
from flyby.core.collision.distance.closed_form import hulls_of, measure
from flyby.core.collision.distance.coal_engine import CoalEngine
from flyby.core.collision.distance.containment import Nesting
from flyby.core.collision.distance.convex import MOST_NEIGHBOURS, hull
from flyby.core.collision.distance.engine import BodyPoses, Witness
from flyby.core.collision.distance.fcl_engine import FclEngine
from flyby.core.collision.distance.solid import Solid, TriangleMesh, core_radius, extent
from flyby.core.robot.shape import Box, Capsule, Cylinder, Sphere

from .conftest import (
    boxes,
    capsules,
    cylinders,
    places,
    polytopes,
    positions,
    shell,
    spheres,
    surface,
    touching_points,
    u_profile,
)

simple = st.one_of(spheres, capsules, boxes)
convex = st.one_of(spheres, capsules, boxes, cylinders, polytopes())
grown = st.one_of(spheres, capsules)
FEW = settings(max_examples=40)
MANY = settings(max_examples=120)
COARSE = 2e-6
"""m by which the libraries' iterations may miss on curved and faceted shapes."""


def coal_distance(a: Solid, b: Solid, at: BodyPoses, within: float = math.inf) -> Witness | None:
    return CoalEngine([a, b], Nesting([a, b])).distance(0, 1, at, within)


def coal_witness(a: Solid, b: Solid, at: BodyPoses) -> Witness:
    found = coal_distance(a, b, at)
    assert found is not None
    return found


def scene_witness(a: Solid, b: Solid, at: BodyPoses) -> Witness:
    """By a closed form where there is one, else by coal, as scenes do it."""
    found, bound = closed_form(a, b, at)
    return found if math.isinf(bound) else coal_witness(a, b, at)


def fcl_touch(a: Solid, b: Solid, at: BodyPoses) -> bool:
    return FclEngine([a, b], Nesting([a, b])).touch(0, 1, at)


def closed_form(
    a: Solid, b: Solid, at: BodyPoses, within: float = math.inf
) -> tuple[Witness, float]:
    found = Distances.farther(1, 1, within)
    R, p = at.rotation[None], at.translation[None]
    bound = measure(hulls_of([a, b]), np.array([[0, 1]]), R, p, within, found.numbers)
    return found.at(0, 0), float(bound[0, 0])


def rounding(a: Solid, b: Solid, found: Witness) -> float:
    """m by which coal may miss the depth of what lies on the axis of a cylinder."""
    curved = isinstance(a, Cylinder) or isinstance(b, Cylinder)
    return 1e-2 * max(-found.distance, 0.0) if curved else 0.0


def side_by_side(distance: float) -> BodyPoses:
    return BodyPoses(np.array([np.eye(3)] * 2), np.array([[0.0, 0.0, 0.0], [distance, 0.0, 0.0]]))


@pytest.mark.parametrize(
    ("first", "second", "gap"),
    [
        (Sphere(0.1), Sphere(0.2), 0.7),
        (Sphere(0.1), Box((0.4, 0.2, 0.2)), 0.7),
        (Capsule(0.1, 0.5), Box((0.4, 0.2, 0.2)), 0.7),
        (Capsule(0.1, 0.5), Capsule(0.2, 0.3), 0.7),
        (Cylinder(0.1, 0.5), Box((0.4, 0.2, 0.2)), 0.7),
        (Box((0.2, 0.2, 0.2)), Box((0.4, 0.2, 0.2)), 0.7),
    ],
)
@pytest.mark.parametrize("apart", [1.0, 0.35, 0.25])
def test_rows_of_shapes_have_the_distance_on_paper(
    first: Solid, second: Solid, gap: float, apart: float
) -> None:
    expected = apart - (1.0 - gap)
    found = coal_witness(first, second, side_by_side(apart))
    assert found.distance == pytest.approx(expected, abs=1e-9)
    np.testing.assert_allclose(found.normal, [-1.0, 0.0, 0.0], atol=1e-7)
    assert fcl_touch(first, second, side_by_side(apart)) == (expected < 0.0)


@MANY
@given(simple, simple, places())
def test_closed_forms_agree_with_coal(a: Solid, b: Solid, at: BodyPoses) -> None:
    assume(not (isinstance(a, Box) and isinstance(b, Box)))
    ours, theirs = closed_form(a, b, at)[0], coal_witness(a, b, at)
    # Where cores meet exactly, coal is asked 1e-7 m beside.
    crossed = ours.distance <= 1e-9 - core_radius(a) - core_radius(b)
    assert ours.distance == pytest.approx(theirs.distance, abs=2e-7 if crossed else 1e-9)
    step = ours.point_a - ours.point_b
    np.testing.assert_allclose(step, ours.distance * ours.normal, atol=1e-9)
    assert np.linalg.norm(ours.normal) == pytest.approx(1.0, abs=1e-9)


@MANY
@given(convex, convex, places())
def test_the_normal_leads_out_by_the_depth(a: Solid, b: Solid, at: BodyPoses) -> None:
    """Moved along the normal, bodies that overlapped just part; those apart just meet."""
    found = scene_witness(a, b, at)

    def moved(step: float) -> BodyPoses:
        shifted = at.translation.copy()
        shifted[0] += step * found.normal
        return BodyPoses(at.rotation, shifted)

    slack = 1e-4 + rounding(a, b, found)
    assert not fcl_touch(a, b, moved(-found.distance + slack))
    if found.distance < 0.0:
        assert fcl_touch(a, b, moved(-found.distance - slack))
    else:
        # Corner against corner, they may pass each other by.
        assert scene_witness(a, b, moved(-found.distance)).distance < slack


@MANY
@given(convex, convex, places())
def test_contacts_agree_with_the_sign_of_the_distance(a: Solid, b: Solid, at: BodyPoses) -> None:
    distance = scene_witness(a, b, at).distance
    assume(abs(distance) > COARSE)
    assert fcl_touch(a, b, at) == (distance < 0.0)


@FEW
@given(convex, convex, places())
def test_no_point_of_one_body_is_nearer_than_the_distance(
    a: Solid, b: Solid, at: BodyPoses
) -> None:
    found = scene_witness(a, b, at)
    heights = [
        (touching_points(solid) @ R.T + p) @ found.normal
        for solid, R, p in zip((a, b), *at, strict=True)
    ]
    slack = COARSE + rounding(a, b, found)
    assert heights[0].min() >= found.point_a @ found.normal - slack
    assert heights[1].max() <= found.point_b @ found.normal + slack


@FEW
@given(st.one_of(convex), st.one_of(convex), places())
def test_bounds_are_below_the_distance(a: Solid, b: Solid, at: BodyPoses) -> None:
    hulls = [Capsule(0.1, 0.2), a, b]
    shifted = BodyPoses(
        np.concatenate([np.eye(3)[None], at.rotation]),
        np.concatenate([np.full((1, 3), 9.0), at.translation]),
    )
    found = Distances.farther(1, 1, math.inf)
    R, p = shifted.rotation[None], shifted.translation[None]
    bound = measure(hulls_of(hulls), np.array([[1, 2]]), R, p, math.inf, found.numbers)[0, 0]
    if math.isfinite(bound):
        assert bound <= scene_witness(a, b, at).distance + 1e-9
    else:
        assert math.isfinite(found.distance[0, 0])


@FEW
@given(convex, convex, places(), st.floats(0.01, 0.5))
def test_a_range_leaves_near_distances_as_they_are(
    a: Solid, b: Solid, at: BodyPoses, within: float
) -> None:
    whole, near = coal_witness(a, b, at), coal_distance(a, b, at, within)
    assume(abs(whole.distance - within) > COARSE)
    if whole.distance > within:
        assert near is None
    else:
        assert near is not None
        assert near.distance == pytest.approx(whole.distance, abs=COARSE)
    ours, bound = closed_form(a, b, at, within)
    if math.isfinite(bound):
        assert bound < within
    elif whole.distance < within:
        assert ours.distance == pytest.approx(whole.distance, abs=COARSE)
    else:
        assert ours.distance == within


@MANY
@given(spheres, places(), st.sampled_from([0.3, 0.9]))
def test_a_sphere_and_a_mesh_of_a_box_are_as_a_sphere_and_the_box(
    ball: Sphere, at: BodyPoses, size: float
) -> None:
    """Also where the sphere's centre is inside: closed meshes have depths for it."""
    mesh = surface(trimesh.creation.box((size, size, size)))
    solid = closed_form(ball, Box((size, size, size)), at)[0]
    assume(abs(solid.distance + ball.radius) > 1e-6)  # the centre on the surface
    found = coal_witness(ball, mesh, at)
    assert found.measured
    assert found.distance == pytest.approx(solid.distance, abs=1e-7)
    np.testing.assert_allclose(
        found.point_a - found.point_b, found.distance * found.normal, atol=1e-7
    )
    assert fcl_touch(ball, mesh, at) == (found.distance < 0.0) or abs(found.distance) < COARSE


@MANY
@given(grown, places())
def test_depths_in_meshes_are_known_down_to_the_core(body: Solid, at: BodyPoses) -> None:
    """While the core is outside, a capsule in a mesh is as deep as the radius less the gap."""
    mesh = surface(u_profile())
    core = Sphere(1e-6) if isinstance(body, Sphere) else Capsule(1e-6, body.length)  # type: ignore[union-attr]
    gap = coal_witness(core, mesh, at)
    found = coal_witness(body, mesh, at)
    assume(abs(gap.distance) > 1e-5)
    if gap.measured and gap.distance > 0.0:
        assert found.distance == pytest.approx(gap.distance - body.radius, abs=2e-6)  # type: ignore[union-attr]
    else:
        assert found.distance < 0.0
    assert np.isfinite([found.distance, *found.point_a, *found.point_b, *found.normal]).all()
    assert np.linalg.norm(found.normal) == pytest.approx(1.0, abs=1e-6)


@FEW
@given(convex, places())
def test_meshes_and_bodies_touch_for_both_engines(body: Solid, at: BodyPoses) -> None:
    mesh = surface(u_profile())
    found = coal_witness(body, mesh, at)
    assume(abs(found.distance) > COARSE)
    assert fcl_touch(body, mesh, at) == (found.distance < 0.0)
    back = BodyPoses(at.rotation[::-1].copy(), at.translation[::-1].copy())
    swapped = coal_witness(mesh, body, back)
    if found.measured:
        assert swapped.distance == pytest.approx(found.distance, abs=1e-9)
        np.testing.assert_allclose(
            swapped.point_a - swapped.point_b, swapped.distance * swapped.normal, atol=1e-7
        )


@FEW
@given(convex, positions)
def test_a_body_inside_a_closed_mesh_is_no_free_body(body: Solid, offset: np.ndarray) -> None:
    size = 4.0 * extent(body).radius + 1.0
    at = BodyPoses(np.array([np.eye(3)] * 2), np.array([0.2 * offset, np.zeros(3)]))
    solid = surface(trimesh.creation.icosphere(subdivisions=2, radius=size))
    found = coal_witness(body, solid, at)
    assert found.distance < 0.0
    assert fcl_touch(body, solid, at)
    open_one = surface(trimesh.creation.icosphere(subdivisions=2, radius=size), closed=False)
    assert coal_witness(body, open_one, at).distance > 0.0


def test_a_mesh_inside_a_mesh_is_no_free_mesh() -> None:
    small, large = (surface(trimesh.creation.icosphere(radius=r)) for r in (0.1, 1.0))
    at = side_by_side(0.0)
    for first, second in ((small, large), (large, small)):
        found = coal_witness(first, second, at)
        assert found.distance < -0.8
        assert fcl_touch(first, second, at)


@FEW
@given(places())
def test_two_meshes_have_the_distance_of_their_parts(at: BodyPoses) -> None:
    """Two U profiles apart: against the boxes that one of them is made of."""
    mesh = surface(u_profile())
    parts = [
        ((0.6, 0.2, 0.2), (0.0, -0.2)),
        ((0.2, 0.4, 0.2), (-0.2, 0.1)),
        ((0.2, 0.4, 0.2), (0.2, 0.1)),
    ]
    found = coal_witness(mesh, mesh, at)
    R, p = at
    expected = min(
        (
            coal_witness(Box(size), mesh, BodyPoses(R, np.array([p[0] + R[0] @ [x, y, 0.0], p[1]])))
            for size, (x, y) in parts
        ),
        key=lambda witness: witness.distance,
    )
    assert (found.distance > 0.0) == (expected.distance > 0.0)
    assert fcl_touch(mesh, mesh, at) == (found.distance < 0.0)
    if found.distance > 1e-4:
        assert found.distance == pytest.approx(expected.distance, abs=1e-7)
        step = found.point_a - found.point_b
        np.testing.assert_allclose(step, found.distance * found.normal, atol=1e-7)


def test_a_body_in_the_hollow_of_a_shell_is_free() -> None:
    hollow = surface(shell(2.0, 0.1))
    for body in (
        Sphere(0.2),
        Box((0.2, 0.3, 0.4)),
        surface(trimesh.creation.icosphere(radius=0.2)),
    ):
        assert coal_witness(body, hollow, side_by_side(0.0)).distance > 0.5
        assert not fcl_touch(body, hollow, side_by_side(0.0))


@MANY
@given(positions, st.sampled_from(["u", "shell", "ball"]))
def test_points_are_inside_where_winding_numbers_say_so(point: np.ndarray, kind: str) -> None:
    """Against the solid angles of all triangles (van Oosterom and Strackee, 1983)."""
    mesh = {
        "u": u_profile(),
        "shell": shell(1.2, 0.25),
        "ball": trimesh.creation.icosphere(subdivisions=2, radius=0.7),
    }[kind]
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces] - point, 1, 0)
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    triple = np.einsum("fi,fi->f", a, np.cross(b, c))
    dots = [np.einsum("fi,fi->f", x, y) for x, y in ((a, b), (b, c), (c, a))]
    angle = 2.0 * np.arctan2(triple, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb)
    winding = angle.sum() / (4.0 * math.pi)
    assume(abs(winding - round(winding)) < 1e-6)
    assume(abs(mesh.nearest.on_surface(point[None])[1][0]) > 1e-6)
    solid = surface(mesh)
    at = BodyPoses(np.eye(3)[None], np.zeros((1, 3)))
    assert Nesting([solid]).inside(0, point[None], at) == (round(winding) % 2 == 1)


def test_overlapping_parts_are_solid_and_hollows_are_not() -> None:
    """Also where a mesh is turned inside out as a whole, or its triangles are turned anyhow."""
    first, second = trimesh.creation.box((1.0, 1.0, 1.0)), trimesh.creation.box((1.0, 1.0, 1.0))
    second.apply_translation([0.5, 0.0, 0.0])
    pair = trimesh.util.concatenate([first, second])
    inverted = pair.copy()
    inverted.invert()
    at = BodyPoses(np.eye(3)[None], np.zeros((1, 3)))
    for mesh in (pair, inverted):
        nesting = Nesting([surface(mesh)])
        for x, expected in ((-0.3, True), (0.2, True), (0.9, True), (1.1, False), (-0.6, False)):
            assert nesting.inside(0, np.array([[x, 0.1, 0.2]]), at) == expected
    anyhow = first.copy()
    anyhow.faces[::2] = anyhow.faces[::2, ::-1]
    nesting = Nesting([surface(anyhow)])
    assert nesting.inside(0, np.array([[0.1, 0.2, 0.3]]), at)
    assert not nesting.inside(0, np.array([[0.1, 0.2, 0.6]]), at)


def test_rays_along_edges_and_corners_are_counted_right() -> None:
    """Points whose rays would hit corners of a fine grid of a cube's triangles."""
    cube = trimesh.creation.box((1.0, 1.0, 1.0))
    for _ in range(3):
        cube = cube.subdivide()
    solid = surface(cube)
    at = BodyPoses(np.eye(3)[None], np.zeros((1, 3)))
    grid = np.stack(np.meshgrid(*[np.linspace(-0.75, 0.75, 13)] * 3), -1).reshape(-1, 3)
    inside = (np.abs(grid) < 0.5).all(axis=1)
    outside = (np.abs(grid) > 0.5).any(axis=1)
    nesting = Nesting([solid])
    for point in grid[inside]:
        assert nesting.inside(0, point[None], at)
    for point in grid[outside]:
        assert not nesting.inside(0, point[None], at)


def drum(facets: int) -> trimesh.Trimesh:
    """A prism of many facets, whose ends have as many corners."""
    return trimesh.creation.cylinder(0.2, 0.5, sections=facets)


def cone(facets: int) -> trimesh.Trimesh:
    """A tip where as many edges meet."""
    return trimesh.creation.cone(0.2, 0.5, sections=facets)


@pytest.mark.parametrize("facets", [100, 400, 1000])
@pytest.mark.parametrize("make", [drum, cone])
@pytest.mark.parametrize("noise", [0.0, 1e-8])
def test_many_edges_at_one_corner_leave_distances_exact(make, facets, noise) -> None:
    """coal takes 255 neighbours of a corner; a lathe's part has caps and tips of more."""
    rng = np.random.default_rng(facets)
    turn = trimesh.transformations.random_rotation_matrix(rng.random(3))
    points = make(facets).apply_transform(turn).vertices
    solid = hull(points + noise * rng.uniform(-1.0, 1.0, points.shape))
    mesh = TriangleMesh(solid.vertices, solid.faces, closed=True)
    assert np.bincount(solid.faces.ravel()).max() <= MOST_NEIGHBOURS
    ball = Sphere(0.01)
    for _ in range(60):
        way = rng.normal(size=3)
        centre = way / np.linalg.norm(way) * rng.uniform(0.3, 2.0)
        at = BodyPoses(np.array([np.eye(3)] * 2), np.array([np.zeros(3), centre]))
        found = coal_witness(solid, ball, at)
        assert found.distance == pytest.approx(coal_witness(mesh, ball, at).distance, abs=3e-8)
