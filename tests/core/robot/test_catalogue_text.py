"""A robot written as a catalogue file is read back as it was."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.cell.cell_text import cell_text
from flyby.core.cell.file import load_cell
from flyby.core.errors import InputError
from flyby.core.program.tool import Load, Tool, WorkObject
from flyby.core.registry import find_robot, installed
from flyby.core.robot.catalogue import load_robot
from flyby.core.robot.catalogue_text import robot_text
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose
from flyby.testing.strategies import poses, tools, work_objects

NAMES = installed().robot_names
NEAR = 1e-12


def read_back(robot: Robot, folder: Path) -> Robot:
    path = folder / "robot.toml"
    path.write_text(robot_text(robot), "utf-8")
    return load_robot(path)


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(NAMES), st.integers(0, 2**31), st.sampled_from((0.0, 0.33)))
def test_every_arm_comes_back(tmp_path: Path, name: str, seed: int, height: float) -> None:
    robot = replace(find_robot(name), base_height=height)
    again = read_back(robot, tmp_path)
    assert again.name == robot.name
    assert again.payload == robot.payload
    assert again.base_height == height
    assert again.doubts == robot.doubts
    assert again.spread == robot.spread
    assert robot.origins.items() <= again.origins.items()
    for values, others in zip(again.limits, robot.limits, strict=True):
        np.testing.assert_array_equal(values, others)
    q = np.random.default_rng(seed).uniform(robot.limits.lower, robot.limits.upper)
    for one, other in zip(again.forward(q), robot.forward(q), strict=True):
        np.testing.assert_allclose(one, other, atol=NEAR)
    assert again.links == robot.links
    for shape, other in zip(again.shapes, robot.shapes, strict=True):
        assert shape.link == other.link
        np.testing.assert_allclose(shape.shape.size, other.shape.size, rtol=1e-9)
        np.testing.assert_allclose(shape.placement.position, other.placement.position, atol=1e-9)


TRACK = ExternalAxis(
    Joint(
        "eax_a",
        Pose((0.1, 0.2, 0.3)),
        (1.0, 0.0, 0.0),
        *(-1.0, 3.0, 1.0, 2.4),
        kind=JointKind.PRISMATIC,
    ),
    ExternalRole.TRACK,
)
TILT = ExternalAxis(
    Joint("tilt", Pose((2.0, 0.0, 0.5)), (0.0, 1.0, 0.0), -1.5, 1.5, 2.0, 4.0), ExternalRole.TABLE
)
TURN = ExternalAxis(
    Joint("turn", Pose((0.0, 0.0, 0.2)), (0.0, 0.0, 1.0), -math.pi, math.pi, 2.0, 4.0),
    ExternalRole.TABLE,
    carried_by="tilt",
)


def near(one: Pose, other: Pose) -> bool:
    return bool(np.allclose(one.matrix(), other.matrix(), atol=1e-12))


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from([(), (TRACK,), (TILT, TURN), (TRACK, TILT, TURN)]),
    poses(),
    st.dictionaries(st.sampled_from(["gun", "Torch 2", "ü"]), tools()),
    st.dictionaries(st.sampled_from(["table", "fixture.1"]), work_objects()),
)
def test_cells_come_back(
    tmp_path: Path,
    axes: tuple[ExternalAxis, ...],
    base: Pose,
    held: dict[str, Tool],
    frames: dict[str, WorkObject],
) -> None:
    robot = find_robot("abb/irb120").with_base(base).with_external_axes(axes)
    (tmp_path / "robot.toml").write_text(robot_text(robot), "utf-8")
    path = tmp_path / "cell.toml"
    path.write_text(cell_text(robot, "robot.toml", held, frames), "utf-8")
    cell = load_cell(path, installed())
    assert cell.robot.name == robot.name
    assert near(cell.robot.base, base)
    assert [a.name for a in cell.robot.external_axes] == [a.name for a in axes]
    q = np.linspace(-0.1, 0.2, robot.size)
    for one, other in zip(cell.robot.forward(q), robot.forward(q), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)
    for name, tool in held.items():
        assert near(cell.tools[name].tcp, tool.tcp)
        assert cell.tools[name].robot_held == tool.robot_held
        same_load(cell.tools[name].load, tool.load)
    for name, frame in frames.items():
        assert near(cell.frames[name].user @ cell.frames[name].frame, frame.user @ frame.frame)


def same_load(one: Load | None, other: Load | None) -> None:
    assert (one is None) == (other is None)
    if one is not None and other is not None:
        assert one.mass == pytest.approx(other.mass)
        assert one.centre == pytest.approx(other.centre)
        np.testing.assert_allclose(tensor(one), tensor(other), atol=1e-9)


def tensor(load: Load) -> FloatArray:
    axes = Pose(quaternion=load.axes).matrix()[:3, :3]
    return axes @ np.diag(load.inertia) @ axes.T


def test_principal_axes_of_a_load_that_are_turned_come_back(tmp_path: Path) -> None:
    half = math.sqrt(0.5)
    load = Load(157.0, (-0.22, 0.01, 0.3), (5.25, 20.95, 23.19), (half, 0.0, 0.0, -half))
    path = tmp_path / "cell.toml"
    robot = find_robot("ur/ur5e")
    path.write_text(cell_text(robot, robot.name, {"g": Tool("g", load=load)}, {}), "utf-8")
    again = load_cell(path, installed()).tools["g"].load
    same_load(again, load)
    assert again is not None and tensor(again)[0, 0] == pytest.approx(20.95)
    moved = path.read_text("utf-8").replace("{ quat", "{ xyz_m = [0, 0, 1], quat")
    path.write_text(moved, "utf-8")
    with pytest.raises(InputError, match="inertia_axes: has an orientation alone"):
        load_cell(path, installed())


def test_a_robot_that_says_nothing_of_its_origins_is_written_all_the_same(tmp_path: Path) -> None:
    robot = replace(find_robot("ur/ur5e"), origins={})
    assert read_back(robot, tmp_path).origins["geometry"].startswith("unknown")


def test_an_oblique_axis_comes_back(tmp_path: Path) -> None:
    oblique = replace(TILT, joint=replace(TILT.joint, axis=(0.6, 0.8, 0.0)))
    robot = find_robot("ur/ur5e").with_external_axes((oblique,))
    (tmp_path / "robot.toml").write_text(robot_text(robot), "utf-8")
    path = tmp_path / "cell.toml"
    path.write_text(cell_text(robot, "robot.toml", {}, {}), "utf-8")
    (axis,) = load_cell(path, installed()).robot.external_axes
    assert axis.joint.axis == pytest.approx((0.6, 0.8, 0.0))
