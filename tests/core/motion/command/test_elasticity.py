"""How far motors lead the links that they drive."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.command.commanded_motion import commanded_motion, stamped_motion
from flyby.core.motion.command.elasticity import _gears, lead_states, leads, leads_at
from flyby.core.motion.command.smoothing import Smoothing
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.elasticity import RIGID, Carried, Coupled, Elasticity
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose

GEARS = Elasticity(
    (0.0, 2e-4, 1e-4, 1e-5), (Carried(3, (1.5e-4, 1e-4)), Carried(5, (1e-4, 1e-4, 5e-5)))
)
ROBOT = "abb/irb6640-180-255"
WIDTHS = (0.04, 0.04, 0.04)
SPEED = Speed(tcp=0.8, reorientation=5.0)


def program(arm) -> Program:
    zone = Radius(0.2 * arm.leg)
    moves = (
        MoveL(arm.target((1, 0, 0)), SPEED, zone),
        MoveL(arm.target((1, 1, 0)), SPEED, zone),
        MoveJ(arm.target((0, 1, 0.4)), SPEED, FINE),
    )
    return Program(moves, start=arm.start)


def states(size: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-1.5, 1.5, (4, size)), *rng.normal(size=(2, 4, size))


def held_at_rest(gears: Elasticity, robot: Robot, q: np.ndarray) -> np.ndarray:
    """What gears hold (T, N), in rad of lead."""
    return _gears(gears, robot, q, np.zeros_like(q), np.zeros_like(q))[1]


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000))
def test_a_mass_on_the_wrist_leads_by_its_own_inertial_torque(seed) -> None:
    """Jᵀ p̈ with J and p̈ from difference quotients of where the wrist is."""
    arm = find_robot("abb/irb6640-180-255")
    q, dq, ddq = states(arm.size, seed)
    wrist = Elasticity((), (Carried(5, (1.0, 1.0, 1.0, 1.0)),))
    # The wrist lies on the tool flange's axis, 0.2 m behind it.
    back = np.array([0.0, 0.0, -0.2])

    def point(q):
        rotation, position = arm.forward(q)
        return position + rotation @ back

    h = 1e-4
    J = np.stack([(point(q + h * e) - point(q - h * e)) / (2 * h) for e in np.eye(6)], -1)

    def at(t):
        return point(q + t * dq + 0.5 * t**2 * ddq)

    pull = (at(h) - 2 * at(0.0) + at(-h)) / h**2
    expected = np.einsum("tij,ti->tj", J, pull)
    np.testing.assert_allclose(leads(wrist, arm, q, dq, ddq), expected, rtol=1e-5, atol=1e-5)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000), factor=st.floats(-3, 3))
def test_leads_at_a_share_of_the_speed_are_its_square(seed, factor) -> None:
    arm = find_robot("ur/ur10e")
    q, dq, ddq = states(arm.size, seed)
    slower = leads(GEARS, arm, q, factor * dq, factor**2 * ddq)
    np.testing.assert_allclose(slower, factor**2 * leads(GEARS, arm, q, dq, ddq), atol=1e-12)
    assert not leads(RIGID, arm, q, dq, ddq).any()


@settings(max_examples=6, deadline=None)
@given(data=st.data())
def test_motors_lead_the_links_and_meet_them_at_rest(arm, data) -> None:
    scale = data.draw(st.floats(0.1, 2.0))
    own = tuple(scale * value for value in GEARS.own)
    gears = Elasticity(own, GEARS.carried)
    links = arm.controller(MotionModel(smoothing=WIDTHS)).run(program(arm), period=0.002)
    motors = arm.controller(MotionModel(smoothing=WIDTHS, elasticity=gears)).run(
        program(arm), period=0.002
    )
    assert motors.duration == links.duration
    ends = [0, -1]
    made, stiff = motors.trajectory, links.trajectory
    assert stiff.q_motor is stiff.q and stiff.dq_motor is stiff.dq
    for name in ("q", "dq", "ddq", "position", "quaternion"):
        np.testing.assert_array_equal(getattr(made, name), getattr(stiff, name))
    np.testing.assert_allclose(made.q_motor[ends], made.q[ends], atol=1e-9)
    lead = leads(gears, arm.robot, made.q, made.dq, made.ddq)
    np.testing.assert_allclose(made.q_motor - made.q, lead, atol=2e-6)
    assert np.abs(lead).max() > 1e-5
    speed = np.gradient(made.q_motor, made.t, axis=0)[2:-2]
    scale = np.abs(made.dq_motor).max()
    assert np.abs(speed - made.dq_motor[2:-2]).max() < 0.02 * scale
    push = np.gradient(made.dq_motor, made.t, axis=0)[2:-2]
    scale = np.abs(made.ddq_motor).max()
    assert np.abs(push - made.ddq_motor[2:-2]).max() < 0.2 * scale


def test_a_flat_corner_of_the_tool_stays_flat() -> None:
    """It is the motors that leave the plane: the gears give way by as much."""
    robot = find_robot(ROBOT)
    controller = Controller(find_vendor("abb"), robot)
    stand = (0.1, 0.2, 0.3, 0.2, 0.9, 0.1)
    pose, speed = robot.flange_pose(stand), Speed(tcp=1.0, reorientation=8.7)
    at = np.array(pose.position)
    corner, end = at - np.array([0.0, 0.5, 0.0]), at + np.array([0.3, -0.5, 0.0])
    moves = tuple(
        MoveL(PoseTarget(Pose(tuple(map(float, place)), pose.quaternion)), speed, zone)
        for place, zone in ((corner, Radius(0.02, 0.03, 0.03)), (end, FINE))
    )
    made = controller.run(Program(moves, start=JointTarget(stand))).trajectory
    np.testing.assert_array_equal(robot.forward(made.q)[1], made.position)
    assert np.abs(made.position[:, 2] - at[2]).max() < 2e-4
    assert np.abs(robot.forward(made.q_motor)[1][:, 2] - at[2]).max() > 1e-3


def test_servos_that_lag_take_their_links_with_them(arm) -> None:
    lag = (2e-3, 0.0, -1e-3)
    plain = MotionModel(smoothing=WIDTHS)
    late = replace(plain, elasticity=Elasticity(lag=lag))
    moves = program(arm)
    stiff = arm.controller(plain).run(moves, period=0.001).trajectory
    made = arm.controller(late).run(moves, period=0.001).trajectory
    ahead = np.array(lag) * stiff.dq[:, :3]
    np.testing.assert_allclose(made.q[:, :3], stiff.q[:, :3] + ahead, atol=1e-12)
    np.testing.assert_allclose(made.q_motor, made.q, atol=2e-6)
    assert np.abs(ahead).max() > 1e-4
    push = np.gradient(made.dq, made.t, axis=0)[2:-2]
    assert np.abs(push - made.ddq[2:-2]).max() < 0.1 * np.abs(made.ddq).max()


def test_leads_and_higher_limits_are_no_excess(arm) -> None:
    """Motors may be asked for more than the links' limits; a scaled limit is the limit."""
    model = MotionModel(
        smoothing=WIDTHS, elasticity=GEARS, joint_acceleration_scale=(1.5,) * arm.robot.arm_size
    )
    fast = Speed(tcp=50.0, reorientation=50.0)
    moves = (MoveJ(arm.joints([0.4, 0.2, -0.3, 0.3, 0.2, 0.5]), fast, FINE),)
    made = arm.controller(model).run(Program(moves, start=arm.start), period=0.001)
    ddq = made.timing.states_at(made.trajectory.t)[2]
    assert np.abs(ddq / arm.robot.limits.acceleration).max() == pytest.approx(1.5, rel=0.02)
    assert not [note for note in made.notes if "acceleration" in note.message]


