"""Accelerations along the path that rise and fall over a while."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.command.commanded_motion import stamped_motion
from flyby.core.motion.command.ramp import ramped
from flyby.core.motion.command.smoothing import even_times
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius


def program(arm, *zones) -> Program:
    speed = Speed(tcp=0.5, reorientation=10.0)
    places = ((1, 0, 0), (1, 1, 0), (0, 1, 0.4))
    moves = tuple(
        MoveL(arm.target(place), speed, zone) for place, zone in zip(places, zones, strict=True)
    )
    return Program(moves, start=arm.start)


def off_the_path(motion_q: np.ndarray, path_q: np.ndarray) -> float:
    """How far (rad) configurations are from a dense polyline of others at most."""
    start, step = path_q[:-1], np.diff(path_q, axis=0)
    length = np.maximum(np.sum(step**2, axis=1), 1e-30)
    worst = 0.0
    for q in motion_q:
        share = np.clip(np.sum((q - start) * step, axis=1) / length, 0.0, 1.0)
        worst = max(worst, float(np.min(np.abs(start + share[:, None] * step - q).max(axis=1))))
    return worst


@settings(max_examples=8, deadline=None)
@given(ramp=st.floats(0.005, 0.08))
def test_a_ramp_takes_its_time_and_leaves_the_path_alone(arm, ramp) -> None:
    driven = program(arm, Radius(0.2 * arm.leg), FINE, FINE)
    plain = arm.controller(MotionModel())
    sudden = plain.stamp(driven, plain.plan(driven))
    controller = arm.controller(MotionModel(ramp=ramp))
    timing = controller.stamp(driven, controller.plan(driven))
    # One inner stop, and the end, are waited for.
    assert timing.duration == pytest.approx(sudden.duration + 2 * ramp)
    motion = stamped_motion(timing)
    np.testing.assert_allclose(motion.q[[0, -1]], sudden.path.q[[0, -1]], atol=1e-9)
    assert not motion.dq[[0, -1]].any()
    dense = sudden.states_at(np.linspace(0.0, sudden.duration, 20000))[0]
    assert off_the_path(motion.q[::20], dense) < 1e-6


@settings(max_examples=6, deadline=None)
@given(ramp=st.floats(0.01, 0.06))
def test_acceleration_along_a_line_rises_and_falls_over_the_ramp(abb, ramp) -> None:
    """Its change is at most twice the acceleration over the ramp, in m/s³."""
    driven = program(abb, FINE, FINE, FINE)
    timing = (c := abb.controller(MotionModel(ramp=ramp))).stamp(driven, c.plan(driven))
    motion = stamped_motion(timing)
    ddq = np.gradient(motion.dq, motion.t, axis=0)
    jerk = np.gradient(ddq, motion.t, axis=0)
    most = abb.robot.limits.acceleration
    assert (np.abs(ddq).max(axis=0) <= 1.05 * most).all()
    assert (np.abs(jerk).max(axis=0) <= 2.1 * most / ramp + 5.0).all()


@settings(max_examples=6, deadline=None)
@given(ramp=st.floats(0.005, 0.08), start=st.sampled_from([0.0, 0.15]))
def test_a_ramp_is_a_mean_of_the_place_whatever_its_knots(arm, ramp, start) -> None:
    """The same places at few knots as at many, velocities their difference quotients."""
    driven = program(arm, Radius(0.2 * arm.leg), FINE, FINE)
    controller = arm.controller(MotionModel(ramp=ramp, start_ramp=start))
    timing = controller.stamp(driven, controller.plan(driven))
    stamped = timing.intervals, timing.along.states, timing.start, ramp
    few, _ = ramped(*stamped, even_times(0.0, timing.duration, 8e-3))
    t = even_times(0.0, timing.duration, 1e-4)
    many, rates = ramped(*stamped, t)
    same = many[::80]
    np.testing.assert_allclose(few[: len(same)], same, atol=1e-9)
    off = np.abs(np.gradient(many, t, axis=0) - rates)[1:-1]
    # Where accelerations jump, a quotient is off by half of what they jump by in a step.
    assert off.max() < 1e-4 * np.abs(np.gradient(rates, t, axis=0)).max() + 1e-9


@settings(max_examples=6, deadline=None)
@given(ramp=st.floats(0.005, 0.08), start=st.sampled_from([0.0, 0.15]))
def test_a_ramp_is_where_the_mean_of_the_way_is_reached(arm, ramp, start) -> None:
    """The way that kinematics give between many instants, summed and averaged."""
    driven = program(arm, Radius(0.2 * arm.leg), FINE, FINE)
    controller = arm.controller(MotionModel(ramp=ramp, start_ramp=start))
    timing = controller.stamp(driven, controller.plan(driven))
    t = np.linspace(0.0, timing.duration, 20001)
    q = timing.driven_at(t)[0]
    rotation, place = arm.robot.forward(q)
    turn = np.linalg.norm(np.diff(rotation, axis=0), axis=(1, 2)) / np.sqrt(2)
    squares = np.sum(np.diff(place, axis=0) ** 2, axis=1) + (0.1 * turn) ** 2
    squares += 1e-4 * np.sum(np.diff(q, axis=0) ** 2, axis=1)
    way = np.concatenate([[0.0], np.cumsum(np.sqrt(squares))])
    area = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(t) * (way[1:] + way[:-1]))])
    mean = (area - np.interp(t - ramp, t, area)) / ramp
    moving = np.concatenate([[True], np.diff(way) > 0.0])
    expected = timing.driven_at(np.interp(mean, way[moving], t[moving]))[0]
    made, _ = ramped(timing.intervals, timing.along.states, timing.start, ramp, t)
    np.testing.assert_allclose(made, expected, atol=2e-5)


@pytest.mark.parametrize("ramp", [0.004, 0.001])
def test_a_short_ramp_is_resolved(arm, ramp) -> None:
    """By knots as near to each other as it asks for."""
    driven = program(arm, FINE, FINE, FINE)
    timing = (c := arm.controller(MotionModel(ramp=ramp))).stamp(driven, c.plan(driven))
    motion = stamped_motion(timing)
    fine = even_times(0.0, timing.duration, 5e-5)
    expected = ramped(timing.intervals, timing.along.states, timing.start, ramp, fine)
    place, rate, _ = motion.at(fine)
    np.testing.assert_allclose(place, expected[0], atol=1e-7)
    np.testing.assert_allclose(rate, expected[1], atol=1e-3 * np.abs(rate).max())


def test_a_run_is_at_rest_at_its_ends(arm) -> None:
    driven = program(arm, Radius(0.2 * arm.leg), FINE, FINE)
    model = MotionModel(ramp=0.03, smoothing=(0.04, 0.04))
    made = arm.controller(model).run(driven, period=0.002).trajectory
    np.testing.assert_allclose(made.q[0], arm.home, atol=1e-9)
    assert np.abs(made.dq[[0, -1]]).max() < 1e-3
    speed = np.gradient(made.q, made.t, axis=0)[2:-2]
    assert np.abs(speed - made.dq[2:-2]).max() < 0.01 * np.abs(made.dq).max()


def test_less_jerk_takes_a_longer_ramp(abb) -> None:
    model = MotionModel(ramp=0.02)
    assert model.ramp_at(0.5) == pytest.approx(0.04)


def test_a_file_states_its_ramp(tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text("[time]\nramp_s = 0.03\n", "utf-8")
    model = load_motion_model(path)
    assert model.ramp == 0.03
    assert "time.ramp_s" in model.figures
    assert "time.ramp_s" not in MotionModel().figures
    path.write_text("[time]\nramp_s = -0.03\n", "utf-8")
    with pytest.raises(InputError, match=r"time\.ramp_s"):
        load_motion_model(path)
