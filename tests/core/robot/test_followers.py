"""Arms whose forearm a rod holds against the base: J3 counts from the horizontal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.model.point_masses import mass_loads
from flyby.core.robot.catalogue import load_robot
from flyby.core.robot.catalogue_text import robot_text
from flyby.core.robot.inertia import Inertia
from flyby.core.robot.joint import Follower
from flyby.core.robot.posture import posture
from flyby.core.spatial.pose import Pose
from flyby.problems.free_motion.optimal_control.task.torque_bounds import BendBounds

from .conftest import abb

SERIAL = abb("test/rod-arm", 0.615, 0.1, 0.705, 0.135, 0.755, 0.085)
BACK = Follower("J2", (0.0, -1.0, 0.0))
ROD = replace(
    SERIAL,
    joints=tuple(
        replace(joint, followers=(BACK,)) if joint.name == "J3" else joint
        for joint in SERIAL.joints
    ),
)
COUPLING = np.eye(6)
COUPLING[2, 1] = -1.0
"""The serial arm's angles are COUPLING @ q."""
LOAD = Inertia(10.0, (0.1, 0.0, 0.05))
configurations = st.lists(st.floats(-1.2, 1.2), min_size=6, max_size=6).map(np.array)


@given(configurations)
def test_it_stands_as_the_serial_arm_with_j3_less_j2(q) -> None:
    for one, other in zip(ROD.forward(q), SERIAL.forward(COUPLING @ q), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
    np.testing.assert_allclose(
        ROD.jacobian(q), SERIAL.jacobian(COUPLING @ q) @ COUPLING, atol=1e-12
    )
    assert posture(ROD, q) == pytest.approx(posture(SERIAL, COUPLING @ q))


@given(configurations)
def test_jacobian_and_hessian_are_differences(q) -> None:
    step = 1e-6
    hessian = ROD.hessian(q)
    for k, way in enumerate(np.eye(6)):
        ahead, behind = q + step * way, q - step * way
        moved = (ROD.forward(ahead)[1] - ROD.forward(behind)[1]) / (2 * step)
        np.testing.assert_allclose(ROD.jacobian(q)[:3, k], moved, atol=1e-8)
        turned = (ROD.jacobian(ahead) - ROD.jacobian(behind)) / (2 * step)
        np.testing.assert_allclose(hessian[:, :, k], turned, atol=1e-7)


@given(configurations)
def test_inverse_kinematics_in_closed_form(q) -> None:
    known = ROD.recognised
    assert known is not None
    np.testing.assert_array_equal(known.coupling, COUPLING)
    np.testing.assert_allclose(known.values(known.angles(q)), q, atol=1e-14)
    pose = ROD.flange_pose(q)
    found = [solution.q for solution in ROD.inverse(pose)]
    for one in found:
        np.testing.assert_allclose(ROD.flange_pose(one).matrix(), pose.matrix(), atol=1e-8)
    if abs(q[4]) > 1e-3:
        apart = [np.abs(np.remainder(one - q + np.pi, 2 * np.pi) - np.pi).max() for one in found]
        assert min(apart) < 1e-6


@given(configurations, configurations, configurations)
def test_motors_bear_what_virtual_work_says(q, dq, ddq) -> None:
    states = [COUPLING @ x for x in (q, dq, ddq)]
    torques = ROD.inverse_dynamics(q, dq, ddq, LOAD)
    serial = SERIAL.inverse_dynamics(*states, LOAD)
    np.testing.assert_allclose(torques, COUPLING.T @ serial, atol=1e-8)
    parts = ROD.inverse_dynamics_derivatives(q, dq, ddq, LOAD)
    expected = SERIAL.inverse_dynamics_derivatives(*states, LOAD)
    for one, other in zip(parts, expected, strict=True):
        np.testing.assert_allclose(one, COUPLING.T @ other @ COUPLING, atol=1e-7)
    bar = np.cos(np.arange(6.0))
    for pulled, part in zip(ROD.pull_inverse_dynamics(q, dq, ddq, bar, LOAD), parts, strict=True):
        np.testing.assert_allclose(pulled, bar @ part, atol=1e-7)


def test_at_rest_torques_are_the_slope_of_the_energy() -> None:
    q, rest, step = np.array([0.3, 0.5, -0.4, 0.7, 0.6, -0.2]), np.zeros(6), 1e-6
    heavy = replace(ROD, links=tuple(Inertia(0.0) for _ in ROD.links))

    def energy(at) -> float:
        matrix = heavy.flange_pose(at).matrix()
        return float(10.0 * 9.80665 * (matrix @ [0.1, 0.0, 0.05, 1.0])[2])

    slope = [(energy(q + step * w) - energy(q - step * w)) / (2 * step) for w in np.eye(6)]
    np.testing.assert_allclose(heavy.inverse_dynamics(q, rest, rest, LOAD), slope, atol=1e-6)


def test_outline_is_the_serial_arms() -> None:
    np.testing.assert_allclose(ROD.outline(), SERIAL.outline(), atol=1e-12)


def test_a_joint_that_follows_elsewhere_has_no_closed_form() -> None:
    away = Follower("J5", (0.0, -1.0, 0.0), Pose((0.1, 0.0, 0.0)))
    joints = [*SERIAL.joints]
    joints[4] = replace(joints[4], followers=(away,))
    arm = replace(SERIAL, joints=tuple(joints))
    assert arm.recognised is None
    q = np.array([0.3, 0.5, -0.4, 0.7, 0.6, -0.2])
    pose = arm.flange_pose(q)
    for solution in arm.inverse(pose):
        np.testing.assert_allclose(arm.flange_pose(solution.q).matrix(), pose.matrix(), atol=1e-8)


def test_bends_of_torques_are_those_of_a_motion_at_most() -> None:
    t, step = np.linspace(0.05, 0.45, 40), 1e-3
    way = np.array([1.0, -0.8, 0.6, 0.5, -0.4, 0.9])
    rates = np.array([[np.abs(way) * size for size in (1.0, 2.0, 4.0, 8.0, 16.0)]])
    bounds = BendBounds(ROD, LOAD, Pose((0.1, 0.0, 0.3)), np.moveaxis(rates, 1, 2))

    def torques(at):
        q, dq, ddq = (
            np.outer(f, way) for f in (np.sin(2 * at), 2 * np.cos(2 * at), -4 * np.sin(2 * at))
        )
        return ROD.inverse_dynamics(q, dq, ddq, LOAD)

    bend = (torques(t + step) - 2 * torques(t) + torques(t - step)) / step**2
    assert (np.abs(bend).max(axis=0) <= bounds.torques()[0] + 1e-3).all()


def test_a_catalogue_file_holds_them(tmp_path) -> None:
    aside = Follower("J4", (0.0, 1.0, 0.0), Pose((0.0, 0.05, 0.0), (0.8, 0.0, 0.6, 0.0)))
    joints = [*ROD.joints]
    joints[4] = replace(joints[4], followers=(BACK, aside))
    arm = replace(ROD, joints=tuple(joints))
    (tmp_path / "arm.toml").write_text(robot_text(arm), "utf-8")
    found = load_robot(tmp_path / "arm.toml")
    assert [joint.followers for joint in found.joints] == [joint.followers for joint in arm.joints]
    q = np.array([0.3, 0.5, -0.4, 0.7, 0.6, -0.2])
    np.testing.assert_allclose(found.flange_pose(q).matrix(), arm.flange_pose(q).matrix())


def test_masses_stand_on_the_axes_of_their_own_joints() -> None:
    """A mass on axis 5 is borne as a body of that mass there, a follower or not."""
    q, rest = np.array([[0.3, 0.5, -0.4, 0.7, 0.6, -0.2]]), np.zeros((1, 6))
    light = replace(ROD, links=tuple(Inertia(1.0 if k == 4 else 0.0) for k in range(6)))
    held = mass_loads(ROD, [(5, (1.0,) * 6)], "key", q, rest, rest).held
    np.testing.assert_allclose(-held[0], light.inverse_dynamics(q, rest, rest)[0], atol=1e-9)


def test_what_followers_must_be() -> None:
    stranger = Follower("J9", (0.0, 0.0, 1.0))
    with pytest.raises(InputError, match="follows 'J9'"):
        replace(SERIAL, joints=(replace(SERIAL.joints[0], followers=(stranger,)),), links=())
    with pytest.raises(InputError, match="length 1"):
        Follower("J2", (0.0, 2.0, 0.0))
