"""The arm angle of arms with seven axes, and the configurations that have a given one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.registry import find_robot
from flyby.core.robot.inverse.solution import UnreachableError
from flyby.core.spatial.pose import Pose

ALONG = [0, 1, 3, 4, 5, 6, 2]
"""The axes from base to flange, as the controller counts them."""
# Axes from base to flange in degrees, and the arm angles that RobotStudio shows of an IRB 14050
# with z and y as reference direction (rpiRobotics/yumi-ik, unit_tests/compare_to_robotstudio.m).
ROBOTSTUDIO = [
    ([0] * 7, 0.0, 90.0),
    ([20] * 7, 6.86, 105.54),
    ([30] * 7, 14.50, 99.26),
    ([-40] * 7, 106.67, 15.68),
    ([-80] * 7, 99.01, -26.0),
    ([104, -31, 1, -18, -55, 117, 69], 19.58, -165.56),
    ([162, 1, -23, -88, 241, 98, -44], 80.07, -131.03),
    ([-20, -139, -144, 77, -263, 128, -104], 139.68, -15.92),
    ([67, -142, 121, 78, -38, 113, -194], -146.69, 119.74),
    ([-58, -138, -35, 70, -283, 133, 207], 165.86, 50.38),
]
SINGLE = find_robot("IRB 14050")
ARMS = [SINGLE, find_robot("yumi left"), find_robot("yumi right")]


def apart(one, other) -> float:
    return float(np.abs(np.angle(np.exp(1j * (np.asarray(one) - other)))).max())


@pytest.mark.parametrize(("along", "by_z", "by_y"), ROBOTSTUDIO)
def test_it_is_that_of_robotstudio(along, by_z, by_y) -> None:
    q = np.radians(np.array(along, dtype=float)[ALONG])
    for reference, shown in (((0.0, 0.0, 1.0), by_z), ((0.0, 1.0, 0.0), by_y)):
        robot = replace(SINGLE, arm_angle_reference=reference)
        angle = robot.arm_angle(q)
        assert angle is not None
        assert math.degrees(angle) == pytest.approx(shown, abs=0.006)


def test_the_two_arms_mirror_each_other() -> None:
    left, right = ARMS[1:]
    q = np.radians([20, -110, 30, 40, 50, 60, -70])
    mirrored = q * [-1, 1, 1, -1, 1, -1, -1]
    at, other = left.flange_pose(q), right.flange_pose(mirrored)
    np.testing.assert_allclose(at.position, np.multiply(other.position, (1, -1, 1)), atol=1e-9)


@st.composite
def standing(draw):
    robot = draw(st.sampled_from(ARMS))
    limits = robot.limits
    shares = np.array(draw(st.lists(st.floats(0.02, 0.98), min_size=7, max_size=7)))
    return robot, limits.lower + shares * (limits.upper - limits.lower)


def regular(robot, q) -> bool:
    """Away from where the arm angle and the pose together leave the configuration open."""
    whole = np.vstack([robot.jacobian(q), robot.arm_angle_slope(q)])
    return bool(np.linalg.cond(whole) < 300)


@settings(max_examples=40)
@given(standing())
def test_a_configuration_is_found_again_from_pose_and_arm_angle(case) -> None:
    robot, q = case
    if not regular(robot, q):
        return
    pose, angle = robot.flange_pose(q), robot.arm_angle(q)
    found = [one.q for one in robot.inverse(pose, arm_angle=angle)]
    assert min(apart(one, q) for one in found) < 1e-6
    for one in found:
        assert np.all(one >= robot.limits.lower) and np.all(one <= robot.limits.upper)
        np.testing.assert_allclose(robot.flange_pose(one).matrix(), pose.matrix(), atol=1e-9)
        assert apart(robot.arm_angle(one), angle) < 1e-9
    for k, one in enumerate(found):
        assert all(apart(one, other) > 1e-6 for other in found[:k])


@given(standing())
def test_its_slope_is_that_of_small_turns(case) -> None:
    robot, q = case
    slope = robot.arm_angle_slope(q)
    if np.abs(slope).max() > 50:
        return
    for joint, step in enumerate(1e-6 * np.eye(7)):
        change = robot.arm_angle(q + step) - robot.arm_angle(q - step)
        assert math.remainder(change, 2 * math.pi) / 2e-6 == pytest.approx(slope[joint], abs=1e-3)


def test_what_cannot_be_had_names_the_angles_that_can() -> None:
    robot = ARMS[2]
    q = np.radians([0, -130, 30, 0, 40, 0, -135])
    pose, angle = robot.flange_pose(q), robot.arm_angle(q)
    with pytest.raises(
        UnreachableError, match=r"arm angle of .*°.*that will do there are"
    ) as caught:
        robot.inverse(pose, arm_angle=angle + math.pi)
    said = str(caught.value).split(" there are ")[1].replace("°", "").replace("over 180 ", "")
    bounds = [tuple(map(float, one.split(" to "))) for one in said.split(" and ")]
    spans = [(low, (high - low) % 360) for low, high in bounds]
    assert any((math.degrees(angle) - low) % 360 <= span + 1 for low, span in spans)
    for low, span in spans:
        assert robot.inverse(pose, arm_angle=math.radians(low + 0.5 * span))
    far = Pose((2.0, 0.0, 0.0))
    with pytest.raises(UnreachableError, match="no configuration was found"):
        robot.inverse(far, arm_angle=0.0)


def test_arms_without_one() -> None:
    six = find_robot("IRB 120")
    assert six.arm_angle(np.zeros(6)) is None
    with pytest.raises(InputError, match="has no arm angle"):
        six.inverse(six.flange_pose(np.zeros(6)), arm_angle=0.0)
    with pytest.raises(InputError, match="arms of 7 turning axes"):
        replace(six, arm_angle_reference=(0.0, 0.0, 1.0))
