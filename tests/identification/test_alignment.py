"""A log laid on the emulated motion of its program: clock, path, and what does not belong."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.spatial.pose import Pose
from flyby.identification.alignment import align, moving_time
from flyby.identification.compatibility import check_coverage, check_limits, check_path
from flyby.identification.logs.cleaning import clean_samples
from flyby.identification.matching import COARSE, match
from flyby.identification.residuals import figures, residuals

from .faulty_logs import HOME, PERIOD, ROBOT, emulated, faulty, joints, program


@pytest.fixture(scope="module")
def run():
    return emulated(program())


@pytest.fixture(scope="module")
def other():
    return emulated(program(leg=-0.25, radius=0.02))


def aligned(run, t, q):
    log = clean_samples(t, q)
    found = align(ROBOT, run.trajectory, log)
    return log, found, residuals(ROBOT, FLANGE, run.trajectory, log, found)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10**6), shift=st.floats(-50, 1e5))
def test_offset_and_path_of_a_faulty_log(run, seed, shift) -> None:
    """The faults are known, so what is left must be the noise, and the clock what it was set to."""
    made = faulty(run, seed)
    log, found, rest = aligned(run, made.t + shift, made.q)
    seen = figures(ROBOT, rest, found)
    assert seen.offset == pytest.approx(shift, abs=2e-4)
    assert abs(seen.drift) < 5e-4
    assert seen.joint_path_p99 < 5e-5
    # Two torn samples side by side may hide each other: they are off by up to a cycle's way.
    assert seen.path_max < 0.25 * PERIOD
    assert seen.path_p99 < 5e-5
    # The moments themselves are stamped with 1 ms of jitter, but the stamps are true.
    assert seen.joint_time_p99 < 2e-4
    assert seen.cycle_time_ratio == pytest.approx(1.0, abs=0.02)
    assert not set(log.torn) & set(found.rows)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10**6), drift=st.floats(-0.1, 0.1), shift=st.floats(-5, 5))
def test_drift_of_the_clock(run, seed, drift, shift) -> None:
    made = faulty(run, seed)
    _, found, rest = aligned(run, (1 + drift) * made.t + shift, made.q)
    assert found.drift == pytest.approx(drift, abs=2e-4)
    assert found.cycle_time_ratio == pytest.approx(1 / (1 + drift), rel=0.02)
    seen = figures(ROBOT, rest, found)
    assert seen.joint_path_p99 < 5e-5
    # Less drift, nothing of it is left.
    assert seen.joint_clock_p99 < 3e-4
    assert found.origin == pytest.approx(shift, abs=1e-3)
    # A constant offset leaves half the drift at either end, at most.
    middle = 0.5 * run.trajectory.duration
    assert found.offset == pytest.approx(shift + drift * middle, abs=abs(drift) * middle + 1e-3)


def test_what_comes_before_and_after_plays_no_part(run) -> None:
    made = faulty(run, 5)
    before = HOME + np.linspace(0.6, 0, 100)[:, None] * np.ones(6)
    after = HOME - np.linspace(0, 0.5, 100)[:, None] * np.ones(6)
    t = np.concatenate(
        [made.t[0] - 0.008 * np.arange(100, 0, -1), made.t, made.t[-1] + 0.008 * np.arange(1, 101)]
    )
    _, plain, one = aligned(run, made.t, made.q)
    _, found, two = aligned(run, t, np.concatenate([before, made.q, after]))
    assert found.offset == pytest.approx(plain.offset, abs=1e-5)
    assert found.logged_moving == pytest.approx(plain.logged_moving, abs=0.03)
    assert two.path.max() < 2 * one.path.max() + 1e-4


def test_a_turned_joint_is_seen_in_the_path(run) -> None:
    made = faulty(run, 7, torn=0)
    _, found, rest = aligned(run, made.t, made.q + 1e-3 * np.eye(6)[0])
    # Of the turn what lies along the path of joints is a matter of time.
    off = np.linalg.norm(rest.joint_path, axis=1)
    assert 0.5e-3 < np.median(off) <= 1.05e-3
    reach = np.linalg.norm(rest.tcp[:, :2], axis=1).max()
    assert 0.1e-3 * reach < rest.path.max() <= 1.05e-3 * reach + 1e-4
    assert (np.diff(rest.arc) > -1e-3).all()
    assert found.rows[0] < 60


def test_a_tool_that_stands_still_is_measured_at_the_flange(run) -> None:
    made = faulty(run, 9, torn=0)
    log, found, rest = aligned(run, made.t, made.q)
    still = Tool("gun", Pose((0, 0, 0.3)), robot_held=False)
    same = residuals(ROBOT, still, run.trajectory, log, found)
    np.testing.assert_array_equal(same.path, rest.path)
    held = residuals(ROBOT, Tool("pen", Pose((0, 0, 0.3))), run.trajectory, log, found)
    assert np.linalg.norm(held.tcp - rest.tcp, axis=1) == pytest.approx(0.3)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6), count=st.integers(2, 60))
def test_samples_of_a_path_lie_on_it_in_order(seed, count) -> None:
    """Any polyline, back and forth as well: its own points are matched to their own moments, but
    for single ones that are nearer to a knot of another stretch."""
    rng = np.random.default_rng(seed)
    line = np.cumsum(rng.normal(size=(8, 3)), axis=0)
    t = np.sort(rng.uniform(0, 1, 8)) + np.arange(8)
    time = np.sort(np.concatenate([[t[0], t[-1]], rng.uniform(t[0], t[-1], count)]))
    q = np.stack([np.interp(time, t, column) for column in line.T], -1)
    found = match(t, line, q)
    assert found.distance.max() <= 0.5 * found.length / COARSE
    right = np.abs(found.time - time) < 1e-6
    assert right.mean() >= 0.8
    assert found.distance[right].max() < 1e-9
    assert found.length == pytest.approx(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


@settings(max_examples=30, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    noise=st.floats(0.0, 1e-4),
    apart=st.floats(-1e-4, 1e-4),
    rest=st.integers(0, 60),
)
def test_a_way_back_is_told_from_the_way_there(
    seed: int, noise: float, apart: float, rest: int
) -> None:
    """By the order alone: noise, and a robot that is a little off the path, are more than what the
    two ways lie apart."""
    t = np.linspace(0.0, 4.0, 2001)
    course = 0.5 - 0.5 * np.cos(np.pi * t)  # there, back, there, back
    path = course[:, None] * np.array([1.0, -0.4, 0.2])
    stamps = np.linspace(0.0, 4.0, 701)
    stamps = np.insert(stamps, 200, np.full(rest, stamps[200]))  # it stands somewhere
    q = np.column_stack([np.interp(stamps, t, column) for column in path.T])
    q += noise * np.random.default_rng(seed).normal(size=q.shape) + apart * np.array([0.4, 1.0, 0])
    found = match(t, path, q)
    moving = np.abs(np.sin(np.pi * stamps)) > 0.1
    assert np.abs(found.time - stamps)[moving].max() < 2e-3


# What does not belong


def refused(run, t, q) -> str:
    with pytest.raises(InputError) as error:
        aligned(run, t, q)
    return str(error.value)


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_units_that_were_mistaken_are_named(run, seed) -> None:
    made = faulty(run, seed)
    assert "joints are in degrees" in refused(run, made.t, np.degrees(made.q))
    assert "were taken for degrees" in refused(run, made.t, np.radians(made.q))
    assert "log's time in ms?" in refused(run, 1e3 * made.t, made.q)
    assert "log's time in s?" in refused(run, 1e-3 * made.t, made.q)


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 10**6), share=st.floats(0.1, 0.85))
def test_a_log_that_is_shorter_than_the_program(run, seed, share) -> None:
    made = faulty(run, seed, rest=0.0)
    cut = int(share * len(made.t))
    assert "shorter than the program" in refused(run, made.t[:cut], made.q[:cut])
    assert "began late" in refused(run, made.t[-cut:], made.q[-cut:])


def test_another_program_or_robot(run, other) -> None:
    made = faulty(other, 1)
    assert "does not follow this program" in refused(run, made.t, made.q)
    assert "another robot, program, start or tool" in refused(run, made.t, made.q + 1.0)
    assert "wrong robot" in refused(run, made.t, np.hstack([made.q, made.q[:, :1]]))


def test_a_log_that_leaves_out_a_part() -> None:
    """There and back and on; the other log begins where the path comes back."""
    course = np.concatenate([np.linspace(0, 1, 300), np.linspace(1, -1, 600)])
    path = course[:, None] * np.ones(6)
    motion = SimpleNamespace(t=np.arange(900.0), q=path)
    whole, late = path[::3], np.vstack([path[:1], path[603::3]])
    check_coverage(motion, whole, match(motion.t, path, whole), 0, len(whole) - 1)
    with pytest.raises(InputError, match=r"from 0 to 6. % .* within one sample"):
        check_coverage(motion, late, match(motion.t, path, late), 0, len(late) - 1)


def test_columns_in_another_order_are_named(run) -> None:
    made = faulty(run, 5)
    for one, other in ((0, 1), (2, 4)):
        q = made.q.copy()
        q[:, [one, other]] = q[:, [other, one]]
        names = f"{ROBOT.axis_names[one]} and {ROBOT.axis_names[other]}"
        assert f"it fits if the columns of {names} are exchanged" in refused(run, made.t, q)


def test_a_log_that_hardly_moves_near_the_path_is_none_in_degrees() -> None:
    """Joints off the path, which passes through zero."""
    t = np.linspace(0.0, 4.0, 1000)
    path = np.linspace(-1.2, 1.2, 1000)[:, None] * np.ones(6)
    q = path + np.array([0.5, -0.5, 0.5, -0.5, 0.5, -0.5])
    with pytest.raises(InputError) as error:
        check_path(ROBOT, SimpleNamespace(t=t, q_motor=path), q, match(t, path, q), slice(0, 1000))
    assert "degrees" not in str(error.value)


def test_joints_beyond_the_limits(run) -> None:
    made = faulty(run, 4)
    check_limits(ROBOT, made.q)
    with pytest.raises(InputError, match=r"seem to be in degrees"):
        check_limits(ROBOT, np.degrees(made.q))
    with pytest.raises(InputError, match=r"elbow reaches -1e.04.*wrong robot"):
        check_limits(ROBOT, made.q + np.array([0, 0, -1e4, 0, 0, 0]))
    some = made.q.copy()
    some[::50] += 1e3
    check_limits(ROBOT, some)  # wild samples are no reason


@pytest.mark.parametrize("axis", [0, 2, 4])
def test_an_axis_that_counts_otherwise_is_named(run, axis) -> None:
    made, name = faulty(run, 2), ROBOT.axis_names[axis]
    shifted, flipped = made.q.copy(), made.q.copy()
    shifted[:, axis] -= np.pi / 2
    flipped[:, axis] *= -1
    assert f"it fits if {name} counts from 90° instead of 0" in refused(run, made.t, shifted)
    if np.abs(made.q[:, axis]).min() > 0.3:
        message = refused(run, made.t, flipped)
        assert name in message and "it fits if" in message


def test_a_robot_that_stands(run) -> None:
    t = np.arange(0, 2, 0.008)
    assert "no motion" in refused(run, t, np.tile(joints(run, np.zeros(1)), (len(t), 1)))


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000))
def test_noise_at_rest_is_no_motion(seed) -> None:
    rng = np.random.default_rng(seed)
    t = np.arange(0, 3, 0.008)
    q = np.clip(t - 1, 0, 1)[:, None] * np.ones(6)
    noisy = q + rng.uniform(-3e-5, 3e-5, q.shape)
    assert moving_time(t, noisy) == pytest.approx(1.0, abs=0.02)
    with pytest.raises(InputError, match="stays within"):
        moving_time(t, noisy[:1] + rng.uniform(-3e-5, 3e-5, q.shape))
