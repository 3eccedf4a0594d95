"""The cell file is read whole, and says what is wrong by file and key."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from flyby.core.cell.cell import Cell
from flyby.core.cell.file import load_cell
from flyby.core.cell.geometry import Mesh
from flyby.core.errors import InputError, UnknownNameError
from flyby.core.program.tool import FLANGE, WORLD
from flyby.core.registry import Registry
from flyby.core.robot.joint import ExternalRole, Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.robot.shape import Box, Capsule
from flyby.core.spatial.pose import IDENTITY, Pose
from flyby.core.vendor import Vendor

ARM = Robot(
    "acme/arm-1",
    tuple(
        Joint(f"joint_{i}", Pose((0.0, 0.0, 0.3)), (0.0, 1.0, 0.0), -2.0, 2.0, 1.0, 4.0)
        for i in (1, 2)
    ),
)
REGISTRY = Registry(
    {"acme": Vendor("acme", {"arm-1": lambda: ARM}, lambda: None, lambda robot, q: None)}  # type: ignore[arg-type, return-value]
)
WHOLE = """
robot = "acme/arm-1"
base = { xyz_mm = [0, 0, 500], abc_deg = [90, 0, 0] }
clearance_mm = 5

[tool.gun]
tcp = { xyz_mm = [75, 0, 493.3], quat_wxyz = [0.966, 0, 0.259, 0] }
mesh = "gun.stl"
units = "mm"
pose = { xyz_m = [0, 0, 0.01] }
mass_kg = 12
centre_mm = [0, 0, 200]
inertia_kgm2 = [0.1, 0.1, 0.05]

[tool.spindle]
robot_held = false
tcp = { xyz_mm = [1500, 0, 900], rotvec_rad = [0, 3.141592653589793, 0] }
capsule_mm = [40, 300]

[frame.bench]
pose = { xyz_mm = [1000, 200, 300] }
object = { xyz_mm = [0, 0, 20] }

[frame.part]
moved_by = "table"

[external_axis.table]
role = "table"
kind = "revolute"
axis = "z"
pose = { xyz_mm = [1800, 0, 400] }
range_deg = [-360, 360]
speed_deg_s = 90
acceleration_deg_s2 = 180

[external_axis.track]
role = "track"
kind = "prismatic"
axis = "x"
range_mm = [0, 4000]
speed_mm_s = 1000
acceleration_mm_s2 = 2000

[[obstacle]]
name = "fixture"
mesh = "fixture.stl"
units = "m"
pose = { xyz_mm = [900, 0, 0] }
carried_by = "table"

[[obstacle]]
name = "wall"
box_mm = [100, 3000, 2000]
pose = { xyz_mm = [-1000, 0, 1000] }

[allow]
pairs = [["gun", "fixture"], ["base", "wall"], ["joint_1", "wall"]]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    trimesh.creation.box((100.0, 20.0, 20.0)).export(tmp_path / "gun.stl")
    trimesh.creation.box((0.2, 0.2, 0.2)).export(tmp_path / "fixture.stl")
    return tmp_path


def read(folder: Path, text: str) -> Cell:
    (folder / "cell.toml").write_text(text, "utf-8")
    return load_cell(folder / "cell.toml", REGISTRY)


def test_a_whole_cell_is_read_in_si(folder: Path) -> None:
    cell = read(folder, WHOLE)
    assert cell.vendor == "acme"
    assert cell.file == folder / "cell.toml"
    assert cell.clearance == pytest.approx(0.005)
    assert cell.robot.base.position == pytest.approx((0.0, 0.0, 0.5))
    assert cell.robot.base.quaternion == pytest.approx((math.sqrt(0.5), 0, 0, math.sqrt(0.5)))
    assert cell.allowed == (("gun", "fixture"), ("base", "wall"), ("joint_1", "wall"))


