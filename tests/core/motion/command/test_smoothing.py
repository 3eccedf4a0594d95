"""Moving averages in time, one after the other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.command.smoothing import (
    JointMotion,
    Smoothing,
    averaged,
    even_times,
    window_for_jerk,
)
from flyby.core.motion.model.motion_model import MotionModel
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
    smooth = arm.controller(MotionModel(smoothing=(window,))).run(program(arm), period=0.002)
    assert smooth.duration == pytest.approx(plain.duration + window)
    np.testing.assert_allclose(smooth.trajectory.q[[0, -1]], plain.trajectory.q[[0, -1]], atol=1e-9)
    limits = arm.robot.limits
    assert (np.abs(smooth.trajectory.dq) <= limits.velocity * 1.005).all()
    assert (np.abs(smooth.trajectory.ddq) <= limits.acceleration * 1.005).all()


@settings(max_examples=6, deadline=None)
@given(window=WINDOWS)
def test_no_joint_deviates_further_than_its_bound(arm, window) -> None:
    """At most a T²/24 from where it would be in the middle of the window."""
    smooth = arm.controller(MotionModel(smoothing=(window,))).run(program(arm), period=0.002)
    t = smooth.trajectory.t
    middle = np.clip(t - 0.5 * window, 0, smooth.timing.duration)
    deviation = np.abs(smooth.trajectory.q - smooth.timing.states_at(middle)[0]).max(axis=0)
    inside = (t > 0.5 * window) & (t < t[-1] - 0.5 * window)
    bound = arm.robot.limits.acceleration * window**2 / 24
    assert (deviation[None] <= bound * 1.01 + 1e-9).all()
    assert inside.any() and deviation.max() > 1e-7


def test_the_mean_of_a_trapezoid_is_known() -> None:
    """a T²/24 from the middle of the window under acceleration a, the middle itself without."""
    t = np.linspace(0, 3, 301)
    dq = np.minimum(np.minimum(t, 1.0), 3.0 - t)
    q = np.where(t < 1, 0.5 * t**2, np.where(t < 2, t - 0.5, 2 - 0.5 * (3 - t) ** 2))
    at = np.array([0.6, 1.7, 2.8])
    mean, rate, bend = Smoothing((0.2,)).command(JointMotion(t, q[:, None], dq[:, None]), at)
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
    smoothing, motion = Smoothing((window,)), JointMotion(t, q, dq)
    _, rate, bend = smoothing.command(motion, at)
    above, below = (smoothing.command(motion, at + s * h) for s in (1, -1))
    np.testing.assert_allclose((above[0] - below[0]) / (2 * h), rate, atol=1e-6)
    np.testing.assert_allclose((above[1] - below[1]) / (2 * h), bend, rtol=1e-4, atol=1e-4)


def trapezoids(seed: int, begin: float = 0.0) -> JointMotion:
    """Two joints that start, pause and stop at bounded accelerations; knots every 2 ms."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 1.2, 601)
    knots = np.sort(rng.uniform(0.05, 1.15, 8))
    rate = np.zeros((601, 2))
    for j in range(2):
        rate[:, j] = np.interp(
            t, knots, [0, *rng.uniform(-1, 1, 2), 0, 0, *rng.uniform(-1, 1, 2), 0]
        )
    q = rng.normal(size=2) + np.concatenate(
        [np.zeros((1, 2)), np.cumsum(0.5 * np.diff(t)[:, None] * (rate[1:] + rate[:-1]), axis=0)]
    )
    return JointMotion(begin + t, q, rate)


CASCADES = st.lists(st.floats(0.005, 0.08), min_size=1, max_size=4).map(tuple)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000), widths=CASCADES)
def test_a_cascade_is_the_convolution_with_each_window(seed, widths) -> None:
    motion, step = trapezoids(seed), 1e-4
    even = np.arange(-0.1, 1.7, step)
    expected = motion.at(even)[0]
    for width in widths:
        area = np.concatenate(
            [[[0, 0]], np.cumsum(0.5 * step * (expected[1:] + expected[:-1]), axis=0)]
        )
        back = even - width
        lower = np.stack([np.interp(back, even, area[:, j]) for j in range(2)], -1)
        lower += np.minimum(back - even[0], 0.0)[:, None] * expected[0]
        expected = (area - lower) / width
    q, _, _ = Smoothing(widths).command(motion, even)
    np.testing.assert_allclose(q, expected, atol=2e-6)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000), widths=CASCADES)
