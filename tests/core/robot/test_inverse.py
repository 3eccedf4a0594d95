"""Inverse kinematics: every branch is found, and forward kinematics leads back to the pose."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.robot.inverse.solution import UnreachableError
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.robot.kinematics.arm_geometry import Family
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

SETTINGS = settings(max_examples=60, deadline=None)
SPHERICAL = ["IRB 6640", "IRB 1600", "lateral offset", "KR 30-3", "KR 16"]
PARALLEL = ["UR5e", "UR10e"]
CLOSED = SPHERICAL + PARALLEL
ANGLES = st.lists(st.floats(-math.pi, math.pi), min_size=6, max_size=6).map(np.array)
QUARTERS = st.lists(st.integers(-2, 2), min_size=6, max_size=6).map(
    lambda turns: np.array(turns) * math.pi / 2
)


def matrix_at(robot, q):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = robot.forward(q)
    return matrix


def apart(a, b):
    """Largest difference of angles, whole turns not counted."""
    return np.abs((np.asarray(a) - b + math.pi) % (2 * math.pi) - math.pi).max()


def check_all_reach(robot, solutions, target) -> None:
    for solution in solutions:
        np.testing.assert_allclose(matrix_at(robot, solution.q), target, atol=1e-9)


def test_families_are_recognised_by_geometry(arms) -> None:
    families = {name: robot.recognised and robot.recognised.family for name, robot in arms.items()}
    assert {name for name, family in families.items() if family is Family.SPHERICAL_WRIST} == set(
        SPHERICAL
    )
    assert {name for name, family in families.items() if family is Family.PARALLEL_AXES} == set(
        PARALLEL
    )


@pytest.mark.parametrize("name", CLOSED)
@SETTINGS
@given(q=ANGLES)
def test_all_solutions_reach_the_pose_and_the_first_is_among_them(arms, name, q) -> None:
    robot = arms[name]
    target = matrix_at(robot, q)
    solutions = robot.inverse(target)
    check_all_reach(robot, solutions, target)
    if not any(solution.singular for solution in solutions):
        assert min(apart(solution.q, q) for solution in solutions) < 1e-5
        branches = [solution.branch for solution in solutions]
        assert len(set(branches)) == len(branches)


@pytest.mark.parametrize("name", CLOSED)
@SETTINGS
@given(q=QUARTERS)
def test_singular_poses_are_solved_too(arms, name, q) -> None:
    robot = arms[name]
    target = matrix_at(robot, q)
    solutions = robot.inverse(target)
    assert solutions
    check_all_reach(robot, solutions, target)


@pytest.mark.parametrize("name", CLOSED)
@SETTINGS
@given(poses=st.lists(st.tuples(ANGLES | QUARTERS, st.sampled_from([0.0, 3.0])), max_size=5))
def test_many_poses_at_once_have_the_solutions_of_each(arms, name, poses) -> None:
    """Where it is left open the pose is singular or out of reach, or joints are at their ends."""
    robot = arms[name]
    targets = np.array([matrix_at(robot, q) for q, _ in poses]).reshape(-1, 4, 4)
    targets[:, 0, 3] += [farther for _, farther in poses]
    found = robot.inverse_at_each(targets, np.empty((len(poses), 0)))
    assert len(found) == len(poses)
    for target, many in zip(targets, found, strict=True):
        try:
            one = robot.inverse(target)
        except UnreachableError:
            assert many is None
            continue
        if many is None:
            assert any(solution.singular for solution in one)
        else:
            np.testing.assert_allclose(many, [solution.q for solution in one], atol=1e-9)


@pytest.mark.parametrize("name", CLOSED)
def test_a_well_placed_pose_has_eight_solutions_of_eight_branches(arms, name) -> None:
    robot = arms[name]
    q = {
        "UR5e": [0.3, -1.2, 1.4, -1.0, 1.1, 0.4],
        "UR10e": [0.3, -1.2, 1.4, -1.0, 1.1, 0.4],
        "KR 30-3": [0.3, -1.9, 1.9, 0.4, 0.7, 0.2],
        "KR 16": [0.3, -1.9, 1.9, 0.4, 0.7, 0.2],
    }.get(name, [0.3, -0.6, 0.3, 0.4, 0.7, 0.2])
    solutions = robot.inverse(matrix_at(robot, np.array(q)))
    assert len({solution.branch for solution in solutions}) == len(solutions) == 8


def test_branches_mean_front_forward_and_positive(arms) -> None:
    robot = arms["IRB 6640"]
    q = np.radians([10.0, 10.0, 10.0, 20.0, 30.0, 40.0])
    found = {s.branch: s.q for s in robot.inverse(matrix_at(robot, q))}
    plain = [branch for branch, solution in found.items() if apart(solution, q) < 1e-9]
    assert [(b.shoulder, b.elbow, b.wrist) for b in plain] == [(False, False, False)]
    for branch, solution in found.items():
        assert (abs(solution[0]) > math.pi / 2) == branch.shoulder
        assert (solution[4] < 0) == branch.wrist


@pytest.mark.parametrize(
    ("name", "degrees", "singular"),
    [
        ("IRB 6640", [10, 20, -30, 40, 0, 50], "wrist"),
        ("KR 30-3", [10, -80, 70, 40, 0, 50], "wrist"),
        ("IRB 1600", [10, 20, -90, 40, 50, 50], "elbow"),
        ("UR5e", [10, -70, 0, 40, 50, 50], "elbow"),
        ("UR5e", [10, -70, 80, 40, 0, 50], "wrist"),
    ],
)
def test_singularities_are_named(arms, name, degrees, singular) -> None:
    robot = arms[name]
    target = matrix_at(robot, np.radians(degrees))
    solutions = robot.inverse(target)
    check_all_reach(robot, solutions, target)
    assert any(singular in solution.singular for solution in solutions)


def test_the_wrist_above_axis_1_is_a_shoulder_singularity(arms) -> None:
    robot = arms["IRB 6640"]
    upper, elbow = 1.075, math.hypot(0.2, 1.1425)
    # The forearm's end comes back onto axis 1: x = 0.32 + sin(q2) upper + sin(psi) fore = 0.
    q2 = 0.3
    psi = math.asin(-(0.32 + math.sin(q2) * upper) / elbow)
    q = np.array([0.4, q2, psi - q2 - math.atan2(1.1425, 0.2), 0.3, 0.5, 0.2])
    target = matrix_at(robot, q)
    solutions = robot.inverse(target)
    check_all_reach(robot, solutions, target)
    assert any("shoulder" in solution.singular for solution in solutions)


@SETTINGS
@given(scale=st.sampled_from([1e-4, 1e-3, 4e-3]), seed=st.integers(0, 2**32 - 1))
def test_arms_slightly_off_the_ideal_are_solved_exactly(arms, scale, seed) -> None:
    """A calibrated arm: the closed form only starts Newton's method."""
    rng = np.random.default_rng(seed)
    joints = []
    for joint in arms["UR5e"].joints:
        off = np.eye(4)
        off[:3, :3] = matrix_from_rotation_vector(scale * rng.uniform(-1, 1, 3))
        off[:3, 3] = scale * rng.uniform(-1, 1, 3)
        placement = Pose.from_matrix(joint.placement.matrix() @ off)
        joints.append(replace(joint, placement=placement))
    robot = replace(arms["UR5e"], joints=tuple(joints))
    assert robot.recognised is not None
    q = np.array([0.0, -1.2, 1.2, -1.0, 1.1, 0.0]) + rng.uniform(-0.4, 0.4, 6)
    q[[0, 5]] = rng.uniform(-3, 3, 2)
    target = matrix_at(robot, q)
    solutions = robot.inverse(target)
    check_all_reach(robot, solutions, target)
    assert min(apart(solution.q, q) for solution in solutions) < 1e-6


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_seven_axes_are_solved_numerically(arms, seed) -> None:
    robot = arms["iiwa 7"]
    q = 0.9 * np.random.default_rng(seed).uniform(robot.limits.lower, robot.limits.upper)
    target = matrix_at(robot, q)
    solutions = robot.inverse(target)
    check_all_reach(robot, solutions, target)
    assert all(solution.branch is None for solution in solutions)


