"""How far servos let joints be off: friction, and where velocities change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.command.servo import (
    FrictionMemory,
    drag_bound,
    friction_at,
    friction_bound,
    transient_at,
)
from flyby.core.motion.command.smoothing import JointMotion, Smoothing
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.servo import IDEAL, Servo
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

SERVO = Servo((1e-3, -2e-3), rise=5e-4, fade=0.3)
DRAGGED = replace(SERVO, drag=(2e-3, -1e-3), drag_time=0.2)
NONE = Smoothing()


def motion(seed: int, pace: float = 1.0) -> JointMotion:
    """Two joints that turn back at times of their own, from rest on."""
    knots = np.random.default_rng(seed).uniform(-0.3, 0.3, (9, 2))
    return JointMotion(np.arange(9.0) / pace, knots, np.zeros_like(knots))


def off(servo: Servo, driven: JointMotion, t: np.ndarray) -> np.ndarray:
    return friction_at(servo, NONE, driven, t, driven.at(t))


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
@given(seed=st.integers(0, 1000), fade=st.floats(0.05, 2.0), time=st.floats(0.05, 1.0))
def test_friction_and_drag_are_what_their_equations_say(seed, fade, time) -> None:
    """Beside Euler's steps."""
    servo = Servo((1e-3, -2e-3), 5e-3, fade, (1e-3, 3e-3), 0.3, time)
    driven, fine = motion(seed), np.linspace(0.0, 8.0, 40_001)
    q, dq, _ = driven.at(fine)
    z, mean, drag = np.zeros(2), np.zeros(2), np.zeros(2)
    expected = np.empty_like(q)
    for k, v in enumerate(dq):
        expected[k] = servo.friction * (z - mean) + servo.drag * drag
        drag = drag + (v * np.abs(v) / (np.abs(v) + 0.3) - drag) * fine[1] / time
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
    for servo in (replace(SERVO, rise=rise), replace(DRAGGED, rise=rise)):
        most = friction_bound(servo, 2) + drag_bound(servo, np.abs(driven.at(t)[1]).max(axis=0))
        assert (np.abs(off(servo, driven, t)) <= most * (1 + 1e-5)).all()


def test_its_derivatives_are_those_of_it() -> None:
    driven, t, h = motion(3), np.arange(0.0501, 7.95, 0.004), 1e-6
    states = driven.at(t)
    made = FrictionMemory(DRAGGED, NONE, 2).over(driven, t, states)
    before, behind = (
        FrictionMemory(DRAGGED, NONE, 2).over(driven, t + step, driven.at(t + step))
        for step in (-h, h)
    )
    fast = np.abs(states[1]) > 0.05  # the second jumps where joints turn back
    for k in (0, 1):
        slope = (behind[k] - before[k]) / (2 * h)
        assert np.abs(slope - made[k + 1])[fast].max() < 1e-4 * np.abs(slope).max()


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 1000), back=st.floats(0.02, 0.5), width=st.floats(0.02, 0.2))
def test_transients_are_what_velocities_exceed_their_means_by(seed, back, width) -> None:
    servo, smoothing = Servo(transient=(2e-3, -1e-3), transient_time=back), Smoothing((width,))
    driven, t = motion(seed), np.linspace(0.05, 7.95, 401)
    states = smoothing.command(driven, t)
    made = transient_at(servo, smoothing, driven, t, states)[0]
    since = t[:, None] + back * (np.arange(400) + 0.5) / 400 - back
    order = np.argsort(since.ravel())
    speed = np.empty((since.size, 2))
    speed[order] = smoothing.command(driven, since.ravel()[order])[1]
    mean = speed.reshape(*since.shape, 2).mean(axis=1)
    expected = servo.transient * (states[1] - mean)
    np.testing.assert_allclose(made, expected, rtol=0, atol=2e-5 * np.abs(states[1]).max())


def test_transients_vanish_at_even_speed() -> None:
    driven = JointMotion(
        np.array([0.0, 1.0, 9.0]), np.array([[0.0], [0.5], [8.5]]), np.ones((3, 1))
    )
    servo, t = Servo(transient=(1e-3,), transient_time=0.2), np.linspace(1.3, 8.9, 50)
    made = transient_at(servo, NONE, driven, t, driven.at(t))[0]
    np.testing.assert_allclose(made, 0.0, rtol=0, atol=1e-15)


@pytest.mark.parametrize("model", [MotionModel(smoothing=(0.05, 0.03)), MotionModel(ramp=0.05)])
def test_transients_are_driven_with_their_derivatives(abb, model) -> None:
    speed = Speed(tcp=0.4, reorientation=5.0)
    moves = (
        MoveL(abb.target((1, 0, 0)), speed, Radius(0.2 * abb.leg)),
        MoveJ(abb.target((0, 1, 0.4)), speed, FINE),
    )
    program = Program(moves, start=abb.start)
    giving = replace(model, servo=Servo(transient=(4e-3, -4e-3, 2e-3), transient_time=0.1))
    plain, off = (
        abb.controller(one).run(program, period=1e-3).trajectory for one in (model, giving)
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
    [("rise", "friction_rise_rad"), ("fade", "friction_fade_s"), ("drag_time", "drag_time_s")],
)
def test_a_way_or_time_of_nothing_is_refused(key: str, named: str) -> None:
    with pytest.raises(InputError, match=f"servo.{named}"):
        Servo(**{key: 0.0})
