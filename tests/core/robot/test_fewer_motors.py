"""Arms with fewer motors than a pose has values: their flanges stay level."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FaultCause, InputError
from flyby.core.registry import find_robot
from flyby.core.robot.catalogue import load_robot
from flyby.core.robot.catalogue_text import robot_text
from flyby.core.robot.inverse.arm_inverse import ArmInverse
from flyby.core.robot.inverse.solution import UnreachableError
from flyby.core.robot.joint import HELD_WITHIN, CoupledRange
from flyby.core.robot.posture import posture
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.testing.strategies import configurations

RODS = find_robot("abb/irb660-180-315")
"""J4 and J5 have no motor; rods keep the flange level."""
GEARED = find_robot("kuka/kr140-r3200-2-pa")
"""A4 has no motor; the controller keeps the flange level with A5, which stands before A4."""
SCARAS = [find_robot("abb/irb910sc-3-065"), find_robot("kuka/kr6-r700-z200")]
"""J5 and J6 have no motor, J3 slides."""
ARMS = st.sampled_from([RODS, GEARED, *SCARAS])


@given(st.data(), ARMS)
def test_the_flange_stays_level(data, robot) -> None:
    q = data.draw(configurations(robot))
    R, _ = robot.forward(q)
    assert R[2, 2] == pytest.approx(-1.0, abs=HELD_WITHIN)


@given(st.data(), ARMS)
@settings(max_examples=15)
def test_closed_form_and_numerical_search_agree(data, robot) -> None:
    q = data.draw(configurations(robot, margin=0.1))
    pose = robot.flange_pose(q).matrix()
    R, p = np.ascontiguousarray(pose[:3, :3]), np.ascontiguousarray(pose[:3, 3])
    arm = robot.arm_chain, robot.joints, robot.coupled_ranges
    exact = [one.q for one in ArmInverse(*arm, robot.recognised).at(R, p)]
    assert min(turned(one - q) for one in exact) < 1e-6
    try:
        searched = ArmInverse(*arm, None).at(R, p)
    except UnreachableError:
        return  # a search need not find any
    for one in searched:
        assert min(turned(one.q - other) for other in exact) < 1e-5


def turned(apart) -> float:
    return float(np.abs(np.remainder(apart + np.pi, 2 * np.pi) - np.pi).max())


@given(st.data(), ARMS, st.floats(0.5, 90.0), st.floats(0.0, 6.2))
def test_a_tilted_pose_is_refused_with_its_cause(data, robot, tilt, about) -> None:
    q = data.draw(configurations(robot, margin=0.2))
    level = robot.flange_pose(q).matrix()
    axis = np.array([np.cos(about), np.sin(about), 0.0])
    level[:3, :3] = matrix_from_rotation_vector(np.radians(tilt) * axis) @ level[:3, :3]
    with pytest.raises(UnreachableError) as refused:
        robot.inverse(level)
    if refused.value.distance == 0.0 and "breaks a joint limit" not in str(refused.value):
        assert refused.value.cause is FaultCause.REACH
        assert "no motor for" in str(refused.value) or "keeps the flange level" in str(
            refused.value
        )


def test_rounded_orientations_are_level_enough() -> None:
    """RAPID writes quaternions with six digits, people with four."""
    q = np.array([0.4, 0.3, 0.5, 0.0, 0.0, 0.7])
    pose = RODS.flange_pose(q)
    for digits in (4, 6):
        rounded = np.round(pose.quaternion, digits)
        near = Pose(pose.position, tuple((rounded / np.linalg.norm(rounded)).tolist()))
        assert min(np.abs(one.q - q).max() for one in RODS.inverse(near)) < 3e-4


@given(st.data(), ARMS)
def test_jacobians_are_differences(data, robot) -> None:
    q, step = data.draw(configurations(robot)), 1e-6
    moved = [robot.forward(q + step * w)[1] - robot.forward(q - step * w)[1] for w in np.eye(6)]
    np.testing.assert_allclose(robot.jacobian(q)[:3].T, np.array(moved) / (2 * step), atol=1e-8)


def test_a5_stands_before_a4_and_counts_behind_it() -> None:
    assert [joint.name for joint in GEARED.joints] == ["A1", "A2", "A3", "A4", "A5", "A6"]
    assert GEARED.along == (0, 1, 2, 4, 3, 5)
    assert GEARED.flange_link == 6
    q = np.radians([0.0, -90.0, 90.0, 0.0, 90.0, 0.0])
    # 330 + 1255 + 265 mm ahead, 645 + 1350 − 250 mm high.
    np.testing.assert_allclose(GEARED.flange_pose(q).position, (1.85, 0.0, 1.745), atol=1e-12)


def test_both_elbows_of_a_scara_are_found() -> None:
    robot = SCARAS[0]
    q = np.array([0.3, 1.1, -0.05, 0.4, 0.0, 0.0])
    found = sorted((one.q for one in robot.inverse(robot.flange_pose(q))), key=lambda x: x[1])
    assert len(found) == 2
    np.testing.assert_allclose(found[1], q, atol=1e-12)
    assert found[0][1] == pytest.approx(-1.1)
    with pytest.raises(UnreachableError, match="out of reach"):
        robot.inverse(Pose((1.0, 0.0, 0.1), (0.0, 1.0, 0.0, 0.0)))
    with pytest.raises(UnreachableError, match=r"needs J3 at .* m, .* beyond"):
        robot.inverse(Pose((0.4, 0.2, 0.5), (0.0, 1.0, 0.0, 0.0)))
    assert posture(robot, q) is None


def test_postures_tell_what_stands_over_axis_1() -> None:
    ahead = posture(RODS, np.radians([0.0, 10.0, 10.0, 0.0, 0.0, 0.0]))
    assert ahead is not None and ahead.shoulder > 0.0 and ahead.elbow > 0.0
    level = posture(GEARED, np.radians([0.0, -90.0, 90.0, 0.0, 90.0, 0.0]))
    assert level is not None and level.shoulder == pytest.approx(1.85)
    assert posture(find_robot("ur/ur5e"), np.zeros(6)) is None


@pytest.mark.parametrize("robot", [RODS, GEARED, *SCARAS], ids=lambda robot: robot.name)
def test_a_catalogue_file_holds_it(robot, tmp_path) -> None:
    (tmp_path / "arm.toml").write_text(robot_text(robot), "utf-8")
    found = load_robot(tmp_path / "arm.toml")
    assert found.order == robot.order
    assert [joint.held for joint in found.joints] == [joint.held for joint in robot.joints]
    assert [one.terms for one in found.coupled_ranges] == [
        one.terms for one in robot.coupled_ranges
    ]
    q = np.radians([10.0, -60.0, 0.5, 0.0, 80.0, 20.0])
    np.testing.assert_allclose(
        found.flange_pose(q).matrix(), robot.flange_pose(q).matrix(), atol=1e-9
    )


def test_ranges_of_several_joints_bind_the_inverse() -> None:
    q = np.radians([10.0, 40.0, 20.0, 0.0, 0.0, 20.0])
    rod = CoupledRange((("J3", 1.0), ("J2", -1.0)), np.radians(-10), np.radians(40), "rods meet")
    bound = replace(RODS, coupled_ranges=(rod,))
    assert rod.sum == "J3 - J2"
    assert RODS.inverse(RODS.flange_pose(q))
    with pytest.raises(UnreachableError, match=r"J3 - J2 would be -20°, beyond .*rods meet"):
        bound.inverse(bound.flange_pose(q))
    np.testing.assert_allclose(bound.beyond_coupled(q), [np.radians(10.0)], atol=1e-12)


def test_what_they_must_be() -> None:
    with pytest.raises(InputError, match="is none"):
        CoupledRange((("J1", 1.0),), 1.0, 0.0, "")
    stranger = CoupledRange((("J9", 1.0),), 0.0, 1.0, "")
    with pytest.raises(InputError, match="couples J9"):
        replace(RODS, coupled_ranges=(stranger,))
    with pytest.raises(InputError, match="none of its joints"):
        replace(RODS, order=("J1", "J2"))