def test_an_odd_arm_is_solved_numerically(arms) -> None:
    """An offset in the wrist leaves no closed form."""
    joints = list(arms["KR 30-3"].joints)
    joints[4] = replace(joints[4], placement=Pose((0.8, 0.0, 0.1)))
    robot = replace(arms["KR 30-3"], joints=tuple(joints))
    assert robot.recognised is None
    q = np.array([0.3, -1.5, 1.4, 0.4, 0.7, 0.2])
    target = matrix_at(robot, q)
    solutions = robot.inverse(target)
    check_all_reach(robot, solutions, target)
    assert min(apart(solution.q, q) for solution in solutions) < 1e-8


def test_out_of_reach_says_how_far(arms) -> None:
    robot = arms["IRB 6640"]
    target = matrix_at(robot, np.zeros(6))
    stretched = math.hypot(1.1425, 0.2) + 1.075
    target[:3, 3] = [0.2 + 0.32 + stretched + 0.25, 0.0, 0.78]
    with pytest.raises(UnreachableError, match=r"misses it by 0\.25 m") as caught:
        robot.inverse(target)
    assert caught.value.distance == pytest.approx(0.25)


def test_a_broken_limit_is_named(arms) -> None:
    robot = arms["IRB 6640"]
    q = np.radians([0.0, 10.0, 10.0, 0.0, 100.0, 0.0])
    target = matrix_at(robot, q)
    limited = [replace(joint, lower=-math.pi / 2, upper=math.pi / 2) for joint in robot.joints]
    narrow = replace(robot, joints=tuple(limited))
    with pytest.raises(UnreachableError, match=r"J5 at 100°, 10° beyond its range of -90° to 90°"):
        narrow.inverse(target)