def test_tools_come_with_load_and_shape(folder: Path) -> None:
    cell = read(folder, WHOLE)
    assert set(cell.tools) == {"tool0", "gun", "spindle"}
    gun = cell.tool("gun")
    assert gun.tcp.position == pytest.approx((0.075, 0.0, 0.4933))
    assert np.linalg.norm(gun.tcp.quaternion) == pytest.approx(1.0, abs=1e-12)
    assert gun.load is not None and gun.load.mass == 12
    assert gun.load.centre == pytest.approx((0.0, 0.0, 0.2))
    assert gun.load.inertia == (0.1, 0.1, 0.05)
    shape = cell.tool_geometries["gun"]
    assert isinstance(shape.shape, Mesh)
    assert shape.shape.file == folder / "gun.stl"
    assert np.ptp(shape.shape.vertices, axis=0) == pytest.approx((0.1, 0.02, 0.02))
    assert shape.placement.position == (0.0, 0.0, 0.01)
    spindle = cell.tool("spindle")
    assert not spindle.robot_held
    assert spindle.tcp.quaternion == pytest.approx((0, 0, 1, 0), abs=1e-12)
    assert cell.tool_geometries["spindle"].shape == Capsule(0.04, 0.3)


def test_frames_and_external_axes(folder: Path) -> None:
    cell = read(folder, WHOLE)
    assert cell.frame("bench").pose.position == pytest.approx((1.0, 0.2, 0.32))
    assert cell.frame("part").moved_by == "table"
    table, track = cell.robot.external_axes
    assert (table.name, table.role) == ("table", ExternalRole.TABLE)
    assert table.joint.kind is JointKind.REVOLUTE
    assert (table.joint.lower, table.joint.upper) == pytest.approx((-2 * math.pi, 2 * math.pi))
    assert (table.joint.velocity, table.joint.acceleration) == pytest.approx((math.pi / 2, math.pi))
    assert (track.name, track.role) == ("track", ExternalRole.TRACK)
    assert (track.joint.lower, track.joint.upper) == (0.0, 4.0)
    assert (track.joint.velocity, track.joint.acceleration) == (1.0, 2.0)
    assert track.joint.axis == (1.0, 0.0, 0.0)


def test_obstacles(folder: Path) -> None:
    fixture, wall = read(folder, WHOLE).obstacles
    assert fixture.carried_by == "table"
    assert fixture.geometry.placement.position == pytest.approx((0.9, 0.0, 0.0))
    assert wall.geometry.shape == Box((0.1, 3.0, 2.0))
    assert wall.carried_by is None


def test_the_smallest_cell(folder: Path) -> None:
    cell = read(folder, 'robot = "acme/arm-1"')
    assert cell.robot == ARM
    assert cell.tools == {"tool0": FLANGE}
    assert cell.frames == {"wobj0": WORLD}
    assert cell.clearance == 0.0
    assert cell.obstacles == cell.allowed == ()
    assert cell.check_meshes() == ()


def test_unknown_tools_and_frames_get_suggestions(folder: Path) -> None:
    cell = read(folder, WHOLE)
    with pytest.raises(UnknownNameError, match=r"'gum': did you mean 'gun'"):
        cell.tool("gum")
    with pytest.raises(UnknownNameError, match=r"'bensch': did you mean 'bench'"):
        cell.frame("bensch")