def test_a_joint_that_an_arm_does_not_have_is_refused() -> None:
    arm = find_robot("ur/ur10e")
    with pytest.raises(InputError, match="no joint 9"):
        leads(Elasticity((), (Carried(9, (1e-4,)),)), arm, *np.zeros((3, 1, 6)))


@settings(max_examples=20, deadline=None)
@given(slack=st.floats(1e-5, 1e-3), seed=st.integers(0, 1000))
def test_slack_doubles_small_leads_and_adds_itself_to_large_ones(slack, seed) -> None:
    arm = find_robot("abb/irb6640-180-255")
    q, dq, ddq = states(arm.size, seed)
    stiff = Elasticity((1.0, 1.0, 1.0))
    soft = Elasticity((1.0, 1.0, 1.0), slack=(slack, 0.0, slack))
    small = 1e-3 * slack
    lead = leads(stiff, arm, q, dq, small * ddq)
    twice = leads(soft, arm, q, dq, small * ddq)
    np.testing.assert_allclose(twice[:, 0], 2 * lead[:, 0], rtol=1e-4)
    np.testing.assert_array_equal(twice[:, 1], lead[:, 1])
    more = leads(soft, arm, q, dq, 1e3 * ddq) - leads(stiff, arm, q, dq, 1e3 * ddq)
    np.testing.assert_allclose(more[:, 2], slack * np.sign(ddq[:, 2]), rtol=1e-3)


