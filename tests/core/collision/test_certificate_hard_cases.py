"""Certificates where proofs are hard: meshes, things inside things, singular postures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry, Mesh, Triangles
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.collision.proof.verdict import Certificate, Verdict
from flyby.core.convex import decomposition, split
from flyby.core.convex.decomposition import NotSplitError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Sphere, TouchingLinks
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

from .conftest import u_parts, u_profile

ARM = "abb/irb6640-180-255"
HOME = np.array([0.1, 0.2, 0.3, 0.2, 0.9, 0.1])
TOOL = Tool("probe", Pose((0.0, 0.0, 0.2)))
SPEED = Speed(tcp=1.0)
WRIST = ("base", "J1", "J2", "J3", "J4", "J5", "J6")


def mesh(solid: trimesh.Trimesh, name: str = "part.stl") -> Mesh:
    return Mesh(Path(name), "m", Triangles(np.array(solid.vertices), np.array(solid.faces)))


def cell_with(tool_shape: Geometry, *obstacles: Obstacle, allowed=()) -> Cell:
    own = tuple((joint, "probe") for joint in ("J4", "J5"))
    return Cell(
        find_robot(ARM),
        "abb",
        tools={"probe": TOOL},
        tool_geometries={"probe": tool_shape},
        obstacles=obstacles,
        allowed=(*own, ("J4", "J6"), *allowed),
    )


def driven(cell: Cell, *moves, start=HOME) -> tuple[Controller, Run]:
    controller = Controller(find_vendor("abb"), cell.robot, MotionModel())
    program = Program(moves, start=JointTarget(tuple(map(float, start))))
    return controller, controller.run(program)


def check(cell: Cell, clearance: float, *moves, start=HOME, **options) -> tuple[Run, Certificate]:
    controller, run = driven(cell, *moves, start=start)
    return run, certify(controller, run, scenes_of(cell), clearance, **options)


def turn(*changes: float) -> MoveJ:
    q = HOME + np.array([*changes, *[0.0] * (6 - len(changes))])
    return MoveJ(JointTarget(tuple(map(float, q))), SPEED, tool=TOOL)


def tip(q=HOME) -> np.ndarray:
    return np.array((find_robot(ARM).flange_pose(np.asarray(q)) @ TOOL.tcp).position)


POINT = Geometry(Sphere(0.02), Pose((0.0, 0.0, 0.2)))


# Meshes


def bent() -> trimesh.Trimesh:
    """A tool of two boxes: a stem, and a finger across its end."""
    stem, finger = trimesh.creation.box((0.04, 0.04, 0.2)), trimesh.creation.box((0.16, 0.05, 0.03))
    stem.apply_translation([0.0, 0.0, 0.1])
    finger.apply_translation([0.06, 0.0, 0.22])
    return trimesh.util.concatenate([stem, finger])


@settings(max_examples=10)
@given(
    st.tuples(*[st.floats(-0.3, 0.3)] * 3).map(np.array),
    st.tuples(*[st.floats(-1.5, 1.5)] * 3).map(np.array),
    st.tuples(*[st.floats(-0.35, 0.35)] * 3),
    st.booleans(),
)
def test_meshes_are_proven_as_tightly_as_simple_shapes(step, angles, change, hollow) -> None:
    assume(max(map(abs, change)) > 1e-3)
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(angles)
    matrix[:3, 3] = tip() + 2.0 * step
    solid = u_profile() if hollow else trimesh.creation.icosphere(2, 0.2)
    thing = Obstacle("thing", Geometry(mesh(solid), Pose.from_matrix(matrix)))
    cell = cell_with(Geometry(mesh(bent(), "gun.stl")), thing)
    controller, run = driven(cell, turn(*change))
    scene = scenes_of(cell)(TOOL)
    q = np.linspace(run.path.q[0], run.path.q[-1], 400)
    least = float(scene.clearance(q, 0.3).min())
    assume(0.002 < least < 0.29)
    found = certify(controller, run, scenes_of(cell), 0.001, resolution=1e-4)
    assert found.proven, found.message
    assert least - 3e-4 <= found.clearance <= least + 1e-7
    found = certify(controller, run, scenes_of(cell), least + 1e-3)
    assert found.verdict is Verdict.VIOLATED and found.distance < least + 1e-3


@pytest.mark.parametrize("parts", ["whole", "three", "coarse", "coacd"])
def test_what_is_in_the_gap_of_a_tool_is_clear_where_it_is_split(
    parts: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A ball between the arms of a C-shaped gun, 30 mm from either."""

    def made(vertices, faces):
        if parts == "whole":
            raise NotSplitError("not there")
        grown = 1.0 if parts == "three" else 0.9
        return [0.5 * (part.mean(axis=0) + grown * (part - part.mean(0))) for part in u_parts()]

    if parts == "coacd":
        pytest.importorskip("coacd")
        monkeypatch.setattr(decomposition, "cache_folder", lambda: tmp_path)
    else:
        monkeypatch.setattr(split, "approximate_parts", made)
    gun = u_profile()
    gun.apply_scale(0.5)
    place = Pose((0.0, 0.0, 0.4))
    at = find_robot(ARM).flange_pose(HOME) @ place @ Pose((0.0, 0.05, 0.0))
    ball = Obstacle("ball", Geometry(Sphere(0.02), Pose(at.position)))
    cell = cell_with(Geometry(mesh(gun, "gun.stl"), place), ball)
    run, found = check(cell, 0.01, turn(0.005), resolution=1e-4)
    if parts == "whole":
        assert found.verdict is Verdict.VIOLATED
        return
    assert found.proven, found.message
    # The parts enclose the gun, so no more is proven than there is.
    surface = trimesh.Trimesh(gun.vertices, gun.faces)
    frames = [cell.robot.flange_pose(q) @ place for q in run.path.q]
    centres = [frame.inverse() @ Pose(at.position) for frame in frames]
    _, gaps, _ = trimesh.proximity.closest_point(surface, [c.position for c in centres])
    assert 0.01 < found.clearance <= gaps.min() - 0.02 + 1e-6


