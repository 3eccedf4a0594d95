"""The robots of the three catalogues against public figures."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor, installed
from flyby.core.robot.model import Robot
from flyby.core.spatial.rotation import matrix_from_quaternion, rotation_vector

POSITION_MM = 0.01
ANGLE_DEG = 0.001

CHECKPOINTS: dict[str, Any] = json.loads(
    (Path(__file__).parent / "fk_checkpoints.json").read_text("utf-8")
)["robots"]
ROBOTS = sorted(installed().robot_names)
EXPECTED = {
    "abb/irb6640-180-255",
    "abb/irb6640-235-255",
    "abb/irb1200-5-090",
    "abb/irb1600-6-145",
    "kuka/kr30-3",
    "kuka/kr3-r540",
    "kuka/iiwa7-r800",
    "kuka/iiwa14-r820",
    "ur/ur3",
    "ur/ur3e",
    "ur/ur5",
    "ur/ur5e",
    "ur/ur10",
    "ur/ur10e",
}


def errors(robot: Robot, q_deg: Any, position_mm: Any, rotation: Any) -> tuple[float, float]:
    """Distance in mm and angle in degrees from the expected flange."""
    R, p = robot.forward(np.radians(q_deg))
    turn = rotation_vector(R.T @ rotation)
    distance = np.linalg.norm(1000 * p - position_mm)
    return float(distance), float(np.degrees(np.linalg.norm(turn)))


def test_the_catalogues_hold_these_robots() -> None:
    assert set(ROBOTS) >= EXPECTED
    assert set(CHECKPOINTS) == EXPECTED - {"kuka/kr3-r540", "ur/ur3"}


@pytest.mark.parametrize("name", sorted(CHECKPOINTS))
def test_forward_kinematics_meet_the_public_source(name: str) -> None:
    robot = find_robot(name)
    for check in CHECKPOINTS[name]["checks"]:
        quaternion = np.array(check["quat_wxyz"])
        rotation = matrix_from_quaternion(quaternion / np.linalg.norm(quaternion))
        distance, angle = errors(robot, check["q_deg"], check["position_mm"], rotation)
        assert distance < POSITION_MM, check["q_deg"]
        assert angle < ANGLE_DEG, check["q_deg"]


@pytest.mark.parametrize("name", sorted(CHECKPOINTS))
def test_forward_kinematics_meet_the_sources_that_agree(name: str) -> None:
    robot = find_robot(name)
    for source in CHECKPOINTS[name]["agreeing"]:
        for q_deg, position in zip(source["q_deg"], source["position_mm"], strict=True):
            _, p = robot.forward(np.radians(q_deg))
            assert np.linalg.norm(1000 * p - position) < 2 * POSITION_MM, source["source"]


def step(axis: str, angle: float = 0.0, xyz: tuple[float, float, float] = (0, 0, 0)) -> np.ndarray:
    """A translation in mm, then a turn in degrees about an axis."""
    matrix = np.eye(4)
    matrix[:3, 3] = xyz
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def kr3_r540(q: list[float]) -> np.ndarray:
    """ros-industrial/kuka_experimental kuka_kr3_support/urdf/kr3r540_macro.xacro."""
    a1, a2, a3, a4, a5, a6 = q
    return (
        step("z", -a1, (0, 0, 345))
        @ step("y", a2, (20, 0, 0))
        @ step("y", a3, (260, 0, 0))
        @ step("x", -a4, (0, 0, 20))
        @ step("y", a5, (260, 0, 0))
        @ step("x", -a6, (75, 0, 0))
        @ step("y", 90)
    )


def ur3_cb3(q: list[float]) -> np.ndarray:
    """The Denavit-Hartenberg table of UniversalRobots/Universal_Robots_ROS2_Description."""
    rows = [
        (151.9, 0.0, 90),
        (0.0, -243.65, 0),
        (0.0, -213.25, 0),
        (112.35, 0.0, 90),
        (85.35, 0.0, -90),
        (81.9, 0.0, 0),
    ]
    pose = np.eye(4)
    for angle, (d, a, alpha) in zip(q, rows, strict=True):
        pose = pose @ step("z", angle, (0, 0, d)) @ step("x", alpha, (a, 0, 0))
    return pose


@pytest.mark.parametrize(("name", "expected"), [("kuka/kr3-r540", kr3_r540), ("ur/ur3", ur3_cb3)])
@pytest.mark.parametrize(
    "q_deg",
    [
        [0.0, 0, 0, 0, 0, 0],
        [0.0, -90, 90, 0, 0, 0],
        [30.0, -60, 80, 40, -35, 60],
        [-75.0, -100, 120, -120, 80, -200],
    ],
)
def test_forward_kinematics_meet_the_published_table(
    name: str, expected: Any, q_deg: list[float]
) -> None:
    pose = expected(q_deg)
    distance, angle = errors(find_robot(name), q_deg, pose[:3, 3], pose[:3, :3])
    assert distance < POSITION_MM
    assert angle < ANGLE_DEG


@pytest.mark.parametrize("name", ROBOTS)
def test_every_figure_states_its_origin(name: str) -> None:
    origins = find_robot(name).origins
    assert {"geometry", "range", "velocity", "acceleration", "shape"} <= set(origins)
    assert all(len(text) > 20 for text in origins.values())


@pytest.mark.parametrize("name", ROBOTS)
def test_unpublished_accelerations_follow_the_stated_rule(name: str) -> None:
    robot = find_robot(name)
    if robot.origins["acceleration"].startswith("assumed: top speed in 0.25 s"):
        ratio = robot.limits.velocity / robot.limits.acceleration
        assert ratio == pytest.approx(np.full(robot.size, 0.25), rel=1e-3)
    else:
        known = robot.origins["acceleration"].startswith(("identified: ", "published: "))
        assert known or "docs/reference/robots.md" in robot.origins["acceleration"]


@pytest.mark.parametrize("name", ROBOTS)
def test_inertias_are_those_of_bodies(name: str) -> None:
    for body in find_robot(name).links:
        moments = np.linalg.eigvalsh(np.array(body.tensor))
        assert body.mass > 0
        assert moments[0] > 0
        assert moments[2] <= moments[0] + moments[1] + 1e-12, "no body has such moments"


REACH_M = {  # manufacturers' figures, to the wrist centre (ABB, KUKA KR) or the flange (UR)
    "abb/irb6640-180-255": (2.55, 4),
    "abb/irb6640-235-255": (2.55, 4),
    "abb/irb1200-5-090": (0.901, 4),
    "abb/irb1600-6-145": (1.45, 4),
    "kuka/kr30-3": (2.033, 4),
    "kuka/kr3-r540": (0.541, 4),
}


@pytest.mark.parametrize("name", sorted(REACH_M))
def test_the_stretched_arm_reaches_as_far_as_its_name_says(name: str) -> None:
    robot = find_robot(name)
    reach, wrist = REACH_M[name]
    chain = robot.arm_chain
    shoulder = chain.translation[1][:2]
    upper = chain.translation[2]
    forearm = chain.translation[3] + chain.translation[wrist]
    stretched = np.hypot(*shoulder) + np.linalg.norm(upper) + np.linalg.norm(forearm)
    assert stretched == pytest.approx(reach, abs=0.012)


def test_the_iiwa_is_emulated_only() -> None:
    kuka = find_vendor("kuka")
    assert set(kuka.emulation_only) == {"iiwa7-r800", "iiwa14-r820"}
    for name in kuka.emulation_only:
        with pytest.raises(InputError, match=rf"kuka/{name}: .*Sunrise.*emulated only"):
            kuka.write(Program(()), kuka.robot(name))