def test_a_cascade_begins_and_ends_at_rest_and_passes_no_limit(seed, widths) -> None:
    motion, smoothing = trapezoids(seed), Smoothing(widths)
    t = np.linspace(0.0, 1.2 + smoothing.window, 700)
    q, dq, ddq = smoothing.command(motion, t)
    np.testing.assert_allclose(q[[0, -1]], motion.q[[0, -1]], atol=1e-12)
    np.testing.assert_allclose(dq[[0, -1]], 0.0, atol=1e-12)
    assert (np.abs(dq).max(axis=0) <= np.abs(motion.dq).max(axis=0) * (1 + 1e-4)).all()
    limit = np.abs(np.diff(motion.dq, axis=0)).max(axis=0) / 0.002
    assert (np.abs(ddq).max(axis=0) <= limit * (1 + 1e-3)).all()
    jerk = np.abs(np.diff(ddq, axis=0)).max(axis=0) / np.diff(t)[0]
    assert (jerk <= 2 * limit / max(widths) * (1 + 1e-2)).all()


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000), widths=CASCADES)
def test_a_cascade_deviates_no_further_than_half_its_variance_allows(seed, widths) -> None:
    motion, smoothing = trapezoids(seed), Smoothing(widths)
    t = np.linspace(0.0, 1.2 + smoothing.window, 500)
    off = smoothing.command(motion, t)[0] - motion.at(t - 0.5 * smoothing.window)[0]
    limit = np.abs(np.diff(motion.dq, axis=0)).max(axis=0) / 0.002
    bound = limit * smoothing.deviation
    assert (np.abs(off).max(axis=0) <= bound * (1 + 1e-6) + 1e-12).all()


@pytest.mark.parametrize("widths", [(0.06,), (0.02, 0.05), (0.04, 0.04, 0.04)])
def test_a_cascade_deviates_just_that_far_under_a_steady_acceleration(widths) -> None:
    t, smoothing = np.linspace(0, 1, 201), Smoothing(widths)
    motion = JointMotion(t, 1.5 * t[:, None] ** 2, 3.0 * t[:, None])
    at = np.array([0.5, 0.8])
    off = smoothing.command(motion, at)[0] - motion.at(at - 0.5 * smoothing.window)[0]
    np.testing.assert_allclose(off, 3.0 * smoothing.deviation, rtol=1e-6)


@settings(max_examples=15, deadline=None)
@given(seeds=st.tuples(st.integers(0, 99), st.integers(100, 199)), widths=CASCADES)
def test_a_cascade_is_linear_and_knows_no_order_and_no_beginning(seeds, widths) -> None:
    one, other = (trapezoids(seed) for seed in seeds)
    smoothing = Smoothing(widths)
    t = np.linspace(0.0, 1.2 + smoothing.window, 200)
    both = JointMotion(one.t, one.q - 2 * other.q, one.dq - 2 * other.dq)
    parts = zip(smoothing.command(one, t), smoothing.command(other, t), strict=True)
    for made, (a, b) in zip(smoothing.command(both, t), parts, strict=True):
        np.testing.assert_allclose(made, a - 2 * b, atol=1e-8)
    turned = Smoothing(widths[::-1]).command(one, t)
    late = smoothing.command(trapezoids(seeds[0], begin=2.5), t + 2.5)
    # What is left is the cubics' between knots that lie elsewhere.
    close = (1e-8, 1e-5, 1e-2)
    now = smoothing.command(one, t)
    for made, again, later, tolerance in zip(now, turned, late, close, strict=True):
        np.testing.assert_allclose(made, again, atol=1e-8)
        np.testing.assert_allclose(made, later, atol=tolerance)


