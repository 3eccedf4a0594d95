"""The picture of a cell: what is drawn of it, and where."""

from __future__ import annotations

from dataclasses import replace

import matplotlib
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.geometry import Geometry
from flyby.core.program.zone import Radius
from flyby.core.robot.shape import Box, Capsule, Cylinder, Sphere
from flyby.core.spatial.pose import Pose
from flyby.drawing.cell import VEIL, draw_cell, make_cell_figure
from flyby.drawing.solids import obstacle_triangles, robot_triangles, skeleton, triangles
from flyby.validation.scenes.clutter_layout import thing
from flyby.validation.scenes.scene import Scene, with_zone
from flyby.validation.scenes.stud_welding import stud_welding_with_panel
from flyby.validation.scenes.two_joints import two_joints

SHAPES = [Box((0.3, 0.2, 0.1)), Sphere(0.2), Capsule(0.1, 0.4), Cylinder(0.1, 0.4)]


def inside(shape, points: np.ndarray) -> np.ndarray:
    """How far points (P, 3) m are from the surface of a shape, roughly."""
    match shape:
        case Box(size):
            return np.abs(points / (0.5 * np.array(size))).max(axis=1) - 1
        case Sphere(radius):
            return np.linalg.norm(points, axis=1) - radius
        case Capsule(radius, length):
            axis = np.clip(points[:, 2], -0.5 * length, 0.5 * length)
            return np.linalg.norm(points - axis[:, None] * [0, 0, 1], axis=1) - radius
        case Cylinder(radius, length):
            side = np.linalg.norm(points[:, :2], axis=1) / radius
            return np.maximum(side, np.abs(points[:, 2]) / (0.5 * length)) - 1


@pytest.mark.parametrize("shape", SHAPES)
def test_corners_of_simple_shapes_lie_on_them(shape) -> None:
    corners = triangles(shape).reshape(-1, 3)
    middle = np.abs(corners).max() * 1e-6
    on_axis = np.linalg.norm(corners[:, :2], axis=1) < middle  # middles of a cylinder's ends
    assert np.abs(inside(shape, corners[~on_axis])).max() < 1e-6


@pytest.mark.parametrize("index", range(4))
def test_large_meshes_are_thinned_and_keep_their_size(index: int) -> None:
    mesh = thing(index, 1)
    drawn = triangles(mesh)
    assert len(drawn) < 0.8 * len(mesh.faces)
    spread = np.ptp(drawn.reshape(-1, 3), axis=0)
    np.testing.assert_allclose(
        spread, np.ptp(mesh.vertices, axis=0), atol=np.ptp(mesh.vertices) / 12
    )


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 6))
@settings(max_examples=20, deadline=None)
def test_the_skeleton_ends_at_the_tip(q: tuple[float, ...]) -> None:
    scene = two_joints()
    bones = skeleton(scene.cell.robot, scene.tool.tcp, np.array([q]))[0]
    tip = scene.cell.robot.flange_pose(q) @ scene.tool.tcp
    np.testing.assert_allclose(bones[-1], tip.position, atol=1e-12)
    np.testing.assert_allclose(bones[-2], scene.cell.robot.flange_pose(q).position, atol=1e-12)
    shoulder = (0.32 * np.cos(q[0]), 0.32 * np.sin(q[0]), 0.78)
    np.testing.assert_allclose(bones[2], shoulder, atol=1e-12)


def test_arm_and_obstacles_stand_where_the_cell_says() -> None:
    scene = two_joints()
    solids = obstacle_triangles(scene.cell, np.zeros(6))
    box = solids["box"].reshape(-1, 3)
    np.testing.assert_allclose(box.min(axis=0), (1.5, -0.6, 0.0), atol=1e-12)
    np.testing.assert_allclose(box.max(axis=0), (1.65, 0.6, 0.75), atol=1e-12)
    arm = robot_triangles(scene.cell, scene.tool.name, np.zeros(6)).reshape(-1, 3)
    # At zero the forearm, the wrist and the tool lie along x at the same height.
    assert arm[:, 0].max() == pytest.approx(0.32 + 1.1425 + 0.2 + 0.3 + 0.05, abs=1e-3)
    assert arm[:, 2].max() == pytest.approx(0.78 + 1.075 + 0.2 + 0.2, abs=1e-2)


def runs_of(scene: Scene, index: int = 0) -> list:
    controller, program = scene.controller(), scene.programs[index]
    faster = with_zone(program, Radius(0.1))
    return [("before", controller.run(program)), ("after", controller.run(faster))]


def test_a_flat_scene_has_one_view_and_others_two() -> None:
    flat = two_joints()
    assert len(make_cell_figure(flat.cell, runs_of(flat)).axes) == 2
    station = stud_welding_with_panel()
    assert len(make_cell_figure(station.cell, runs_of(station, 0)).axes) == 3


def test_both_traces_are_drawn_and_named_with_their_times() -> None:
    scene = two_joints()
    runs = runs_of(scene)
    figure = make_cell_figure(scene.cell, runs)
    space, plane = figure.axes
    texts = [text.get_text() for text in space.get_legend().get_texts()]
    assert texts == [f"{label}: {run.duration:.3f} s" for label, run in runs]
    traces = [line for line in plane.get_lines() if line.get_label() in ("before", "after")]
    for line, (label, run) in zip(traces, runs, strict=True):
        assert line.get_label() == label
        np.testing.assert_allclose(line.get_ydata(), 1e3 * run.trajectory.position[:, 2])
    low, high = plane.get_xlim()
    assert low < 1120 < 2200 < high


@pytest.mark.parametrize(("kind", "begin"), [("png", b"\x89PNG"), ("svg", b"<?xml")])
def test_the_picture_is_a_file_of_its_kind(kind: str, begin: bytes) -> None:
    scene = two_joints()
    assert draw_cell(scene.cell, runs_of(scene)[:1], kind).startswith(begin)
    assert matplotlib.rcParams["font.size"] == matplotlib.rcParamsDefault["font.size"]


def test_obstacles_are_named_and_a_fence_in_front_is_a_veil() -> None:
    scene = two_joints()
    fence = replace(
        scene.cell.obstacles[0],
        name="front fence",
        geometry=Geometry(Box((6.0, 0.02, 4.0)), Pose((0.8, -0.8, 1.0))),
    )
    cell = replace(scene.cell, obstacles=(*scene.cell.obstacles, fence))
    figure = make_cell_figure(cell, runs_of(scene))
    space, *planes = figure.axes
    assert {text.get_text() for text in space.texts} == {"box", "front fence"}
    alphas = {round(float(a), 3) for c in space.collections for a in c.get_facecolor()[:, 3]}
    assert alphas == {1.0, 0.3, round(VEIL, 3)}
    # In the plane it is seen through, and what lies behind it has the name.
    assert all("front fence" not in {t.get_text() for t in plane.texts} for plane in planes)
    assert any("box" in {t.get_text() for t in plane.texts} for plane in planes)
    circles = [c for plane in planes for c in plane.collections if len(c.get_edgecolor())]
    assert circles, "zones are drawn"
