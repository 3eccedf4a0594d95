"""What a cell becomes: bodies on their carriers, convex pieces, pairs left out, and refusals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry, Mesh
from flyby.core.collision.distance.convex import hull, is_closed, obstacle_solids, tool_solids
from flyby.core.collision.distance.solid import Polytope, TriangleMesh
from flyby.core.collision.scene.bodies import BodyKind, bodies_of
from flyby.core.collision.scene.frames import WORLD, frame_of_axis
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.convex import split
from flyby.core.convex.decomposition import NotSplitError
from flyby.core.errors import InputError
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.robot.shape import Box, Capsule, LinkShape, Sphere
from flyby.core.spatial.pose import Pose

from .conftest import arm, cell_of, shell, table, track, u_parts, u_profile

GUN, SPINDLE = Tool("gun"), Tool("spindle", robot_held=False)
TOOLS = {"gun": GUN, "spindle": SPINDLE, "bare": Tool("bare")}
SHAPES = {
    "gun": Geometry(Capsule(0.04, 0.2), Pose((0.0, 0.0, 0.1))),
    "spindle": Geometry(Sphere(0.1), Pose((1.0, 0.0, 0.5))),
}
BALL = Geometry(Sphere(0.1), Pose((0.5, 0.5, 0.5)))


def cell(axes=(), **parts) -> Cell:
    return cell_of(arm(axes), tools=TOOLS, tool_geometries=SHAPES, **parts)


def excluded(scene: CollisionScene) -> dict[frozenset[str], str]:
    return {frozenset((e.first, e.second)): e.reason for e in scene.exclusions}


def pairs(scene: CollisionScene) -> set[frozenset[str]]:
    return {frozenset(scene.pair_names(k)) for k in range(len(scene.pairs))}


def test_links_tool_and_obstacles_ride_on_their_carriers() -> None:
    fixture = Obstacle("fixture", BALL, "table")
    scene = CollisionScene(cell([*table(), track()], obstacles=(fixture,)), GUN)
    by_name = {body.name: body for body in scene.bodies}
    assert list(by_name) == [
        "base",
        "J1",
        "J2",
        "J3 (1)",
        "J3 (2)",
        "gun",
        "spindle",
        "fixture",
    ]
    robot = scene.robot
    assert by_name["base"].frame == frame_of_axis(robot, "track")
    assert by_name["gun"].frame == 3 and by_name["gun"].kind is BodyKind.TOOL
    assert by_name["gun"].placement.position == pytest.approx((0.0, 0.0, 0.7))
    assert by_name["spindle"].frame == WORLD
    assert by_name["fixture"].frame == frame_of_axis(robot, "table")
    assert by_name["J3 (2)"].part == "J3"
    assert scene.body_names == tuple(by_name)


def test_a_tool_that_the_robot_does_not_hold_is_left_out() -> None:
    assert "gun" not in CollisionScene(cell(), FLANGE).body_names
    assert "spindle" in CollisionScene(cell(), FLANGE).body_names


def test_every_pair_is_looked_at_or_left_out_with_a_reason() -> None:
    scene = CollisionScene(cell(obstacles=(Obstacle("ball", BALL),)), GUN)
    names = scene.body_names
    everything = {frozenset((a, b)) for a in names for b in names if a < b}
    everything -= {frozenset(("J3 (1)", "J3 (2)"))}
    assert pairs(scene) | set(excluded(scene)) == everything
    assert not pairs(scene) & set(excluded(scene))
    reasons = excluded(scene)
    assert reasons[frozenset(("J1", "J2"))] == "adjacent links"
    assert reasons[frozenset(("J3 (1)", "gun"))] == "they do not move against each other"
    assert reasons[frozenset(("base", "ball"))] == "they do not move against each other"
    assert str(scene.exclusions[0]).endswith(scene.exclusions[0].reason)


def test_links_that_always_overlap_are_left_out() -> None:
    """A long shape of J1 that reaches the elbow's."""
    robot = arm()
    collar = LinkShape(1, Sphere(0.8), Pose((0.0, 0.0, 0.5)))
    knob = LinkShape(3, Sphere(0.3))
    scene = CollisionScene(cell_of(replace(robot, shapes=(collar, knob))))
    (exclusion,) = scene.exclusions
    assert {exclusion.first, exclusion.second} == {"J1", "J3"}
    assert "overlap at all of 512 configurations" in exclusion.reason
    assert len(scene.pairs) == 0