@pytest.mark.parametrize(
    ("old", "new", "key", "message"),
    [
        ('robot = "acme/arm-1"', 'robot = "acme/arm-2"', "robot", "near it are acme/arm-1"),
        ('robot = "acme/arm-1"', "", "robot", "is missing"),
        ('robot = "acme/arm-1"', "robot = 3", "robot", "must be a string"),
        ("clearance_mm = 5", "clearance_mm = -5", "clearance", "zero or more"),
        ("clearance_mm = 5", "clearance = 5", "clearance", "units clearance_mm, clearance_m"),
        ("clearance_mm = 5", "clearance_cm = 5", "clearance_cm", "units clearance_mm"),
        ("clearance_mm = 5", "clearence_mm = 5", "clearence_mm", "mean 'clearance_mm'"),
        ("clearance_mm = 5", 'clearance_mm = "5"', "clearance_mm", "must be a number"),
        ("clearance_mm = 5", "clearance_mm = nan", "clearance_mm", "must be finite"),
        ("clearance_mm = 5", "clearance_mm = true", "clearance_mm", "must be a number"),
        ("xyz_mm = [0, 0, 500]", "xyz_mm = [0, 0]", "base.xyz_mm", "list of 3 numbers"),
        ("xyz_mm = [0, 0, 500]", "xzy_mm = [0, 0, 5]", "base.xzy_mm", "mean 'xyz_mm'"),
        ("abc_deg = [90, 0, 0]", "abc_rad = [1, 0, 0]", "base.abc_rad", "mean 'abc_deg'"),
        (
            "abc_deg = [90, 0, 0]",
            "abc_deg = [90, 0, 0], quat_wxyz = [1, 0, 0, 0]",
            "base.abc_deg",
            "given by quat_wxyz already",
        ),
        ("[0.966, 0, 0.259, 0]", "[0.9, 0, 0.2, 0]", "tool.gun.tcp.quat_wxyz", "length 1"),
        ("gun.stl", "gum.stl", "tool.gun.mesh", "did you mean 'gun.stl'"),
        ("gun.stl", "no/gun.stl", "tool.gun.mesh", "there is no file"),
        ('units = "mm"', "", "tool.gun.units", "is missing"),
        ('units = "mm"', 'units = "furlong"', "tool.gun.units", "'furlong' is unknown"),
        ('units = "mm"', 'units = "mm"\nbox_mm = [1, 1, 1]', "tool.gun.mesh", "'box' already"),
        ("mass_kg = 12", "mass_kg = -12", "tool.gun.mass_kg", "not negative"),
        ("mass_kg = 12", "", "tool.gun.centre_mm", "without mass_kg"),
        ("robot_held = false", "robot_held = 0", "tool.spindle.robot_held", "true or false"),
        ("capsule_mm = [40, 300]", "capsule_mm = [40]", "tool.spindle.capsule_mm", "2 numbers"),
        ("capsule_mm = [40, 300]", "capsule_mm = [0, 3]", "tool.spindle.capsule_mm", "positive"),
        ("capsule_mm = [40, 300]", 'units = "mm"', "tool.spindle.units", "belongs to a mesh"),
        ("[tool.spindle]", "[tool.tool0]", "tool.tool0", "bare flange"),
        ("[frame.bench]", "[frame.wobj0]", "frame.wobj0", "the world"),
        ('moved_by = "table"', 'moved_by = "track"', "frame.part.moved_by", "'track' is a track"),
        ('role = "table"', 'role = "turntable"', "external_axis.table.role", "'table'"),
        ('kind = "revolute"', "", "external_axis.table.kind", "is missing"),
        ('axis = "z"', 'axis = "w"', "external_axis.table.axis", "known: x, y, z"),
        ("range_deg", "range_mm", "external_axis.table.range_mm", "units range_deg"),
        ("[-360, 360]", "[360, -360]", "external_axis.table.range", "must rise"),
        ("speed_deg_s = 90", "speed_deg_s = 0", "external_axis.table.speed", "above zero"),
        ("speed_deg_s = 90", "speed_deg = 90", "external_axis.table.speed_deg", "speed_deg_s"),
        (
            'role = "table"',
            'role = "table"\ncarried_by = "gantry"',
            "external_axis",
            "unknown external axis of acme/arm-1 'gantry'",
        ),
        ('name = "wall"', 'name = "fixture"', "obstacle[2].name", "called 'fixture' already"),
        ('name = "wall"', "", "obstacle[2].name", "is missing"),
        ("box_mm = [100, 3000, 2000]", "", "obstacle[2].mesh", "is missing"),
        ("box_mm = [100, 3000, 2000]", "box_mm = [1, 0, 1]", "obstacle[2].box_mm", "positive"),
        ('carried_by = "table"', 'carried_by = "tabel"', "obstacle[1].carried_by", "mean 'table'"),
        ('["gun", "fixture"]', '["gum", "fixture"]', "allow.pairs", "did you mean 'gun'"),
        ('["gun", "fixture"]', '["gun"]', "allow.pairs", "pairs of names"),
        ("[[obstacle]]", "[[obstacles]]", "obstacles", "mean 'obstacle'"),
    ],
)
def test_an_error_names_file_and_key(
    folder: Path, old: str, new: str, key: str, message: str
) -> None:
    assert old in WHOLE
    with pytest.raises(InputError) as caught:
        read(folder, WHOLE.replace(old, new))
    text = str(caught.value)
    assert text.startswith(f"{folder / 'cell.toml'}: {key}: ")
    assert message in text


