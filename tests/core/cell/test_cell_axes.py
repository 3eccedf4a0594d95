"""External axes along any direction: cell files say them, and are written with them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.cell.cell_text import cell_text
from flyby.core.cell.file import load_cell
from flyby.core.errors import InputError
from flyby.core.registry import find_robot, installed
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint
from flyby.core.spatial.pose import Pose

KR16 = find_robot("kuka/kr16-2")
component = st.floats(-1.0, 1.0)


def written(folder: Path, axis: tuple[float, float, float]) -> Path:
    joint = Joint("E1", Pose((1.0, 0.0, 0.2)), axis, -3.0, 3.0, 1.5, 3.0)
    robot = KR16.with_external_axes([ExternalAxis(joint, ExternalRole.TABLE)])
    file = folder / "cell.toml"
    file.write_text(cell_text(robot, robot.name, {}, {}), "utf-8")
    return file


@given(direction=st.tuples(component, component, component).filter(lambda v: math.hypot(*v) > 0.1))
def test_any_direction_comes_back(tmp_path_factory, direction) -> None:
    length = math.hypot(*direction)
    x, y, z = (part / length for part in direction)
    cell = load_cell(written(tmp_path_factory.mktemp("cell"), (x, y, z)), installed())
    assert cell.robot.external_axes[0].joint.axis == pytest.approx((x, y, z), abs=1e-12)


def test_the_usual_ones_are_named(tmp_path) -> None:
    file = written(tmp_path, (0.0, 1.0, 0.0))
    assert 'axis = "y"' in file.read_text("utf-8")
    assert load_cell(file, installed()).robot.external_axes[0].joint.axis == (0.0, 1.0, 0.0)


@pytest.mark.parametrize("axis", ["[0, 0, 0]", "[1, 0]", '"w"', "[1, 0, true]"])
def test_what_is_no_direction(tmp_path, axis: str) -> None:
    file = written(tmp_path, (0.0, 0.0, 1.0))
    file.write_text(file.read_text("utf-8").replace('axis = "z"', f"axis = {axis}"), "utf-8")
    with pytest.raises(InputError, match="axis"):
        load_cell(file, installed())


TABLE = """
[external_axis.table]
role = "table"
kind = "revolute"
axis = "z"
range_deg = [-90, 90]
speed_deg_s = 90
acceleration_deg_s2 = 180
"""


def test_a_cell_without_a_robot_is_a_positioner(tmp_path: Path) -> None:
    file = tmp_path / "cell.toml"
    file.write_text(f'vendor = "abb"\n{TABLE}')
    robot = load_cell(file, installed()).robot
    assert not robot.has_arm and robot.axis_names[-1] == "table"
    for text, words in ((TABLE, "robot: .*give the vendor"), (f'vendor = "abv"\n{TABLE}', "abb")):
        file.write_text(text)
        with pytest.raises(InputError, match=words):
            load_cell(file, installed())