def test_what_surrounds_the_robot_is_never_left_out_silently() -> None:
    pedestal = Obstacle("pedestal", Geometry(Box((0.5, 0.5, 0.7))))
    scene = CollisionScene(cell(obstacles=(pedestal,)), GUN)
    assert frozenset(("J1", "pedestal")) in pairs(scene)
    (note,) = [n for n in scene.notes if "pedestal" in n.message]
    assert "J1 and pedestal overlap wherever the robot stands" in note.message
    assert '[allow] pairs = [["J1", "pedestal"]]' in note.message
    allowed = CollisionScene(cell(obstacles=(pedestal,), allowed=(("J1", "pedestal"),)), GUN)
    assert not any("pedestal" in n.message for n in allowed.notes)
    reason = excluded(allowed)[frozenset(("J1", "pedestal"))]
    assert reason == "allowed by the cell as 'J1', 'pedestal'"


@pytest.mark.parametrize(
    ("allowed", "gone"),
    [
        (("gun", "ball"), {("gun", "ball")}),
        (("ball", "gun"), {("gun", "ball")}),
        (("J3", "ball"), {("J3 (1)", "ball"), ("J3 (2)", "ball")}),
        (("base", "J3"), {("J3 (1)", "base"), ("J3 (2)", "base")}),
        (("table", "gun"), {("fixture", "gun")}),
    ],
)
def test_the_cell_allows_by_name(allowed: tuple[str, str], gone: set[tuple[str, str]]) -> None:
    things = (Obstacle("ball", BALL), Obstacle("fixture", BALL, "table"))
    strict = CollisionScene(cell(table(), obstacles=things), GUN)
    lenient = CollisionScene(cell(table(), obstacles=things, allowed=(allowed,)), GUN)
    assert pairs(strict) - pairs(lenient) == {frozenset(pair) for pair in gone}


def test_a_robot_without_shapes_is_refused() -> None:
    with pytest.raises(InputError, match=r"has no shapes.*add \[\[shape\]\] tables"):
        CollisionScene(cell_of(replace(arm(), shapes=())))


def test_a_tool_that_the_cell_does_not_know_is_refused() -> None:
    with pytest.raises(InputError, match=r"has no tool 'torch'.*'bare', 'gun', 'spindle', 'tool0'"):
        CollisionScene(cell(), Tool("torch"))
    in_file = replace(cell(), file=Path("station.toml"))
    with pytest.raises(InputError, match=r'add \[tool\."TOOL_DATA\[1\]"\]'):
        CollisionScene(in_file, Tool("TOOL_DATA[1]"))
    with pytest.raises(InputError, match=r"station\.toml has no tool 'torch'"):
        CollisionScene(in_file, Tool("torch"))


def test_a_tool_held_elsewhere_is_refused() -> None:
    with pytest.raises(InputError, match="held by the robot in the program but standing"):
        CollisionScene(cell(), Tool("spindle"))


def test_a_tool_without_a_shape_is_noted() -> None:
    (note,) = CollisionScene(cell(), TOOLS["bare"]).notes
    assert "tool 'bare' has no shape in the cell" in note.message
    assert CollisionScene(cell(), FLANGE).notes == ()


def test_a_tool_with_another_tcp_is_noted() -> None:
    moved = Tool("gun", Pose((0.0, 0.0, 0.012)))
    (note,) = CollisionScene(cell(), moved).notes
    assert "tool 'gun' has its TCP 12 mm away from where the cell has it" in note.message


def test_a_convex_mesh_becomes_a_polytope(mesh_file: Callable[..., Mesh]) -> None:
    mesh = mesh_file(trimesh.creation.icosphere(subdivisions=2, radius=0.2))
    ((solid,), notes) = obstacle_solids(mesh)
    assert isinstance(solid, Polytope)
    assert notes == []
    ((tool,), notes) = tool_solids("gun", mesh)
    assert isinstance(tool, Polytope)
    assert notes == []


def test_a_mesh_of_convex_parts_is_taken_apart(mesh_file: Callable[..., Mesh]) -> None:
    parts = [trimesh.creation.box((0.1, 0.2, 0.3)), trimesh.creation.icosphere(radius=0.1)]
    parts[1].apply_translation([0.5, 0.0, 0.0])
    mesh = mesh_file(trimesh.util.concatenate(parts))
    for solids, notes in (obstacle_solids(mesh), tool_solids("gun", mesh)):
        assert [type(solid) for solid in solids] == [Polytope, Polytope]
        assert notes == []
    scene = CollisionScene(cell(obstacles=(Obstacle("rack", Geometry(mesh)),)), GUN)
    assert {"rack (1)", "rack (2)"} <= set(scene.body_names)


