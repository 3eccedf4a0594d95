"""Moves that are programmed to take a time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import DurationRule
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

THIRDS = MotionModel(duration=DurationRule.THIRDS)
DENSE = Sampling(step=2e-4, joint=0.004, turn=0.004, most=2000)


def drive(arm, *moves, model=THIRDS):
    controller = arm.controller(model)
    controller.sampling = DENSE
    return controller.run(Program(moves, start=arm.start), period=0.002)


def way(t: np.ndarray, duration: float, ramp: float = 1 / 3) -> np.ndarray:
    """Share of the way of a trapezoid that accelerates and brakes over a share each of its time."""
    s = np.clip(t / duration, 0.0, 1.0)
    a, speed = 1 / (ramp * (1 - ramp)), 1 / (1 - ramp)
    middle = speed * (s - 0.5 * ramp)
    ends = np.where(s < ramp, 0.5 * a * s**2, 1 - 0.5 * a * (1 - s) ** 2)
    return np.where((s >= ramp) & (s <= 1 - ramp), middle, ends)


@pytest.mark.parametrize("rule", [DurationRule.THIRDS, DurationRule.HALVES])
@settings(max_examples=6, deadline=None)
@given(duration=st.floats(2.0, 20.0), seed=st.integers(0, 100))
def test_a_joint_move_is_driven_in_thirds_or_halves(arm, rule, duration, seed) -> None:
    change = np.random.default_rng(seed).uniform(-0.5, 0.5, len(arm.home))
    move, model = MoveJ(arm.joints(change), Speed(duration=duration)), MotionModel(duration=rule)
    made = drive(arm, move, model=model).trajectory
    assert made.duration == pytest.approx(duration, rel=1e-4)
    expected = arm.home + way(made.t, duration, rule.ramp)[:, None] * change
    np.testing.assert_allclose(made.q, expected, atol=1e-4 * np.abs(change).max())


@settings(max_examples=6, deadline=None)
@given(duration=st.floats(2.0, 20.0), turn=st.sampled_from([0.0, 0.05, 0.4]))
def test_a_line_is_driven_in_thirds(arm, duration, turn) -> None:
    target = arm.target((1, 0, 0), (0.0, turn, 0.0))
    made = drive(arm, MoveL(target, Speed(duration=duration))).trajectory
    assert made.duration == pytest.approx(duration, rel=1e-4)
    driven = np.linalg.norm(made.position - made.position[0], axis=1)
    np.testing.assert_allclose(driven, arm.leg * way(made.t, duration), atol=1e-4 * arm.leg)


@settings(max_examples=4, deadline=None)
@given(duration=st.floats(2.0, 10.0))
def test_times_between_zones_are_met(arm, duration) -> None:
    timed = Speed(duration=duration)
    zone = Radius(0.1 * arm.leg)
    run = drive(
        arm,
        MoveL(arm.target((1, 0, 0)), timed, zone),
        MoveL(arm.target((1, 1, 0)), timed, zone),
        MoveJ(arm.target((0, 1, 0.3)), replace(timed, duration=0.7 * duration), FINE),
    )
    spent = run.timing.segment_durations()
    assert spent == pytest.approx([duration, duration, 0.7 * duration], rel=1e-4)


def test_a_time_too_short_is_said_and_scaled_motion_differs(arm) -> None:
    change = np.full(len(arm.home), 0.4)
    run = drive(arm, MoveJ(arm.joints(change), Speed(duration=0.01)))
    assert "programmed to take 0.01 s" in run.notes[-1].message
    move = MoveJ(arm.joints(change), Speed(duration=4.0))
    fastest = [
        np.abs(drive(arm, move, model=model).trajectory.dq).max()
        for model in (THIRDS, MotionModel())
    ]
    assert fastest[0] == pytest.approx(1.5 * 0.4 / 4.0, rel=1e-3)
    assert fastest[1] < 0.8 * fastest[0]


def test_the_rule_is_read_and_needs_a_source(tmp_path) -> None:
    file = tmp_path / "motion.toml"
    file.write_text('[time]\nduration = "thirds"\n')
    model = load_motion_model(file)
    assert model.duration is DurationRule.THIRDS and "time.duration" in model.figures
    assert "time.duration" not in MotionModel().figures
    file.write_text('[time]\nduration = "fifths"\n')
    with pytest.raises(InputError, match=r"time\.duration"):
        load_motion_model(file)