def test_an_hour_loses_no_digits() -> None:
    """The same motion at the end of an hour of rest at an angle far from zero."""
    motion, smoothing = trapezoids(7), Smoothing((0.04, 0.04, 0.04))
    late = JointMotion(
        np.append(-3600.0, motion.t), *(np.vstack([a[:1], a]) for a in (motion.q, motion.dq))
    )
    t = np.linspace(0.0, 1.3, 100)
    for made, alone in zip(smoothing.command(late, t), smoothing.command(motion, t), strict=True):
        np.testing.assert_allclose(made, alone, atol=1e-5)
    np.testing.assert_allclose(
        smoothing.command(late, t)[0], smoothing.command(motion, t)[0], atol=1e-9
    )


@settings(max_examples=6, deadline=None)
@given(wait=st.floats(0.0, 0.3))
def test_stops_on_the_way_wait_as_long_as_the_model_says(ur, wait) -> None:
    stops = Program(
        tuple(MoveL(move.target, SPEED, FINE) for move in program(ur).moves), start=ur.start
    )
    widths = (0.04, 0.04, 0.04)
    bare = ur.controller().run(stops).timing.stamp.duration
    run = ur.controller(MotionModel(smoothing=widths, settling=wait)).run(stops)
    assert run.duration == pytest.approx(bare + 2 * min(wait, 0.12) + 0.12)
    whole = ur.controller(MotionModel(smoothing=widths)).run(stops)
    assert whole.duration == pytest.approx(bare + 3 * 0.12)
    np.testing.assert_allclose(run.trajectory.q[-1], whole.trajectory.q[-1], atol=1e-9)


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


@settings(max_examples=40, deadline=None)
@given(window=st.floats(0.003, 0.2), step=st.sampled_from([0.001, 0.002]), seed=st.integers(0, 99))
def test_an_average_at_even_knots_is_the_average_there(window, step, seed) -> None:
    """Whether the window is a whole number of steps or not, and beyond both ends of the motion."""
    rng = np.random.default_rng(seed)
    t = even_times(0.3, 0.5, step)
    q, dq = rng.normal(size=(2, len(t), 3))
    dq[[0, -1]] = 0.0
    made = averaged(JointMotion(t, q, dq, step), window, step)
    assert made.t[0] == t[0] and made.t[-1] >= t[-1] + window - 1e-12
    places, speeds, _ = JointMotion(t, q, dq).averaged(window, made.t)
    np.testing.assert_allclose(made.q, places, atol=1e-12)
    np.testing.assert_allclose(made.dq, speeds, atol=1e-9)


@settings(max_examples=40, deadline=None)
@given(
    window=st.floats(0.003, 0.2),
    every=st.integers(1, 4),
    first=st.integers(-30, 90),
    seed=st.integers(0, 99),
)
def test_an_average_at_some_of_the_even_knots_is_the_average_there(
    window, every, first, seed
) -> None:
    """Accelerations with it, and from before the motion begins to long after it has ended."""
    rng, step = np.random.default_rng(seed), 0.002
    t = even_times(0.3, 0.5, step)
    q, dq = rng.normal(size=(2, len(t), 3))
    dq[[0, -1]] = 0.0
    at = t[0] + step * (first + every * np.arange(120))
    made = JointMotion(t, q, dq, step).averaged(window, at)
    for one, other in zip(made, JointMotion(t, q, dq).averaged(window, at), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-7)


@given(begin=st.floats(0, 100), span=st.floats(0, 10), step=st.sampled_from([1e-3, 2e-3, 4e-3]))
def test_even_times_cover_a_span_with_multiples_of_their_step(begin, span, step) -> None:
    t = even_times(begin, begin + span, step)
    assert len(t) >= 2
    assert t[0] <= begin + 1e-5 * step and t[-1] >= begin + span - 1e-5 * step
    assert t[0] > begin - step and t[-1] < begin + span + 2 * step
    np.testing.assert_allclose(t / step, np.round(t / step), atol=1e-9)
