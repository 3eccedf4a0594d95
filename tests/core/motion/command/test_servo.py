"""How far servos let joints be off: friction, and drag."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.command.servo import (
    FrictionMemory,
    drag_at,
    drag_bound,
    friction_bound,
    offsets_at,
    time_to_rest,
)
from flyby.core.motion.command.smoothing import JointMotion, Smoothing
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.servo import IDEAL, Servo
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

SERVO = Servo((1e-3, -2e-3), rise=5e-4, fade=0.3)
DRAGGED = Servo(drag=(2e-3, -1e-3), drag_speed=0.2, drag_delay=0.15)
NONE = Smoothing()


def motion(seed: int, pace: float = 1.0) -> JointMotion:
    """Two joints that turn back at times of their own, from rest on."""
    knots = np.random.default_rng(seed).uniform(-0.3, 0.3, (9, 2))
    return JointMotion(np.arange(9.0) / pace, knots, np.zeros_like(knots))


def off(servo: Servo, driven: JointMotion, t: np.ndarray) -> np.ndarray:
    return offsets_at(servo, NONE, driven, t, driven.at(t))


def test_it_sets_in_as_a_joint_turns_back_and_fades() -> None:
    driven = JointMotion(
        np.array([0.0, 1.0, 2.0]), np.array([[0.0], [0.5], [0.0]]), np.zeros((3, 1))
    )
    t = np.linspace(1.0, 2.0, 501)
    made = off(replace(SERVO, friction=(1e-3,)), driven, t)[:, 0]
    assert made[0] == pytest.approx(1e-3 * np.exp(-1.0 / SERVO.fade), rel=0.1)
    at = int(np.argmin(made))
    way = 0.5 - driven.at(t)[0][:, 0]
    assert SERVO.rise < way[at] < 20 * SERVO.rise
    assert -2e-3 < made[at] < -1.6e-3
    np.testing.assert_allclose(
        made[at + 100 :], made[at + 100] * np.exp((t[at + 100] - t[at + 100 :]) / SERVO.fade), 1e-6
    )


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 1000), fade=st.floats(0.05, 2.0), delay=st.floats(0.0, 1.0))
def test_friction_and_drag_are_what_their_equations_say(seed, fade, delay) -> None:
    """Beside Euler's steps."""
    servo = Servo((1e-3, -2e-3), 5e-3, fade, (1e-3, 3e-3), 0.3, delay)
    driven, fine = motion(seed), np.linspace(0.0, 8.0, 40_001)
    dq = driven.at(fine)[1]
    then = driven.at(fine - delay)[1]
    z, mean = np.zeros(2), np.zeros(2)
    expected = servo.drag * then**3 / (then**2 + 0.3**2)
    for k, v in enumerate(dq):
        expected[k] += servo.friction * (z - mean)
        mean = mean + (z - mean) * fine[1] / fade
        z = z + (v - z * np.abs(v)) * fine[1] / servo.rise
    made = off(servo, driven, fine[::37])
    np.testing.assert_allclose(made, expected[::37], rtol=0, atol=2e-5)
    assert np.abs(made).max() > 1e-3


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 1000), pace=st.floats(0.1, 2.0), cut=st.floats(0.05, 0.95))
def test_it_sets_in_by_ways_alone(seed: int, pace: float, cut: float) -> None:
    """The same at every speed, from either side, wherever joints are zero and stretches join."""
    driven, t = motion(seed), np.linspace(0.0, 8.0, 4001)
    stays = replace(SERVO, fade=1e9)
    paced = off(stays, motion(seed, pace), t / pace)
    # Where a joint turns back within a step, as much of its way is missed.
    np.testing.assert_allclose(paced, off(stays, driven, t), rtol=0, atol=1e-4)
    made = off(SERVO, driven, t)
    assert np.abs(made).max() > 1e-3
    mirrored = replace(driven, q=1.0 - driven.q, dq=-driven.dq)
    np.testing.assert_allclose(off(SERVO, mirrored, t), -made, rtol=0, atol=1e-12)
    memory, at = FrictionMemory(SERVO, NONE, 2), int(cut * len(t))
    parts = [memory.over(driven, part, driven.at(part))[0] for part in (t[:at], t[at:])]
    np.testing.assert_allclose(np.concatenate(parts), made, rtol=0, atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 1000), pace=st.floats(0.1, 10.0), rise=st.floats(1e-4, 0.1))
def test_it_stays_within_its_bound(seed: int, pace: float, rise: float) -> None:
    t = np.linspace(0.0, 8.0 / pace, 2000)
    driven = motion(seed, pace)
    both = replace(DRAGGED, friction=SERVO.friction, rise=rise)
    fastest = np.abs(driven.at(np.linspace(0.0, 8.0 / pace, 40_000))[1]).max(axis=0)
    for servo in (replace(SERVO, rise=rise), DRAGGED, both):
        most = friction_bound(servo, 2) + drag_bound(servo, fastest)
        assert (np.abs(off(servo, driven, t)) <= most * (1 + 1e-5)).all()