@settings(max_examples=20, deadline=None)
@given(slack=st.floats(1e-5, 1e-3), seed=st.integers(0, 1000))
def test_a_gear_that_holds_a_weight_has_less_slack_left(slack, seed) -> None:
    arm = find_robot("abb/irb6640-180-255")
    q, dq, ddq = states(arm.size, seed)
    stiff = Elasticity((1e-4, 1e-4, 1e-4), (Carried(5, (1e-5, 1e-5, 1e-5)),))
    free = replace(stiff, slack=(slack,) * 3)
    loaded = replace(free, weight=(1.0,) * 3)
    lead, more = leads(stiff, arm, q, dq, ddq)[:, :3], leads(loaded, arm, q, dq, ddq)[:, :3]
    held = held_at_rest(loaded, arm, q)[:, :3]
    again = slack * (np.tanh((lead + held) / slack) - np.tanh(held / slack))
    np.testing.assert_allclose(more - lead, again, rtol=0, atol=1e-15)
    # A vertical axis holds no weight, and stays as soft as without.
    np.testing.assert_allclose(more[:, 0], leads(free, arm, q, dq, ddq)[:, 0], rtol=0, atol=1e-15)
    # At rest nothing leads, whatever is held; a stretched spring leaves no slack.
    assert not leads(loaded, arm, q, 0 * dq, 0 * ddq).any()
    sprung = replace(stiff, slack=(slack,), spring=(1e3,))
    np.testing.assert_allclose(
        leads(sprung, arm, q, dq, ddq), leads(stiff, arm, q, dq, ddq), rtol=0, atol=1e-15
    )


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000))
def test_what_gears_hold_is_the_change_of_the_masses_height(seed) -> None:
    """Of a mass on the wrist, by difference quotients; and a spring's sine."""
    arm = find_robot("abb/irb6640-180-255")
    q, _, _ = states(arm.size, seed)
    share, weight, spring = (1e-5, 3e-5, 2e-5), (0.5, 2.0, 1.0), (0.0, 3e-3)
    gears = Elasticity((), (Carried(5, share),), weight=weight, spring=spring)
    h, back = 1e-5, np.array([0.0, 0.0, -0.2])

    def height(q):
        rotation, position = arm.forward(q)
        return (position + rotation @ back)[:, 2]

    rise = np.stack([(height(q + h * e) - height(q - h * e)) / (2 * h) for e in np.eye(6)[:3]], -1)
    expected = np.linalg.norm(arm.gravity) * np.array(share) * weight * rise
    expected[:, 1] += spring[1] * np.sin(q[:, 1])
    np.testing.assert_allclose(held_at_rest(gears, arm, q)[:, :3], expected, rtol=1e-3, atol=1e-9)


@settings(max_examples=10, deadline=None)
@given(lag=st.lists(st.floats(-3e-3, 3e-3), min_size=6, max_size=6), seed=st.integers(0, 1000))
def test_a_lag_leads_by_its_time(lag, seed) -> None:
    arm = find_robot("kuka/kr3-r540")
    q, dq, ddq = states(arm.size, seed)
    made = replace(GEARS, lag=tuple(lag))
    more = leads(made, arm, q, dq, ddq) - leads(GEARS, arm, q, dq, ddq)
    np.testing.assert_allclose(more, np.array(lag) * dq, atol=1e-12)


