"""Comparing a log with an emulated motion, on motions whose distance is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.controller import Controller
from flyby.core.motion.model import MotionModel
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.identification.comparison import compare, distance_to_polyline, moving_time
from flyby.identification.corners import measure_corner

HOME = np.array([0.2, -1.4, -1.8, -1.4, 1.5, 0.3])
LEG, RADIUS = 0.2, 0.05


@pytest.fixture(scope="module")
def run():
    robot = find_robot("ur/ur10e")
    at = robot.flange_pose(HOME)

    def there(*offset):
        return PoseTarget(Pose(tuple(np.array(at.position) + offset), at.quaternion))

    speed = Speed(tcp=0.1)
    moves = (MoveL(there(LEG, 0, 0), speed, Radius(RADIUS)), MoveL(there(LEG, LEG, 0), speed, FINE))
    program = Program(moves, start=JointTarget(tuple(HOME)))
    return Controller(find_vendor("ur"), robot, MotionModel()).run(program)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), off=st.floats(0, 0.1))
def test_distance_to_a_polyline(seed, off) -> None:
    rng = np.random.default_rng(seed)
    line = np.stack([np.linspace(0, 1, 40), np.zeros(40), np.zeros(40)], -1)
    points = np.stack([rng.uniform(0, 1, 20), np.full(20, off), np.zeros(20)], -1)
    np.testing.assert_allclose(distance_to_polyline(points, line), off, atol=1e-12)
    held = np.repeat(line, 3, axis=0)  # standing still adds nothing
    np.testing.assert_allclose(distance_to_polyline(points, held), off, atol=1e-12)
    beyond = np.array([[1.3, 0.0, 0.4]])
    assert distance_to_polyline(beyond, line)[0] == pytest.approx(0.5)


def test_a_motion_compared_with_itself(run) -> None:
    motion = run.trajectory
    found = compare(find_robot("ur/ur10e"), FLANGE, motion.t, motion.q, motion)
    assert found.deviation.max() < 1e-9
    assert found.cycle_time_ratio == 1.0
    assert max(found.start, found.end) < 1e-9


@settings(max_examples=10, deadline=None)
@given(shift=st.floats(-0.01, 0.01), stretch=st.floats(0.5, 2.0), lead=st.floats(0, 1))
def test_a_turned_and_stretched_log(run, shift, stretch, lead) -> None:
    """Joint 1 turned by a known angle; a wait before the motion does not count."""
    motion, robot = run.trajectory, find_robot("ur/ur10e")
    q = motion.q + shift * np.eye(6)[0]
    t = np.concatenate([[-lead - 0.01], stretch * motion.t])
    found = compare(robot, FLANGE, t, np.concatenate([q[:1], q]), motion)
    reach = np.linalg.norm(motion.position[:, :2], axis=1).max()
    assert found.deviation.max() <= 2 * np.sin(abs(shift) / 2) * reach + 1e-9
    first = np.linalg.norm(motion.position[0, :2])
    assert found.start == pytest.approx(2 * np.sin(abs(shift) / 2) * first, abs=1e-9)
    assert found.cycle_time_ratio == pytest.approx(1 / stretch, rel=1e-9)


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


def test_a_stationary_tool_is_refused(run) -> None:
    motion = run.trajectory
    with pytest.raises(InputError, match="stationary"):
        still = Tool("gun", robot_held=False)
        compare(find_robot("ur/ur10e"), still, motion.t, motion.q, motion)


def test_the_corner_of_a_parabola(run) -> None:
    motion = run.trajectory
    begin = motion.position[0]
    points = np.array([begin, begin + LEG * np.eye(3)[0], begin + LEG * np.array([1, 1, 0])])
    corner = measure_corner(motion.t, motion.position, points, 1.2 * RADIUS)
    apex = 0.5 * RADIUS * np.sin(np.pi / 4)
    assert corner.apex == pytest.approx(apex, abs=1e-5)
    assert 0.85 * RADIUS < corner.entry < RADIUS
    assert 0.85 * RADIUS < corner.exit < RADIUS
    # The legs outside the zone, and the parabola 1 + asinh(1)/√2 radii long.
    length = RADIUS * (2 * 0.2 + 1 + np.arcsinh(1) / np.sqrt(2))
    assert corner.duration == pytest.approx(length / 0.1, rel=0.02)
    line = np.linspace(0, 1, 201)[:, None] * np.array([1.0, 0.0, 0.0])
    plain = measure_corner(np.linspace(0, 1, 201), line, line[[0, 100, 200]], 0.1)
    assert (plain.apex, plain.entry, plain.exit) == pytest.approx((0, 0, 0), abs=1e-12)
    with pytest.raises(InputError, match="away from the waypoint"):
        measure_corner(motion.t, motion.position, points + 1.0, RADIUS)
