"""Backups of a YuMi: two arms of seven axes on one body, a task for each."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.core.robot.model import STANDARD_GRAVITY

from .station import Station, yumi

NAMES = ["abb/irb14000-05-056-right", "abb/irb14000-05-056-left"]


def opened(station: Station, folder: Path):
    return flyby.open_backup(station.write(folder))


def test_each_task_has_its_arm_with_its_own_ranges(tmp_path) -> None:
    backup = opened(yumi(), tmp_path)
    assert [one.robot.name for one in backup.robots] == NAMES
    for one in backup.robots:
        assert one.robot.external_axes == () and one.robot.gravity == STANDARD_GRAVITY
        assert one.robot.limits.upper[6] == pytest.approx(math.radians(150))
    assert [(task.name, task.robot) for task in backup.tasks] == [("T_ROB_R", 0), ("T_ROB_L", 1)]
    assert not any("gravity" in note.message for note in backup.notes)


@pytest.mark.parametrize(
    "kinds", [("ROB1_14000_0.5_0.5", "ROB2_14000_0.5_0.5"), ("ROB_R_14000_05_05_X", "ROB_14000")]
)
def test_the_arms_names_tell_them_apart_where_types_do_not(tmp_path, kinds) -> None:
    assert [one.robot.name for one in opened(yumi(kinds), tmp_path).robots] == NAMES


@pytest.mark.parametrize("drives", [(), ("Drive System IRB 14000", "Drive System IRB 120/140")])
def test_without_moc_the_product_has_two_arms(tmp_path, drives: tuple[str, ...]) -> None:
    station = yumi()
    folder = replace(station, products=(*station.products, *drives)).write(tmp_path)
    (folder / "SYSPAR/MOC.cfg").unlink()
    backup = flyby.open_backup(folder)
    assert [one.robot.name for one in backup.robots] == NAMES
    assert [task.robot for task in backup.tasks] == [0, 1]


def test_external_axes_begin_with_eax_b(tmp_path) -> None:
    station = yumi()
    moc = {key: list(value) for key, value in station.moc.items()}
    moc["JOINT"] = ['-name "stn_1" -logical_axis 8']
    moc["ARM"].append('-name "stn_1" -lower_joint_bound -3 -upper_joint_bound 3')
    moc["SINGLE"].append('-name "STN_1" -use_single_type "ROT" -use_joint "stn_1"')
    moc["SINGLE_TYPE"] = ['-name "ROT" -mechanics "FREE_ROT"']
    station.moc = moc
    first, *rest = station.sys["MECHANICAL_UNIT_GROUP"]
    station.sys = {"MECHANICAL_UNIT_GROUP": [f'{first} -MechanicalUnit_2 "STN_1"', *rest]}
    right, left = opened(station, tmp_path).robots
    assert [axis.name for axis in right.robot.external_axes] == ["STN_1"]
    assert left.robot.external_axes == ()


def test_a_direction_of_arm_angles_that_is_stated_is_told(tmp_path) -> None:
    station = yumi()
    robots = [f'{one} -arm_angle_ref_dir "X"' for one in station.moc["ROBOT"]]
    station.moc = {**station.moc, "ROBOT": robots}
    for one in opened(station, tmp_path).robots:
        assert any("arm_angle_ref_dir X, which is not understood" in lack for lack in one.lacks)


def test_both_arms_run_as_a_station(tmp_path) -> None:
    made = flyby.station(yumi().write(tmp_path), no_proof=True)
    right, left = (made.station.members[name] for name in ("T_ROB_R", "T_ROB_L"))
    assert [right.cell.robot.name, left.cell.robot.name] == NAMES
    q, mirrored = (one.run.trajectory.q[-1] for one in (right, left))
    np.testing.assert_allclose(q * [-1, 1, 1, -1, 1, -1, -1], mirrored, atol=1e-6)
    assert made.duration == pytest.approx(right.run.duration, rel=1e-6)