@pytest.mark.parametrize("text", ["robot = ", "\x00", "[tool]\n[tool]"])
def test_what_is_no_toml_is_said_so(folder: Path, text: str) -> None:
    with pytest.raises(InputError, match=r"cell\.toml: is not TOML: "):
        read(folder, text)


def test_a_missing_cell_file(folder: Path) -> None:
    with pytest.raises(InputError, match=r"none\.toml: cannot be read"):
        load_cell(folder / "none.toml", REGISTRY)


def write_stl(file: Path, corners: list[list[float]]) -> None:
    lines = ["solid s", "facet normal 0 0 1", "outer loop"]
    lines += [f"vertex {x} {y} {z}" for x, y, z in corners]
    file.write_text("\n".join([*lines, "endloop", "endfacet", "endsolid s", ""]), "utf-8")


def meshes_of(folder: Path) -> Any:
    return read(folder, 'robot = "acme/arm-1"\n[[obstacle]]\nname="m"\nmesh="m.stl"\nunits="mm"')


def test_an_open_mesh_is_noted(folder: Path) -> None:
    write_stl(folder / "m.stl", [[0, 0, 0], [100, 0, 0], [0, 100, 0]])
    (note,) = meshes_of(folder).check_meshes()
    assert "not watertight" in note.message and "m.stl" in note.message


def test_a_mesh_in_the_wrong_unit_is_noted(folder: Path) -> None:
    trimesh.creation.box((0.2, 0.2, 0.2)).export(folder / "m.stl")
    (note,) = meshes_of(folder).check_meshes()
    assert "in mm it is 0.0002 m long" in note.message


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_a_mesh_with_no_number_is_refused(folder: Path, number: float) -> None:
    write_stl(folder / "m.stl", [[0, 0, 0], [100, number, 0], [0, 100, 0]])
    with pytest.raises(InputError, match=r"m\.stl: .*not finite"):
        meshes_of(folder).check_meshes()


@pytest.mark.parametrize("content", ["", "solid s\nendsolid s\n", "no mesh at all"])
def test_a_mesh_without_triangles_is_refused(folder: Path, content: str) -> None:
    (folder / "m.stl").write_text(content, "utf-8")
    with pytest.raises(InputError, match=r"m\.stl: "):
        meshes_of(folder).check_meshes()


def test_meshes_are_read_when_asked_for(folder: Path) -> None:
    (folder / "m.stl").write_text("no mesh at all", "utf-8")
    (obstacle,) = meshes_of(folder).obstacles
    (folder / "m.stl").unlink()
    trimesh.creation.box((100, 100, 100)).export(folder / "m.stl")
    assert isinstance(obstacle.geometry.shape, Mesh)
    assert obstacle.geometry.shape.vertices.shape == (8, 3)
    (folder / "m.stl").unlink()
    assert obstacle.geometry.shape.faces.shape == (12, 3)
    assert obstacle.geometry.placement == IDENTITY
