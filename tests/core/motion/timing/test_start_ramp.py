"""A program's time that comes up to speed at its start."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.command.commanded_motion import stamped_motion
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.timing.start_ramp import SUDDEN, StartRamp
from flyby.core.program.move import MoveJ, MoveL, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

LENGTHS = st.floats(0.01, 0.5)


def controller_of(arm, model: MotionModel):
    """With samples that a ramp does not make denser."""
    controller = arm.controller(model)
    controller.sampling = Sampling()
    return controller


def program(arm, *before: Wait) -> Program:
    speed = Speed(tcp=0.5, reorientation=10.0)
    zone = Radius(0.2 * arm.leg)
    moves = (
        MoveL(arm.target((1, 0, 0)), speed, zone),
        MoveJ(arm.target((1, 1, 0)), speed, zone),
        MoveL(arm.target((0, 1, 0.4)), speed, FINE),
    )
    return Program((*before, *moves), start=arm.start)


@given(length=LENGTHS, begin=st.floats(0.0, 2.0))
def test_time_there_and_back_is_the_same_time(length, begin) -> None:
    ramp = StartRamp(length, begin)
    t = np.linspace(0.0, begin + 3 * length, 200)
    stamped, rate, growth = ramp.stamped(t)
    np.testing.assert_allclose(ramp.driven(stamped), t, atol=1e-7)
    assert (np.diff(stamped) > -1e-15).all() and ((rate >= 0.0) & (rate <= 1.0)).all()
    moving = t > begin + 1e-9
    np.testing.assert_allclose(rate[moving & (t > begin + length)], 1.0)
    h = 1e-6
    near = (ramp.stamped(t + h)[0] - ramp.stamped(t - h)[0]) / (2 * h)
    away = (np.abs(t - begin) > 2 * h) & (np.abs(t - begin - length) > 2 * h)
    np.testing.assert_allclose(near[away & moving], rate[away & moving], atol=1e-7)
    inside = moving & (t < begin + length)
    np.testing.assert_allclose(growth[inside], 1.0 / length)


@settings(max_examples=6, deadline=None)
@given(length=LENGTHS, wait=st.floats(0.0, 0.3))
def test_all_is_later_by_half_the_ramp_on_the_same_path(arm, length, wait) -> None:
    driven = program(arm, Wait(wait))
    sudden = controller_of(arm, MotionModel()).run(driven, period=0.002)
    ramped = controller_of(arm, MotionModel(start_ramp=length)).run(driven, period=0.002)
    assert ramped.duration == pytest.approx(sudden.duration + 0.5 * length, abs=1e-9)
    made = ramped.trajectory
    stamped = ramped.timing.start.stamped(made.t)[0]
    q, sigma = sudden.timing.states_at(stamped)[0], sudden.timing.place_at(stamped)
    np.testing.assert_allclose(made.q, q, atol=1e-9)
    np.testing.assert_allclose(made.sigma, sigma, atol=1e-9)
    assert not made.dq[made.t <= wait].any()


@settings(max_examples=6, deadline=None)
@given(length=LENGTHS)
def test_velocities_and_accelerations_are_those_of_the_joints(arm, length) -> None:
    controller = arm.controller(MotionModel(start_ramp=length))
    driven = program(arm)
    timing = controller.stamp(driven, controller.plan(driven))
    t = np.linspace(1e-3, timing.duration - 1e-3, 400)
    q, dq, ddq = timing.driven_at(t)
    h = 1e-5
    after, before = timing.driven_at(t + h), timing.driven_at(t - h)
    np.testing.assert_allclose((after[0] - before[0]) / (2 * h), dq, atol=1e-3)
    # Accelerations jump at the stamp's knots; a few quotients reach over one.
    off = np.abs((after[1] - before[1]) / (2 * h) - ddq).max(axis=1)
    assert np.mean(off < 1e-3 * np.abs(ddq).max()) > 0.9
    stamped = timing.states_at(np.linspace(0.0, timing.duration, 4000))[2]
    most = np.abs(stamped).max(axis=0)
    assert (np.abs(ddq).max(axis=0) <= 1.5 * most + 1e-9).all()
    motion = stamped_motion(timing)
    np.testing.assert_allclose(motion.at(t)[0], q, atol=1e-6)


def test_without_a_ramp_nothing_changes(arm) -> None:
    controller = arm.controller(MotionModel())
    driven = program(arm)
    timing = controller.stamp(driven, controller.plan(driven))
    assert timing.start == SUDDEN
    t = np.linspace(0.0, timing.duration, 300)
    for before, after in zip(timing.states_at(t), timing.driven_at(t), strict=True):
        assert (before == after).all()


def test_a_ramp_makes_no_excess(arm) -> None:
    """Time that comes up to speed asks for more acceleration than was stamped; that is its own."""
    fast = Speed(tcp=50.0, reorientation=50.0)
    moves = (MoveJ(arm.joints([0.4, 0.2, -0.3, 0.3, 0.2, 0.5]), fast, FINE),)
    controller = arm.controller(MotionModel(start_ramp=0.15))
    run = controller.run(Program(moves, start=arm.start), period=0.001)
    most = np.abs(run.trajectory.ddq / arm.robot.limits.acceleration).max()
    assert 1.2 < most < 1.51
    assert not [note for note in run.notes if "acceleration" in note.message]


def test_the_key_is_read_and_needs_a_source(tmp_path) -> None:
    file = tmp_path / "motion.toml"
    file.write_text("[time]\nstart_ramp_s = 0.15\n")
    model = load_motion_model(file)
    assert model.start_ramp == 0.15 and "time.start_ramp_s" in model.figures
    assert "time.start_ramp_s" not in MotionModel().figures
    file.write_text("[time]\nstart_ramp_s = -0.1\n")
    with pytest.raises(InputError, match=r"time\.start_ramp_s"):
        load_motion_model(file)
