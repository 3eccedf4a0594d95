"""A UR's calibration: its flange is where the calibrated table says, and found again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.errors import InputError
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose
from flyby.vendors.ur.machine_data import with_machine_data

NOMINAL = find_robot("ur/ur10e")
TABLE = np.array(
    [
        (0.0, 0.0, 0.1807, np.pi / 2),
        (0.0, -0.6127, 0.0, 0.0),
        (0.0, -0.57155, 0.0, 0.0),
        (0.0, 0.0, 0.17415, np.pi / 2),
        (0.0, 0.0, 0.11985, -np.pi / 2),
        (0.0, 0.0, 0.11655, 0.0),
    ]
)
"""θ, a, d, α of the type."""
small = st.lists(st.floats(-1.0, 1.0), min_size=24, max_size=24).map(
    lambda values: np.reshape(values, (6, 4)) * (1e-3, 5e-4, 5e-4, 1e-3)
)
angles = st.lists(st.floats(-2.5, 2.5), min_size=6, max_size=6).map(np.array)


def text(deltas: np.ndarray) -> str:
    rows = (
        f"delta_{name} = [ {', '.join(map(repr, map(float, column)))}]"
        for name, column in zip(("theta", "a", "d", "alpha"), deltas.T, strict=True)
    )
    return "\n".join(
        ["[mounting]", *rows, "calibration_status = 2 # 0 == notInitialised", "joint_checksum = []"]
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("calibrations")


def calibrated(folder: Path, deltas: np.ndarray) -> Robot:
    file = folder / "calibration.conf"
    file.write_text(text(deltas))
    return with_machine_data(NOMINAL, file)


def product(q: np.ndarray, deltas: np.ndarray) -> np.ndarray:
    """The flange by a plain product of the table's matrices."""
    T = np.eye(4)
    for own, (theta, a, d, alpha) in zip(q, TABLE + deltas, strict=True):
        c, s, ca, sa = np.cos(own + theta), np.sin(own + theta), np.cos(alpha), np.sin(alpha)
        T = T @ np.array(
            [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        )
    return T


@settings(max_examples=30, deadline=None)
@given(deltas=small, q=angles)
def test_the_flange_is_where_the_calibrated_table_says(folder, deltas, q) -> None:
    found = calibrated(folder, deltas).flange_pose(q).matrix()
    np.testing.assert_allclose(found, product(q, deltas), atol=1e-12)


@settings(max_examples=20, deadline=None)
@given(deltas=small, q=angles)
def test_inverse_kinematics_find_the_joints_again(folder, deltas, q) -> None:
    robot = calibrated(folder, deltas)
    pose = robot.flange_pose(q)
    for found in robot.inverse(pose):
        np.testing.assert_allclose(robot.flange_pose(found.q).matrix(), pose.matrix(), atol=1e-8)
    if min(abs(np.sin(q[2])), abs(np.sin(q[4]))) > 0.1:
        assert min(np.abs(found.q - q).max() for found in robot.inverse(pose)) < 1e-6


def test_an_arm_without_deltas_is_the_nominal_one(folder) -> None:
    robot = calibrated(folder, np.zeros((6, 4)))
    q = np.random.default_rng(1).uniform(-2, 2, (50, 6))
    for one, other in zip(robot.forward(q), NOMINAL.forward(q), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-15)
    assert robot.origins["geometry"].startswith("measured: calibration.conf")


def test_lengths_that_cancel_along_the_parallel_axes(folder) -> None:
    """What a controller has linearised: metres apart from the table, and the same arm."""
    deltas = np.zeros((6, 4))
    deltas[1:4, 2] = 300.0, -420.0, 120.0
    robot = calibrated(folder, deltas)
    q = np.array([0.3, -1.2, 1.4, -0.7, 1.1, 0.4])
    np.testing.assert_allclose(
        robot.flange_pose(q).matrix(), NOMINAL.flange_pose(q).matrix(), atol=1e-12
    )
    assert min(np.abs(found.q - q).max() for found in robot.inverse(robot.flange_pose(q))) < 1e-9


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ("", "delta_theta is missing"),
        ("[mounting]\ndelta_theta = [1, 2]\n", "6 numbers"),
        ("[mounting]\ndelta_theta = [nan, 0, 0, 0, 0, 0]\n", "6 numbers"),
        ("delta_theta\n", "not a calibration.conf"),
    ],
)
def test_what_is_no_calibration_is_refused(tmp_path, wrong: str, said: str) -> None:
    file = tmp_path / "calibration.conf"
    file.write_text(wrong)
    with pytest.raises(InputError, match=said):
        with_machine_data(NOMINAL, file)


def test_the_calibration_of_another_type_is_refused(folder) -> None:
    deltas = np.zeros((6, 4))
    deltas[1, 1] = 0.1
    with pytest.raises(InputError, match="another robot"):
        calibrated(folder, deltas)


def test_a_program_is_driven_by_the_calibrated_arm(tmp_path) -> None:
    """Its lines are straight at the calibrated flange, and its joints are others."""
    deltas = np.zeros((6, 4))
    deltas[:, 0], deltas[1, 1] = 5e-4, 4e-4
    conf, program = tmp_path / "calibration.conf", tmp_path / "p.script"
    conf.write_text(text(deltas))
    program.write_text(
        "def p():\n  movej([0.1,-1.5,1.6,-1.7,-1.5,0.2])\n  movel(p[0.6,-0.3,0.4,0,3.1,0.1])\nend\n"
    )
    read = flyby.read(program, robot="ur/ur10e")
    nominal = flyby.emulate(read).trajectory
    own = flyby.emulate(read, machine_data=conf).trajectory
    target = Pose(tuple(own.position[-1]), tuple(own.quaternion[-1])).matrix()
    np.testing.assert_allclose(product(own.q[-1], deltas), target, atol=1e-6)
    np.testing.assert_allclose(own.position[-1], nominal.position[-1], atol=1e-6)
    assert 1e-4 < np.abs(own.q[-1] - nominal.q[-1]).max() < 5e-3


def test_vendors_without_such_files_say_so(tmp_path) -> None:
    with pytest.raises(InputError, match="no machine data"):
        find_vendor("abb").as_described(find_robot("abb/irb1200-5-090"), tmp_path / "x")


def test_a_program_saved_on_the_robot_states_its_arm(build, tmp_path) -> None:
    rows = TABLE + np.random.default_rng(3).uniform(-1, 1, (6, 4)) * (1e-3, 3e-4, 3e-4, 1e-3)
    path = build.packed(tmp_path / "job.urp", build.program(rows=rows.tolist()))
    robot = with_machine_data(NOMINAL, path)
    q = np.random.default_rng(1).uniform(-2, 2, (20, 6))
    for joints, position in zip(q, robot.forward(q)[1], strict=True):
        np.testing.assert_allclose(position, product(joints, rows - TABLE)[:3, 3], atol=1e-12)
    with pytest.raises(InputError, match="name another robot"):
        with_machine_data(find_robot("ur/ur5e"), path)
    none = build.packed(tmp_path / "none.urp", "<URProgram/>")
    with pytest.raises(InputError, match="states no kinematics"):
        with_machine_data(NOMINAL, none)
