"""``flyby fk`` and ``flyby ik``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner, Result

from flyby.cli.main import app
from flyby.core.registry import find_robot

ROBOT = "abb/irb6640-180-255"
angles = st.floats(-1.0, 1.0)


def degrees(q: Sequence[float]) -> str:
    return ",".join(f"{value:.12f}" for value in np.degrees(q))


def run(*words: str) -> Result:
    return CliRunner().invoke(app, list(words))


def test_robots_of_files(tmp_path: Path) -> None:
    """As wherever a robot is named: here a URDF, whose driver is said beside it."""
    turns = [(i, axis) for i, axis in enumerate(("0 0 1", "0 1 0", "0 1 0", "1 0 0"), 1)]
    turns += [(5, "0 1 0"), (6, "1 0 0")]
    text = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="revolute"><parent link="l{i - 1}"/>'
        f'<child link="l{i}"/><origin xyz="{0.1 * (i > 3)} 0 0.2"/><axis xyz="{axis}"/>'
        '<limit lower="-3" upper="3" velocity="3" effort="9"/></joint>'
        for i, axis in turns
    )
    path = tmp_path / "arm.urdf"
    path.write_text(f'<robot name="arm"><link name="l0"/>{text}</robot>', "utf-8")
    found = run("fk", str(path), "0,0,0,0,0,0", "--vendor", "abb", "--json")
    assert found.exit_code == 0, found.output
    assert json.loads(found.stdout)["position_m"] == pytest.approx([0.3, 0.0, 1.2])
    assert "--vendor" in run("fk", str(path), "0,0,0,0,0,0").output


@settings(max_examples=25, deadline=None)
@given(st.tuples(angles, angles, angles, angles, angles, angles))
def test_fk_of_every_ik_solution_is_the_pose(shares: tuple[float, ...]) -> None:
    limits = find_robot(ROBOT).limits
    middle, half = 0.5 * (limits.upper + limits.lower), 0.5 * (limits.upper - limits.lower)
    q = middle + 0.95 * np.array(shares) * half
    pose = json.loads(run("fk", ROBOT, degrees(q), "--json").stdout)
    numbers = [1e3 * value for value in pose["position_m"]] + pose["quaternion_wxyz"]
    text = ",".join(f"{value:.15g}" for value in numbers)
    found = json.loads(run("ik", ROBOT, text, "--json").stdout)["solutions"]
    assert found
    for solution in found:
        again = json.loads(run("fk", ROBOT, degrees(solution["joints_rad"]), "--json").stdout)
        assert again["position_m"] == pytest.approx(pose["position_m"], abs=1e-7)
        alike = np.dot(again["quaternion_wxyz"], pose["quaternion_wxyz"])
        assert abs(alike) == pytest.approx(1.0, abs=1e-9)


def test_fk_prints_mm_and_degrees() -> None:
    result = run("fk", ROBOT, "0,0,0,0,0,0")
    assert result.exit_code == 0
    assert "position    1662.500, 0.000, 2055.000 mm" in result.stdout
    assert "rx, ry, rz  0.0000°, 90.0000°, 0.0000°" in result.stdout
    assert "cf1=0 cf4=0 cf6=0 cfx=0" in result.stdout


def test_a_tool_moves_the_tcp_in_the_flange() -> None:
    bare = json.loads(run("fk", ROBOT, "0,0,0,0,0,0", "--json").stdout)
    held = json.loads(run("fk", ROBOT, "0,0,0,0,0,0", "--tool", "0,0,100", "--json").stdout)
    assert np.subtract(held["position_m"], bare["position_m"]) == pytest.approx([0.1, 0, 0])


def test_ik_takes_turns_for_the_orientation_and_the_tool_off() -> None:
    turned = run("ik", ROBOT, "1500,100,800,180,0,180", "--tool", "0,0,100", "--json")
    quaternion = run("ik", ROBOT, "1500,100,900,0,0,1,0", "--json")
    a, b = (json.loads(result.stdout)["solutions"] for result in (turned, quaternion))
    assert [s["configuration"] for s in a] == [s["configuration"] for s in b]
    for one, other in zip(a, b, strict=True):
        assert one["joints_rad"] == pytest.approx(other["joints_rad"], abs=1e-9)


def test_ik_labels_every_solution() -> None:
    result = run("ik", ROBOT, "1500,100,900,0,0,1,0")
    assert result.exit_code == 0
    assert "cf1=0 cf4=0 cf6=0 cfx=0" in result.stdout
    assert "cfx=1" in result.stdout


def test_joints_beyond_their_range_are_a_warning() -> None:
    result = run("fk", ROBOT, "0,0,200,0,0,0")
    assert result.exit_code == 0
    assert "warning: J3 is outside its range" in result.stderr


@pytest.mark.parametrize(
    ("status", "words", "message"),
    [
        (1, ("fk", ROBOT, "1,2,3"), "has 6 axes (J1, J2, J3, J4, J5, J6); 3 values given"),
        (2, ("fk", ROBOT, "1,2,3,4,5,six"), "'six' is no number"),
        (2, ("fk", ROBOT, "1,2,3,4,5,nan"), "nan is not finite"),
        (2, ("ik", ROBOT, "1,2"), "a pose is x,y,z"),
        (2, ("ik", ROBOT, "1,2,3,1,1,0,0"), "must have length 1, not 1.41421"),
        (1, ("ik", ROBOT, "9000,0,0"), "out of reach"),
        (1, ("fk", "abb/irb6640-180-25", "0"), "near it are abb/irb6640-180-255 (180 kg, 2.55 m)"),
    ],
)
def test_wrong_input_is_one_message(status: int, words: tuple[str, ...], message: str) -> None:
    result = run(*words)
    assert result.exit_code == status
    assert message in result.stderr
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert not result.stdout