@settings(max_examples=20, deadline=None)
@given(share=st.floats(-0.5, 0.5), seed=st.integers(0, 1000))
def test_a_coupled_joint_leads_by_a_share_of_what_stiffness_asks_of_another(share, seed) -> None:
    arm = find_robot("abb/irb6640-180-255")
    q, dq, ddq = states(arm.size, seed)
    stiff = replace(GEARS, own=(1e-4, 2e-4, 1e-4, 1e-5))
    lead = leads(stiff, arm, q, dq, ddq)
    coupled = (Coupled(3, 1, share), Coupled(2, 1, -share), Coupled(6, 4, 1.0))
    expected = lead.copy()
    expected[:, 2] += share * lead[:, 0]
    expected[:, 1] -= share * lead[:, 0]
    expected[:, 5] += lead[:, 3]
    made = replace(stiff, coupled=coupled)
    np.testing.assert_allclose(leads(made, arm, q, dq, ddq), expected, rtol=0, atol=1e-15)
    # Slack is in the gear itself: it neither bends others nor softens what others bend.
    slack = (1e-3, 0.0, 5e-4)
    more = leads(replace(made, slack=slack), arm, q, dq, ddq) - expected
    soft = leads(replace(stiff, slack=slack), arm, q, dq, ddq) - lead
    np.testing.assert_allclose(more, soft, rtol=0, atol=1e-15)


def test_coupled_joints_are_read_with_their_key(tmp_path) -> None:
    file = tmp_path / "motion.toml"
    file.write_text("[elasticity]\ncoupled = [{ joint = 3, by = 1, share = 0.25 }]\n")
    model = load_motion_model(file)
    assert model.elasticity == Elasticity(coupled=(Coupled(3, 1, 0.25),))
    assert "elasticity.coupled" in model.figures


@pytest.mark.parametrize(
    "entry",
    ["joint = 3, by = 3, share = 1.0", "joint = 0, by = 1, share = 1.0", "joint = 3, by = 1"]
    + [f"joint = {j}, by = 1, share = {s}" for j, s in (("3.5", 1), (3, "nan"), (3, "'a'"))],
)
def test_coupled_joints_that_make_no_sense_are_refused(entry, tmp_path) -> None:
    file = tmp_path / "motion.toml"
    file.write_text(f"[elasticity]\ncoupled = [{{ {entry} }}]\n")
    with pytest.raises(InputError, match=r"elasticity\.coupled"):
        load_motion_model(file)


def test_a_coupled_joint_that_an_arm_does_not_have_is_refused() -> None:
    arm = find_robot("ur/ur10e")
    with pytest.raises(InputError, match="no joint 7"):
        leads(Elasticity(coupled=(Coupled(7, 1, 0.1),)), arm, *np.zeros((3, 1, 6)))


def test_what_gears_hold_is_read_with_its_keys(tmp_path) -> None:
    file = tmp_path / "motion.toml"
    file.write_text("[elasticity]\nweight = [0.0, 2.0]\nspring_rad = [0.0, 3e-3]\n")
    model = load_motion_model(file)
    assert model.elasticity == Elasticity(weight=(0.0, 2.0), spring=(0.0, 3e-3))
    assert {"elasticity.weight", "elasticity.spring_rad"} <= set(model.figures)
    file.write_text("[elasticity]\nweight = [inf]\n")
    with pytest.raises(InputError, match=r"elasticity\.weight"):
        load_motion_model(file)


