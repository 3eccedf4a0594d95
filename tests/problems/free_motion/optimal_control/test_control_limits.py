"""Limits between nodes, waypoints, loads, costs, and what does not depend on units and frames."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.motion.model.consumption import Motors, SquaredTorque
from flyby.core.robot.inertia import Inertia
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_quaternion
from flyby.problems.free_motion.optimal_control import (
    ControlLimits,
    MotionEffort,
    MotionObjective,
    MotionTask,
    Optimum,
    SchemeKind,
    TorqueLine,
    Waypoint,
    energy_of,
    optimize,
)
from flyby.problems.free_motion.optimal_control.task.sampled import TcpSpeed

from .control_tasks import ARM, END, START, TORQUE, arm_task, cart, middle

QUICK = MotionEffort(intervals=16)
COARSE = MotionEffort(intervals=10)
LOAD = Inertia(40.0, (0.0, 0.0, 0.2))


@cache
def quickest(effort: MotionEffort) -> Optimum:
    """Of `arm_task` as it is."""
    return optimize(arm_task(), effort=effort)


def times(found: Optimum, count: int = 4001) -> FloatArray:
    return np.linspace(0.0, found.time, count)


@pytest.mark.parametrize("scheme", list(SchemeKind))
def test_limits_hold_between_nodes(scheme: SchemeKind) -> None:
    jerk = None if scheme is SchemeKind.CONSTANT else [300.0] * 6
    limits = ControlLimits(torque=TORQUE, tcp_speed=3.0, jerk=jerk)
    found = optimize(arm_task(limits=limits), effort=replace(QUICK, scheme=scheme))
    t = times(found)
    own, speed = found.limits, TcpSpeed(found.task, 1.0)
    assert (np.abs(found.torque(t)) <= own.torque * 1.001 + 1e-9).all()
    assert (np.abs(found.motion.at(t, 1)) <= own.velocity * (1 + 1e-6)).all()
    assert (np.abs(found.motion.at(t, 2)) <= own.acceleration * (1 + 1e-6)).all()
    tcp = np.linalg.norm(speed.velocity(found.motion.at(t), found.motion.at(t, 1)), axis=1)
    assert tcp.max() <= 3.0 * 1.001
    if jerk is not None:
        assert (np.abs(found.motion.at(t, 3)) <= 300.0 * (1 + 1e-4)).all()
    # They matter: the torque is used, and so is the TCP's speed.
    assert (np.abs(found.torque(t)) / own.torque).max() > 0.99
    assert tcp.max() > 2.97


def test_what_the_audit_proves_is_what_dense_samples_show() -> None:
    found = quickest(QUICK)
    dense = (np.abs(found.torque(times(found, 40_001))) / found.limits.torque).max()
    assert dense <= found.audit.torque.max() + 1e-9
    assert found.audit.torque.max() <= dense + 1e-3


def test_torque_that_falls_with_speed() -> None:
    lines = tuple(
        TorqueLine(name, 1.1 * most, 1500.0)
        for name, most in zip(ARM.axis_names[:3], TORQUE[:3], strict=True)
    )
    found = optimize(arm_task(limits=ControlLimits(torque=TORQUE, curves=lines)), effort=QUICK)
    t = times(found)
    driven = found.torque(t)[:, :3] + 1500.0 * found.motion.at(t, 1)[:, :3]
    assert (np.abs(driven) <= 1.1 * np.array(TORQUE[:3]) * 1.001).all()
    assert found.time > quickest(QUICK).time * 1.001


def test_positions_hold_between_nodes() -> None:
    """Full speed towards the end of the rail: the motion has to turn back within it."""
    robot = cart()
    joint = replace(robot.joints[0], upper=4.05)
    task = MotionTask(replace(robot, joints=(joint,)), [4.0], [3.0], start_velocity=[0.3])
    found = optimize(task, effort=MotionEffort(intervals=12))
    assert found.motion.at(times(found)).max() <= 4.05 + 1e-6


def test_waypoints_are_passed_and_stops_are_made() -> None:
    stop = Waypoint(START + 0.6 * (END - START), stop=True)
    task = MotionTask(ARM, START, END, waypoints=(middle(), stop))
    found = optimize(task, effort=COARSE)
    leg = found.motion.leg
    at = found.motion.knots[[int(np.argmax(leg == 1)), int(np.argmax(leg == 2))]]
    q, dq = found.motion.at(at), found.motion.at(at, 1)
    assert np.allclose(q, [middle().q, stop.q], atol=1e-5)
    assert np.abs(dq[0]).max() > 0.5
    assert np.abs(dq[1]).max() < 1e-5
    assert np.all(np.diff(leg) >= 0)


def test_a_load_taken_up_on_the_way_counts_from_there() -> None:
    bare = optimize(arm_task(waypoints=(middle(),)), effort=COARSE)
    task = arm_task(waypoints=(middle(),), loads=(None, LOAD))
    found = optimize(task, effort=COARSE)
    most = np.array(TORQUE) * 1.001
    assert (np.abs(found.torque(times(found))) <= most).all()
    # The motion without the load would be too much with it, on the second leg alone.
    t = times(bare)
    loaded = np.abs(replace(bare, task=task).torque(t))
    second = bare.motion.leg[bare.motion.pieces(t)] == 1
    assert (loaded[second] > most).any() and (loaded[~second] <= most).all()


def test_more_weight_on_energy_takes_longer_and_less() -> None:
    slower = [optimize(arm_task(objective=MotionObjective(w)), effort=COARSE) for w in (0.5, 0.2)]
    found = [quickest(COARSE), *slower]
    assert found[0].time < found[1].time < found[2].time
    energies = [f.energy() for f in found]
    assert energies[0] > energies[1] > energies[2]


@pytest.mark.parametrize("weight", [0.05, 0.5])
def test_energy_without_obstacles_takes_few_iterations(weight: float) -> None:
    task = arm_task(objective=MotionObjective(weight))
    found = optimize(task, effort=MotionEffort(intervals=30))
    assert found.converged and found.audit.holds(1e-3)
    assert sum(step.iterations for step in found.steps) < 120
    # No step led to slow motions, where nothing is limited and slopes vanish.
    assert all(step.candidate < 3.0 * found.time for step in found.steps)


def test_motors_that_recuperate_take_less() -> None:
    copper = (1e-4,) * 6
    burnt, given_back = Motors(copper, 0.0), Motors(copper, 0.8)
    objective = MotionObjective(0.5, given_back)
    found = optimize(arm_task(objective=objective), effort=COARSE)
    assert 0.0 < found.energy(given_back) < found.energy(burnt)
    assert found.time > quickest(COARSE).time


# What must not matter


def kinematic(seed: int) -> MotionTask:
    rng = np.random.default_rng(seed)
    lower, upper = ARM.limits.lower, ARM.limits.upper
    ends = lower + (upper - lower) * rng.uniform(0.2, 0.8, (2, 6))
    return MotionTask(ARM, ends[0], ends[1])


@settings(max_examples=4, deadline=None)
@given(st.integers(0, 1000), st.floats(0.5, 3.0))
def test_scaled_limits_scale_time(seed: int, s: float) -> None:
    task = kinematic(seed)
    own = ARM.limits
    limits = ControlLimits(velocity=own.velocity * s, acceleration=own.acceleration * s**2)
    plain = optimize(task, effort=MotionEffort(intervals=16))
    scaled = optimize(replace(task, limits=limits), effort=MotionEffort(intervals=16))
    assert scaled.time == pytest.approx(plain.time / s, rel=1e-4)


@settings(max_examples=4, deadline=None)
@given(st.integers(0, 1000))
def test_the_way_back_takes_as_long(seed: int) -> None:
    task = kinematic(seed)
    back = replace(task, start=task.end, end=task.start)
    there, again = (optimize(t, effort=MotionEffort(intervals=16)) for t in (task, back))
    assert again.time == pytest.approx(there.time, rel=1e-4)
    # A motion driven backwards is one of the way back, and uses the same torques.
    turned = there.motion.reversed()
    t = np.linspace(0.0, there.time, 50)
    assert np.allclose(turned.at(t), there.motion.at(there.time - t), atol=1e-9)
    # What one gives back the other takes: heat is left of both.
    motors, heat = Motors((1e-4,) * 6, 1.0), SquaredTorque((1e-4,) * 6)
    both = energy_of(back, turned, motors) + energy_of(task, there.motion, motors)
    assert both == pytest.approx(2 * energy_of(task, there.motion, heat), rel=1e-5, abs=1e-3)


@settings(max_examples=3, deadline=None)
@given(st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi))
def test_the_world_may_be_turned(about_z: float, about_x: float) -> None:
    z = np.array([math.cos(about_z / 2), 0.0, 0.0, math.sin(about_z / 2)])
    x = np.array([math.cos(about_x / 2), math.sin(about_x / 2), 0.0, 0.0])
    turn = matrix_from_quaternion(z) @ matrix_from_quaternion(x)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, (0.3, -2.0, 1.0)
    gravity = tuple(float(v) for v in turn @ np.array(ARM.gravity))
    moved = ARM.with_base(Pose.from_matrix(matrix)).with_gravity(
        (gravity[0], gravity[1], gravity[2])
    )
    limits = ControlLimits(torque=TORQUE)
    found = optimize(MotionTask(moved, START, END, limits=limits), effort=QUICK)
    assert found.time == pytest.approx(quickest(QUICK).time, rel=1e-3)


def test_still_joints_stay() -> None:
    ends = np.array([START, START])
    ends[1, [1, 2]] += 0.7
    found = optimize(MotionTask(ARM, ends[0], ends[1], joints=(1, 2)), effort=QUICK)
    trajectory = found.trajectory(0.01)
    assert np.allclose(trajectory.q[:, [0, 3, 4, 5]], START[[0, 3, 4, 5]])
    assert np.allclose(trajectory.q[-1], ends[1], atol=1e-6)
    assert trajectory.duration == pytest.approx(found.time)


def test_interrupted_searches_keep_their_best() -> None:
    seen: list[float] = []

    def enough(step: object) -> bool:
        seen.append(0.0)
        return True

    found = optimize(arm_task(), effort=QUICK, report=enough)
    assert not found.converged and len(seen) == 1
    assert found.audit.holds(QUICK.tolerance)
    assert found.notes
