"""Newton tracking and its linear solver."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.robot.catalogue import load_robot
from flyby.core.robot.kinematics.chain import Chain
from flyby.core.robot.kinematics.chain_kernels import pose
from flyby.core.robot.kinematics.linear import solve_in_place
from flyby.core.robot.kinematics.tracking import rotation_error, track
from flyby.core.spatial.rotation import matrix_from_rotation_vector, rotation_vector

SETTINGS = settings(max_examples=80, deadline=None)
ARM = np.arange(6)


@pytest.fixture(scope="module")
def irb6640(robot_file):
    return load_robot(robot_file("abb", "irb6640-180-255"))


def pose_of(chain: Chain, q):
    R, p = np.empty((3, 3)), np.empty(3)
    pose(chain, q, R, p)
    return R, p


@SETTINGS
@given(st.integers(1, 7), st.integers(0, 2**32 - 1))
def test_solves_linear_systems(size, seed) -> None:
    rng = np.random.default_rng(seed)
    A, x = rng.normal(size=(size, size)), rng.normal(size=size)
    b = A @ x
    pivot = solve_in_place(A.copy(), b)
    np.testing.assert_allclose(b, x, rtol=1e-6, atol=1e-6 * np.linalg.cond(A) * 1e-6)
    assert 0.0 < pivot <= np.abs(A).sum()


def test_a_singular_system_has_no_pivot() -> None:
    A = np.outer(np.arange(1.0, 7.0), np.ones(6))
    assert solve_in_place(A, np.ones(6)) == 0.0


@SETTINGS
@given(st.floats(0.0, np.pi), st.integers(0, 2**32 - 1))
def test_rotation_error_is_the_rotation_vector_between(angle, seed) -> None:
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    turn = matrix_from_rotation_vector(angle * axis / np.linalg.norm(axis))
    current = matrix_from_rotation_vector(rng.normal(size=3))
    found = np.array(rotation_error(turn @ current, current))
    np.testing.assert_allclose(matrix_from_rotation_vector(found), turn, atol=2e-8)
    np.testing.assert_allclose(
        np.linalg.norm(found), np.linalg.norm(rotation_vector(turn)), atol=1e-8
    )


@SETTINGS
@given(st.integers(0, 2**32 - 1))
def test_tracking_reaches_the_pose_to_machine_precision(irb6640, seed) -> None:
    rng = np.random.default_rng(seed)
    limits = irb6640.limits
    q = rng.uniform(limits.lower, limits.upper)
    R, p = pose_of(irb6640.chain, q)
    out = np.empty(6)
    converged, _, _ = track(irb6640.chain, q + rng.uniform(-0.02, 0.02, 6), R, p, ARM, out)
    assert converged
    found_R, found_p = pose_of(irb6640.chain, out)
    np.testing.assert_allclose(found_R, R, atol=5e-12)
    np.testing.assert_allclose(found_p, p, atol=5e-12)


def test_a_good_guess_keeps_the_branch_and_converges_fast(irb6640) -> None:
    q = np.radians([20.0, 10.0, -15.0, 40.0, 50.0, -70.0])
    out = np.empty(6)
    converged, iterations, pivot = track(
        irb6640.chain, q + 0.01, *pose_of(irb6640.chain, q), ARM, out
    )
    assert converged and iterations <= 5 and pivot > 1e-2
    np.testing.assert_allclose(out, q, atol=1e-12)


def test_a_singular_pose_is_reached_and_told_by_its_pivot(irb6640) -> None:
    q = np.radians([20.0, 10.0, -15.0, 40.0, 0.0, -70.0])
    out = np.empty(6)
    R, p = pose_of(irb6640.chain, q)
    converged, _, pivot = track(irb6640.chain, q + 1e-3, R, p, ARM, out)
    assert converged and pivot < 1e-5
    np.testing.assert_allclose(pose_of(irb6640.chain, out)[1], p, atol=1e-11)


def test_an_unreachable_pose_does_not_converge(irb6640) -> None:
    out = np.empty(6)
    converged, _, _ = track(irb6640.chain, np.zeros(6), np.eye(3), np.array([9.0, 0, 0]), ARM, out)
    assert not converged


def test_prescribed_values_stay(irb6640) -> None:
    """The same chain over eight values, of which only the arm's may move."""
    chain = irb6640.chain._replace(joint=ARM + 2)
    q = np.array([5.0, 6.0, 0.1, 0.2, -0.3, 0.4, 0.5, -0.6])
    out = np.empty(8)
    converged, _, _ = track(chain, q + 0.01, *pose_of(chain, q), ARM + 2, out)
    assert converged
    np.testing.assert_array_equal(out[:2], q[:2] + 0.01)
    np.testing.assert_allclose(out[2:], q[2:], atol=1e-12)


def test_seven_joints_take_the_step_of_least_norm() -> None:
    rng = np.random.default_rng(0)
    axis = rng.normal(size=(7, 3))
    chain = Chain(
        rotation=matrix_from_rotation_vector(rng.normal(size=(7, 3))),
        translation=rng.normal(size=(7, 3)),
        axis=axis / np.linalg.norm(axis, axis=1, keepdims=True),
        prismatic=np.zeros(7, dtype=bool),
        joint=np.arange(7),
        sign=np.ones(7),
        end_rotation=np.eye(3),
        end_translation=np.zeros(3),
    )
    q, guess = rng.normal(size=7), np.empty(7)
    guess[:] = q + 1e-4 * rng.normal(size=7)
    out = np.empty(7)
    converged, _, _ = track(chain, guess, *pose_of(chain, q), np.arange(7), out)
    assert converged
    # The move has no part in the null space, in which the pose does not change.
    from flyby.core.robot.kinematics.chain_kernels import jacobians

    null = np.linalg.svd(jacobians(chain, out[None])[0])[2][6]
    assert abs(null @ (out - guess)) < 1e-6
    np.testing.assert_allclose(pose_of(chain, out)[1], pose_of(chain, q)[1], atol=1e-11)