def test_what_a_proof_takes_for_granted_of_the_arm_is_said() -> None:
    cell = cell_with(POINT)
    _, found = check(cell, 0.0, turn(0.01))
    assert found.proven
    assumed = cell.robot.origins["shape"].startswith("assumed")
    assert ("(shape assumed)" in found.message) is assumed
    pair = TouchingLinks(1, 3, "arm.srdf", "Never")
    origins = {**cell.robot.origins, "shape": "published: x" if assumed else "assumed: x"}
    robot = replace(cell.robot, may_touch=(pair,), origins=origins)
    _, found = check(replace(cell, robot=robot), 0.0, turn(0.01))
    assert found.proven
    assert ("(shape assumed)" in found.message) is not assumed
    assert "(pairs allowed to touch by arm.srdf)" in found.message


def deep_block() -> Obstacle:
    """A closed mesh that is not convex, round the probe's tip."""
    solid = u_profile()
    solid.apply_scale(3.0)
    # Into the middle of the profile's floor, 0.6 m thick.
    solid.apply_translation([0.0, 0.6, 0.0])
    return Obstacle("block", Geometry(mesh(solid, "block.stl"), Pose(tuple(map(float, tip())))))


def test_a_start_inside_a_mesh_is_refused() -> None:
    allowed = tuple((name, "block") for name in WRIST)
    cell = cell_with(POINT, deep_block(), allowed=allowed)
    _, found = check(cell, 0.0, turn(0.01))
    assert found.verdict is Verdict.VIOLATED
    assert set(found.pair) == {"probe", "block"} and found.sigma[0] == 0.0
    assert found.distance < -0.1 and "overlap by" in found.message


def test_the_same_mesh_is_no_hindrance_beside_the_way() -> None:
    block = deep_block()
    x, y, z = block.geometry.placement.position
    away = Obstacle("block", Geometry(block.geometry.shape, Pose((x, y + 3.0, z))))
    assert check(cell_with(POINT, away), 0.0, turn(0.01))[1].proven


# Singular postures

STRAIGHT = np.array([0.0, 0.2, 0.3, 0.0, 0.0, 0.0])


def through_the_wrist(offset: float) -> tuple[MoveJ, MoveL]:
    """A line on which axis 5 turns from one side of zero to the other, ``offset`` rad beside."""
    straight = find_robot(ARM).flange_pose(STRAIGHT) @ TOOL.tcp

    def leaning(side: float) -> PoseTarget:
        matrix = straight.matrix()
        lean = matrix_from_rotation_vector([0.0, offset, side * 0.31])
        matrix[:3, :3] = lean @ matrix[:3, :3]
        matrix[:3, 3] += [0.0, side * 0.17, 0.0]
        return PoseTarget(Pose.from_matrix(matrix))

    # Ends that differ, so that the middle of the line is not the singular place.
    return MoveJ(leaning(0.9), SPEED, tool=TOOL), MoveL(leaning(-1.0), SPEED, tool=TOOL)


def test_a_singular_stretch_is_unproven_and_named() -> None:
    cell = cell_with(POINT)
    begin = np.array([0.0, 0.2, 0.3, 0.1, 0.5, 0.1])
    run, found = check(cell, 0.001, *through_the_wrist(0.0), start=begin)
    assert found.verdict is Verdict.UNPROVEN
    assert found.move == 1 and found.pair is None
    assert "singular" in found.message and found.message.startswith("move 2, at ")
    # No more than the place itself.
    assert found.sigma[1] - found.sigma[0] < 1e-3 * run.path.sigma[-1]
    nearest = np.argmin(run.path.conditioning)
    # The least since the sample before is the conditioning of a sample.
    before, behind = run.path.sigma[[nearest - 1, nearest]]
    assert before - 0.02 < found.sigma[0] < behind + 0.02


def test_beside_a_singular_posture_the_proof_goes_through() -> None:
    cell = cell_with(POINT)
    begin = np.array([0.0, 0.2, 0.3, 0.1, 0.5, 0.1])
    run, found = check(cell, 0.001, *through_the_wrist(0.05), start=begin, resolution=1e-4)
    assert found.proven, found.message
    least = scenes_of(cell)(TOOL).clearance(run.path.q).min()
    assert least - 1e-3 <= found.clearance <= least + 1e-7
