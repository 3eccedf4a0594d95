"""The moving average in time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.model import MotionModel
from flyby.core.motion.smoothing import moving_average, window_for_jerk
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

SPEED = Speed(tcp=0.8, reorientation=5.0)
WINDOWS = st.floats(0.01, 0.3)


def program(arm) -> Program:
    zone = Radius(0.2 * arm.leg)
    moves = (
        MoveL(arm.target((1, 0, 0)), SPEED, zone),
        MoveL(arm.target((1, 1, 0)), SPEED, zone),
        MoveJ(arm.target((0, 1, 0.4)), SPEED, FINE),
    )
    return Program(moves, start=arm.start)


@settings(max_examples=6, deadline=None)
@given(window=WINDOWS)
def test_limits_and_ends_hold_and_the_motion_lasts_the_window_longer(arm, window) -> None:
    plain = arm.controller().run(program(arm), period=0.002)
    smooth = arm.controller(MotionModel(smoothing=window)).run(program(arm), period=0.002)
    assert smooth.duration == pytest.approx(plain.duration + window)
    np.testing.assert_allclose(smooth.trajectory.q[[0, -1]], plain.trajectory.q[[0, -1]], atol=1e-9)
    limits = arm.robot.limits
    assert (np.abs(smooth.trajectory.dq) <= limits.velocity * 1.005).all()
    assert (np.abs(smooth.trajectory.ddq) <= limits.acceleration * 1.005).all()


@settings(max_examples=6, deadline=None)
@given(window=WINDOWS)
def test_no_joint_strays_further_than_its_bound(arm, window) -> None:
    """At most a T²/24 from where it would be in the middle of the window."""
    smooth = arm.controller(MotionModel(smoothing=window)).run(program(arm), period=0.002)
    t = smooth.trajectory.t
    middle = np.clip(t - 0.5 * window, 0, smooth.timing.duration)
    stray = np.abs(smooth.trajectory.q - smooth.timing.states_at(middle)[0]).max(axis=0)
    inside = (t > 0.5 * window) & (t < t[-1] - 0.5 * window)
    bound = arm.robot.limits.acceleration * window**2 / 24
    assert (stray[None] <= bound * 1.01 + 1e-9).all()
    assert inside.any() and stray.max() > 1e-7


def test_the_mean_of_a_trapezoid_is_known() -> None:
    """a T²/24 from the middle of the window under acceleration a, the middle itself without."""
    t = np.linspace(0, 3, 301)
    dq = np.minimum(np.minimum(t, 1.0), 3.0 - t)
    q = np.where(t < 1, 0.5 * t**2, np.where(t < 2, t - 0.5, 2 - 0.5 * (3 - t) ** 2))
    at = np.array([0.6, 1.7, 2.8])
    mean, rate, bend = moving_average(t, q[:, None], dq[:, None], 0.2, at)
    middle = np.array([0.5 * 0.5**2, 1.6 - 0.5, 2 - 0.5 * 0.3**2])
    np.testing.assert_allclose(mean[:, 0] - middle, [0.04 / 24, 0, -0.04 / 24], atol=1e-12)
    np.testing.assert_allclose(rate[:, 0], [0.5, 1.0, 0.3], atol=1e-12)
    np.testing.assert_allclose(bend[:, 0], [1.0, 0.0, -1.0], atol=1e-9)


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 1000), window=WINDOWS)
def test_rates_are_those_of_the_mean(seed, window) -> None:
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, 26)
    q = np.cumsum(rng.normal(size=(26, 2)) * 0.01, axis=0)
    dq = np.zeros((26, 2))
    at, h = np.sort(rng.uniform(0, 1 + window, 12)), 1e-5
    at = at[np.abs(at[:, None] - np.concatenate([t, t + window])).min(axis=1) > 2 * h]
    _, rate, bend = moving_average(t, q, dq, window, at)
    above, below = (moving_average(t, q, dq, window, at + s * h) for s in (1, -1))
    np.testing.assert_allclose((above[0] - below[0]) / (2 * h), rate, atol=1e-6)
    np.testing.assert_allclose((above[1] - below[1]) / (2 * h), bend, rtol=1e-4, atol=1e-4)


@settings(max_examples=5, deadline=None)
@given(jerk=st.floats(8.0, 40.0))
def test_a_jerk_limit_is_held_by_the_window(ur, jerk) -> None:
    """Jerk as a multiple of each joint's acceleration limit per second."""
    smooth = ur.controller(MotionModel(jerk=jerk)).run(program(ur), period=0.001)
    stops = int(smooth.path.pieces.stop[1:].sum())
    settled = smooth.timing.stamp.duration + stops * window_for_jerk(jerk)
    assert smooth.duration == pytest.approx(settled)
    change = np.abs(np.diff(smooth.trajectory.ddq[:-1], axis=0)) / 0.001
    assert (change <= jerk * ur.robot.limits.acceleration * 1.02).all()


@pytest.mark.parametrize("broken", [{"smoothing": -0.1}, {"jerk": 0.0}, {"jerk": -3.0}])
def test_windows_below_zero_are_refused(broken) -> None:
    with pytest.raises(InputError):
        MotionModel(**broken)