def test_the_base_moves_the_pose(arms) -> None:
    robot = arms["UR5e"].with_base(
        Pose((1.0, 2.0, 3.0), (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)))
    )
    q = np.array([0.3, -1.2, 1.4, -1.0, 1.1, 0.4])
    solutions = robot.inverse(robot.flange_pose(q))
    assert min(apart(solution.q, q) for solution in solutions) < 1e-9


def test_external_axes_are_prescribed(arms) -> None:
    track = Joint("E1", Pose(), (0.0, 1.0, 0.0), -3, 3, 1, 1, kind=JointKind.PRISMATIC)
    robot = arms["IRB 6640"].with_external_axes([ExternalAxis(track, ExternalRole.TRACK)])
    q = np.array([0.3, -0.6, 0.3, 0.4, 0.7, 0.2, 1.25])
    solutions = robot.inverse(robot.flange_pose(q), external=(1.25,))
    assert min(apart(solution.q, q[:6]) for solution in solutions) < 1e-9
    with pytest.raises(InputError, match="1 external axes; 0 values"):
        robot.inverse(robot.flange_pose(q))


def test_turns_lists_equivalent_values_nearest_first(arms) -> None:
    robot = arms["IRB 6640"]
    q = np.array([0.3, -0.6, 0.3, 0.4, 0.7, 5.0])
    turns = robot.turns(q)
    assert len(turns) == 2**6
    np.testing.assert_allclose(turns[0], q)
    assert (turns >= robot.limits.lower).all() and (turns <= robot.limits.upper).all()
    for other in turns:
        np.testing.assert_allclose(matrix_at(robot, other), matrix_at(robot, q), atol=1e-12)