def test_a_dented_obstacle_keeps_its_surface(mesh_file: Callable[..., Mesh]) -> None:
    for mesh in (u_profile(), shell(0.5, 0.1)):
        ((solid,), notes) = obstacle_solids(mesh_file(mesh))
        assert isinstance(solid, TriangleMesh)
        assert solid.closed
        assert notes == []


def test_a_dented_tool_is_filled_and_noted(
    mesh_file: Callable[..., Mesh], monkeypatch: pytest.MonkeyPatch
) -> None:
    def not_there(vertices, faces):
        raise NotSplitError("install something")

    monkeypatch.setattr(split, "approximate_parts", not_there)
    ((solid,), notes) = tool_solids("gun", mesh_file(u_profile()))
    assert isinstance(solid, Polytope)
    assert len(solid.vertices) == 8
    (note,) = notes
    # 0.36 - 0.08 of the square's area are there: the hull is 0.36 / 0.28 as large.
    assert "tool 'gun'" in note.message and "28.6 % larger in volume" in note.message
    assert note.message.endswith("has 1.29 times its volume; install something")


def test_a_dented_tool_is_split(
    mesh_file: Callable[..., Mesh], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(split, "approximate_parts", lambda vertices, faces: u_parts())
    solids, notes = tool_solids("gun", mesh_file(u_profile()))
    assert [type(solid) for solid in solids] == [Polytope] * 3
    (note,) = notes
    assert "3 convex parts that enclose it stand for it" in note.message


def test_an_open_mesh_has_no_inside_and_says_so(mesh_file: Callable[..., Mesh]) -> None:
    box = trimesh.creation.box((1.0, 1.0, 1.0))
    lid_off = trimesh.Trimesh(box.vertices, box.faces[2:], process=False)
    ((solid,), notes) = obstacle_solids(mesh_file(lid_off))
    assert isinstance(solid, TriangleMesh)
    assert not solid.closed
    assert any("not watertight" in note.message for note in notes)
    (_, notes) = tool_solids("gun", mesh_file(lid_off, name="tool"))
    assert any("unknown volume" in note.message for note in notes)


def test_a_mesh_in_the_wrong_unit_is_noted(mesh_file: Callable[..., Mesh]) -> None:
    huge = mesh_file(trimesh.creation.box((300.0, 400.0, 500.0)), "m")
    scene = CollisionScene(cell(obstacles=(Obstacle("block", Geometry(huge)),)), GUN)
    told = "in m it is 500 m long; check its units: with units = 'mm' it would be 0.5 m"
    assert any(told in note.message for note in scene.notes)
    assert scene.cell.doubtful_units() == (f"{huge.file}: {told}",)
    tiny = mesh_file(trimesh.creation.box((0.3, 0.4, 1.2)), "mm")
    assert tiny.doubt is not None and "with units = 'm' it would be 1.2 m" in tiny.doubt
    assert mesh_file(trimesh.creation.box((0.3, 0.4, 1.2)), "m").doubt is None


@settings(max_examples=40)
@given(st.integers(0, 10**6), st.integers(4, 40))
def test_hulls_hold_their_points_and_face_outward(seed: int, count: int) -> None:
    points = np.random.default_rng(seed).normal(size=(count, 3))
    solid = hull(points)
    a, b, c = np.moveaxis(solid.vertices[solid.faces], 1, 0)
    normal = np.cross(b - a, c - a)
    height = points @ normal.T - np.einsum("fi,fi->f", a, normal)
    assert height.max() < 1e-9 * np.abs(normal).max()
    assert is_closed(solid.faces)


def test_flat_and_straight_parts_get_a_thickness() -> None:
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    for points in (square, square[:2]):
        solid = hull(points)
        assert np.abs(solid.vertices[:, 2]).max() == pytest.approx(1e-6)


@pytest.mark.parametrize("robot", [arm(), arm([track()])])
def test_bodies_are_named_once(robot) -> None:
    names = [
        body.name for body in bodies_of(cell_of(robot, obstacles=(Obstacle("a", BALL),)), FLANGE)[0]
    ]
    assert len(set(names)) == len(names)


def test_points_that_coincide_have_no_hull() -> None:
    with pytest.raises(InputError, match="no extent"):
        hull(np.ones((3, 3)))
