"""Robots: kinematics and dynamics over leading axes, against Pinocchio and finite differences."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError, UnknownNameError
from flyby.core.program.tool import Load, Tool
from flyby.core.robot.inertia import Inertia, carried_inertia
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.spatial.pose import Pose

SETTINGS = settings(max_examples=25, deadline=None)
SEEDS = st.integers(0, 2**32 - 1)
LOAD = Inertia(12.0, (0.1, -0.2, 0.3), ((0.5, 0.01, 0.0), (0.01, 0.6, 0.02), (0.0, 0.02, 0.4)))
TURNED = Pose((0.5, -0.3, 0.2), (0.5, 0.5, -0.5, 0.5))


def on_track(robot, inertia=None):
    """The arm on a track, before a tilting turntable."""
    axes = [
        ExternalAxis(
            Joint("TILT", Pose((2.0, 0.0, 0.5)), (1.0, 0.0, 0.0), -2, 2, 1, 1), ExternalRole.TABLE
        ),
        ExternalAxis(
            Joint("TURN", Pose((0.0, 0.0, 0.2)), (0.0, 0.0, 1.0), -6, 6, 1, 1),
            ExternalRole.TABLE,
            carried_by="TILT",
        ),
        ExternalAxis(
            Joint("E1", TURNED, (0.0, 1.0, 0.0), -3, 3, 1, 1, kind=JointKind.PRISMATIC),
            ExternalRole.TRACK,
            inertia=inertia,
        ),
    ]
    return robot.with_external_axes(axes).with_base(Pose((0.1, 0.2, 0.3)))


def states(robot, seed, *lead):
    return np.random.default_rng(seed).normal(size=(3, *lead, robot.size))


def reference(robot, load=None):
    """A Pinocchio model written out on its own, for arms without external axes."""
    model = pin.Model()
    model.gravity.linear = np.array(robot.gravity)
    parent, step = 0, pin.SE3(robot.base.matrix())
    for joint, link in zip(robot.joints, robot.links, strict=True):
        placement = step * pin.SE3(joint.placement.matrix())
        kind = pin.JointModelRevoluteUnaligned(np.array(joint.axis))
        parent = model.addJoint(parent, kind, placement, joint.name)
        body = pin.Inertia(link.mass, np.array(link.centre), np.array(link.tensor))
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
        step = pin.SE3.Identity()
    if load is not None:
        body = pin.Inertia(load.mass, np.array(load.centre), np.array(load.tensor))
        model.appendBodyToJoint(parent, body, pin.SE3(robot.flange.matrix()))
    return model


@SETTINGS
@given(seed=SEEDS)
def test_torques_and_their_derivatives_agree_with_pinocchio(arms, seed) -> None:
    robot = arms["KR 30-3"].with_base(TURNED)
    q, dq, ddq = states(robot, seed)
    model = reference(robot, LOAD)
    data = model.createData()
    found = robot.inverse_dynamics(q, dq, ddq, LOAD)
    np.testing.assert_allclose(found, pin.rnea(model, data, q, dq, ddq), rtol=1e-9, atol=1e-8)
    expected = pin.computeRNEADerivatives(model, data, q, dq, ddq)[:3]
    for part, other in zip(
        robot.inverse_dynamics_derivatives(q, dq, ddq, LOAD), expected, strict=True
    ):
        np.testing.assert_allclose(part, other, rtol=1e-8, atol=1e-7)


def test_torque_derivatives_are_slopes_also_on_a_track(arms) -> None:
    robot = on_track(arms["UR5e"], Inertia(200.0))
    point = states(robot, 5)
    parts = robot.inverse_dynamics_derivatives(*point)
    known = [index for index, name in enumerate(robot.axis_names) if name not in ("TILT", "TURN")]
    h = 1e-6
    for which, part in enumerate(parts):
        for k in range(robot.size):
            up, down = point.copy(), point.copy()
            up[which, k] += h
            down[which, k] -= h
            slope = (robot.inverse_dynamics(*up) - robot.inverse_dynamics(*down)) / (2 * h)
            np.testing.assert_allclose(part[known, k], slope[known], rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize("name", ["IRB 6640", "UR5e", "iiwa 7"])
@SETTINGS
@given(seed=SEEDS, external=st.booleans())
def test_the_reverse_of_torques_weighs_their_derivatives(arms, name, seed, external) -> None:
    robot = arms[name].with_base(TURNED)
    if external:
        robot = on_track(robot, Inertia(200.0, (0.1, 0.2, 0.3)))
    point = states(robot, seed, 3)
    weight = np.random.default_rng(seed + 1).normal(size=point[0].shape)
    weight[:, [name in ("TILT", "TURN") for name in robot.axis_names]] = 0.0
    found = robot.pull_inverse_dynamics(*point, weight, LOAD)
    for made, part in zip(found, robot.inverse_dynamics_derivatives(*point, LOAD), strict=True):
        expected = np.einsum("mij,mi->mj", np.nan_to_num(part), weight)
        np.testing.assert_allclose(made, expected, rtol=1e-8, atol=1e-7)


def test_axes_of_unknown_inertia_have_unknown_torques_only_themselves(arms) -> None:
    robot = on_track(arms["UR5e"])
    torques = robot.inverse_dynamics(*states(robot, 1))
    np.testing.assert_array_equal(np.isnan(torques), [False] * 6 + [True] * 3)


def test_a_track_that_falls_freely_leaves_the_arm_without_weight(arms) -> None:
    robot = on_track(arms["UR5e"], Inertia(100.0)).with_gravity((0.0, 0.0, -9.0))
    down = Joint("E1", Pose(), (0.0, 0.0, -1.0), -9, 9, 9, 9, kind=JointKind.PRISMATIC)
    robot = robot.with_external_axes([ExternalAxis(down, ExternalRole.TRACK, None, Inertia(100.0))])
    q = np.array([0.3, -1.0, 0.8, 0.2, 0.4, 0.1, 0.5])
    ddq = np.array([0.0] * 6 + [9.0])
    np.testing.assert_allclose(robot.inverse_dynamics(q, 0 * q, ddq), 0.0, atol=1e-9)


@SETTINGS
@given(seed=SEEDS, lead=st.sampled_from([(), (4,), (2, 3)]))
def test_methods_work_over_leading_axes(arms, seed, lead) -> None:
    robot = on_track(arms["IRB 6640"], Inertia(100.0))
    q, dq, ddq = states(robot, seed, *lead)
    size = robot.size
    rotations, positions = robot.forward(q)
    assert rotations.shape == (*lead, 3, 3) and positions.shape == (*lead, 3)
    assert robot.jacobian(q).shape == (*lead, 6, size)
    assert robot.hessian(q).shape == (*lead, 6, size, size)
    assert robot.inverse_dynamics(q, dq, ddq).shape == (*lead, size)
    for part in robot.inverse_dynamics_derivatives(q, dq, ddq):
        assert part.shape == (*lead, size, size)
    last = tuple(n - 1 for n in lead)
    np.testing.assert_array_equal(robot.jacobian(q)[last], robot.jacobian(q[last]))
    single = robot.inverse_dynamics(q[last], dq[last], ddq[last])
    np.testing.assert_array_equal(robot.inverse_dynamics(q, dq, ddq)[last], single)


@pytest.mark.parametrize("name", ["IRB 6640", "UR5e", "iiwa 7"])
@SETTINGS
@given(seed=SEEDS)
def test_the_hessian_is_the_slope_of_the_jacobian(arms, name, seed) -> None:
    robot = on_track(arms[name])
    q, _, _ = states(robot, seed)
    h = 1e-6
    hessian = robot.hessian(q)
    for k in range(robot.size):
        step = h * np.eye(robot.size)[k]
        slope = (robot.jacobian(q + step) - robot.jacobian(q - step)) / (2 * h)
        np.testing.assert_allclose(hessian[:, :, k], slope, atol=1e-7)


def test_a_batch_of_torques_is_fast(arms) -> None:
    """40 000 configurations: bound ten times what an idle core needs."""
    robot = arms["KR 30-3"]
    q, dq, ddq = states(robot, 0, 40_000)
    robot.inverse_dynamics(q[:2], dq[:2], ddq[:2])
    start = time.process_time()
    robot.inverse_dynamics(q, dq, ddq)
    assert time.process_time() - start < 0.5


def test_dynamics_without_inertias_say_what_is_missing(arms) -> None:
    robot = replace(arms["UR5e"], links=())
    robot.forward(np.zeros(6))
    with pytest.raises(InputError, match=r"UR5e need the inertias of its links"):
        robot.inverse_dynamics(np.zeros(6), np.zeros(6), np.zeros(6))


def test_limits_cover_all_axes_and_cannot_be_written(arms) -> None:
    limits = on_track(arms["UR5e"]).limits
    assert all(len(column) == 9 for column in limits)
    assert limits.upper[-1] == 3.0 and math.isinf(limits.effort[0])
    with pytest.raises(ValueError, match="read-only"):
        limits.lower[0] = 0.0


def test_configurations_of_the_wrong_length_are_refused(arms) -> None:
    with pytest.raises(InputError, match=r"UR5e has 6 axes \(J1, J2, .*shape \(7,\)"):
        arms["UR5e"].forward(np.zeros(7))


def test_equal_robots_are_equal_and_hash_alike(arms) -> None:
    robot = arms["UR5e"]
    twin = replace(robot, origins={"geometry": "assumed: a test"})
    assert hash(robot) == hash(twin) and robot == replace(robot)


def axis(name, role=ExternalRole.TRACK, carried_by=None):
    joint = Joint(name, Pose(), (1.0, 0.0, 0.0), -1, 1, 1, 1, kind=JointKind.PRISMATIC)
    return ExternalAxis(joint, role, carried_by)


def test_impossible_external_axes_are_refused(arms) -> None:
    robot = arms["UR5e"]
    with pytest.raises(InputError, match="several axes are called 'J1'"):
        robot.with_external_axes([axis("J1")])
    with pytest.raises(InputError, match="stands on several tracks: A, B"):
        robot.with_external_axes([axis("A"), axis("B")])
    with pytest.raises(InputError, match="in a ring"):
        robot.with_external_axes([axis("A", carried_by="B"), axis("B", carried_by="A")])
    with pytest.raises(UnknownNameError, match="'C'"):
        robot.with_external_axes([axis("A", carried_by="C")])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"axis": (0.0, 0.0, 2.0)}, "length 1"),
        ({"lower": 2.0, "upper": 1.0}, "must be below"),
        ({"velocity": 0.0}, "velocity 0 must be positive"),
        ({"acceleration": math.nan}, "acceleration nan must be positive"),
        ({"effort": -1.0}, "effort -1 must be positive"),
    ],
)
def test_impossible_joints_are_refused(arms, change, message) -> None:
    with pytest.raises(InputError, match=f"joint J1.*{message}"):
        replace(arms["UR5e"].joints[0], **change)


@SETTINGS
@given(seed=SEEDS)
def test_bodies_add_and_move_as_pinocchio_says(seed) -> None:
    rng = np.random.default_rng(seed)
    load = Load(3.0, tuple(rng.normal(size=3)), tuple(rng.uniform(1, 2, 3)), (0.5, 0.5, 0.5, 0.5))
    moved = Inertia.of_load(load, TURNED)
    axes = pin.Quaternion(0.5, 0.5, 0.5, 0.5).matrix()
    own = pin.Inertia(3.0, np.array(load.centre), axes @ np.diag(load.inertia) @ axes.T)
    expected = own.se3Action(pin.SE3(TURNED.matrix()))
    np.testing.assert_allclose(moved.centre, expected.lever, atol=1e-12)
    np.testing.assert_allclose(moved.tensor, expected.inertia, atol=1e-12)
    total = moved + LOAD
    both = expected + pin.Inertia(LOAD.mass, np.array(LOAD.centre), np.array(LOAD.tensor))
    assert total.mass == pytest.approx(both.mass)
    np.testing.assert_allclose(total.centre, both.lever, atol=1e-12)
    np.testing.assert_allclose(total.tensor, both.inertia, atol=1e-10)


def test_impossible_bodies_are_refused() -> None:
    with pytest.raises(InputError, match="mass"):
        Inertia(-1.0)
    with pytest.raises(InputError, match="symmetric"):
        Inertia(1.0, tensor=((1.0, 0.5, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    with pytest.raises(InputError, match="principal moments"):
        Inertia(1.0, tensor=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)))


def test_the_flange_carries_tool_and_payload() -> None:
    tool = Tool("gun", Pose((0.0, 0.0, 0.5)), Load(2.0, (0.1, 0.0, 0.2)))
    payload = Load(6.0, (0.0, 0.0, 0.1))
    both = carried_inertia(tool, payload)
    assert both.mass == 8.0
    np.testing.assert_allclose(both.centre, [0.025, 0.0, 0.5])
    assert carried_inertia(tool).mass == 2.0 and carried_inertia(Tool()).mass == 0.0
    nozzle = Tool("nozzle", Pose((9.0, 0.0, 0.0)), Load(2.0), robot_held=False)
    held = carried_inertia(nozzle, payload)
    assert held.mass == 6.0
    np.testing.assert_allclose(held.centre, [0.0, 0.0, 0.1], atol=1e-15)
