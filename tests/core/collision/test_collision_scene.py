"""Scenes: distances and gradients of whole cells, external axes, ranges, and what never changes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry, Mesh
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import InputError
from flyby.core.program.tool import Tool
from flyby.core.robot.joint import ExternalAxis
from flyby.core.robot.model import Robot
from flyby.core.robot.shape import Box, Capsule, Cylinder, Sphere
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

from .conftest import arm, cell_of, configurations, table, track, u_profile

GUN = Tool("gun")
GUN_SHAPE = Geometry(Capsule(0.04, 0.2), Pose((0.05, 0.0, 0.1), (0.8, 0.6, 0.0, 0.0)))
FEW = settings(max_examples=40)


def at(x: float, y: float, z: float) -> Pose:
    return Pose((x, y, z), (0.8, 0.36, 0.48, 0.0))


def standing() -> tuple[Obstacle, ...]:
    """Obstacles of every simple shape round the arm."""
    return (
        Obstacle("block", Geometry(Box((0.3, 0.4, 0.5)), at(0.9, 0.3, 0.6))),
        Obstacle("post", Geometry(Cylinder(0.1, 1.0), at(-0.6, 0.7, 0.8))),
        Obstacle("rail", Geometry(Capsule(0.05, 0.8), at(0.2, -0.9, 0.9))),
        Obstacle("ball", Geometry(Sphere(0.15), at(-0.7, -0.5, 1.1))),
    )


def scene_of(robot: Robot, obstacles: tuple[Obstacle, ...] | None = None) -> CollisionScene:
    things = standing() if obstacles is None else obstacles
    cell = cell_of(robot, tools={"gun": GUN}, tool_geometries={"gun": GUN_SHAPE}, obstacles=things)
    return CollisionScene(cell, GUN)


CARRIED = (*standing(), Obstacle("part", Geometry(Box((0.2, 0.3, 0.1)), at(0, 0, 0.1)), "table"))
SCENES = {
    "alone": scene_of(arm()),
    "track": scene_of(arm([track()])),
    "table": scene_of(arm(table()), CARRIED),
    "both": scene_of(arm([*table(), track()]), CARRIED),
}
scenes = st.sampled_from(list(SCENES.values()))


def drawn(scene: CollisionScene, seed: int, count: int = 3) -> FloatArray:
    return configurations(scene.robot, count, seed)


@FEW
@given(scenes, st.integers(0, 10**6))
def test_gradients_are_those_of_the_distances(scene: CollisionScene, seed: int) -> None:
    """Against central differences, where these agree for two steps: distances have kinks."""
    q = drawn(scene, seed, 1)
    found = scene.distances(q)
    pairs = np.arange(len(scene.pairs))
    gradient = scene.gradients(q, found, (np.zeros_like(pairs), pairs))

    def differences(step: float) -> FloatArray:
        moves = np.concatenate([np.eye(scene.robot.size), -np.eye(scene.robot.size)]) * step
        d = scene.distances(q + moves).distance
        ahead, behind = np.split(d, 2)
        return np.asarray((ahead - behind).T / (2.0 * step))

    coarse, fine = differences(2e-5), differences(1e-5)
    smooth = (np.abs(coarse - fine) < 1e-5).all(axis=1)
    # A kink between the samples: forward and backward differences part company.
    one_sided = scene.distances(q + 1e-5 * np.eye(scene.robot.size)).distance - found.distance
    smooth &= (np.abs(one_sided.T / 1e-5 - fine) < 1e-3).all(axis=1)
    assert smooth.mean() > 0.7
    apart = found.distance[0] > 0.0
    np.testing.assert_allclose(gradient[smooth & apart], fine[smooth & apart], atol=1e-4)
    # coal finds depths of curved solids to 1e-6 m, and so their normals to 1e-3 or so.
    np.testing.assert_allclose(gradient[smooth & ~apart], fine[smooth & ~apart], atol=2e-2)


@FEW
@given(scenes, st.integers(0, 10**6))
def test_contacts_are_where_distances_are_negative(scene: CollisionScene, seed: int) -> None:
    q = drawn(scene, seed, 20)
    distance = scene.distances(q).distance.min(axis=1)
    clear = np.abs(distance) > 1e-6
    np.testing.assert_array_equal(scene.collides(q)[clear], distance[clear] < 0.0)
    for row, least in zip(q, distance, strict=True):
        contact = scene.contact(row)
        if abs(least) < 1e-6:
            continue
        assert (contact is None) == (least > 0.0)
        if contact is not None:
            assert contact.depth is not None
            assert contact.depth == pytest.approx(-least, abs=1e-6) or contact.depth <= -least
            assert {contact.first, contact.second} <= set(scene.body_names)
            assert f"{contact.first} and {contact.second} overlap by" in str(contact)


@FEW
@given(scenes, st.integers(0, 10**6), st.floats(0.0, 0.5))
def test_a_range_only_cuts_off(scene: CollisionScene, seed: int, within: float) -> None:
    q = drawn(scene, seed)
    whole, near = scene.distances(q), scene.distances(q, within)
    np.testing.assert_allclose(near.distance, np.minimum(whole.distance, within), atol=1e-7)
    far = near.distance >= within
    assert not near.normal[far].any()
    np.testing.assert_allclose(
        scene.clearance(q, within), np.minimum(whole.distance.min(axis=1), within), atol=1e-7
    )
    np.testing.assert_allclose(scene.clearance(q), whole.distance.min(axis=1), atol=1e-9)


@FEW
@given(scenes, st.integers(0, 10**6), st.floats(0.0, 0.5), st.floats(0.0, 0.5))
def test_a_range_of_costly_pairs_leaves_a_lower_bound(
    scene: CollisionScene, seed: int, within: float, costly: float
) -> None:
    q = drawn(scene, seed)
    near, rough = scene.distances(q, within), scene.distances(q, within, costly)
    assert np.all(rough.distance <= near.distance + 1e-9)
    assert np.all(rough.distance >= np.minimum(near.distance, min(within, costly)) - 1e-9)
    told = rough.normal.any(axis=-1)
    np.testing.assert_array_equal(rough.distance[told], near.distance[told])
    assert np.all(told | (rough.distance >= min(within, costly)))


@FEW
@given(scenes, st.integers(0, 10**6))
def test_witness_points_are_the_distance_apart(scene: CollisionScene, seed: int) -> None:
    found = scene.distances(drawn(scene, seed))
    step = found.distance[..., None] * found.normal
    np.testing.assert_allclose(found.point_a - found.point_b, step, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(found.normal, axis=-1), 1.0, atol=1e-6)


@settings(max_examples=8)
@given(
    st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    st.sampled_from([[], [track()], table()]),
)
def test_moving_the_whole_cell_changes_no_distance(
    offset: tuple[float, float, float],
    turn: tuple[float, float, float],
    axes: list[ExternalAxis],
) -> None:
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(np.array(turn))
    matrix[:3, 3] = offset
    move = Pose.from_matrix(matrix)
    things = CARRIED if any(axis.name == "table" for axis in axes) else standing()
    here = scene_of(arm(axes), things)
    there = scene_of(_moved(arm(axes), move), tuple(_moved_obstacle(o, move) for o in things))
    q = configurations(here.robot, 10)
    np.testing.assert_array_equal(here.pairs, there.pairs)
    a, b = here.distances(q), there.distances(q)
    np.testing.assert_allclose(a.distance, b.distance, atol=1e-6)
    pairs = np.arange(len(here.pairs))
    which = np.zeros_like(pairs), pairs
    smooth = np.linalg.norm(a.point_a[0] @ matrix[:3, :3].T + offset - b.point_a[0], axis=1) < 1e-6
    np.testing.assert_allclose(
        here.gradients(q, a, which)[smooth], there.gradients(q, b, which)[smooth], atol=1e-5
    )


def _moved(robot: Robot, move: Pose) -> Robot:
    """The robot with all that stands on the floor moved."""
    axes = [
        axis
        if axis.carried_by is not None
        else replace(axis, joint=replace(axis.joint, placement=move @ axis.joint.placement))
        for axis in robot.external_axes
    ]
    on_floor = not any(axis.role == "track" for axis in axes)
    moved = robot.with_base(move @ robot.base) if on_floor else robot
    return moved.with_external_axes(axes)


def _moved_obstacle(obstacle: Obstacle, move: Pose) -> Obstacle:
    if obstacle.carried_by is not None:
        return obstacle
    shape, placement = obstacle.geometry.shape, obstacle.geometry.placement
    return replace(obstacle, geometry=Geometry(shape, move @ placement))


def test_a_carried_part_meets_the_arm_and_the_cell() -> None:
    scene = SCENES["table"]
    partners = {
        frozenset(scene.pair_names(k))
        for k in range(len(scene.pairs))
        if "part" in scene.pair_names(k)
    }
    assert frozenset(("gun", "part")) in partners
    assert frozenset(("block", "part")) in partners
    q = np.zeros((2, 5))
    q[1, 3] = 0.7
    before, after = scene.distances(q).distance
    rows = [k for k in range(len(scene.pairs)) if scene.pair_names(k) == ("block", "part")]
    assert before[rows[0]] != pytest.approx(after[rows[0]], abs=1e-3)


def test_distances_to_a_mesh_are_those_to_the_shape(mesh_file: Callable[..., Mesh]) -> None:
    """A box as a mesh file in millimetres, and as a box; convex meshes have depths."""
    box = trimesh.creation.box((300.0, 400.0, 500.0))
    place = at(0.9, 0.3, 0.6)
    as_mesh = (Obstacle("block", Geometry(mesh_file(box, "mm"), place)),)
    meshed, plain = scene_of(arm(), as_mesh), scene_of(arm(), standing()[:1])
    q = configurations(arm(), 200)
    np.testing.assert_allclose(meshed.distances(q).distance, plain.distances(q).distance, atol=2e-6)
    assert (plain.clearance(q) < -0.05).any()


def test_distances_to_a_dented_mesh_are_those_to_its_boxes(mesh_file: Callable[..., Mesh]) -> None:
    """The U profile as one mesh and as three boxes: the same wherever nothing overlaps."""
    place = at(0.9, 0.3, 0.7)
    parts = {"floor": (0.6, 0.2, (0.0, -0.2)), "left": (0.2, 0.4, (-0.2, 0.1))}
    parts["right"] = (0.2, 0.4, (0.2, 0.1))
    boxes = tuple(
        Obstacle(name, Geometry(Box((w, h, 0.2)), place @ Pose((x, y, 0.0))))
        for name, (w, h, (x, y)) in parts.items()
    )
    mesh = (Obstacle("u", Geometry(mesh_file(u_profile()), place)),)
    meshed, boxed = scene_of(arm(), mesh), scene_of(arm(), boxes)
    q = configurations(arm(), 300)
    ours, expected = meshed.clearance(q), boxed.clearance(q)
    free = expected > 0.0
    np.testing.assert_allclose(ours[free], expected[free], atol=2e-6)
    assert (ours[~free] < 0.0).all()
    np.testing.assert_array_equal(meshed.collides(q), boxed.collides(q))
    assert 0.1 < free.mean() < 0.95


def test_an_arm_inside_a_closed_mesh_collides(mesh_file: Callable[..., Mesh]) -> None:
    hall = trimesh.creation.icosphere(subdivisions=2, radius=9.0)
    hall.vertices[0] *= 0.7
    cell = cell_of(arm(), obstacles=(Obstacle("hall", Geometry(mesh_file(hall))),))
    scene = CollisionScene(cell)
    q = np.array([[0.1, 0.2, 0.3]])
    assert scene.collides(q).all()
    assert scene.clearance(q, 0.01)[0] < -4.0
    contact = scene.contact(q[0])
    assert contact is not None and contact.second == "hall"


def test_answers_repeat_and_cannot_be_written_to() -> None:
    scene = SCENES["alone"]
    q = configurations(scene.robot, 4)
    first = scene.distances(q)
    assert scene.distances(q.copy()) is first
    with pytest.raises(ValueError, match="read-only"):
        first.distance[0, 0] = 0.0
    again = scene_of(arm())
    np.testing.assert_array_equal(again.distances(q).distance, first.distance)


def test_many_configurations_are_worked_on_in_parts() -> None:
    scene = SCENES["both"]
    q = configurations(scene.robot, 700)
    one_by_one = np.concatenate([scene.clearance(row[None], 0.3) for row in q])
    np.testing.assert_allclose(scene.clearance(q, 0.3), one_by_one, atol=1e-9)
    hits = scene.collides(q.reshape(7, 100, -1))
    assert hits.shape == (7, 100)
    assert hits.any() and not hits.all()
    np.testing.assert_array_equal(hits.ravel(), [scene.contact(row) is not None for row in q])


def test_no_configuration_gives_no_answer() -> None:
    scene = SCENES["alone"]
    none = np.empty((0, 3))
    assert scene.clearance(none).shape == (0,)
    assert scene.collides(none).shape == (0,)
    assert scene.distances(none).distance.shape == (0, len(scene.pairs))
    assert scene.collides(np.zeros(3)).shape == ()


@pytest.mark.parametrize("shape", [(2,), (1, 4), (), (1, 1, 2)])
def test_configurations_of_another_robot_are_refused(shape: tuple[int, ...]) -> None:
    for ask in (SCENES["alone"].clearance, SCENES["alone"].collides):
        with pytest.raises(InputError, match=r"3 axes \(J1, J2, J3\)"):
            ask(np.zeros(shape))


def test_configurations_that_are_no_numbers_are_refused() -> None:
    with pytest.raises(InputError, match="not finite"):
        SCENES["alone"].clearance(np.array([[0.0, math.nan, 0.0]]))


def test_a_robot_alone_has_distances_of_its_own() -> None:
    scene = CollisionScene(cell_of(arm()))
    folded = np.array([[0.0, 0.0, 3.1]])
    assert scene.clearance(np.zeros((1, 3)))[0] > 0.0
    assert scene.clearance(folded)[0] < scene.clearance(np.zeros((1, 3)))[0]
    assert math.isinf(scene.clearance(np.zeros((1, 3)), math.inf)[0]) is False


def test_an_empty_world_leaves_nothing_to_be_near_to() -> None:
    robot = replace(arm(), shapes=arm().shapes[:1])
    scene = CollisionScene(Cell(robot, "acme"))
    assert len(scene.pairs) == 0
    assert scene.clearance(np.zeros((2, 3)), 0.5).tolist() == [0.5, 0.5]
    assert not scene.collides(np.zeros(3))
    assert scene.contact(np.zeros(3)) is None