def test_its_derivatives_are_those_of_it() -> None:
    driven, t, h = motion(3), np.arange(0.0501, 7.95, 0.004), 1e-6
    states = driven.at(t)
    made = FrictionMemory(SERVO, NONE, 2).over(driven, t, states)
    before, behind = (
        FrictionMemory(SERVO, NONE, 2).over(driven, t + step, driven.at(t + step))
        for step in (-h, h)
    )
    fast = np.abs(states[1]) > 0.05  # the second jumps where joints turn back
    for k in (0, 1):
        slope = (behind[k] - before[k]) / (2 * h)
        assert np.abs(slope - made[k + 1])[fast].max() < 1e-4 * np.abs(slope).max()


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 1000), width=st.floats(0.05, 0.2), begin=st.floats(0.0, 4.0))
def test_derivatives_of_drag_are_those_of_it(seed: int, width: float, begin: float) -> None:
    """Wherever one begins to look."""
    driven, t, h = motion(seed), np.arange(begin, 7.95, 0.004), 1e-6
    smoothing = Smoothing((width, width))
    made = drag_at(DRAGGED, smoothing, driven, t)
    before, behind = (drag_at(DRAGGED, smoothing, driven, t + step) for step in (-h, h))
    slope = (behind[0] - before[0]) / (2 * h)
    np.testing.assert_allclose(made[1], slope, rtol=0, atol=1e-6 * np.abs(slope).max())
    bend = (behind[1] - before[1]) / (2 * h)
    # Told by cubics, where the velocity's derivative is broken.
    assert np.abs(bend - made[2]).max() < 0.1 * np.abs(bend).max()
    assert np.median(np.abs(bend - made[2])) < 1e-3 * np.abs(bend).max()


def test_joints_come_to_rest_after_what_is_commanded(abb) -> None:
    program = Program((MoveJ(abb.target((0, 1, 0.4)), Speed(tcp=0.4), FINE),), start=abb.start)
    servo = Servo(drag=(3e-3, -3e-3, 3e-3), drag_speed=0.1)
    controller = abb.controller(MotionModel(smoothing=(0.05, 0.03), servo=servo))
    run = controller.run(program, period=1e-3)
    longer = controller.run(program, period=1e-3, beyond=time_to_rest(servo)).trajectory
    count = len(run.trajectory.t) - 1
    np.testing.assert_allclose(longer.q[:count], run.trajectory.q[:count], rtol=0, atol=1e-12)
    assert longer.duration == pytest.approx(run.duration + servo.drag_delay)
    end = run.path.route.ends.q[-1, 1]
    assert np.abs(run.trajectory.q[-1] - end).max() > 1e-5
    np.testing.assert_allclose(longer.q[-1], end, rtol=0, atol=1e-9)
    assert time_to_rest(SERVO) == 0.0


@pytest.mark.parametrize("model", [MotionModel(smoothing=(0.05, 0.03)), MotionModel(ramp=0.05)])
def test_drag_is_driven_with_its_derivatives(abb, model) -> None:
    speed = Speed(tcp=0.4, reorientation=5.0)
    moves = (
        MoveL(abb.target((1, 0, 0)), speed, Radius(0.2 * abb.leg)),
        MoveJ(abb.target((0, 1, 0.4)), speed, FINE),
    )
    program = Program(moves, start=abb.start)
    pulled = replace(model, servo=Servo(drag=(4e-3, -4e-3, 2e-3), drag_speed=0.1))
    plain, off = (
        abb.controller(one).run(program, period=1e-3).trajectory for one in (model, pulled)
    )
    away, rate = off.q - plain.q, off.dq - plain.dq
    assert np.abs(away).max() > 1e-4
    np.testing.assert_array_equal(away[:, 3:], 0.0)
    slope = (away[2:] - away[:-2]) / 2e-3
    assert np.median(np.abs(slope - rate[1:-1])) < 1e-3 * np.abs(rate).max()
    bend, change = (rate[2:] - rate[:-2]) / 2e-3, (off.ddq - plain.ddq)[1:-1]
    assert np.median(np.abs(bend - change)) < 2e-2 * np.abs(change).max()


def test_links_and_motors_are_off_alike(abb) -> None:
    speed = Speed(tcp=0.4, reorientation=5.0)
    moves = (
        MoveL(abb.target((1, 0, 0)), speed, Radius(0.2 * abb.leg)),
        MoveL(abb.target((1, 1, 0)), speed, FINE),
        MoveJ(abb.target((0, 1, 0.4)), speed, FINE),
    )
    program = Program(moves, start=abb.start)
    smooth = MotionModel(smoothing=(0.05, 0.03))
    plain, same, rubbed = (
        abb.controller(replace(smooth, servo=servo)).run(program, period=0.004).trajectory
        for servo in (IDEAL, Servo((0.0, 0.0), rise=0.1), Servo((1e-3, -1e-3, 2e-3)))
    )
    np.testing.assert_array_equal(same.q, plain.q)
    away = rubbed.q - plain.q
    np.testing.assert_array_equal(rubbed.q_motor, rubbed.q)
    bound = friction_bound(Servo((1e-3, -1e-3, 2e-3)), away.shape[1])
    assert (np.abs(away) <= bound + 1e-12).all()
    assert (np.abs(away).max(axis=0)[:3] > 0.3 * bound[:3]).any()
    np.testing.assert_array_equal(rubbed.t, plain.t)


@pytest.mark.parametrize(
    ("key", "named"),
    [
        ("rise", "friction_rise_rad"),
        ("fade", "friction_fade_s"),
        ("drag_speed", "drag_speed_radps"),
    ],
)
def test_a_way_or_time_of_nothing_is_refused(key: str, named: str) -> None:
    with pytest.raises(InputError, match=f"servo.{named}"):
        Servo(**{key: 0.0})