def test_slack_may_be_averaged_with_what_it_adds_to(abb) -> None:
    """The mean, over the longest average, of what it adds to the motion before that."""
    gears = replace(GEARS, slack=(2e-3, 1e-3), weight=(0.0, 2.0), slack_averaged=True)
    controller = abb.controller(MotionModel(smoothing=(0.03, 0.05), elasticity=gears))
    driven = program(abb)
    timing = controller.stamp(driven, controller.plan(driven))
    stamped, smoothing = stamped_motion(timing), controller.smoothing(driven, timing.path)
    t = np.linspace(0.1, timing.duration - 0.1, 200)
    back = np.linspace(0.0, 0.05, 201)
    at = (t[:, None] - back[::-1]).ravel()
    order = np.argsort(at, kind="stable")
    before = [np.empty((len(at), abb.robot.size)) for _ in range(3)]
    for made, one in zip(before, Smoothing((0.03,)).command(stamped, at[order]), strict=True):
        made[order] = one
    stiff = replace(gears, slack=(), slack_averaged=False)
    added = leads(gears, abb.robot, *before) - leads(stiff, abb.robot, *before)
    mean = np.trapezoid(added.reshape(len(t), -1, abb.robot.size), dx=1.0 / 200, axis=1)
    states = smoothing.command(stamped, t)
    expected = leads(stiff, abb.robot, *states) + mean
    found = leads_at(gears, abb.robot, smoothing, stamped, t, states)
    largest = np.abs(mean).max()
    assert largest > 3e-4
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-3 * largest)
    # Motions are sampled as logs are compared, and the lead's rates are its own.
    h = 1e-3
    sampled = commanded_motion(
        abb.robot, controller.model, smoothing, timing, (t[:, None] + [-h, 0.0, h]).ravel()
    ).lead
    place, speed, push = (part.reshape(len(t), 3, -1) for part in sampled)
    np.testing.assert_allclose(place[:, 1], expected, rtol=0, atol=2e-3 * largest)
    slope = (place[:, 2] - place[:, 0]) / (2 * h)
    np.testing.assert_allclose(speed[:, 1], slope, rtol=0, atol=2e-2 * np.abs(slope).max())
    bend = (speed[:, 2] - speed[:, 0]) / (2 * h)
    np.testing.assert_allclose(push[:, 1], bend, rtol=0, atol=5e-2 * np.abs(bend).max())


def test_a_lag_is_read_with_its_key(tmp_path) -> None:
    file = tmp_path / "motion.toml"
    file.write_text("[elasticity]\nlag_s = [0.0, 0.0, 0.0018]\n")
    model = load_motion_model(file)
    assert model.elasticity == Elasticity(lag=(0.0, 0.0, 0.0018))
    assert "elasticity.lag_s" in model.figures
    file.write_text("[elasticity]\nlag_s = [nan]\n")
    with pytest.raises(InputError, match=r"elasticity\.lag_s"):
        load_motion_model(file)


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 1000), slack=st.floats(1e-5, 1e-3))
def test_what_gears_give_way_by_has_its_own_derivatives(seed, slack) -> None:
    """Between and at the even times, those of slack included, which changes fast."""
    arm = find_robot(ROBOT)
    gears = replace(GEARS, slack=(slack, slack), weight=(0.0, 2.0), coupled=(Coupled(1, 2, 0.1),))
    rng = np.random.default_rng(seed)
    middle, size = rng.uniform(-1, 1, (2, arm.size))
    pace, phase = rng.uniform(4.0, 8.0, arm.size), rng.uniform(0, 6, arm.size)

    def motion(t):
        angle = pace * t[:, None] + phase
        swing = 0.2 * size
        return (
            middle + swing * np.sin(angle),
            swing * pace * np.cos(angle),
            -swing * pace**2 * np.sin(angle),
        )

    t, at, h = np.arange(0.0, 1.0, 4e-3), np.linspace(0.3, 0.7, 77), 1e-5
    place, speed, push = lead_states(gears, arm, t, motion(t), at)
    before, here, behind = (leads(gears, arm, *motion(at + step)) for step in (-h, 0.0, h))
    np.testing.assert_allclose(place, here, rtol=0, atol=1e-4 * np.abs(here).max())
    slope, bend = (behind - before) / (2 * h), (behind - 2 * here + before) / h**2
    np.testing.assert_allclose(speed, slope, rtol=0, atol=1e-3 * np.abs(slope).max())
    np.testing.assert_allclose(push, bend, rtol=0, atol=1e-2 * np.abs(bend).max())
