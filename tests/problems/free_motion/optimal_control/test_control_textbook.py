"""Optimal motions that are known from elsewhere."""

from __future__ import annotations

import math

import pytest

from flyby.problems.free_motion.optimal_control import (
    ControlLimits,
    MotionEffort,
    MotionObjective,
    MotionTask,
    SchemeKind,
    optimize,
)
from flyby.validation.textbook.double_integrator import minimum_time

from .control_tasks import cart, strong_swing_up, swing_up, weak_swing_up

ALL = list(SchemeKind)


@pytest.mark.parametrize("scheme", ALL)
def test_double_integrator(scheme: SchemeKind) -> None:
    task = MotionTask(cart(), [4.0], [0.0], start_velocity=[1.0])
    exact = minimum_time(4.0, 1.0).time
    found = optimize(task, effort=MotionEffort(intervals=40, scheme=scheme))
    assert exact - 1e-6 <= found.time <= exact * 1.001


@pytest.mark.parametrize("scheme", ALL)
def test_a_free_grid_finds_the_switch(scheme: SchemeKind) -> None:
    task = MotionTask(cart(), [4.0], [0.0], start_velocity=[1.0])
    exact = minimum_time(4.0, 1.0).time
    found = optimize(task, effort=MotionEffort(intervals=16, scheme=scheme, group=1))
    assert exact - 1e-6 <= found.time <= exact * (1 + 1e-4)


def test_double_integrator_by_torque_is_that_by_acceleration() -> None:
    limits = ControlLimits(acceleration=[math.inf], torque=[1.0])
    by_torque = MotionTask(cart(), [4.0], [0.0], start_velocity=[1.0], limits=limits)
    by_rise = MotionTask(cart(), [4.0], [0.0], start_velocity=[1.0])
    times = [
        optimize(task, effort=MotionEffort(intervals=30)).time for task in (by_torque, by_rise)
    ]
    assert times[0] == pytest.approx(times[1], rel=1e-5)


@pytest.mark.parametrize("scheme", ALL)
def test_rest_to_rest_with_a_velocity_limit(scheme: SchemeKind) -> None:
    """d / v + v / a = 3 / 1 + 1 / 2."""
    task = MotionTask(cart(acceleration=2.0, velocity=1.0), [0.0], [3.0])
    found = optimize(task, effort=MotionEffort(intervals=42, scheme=scheme))
    assert 3.5 - 1e-5 <= found.time <= 3.5 * 1.002
    assert found.audit.velocity.max() <= 1.0 + 1e-6


def test_rest_to_rest_with_a_jerk_limit() -> None:
    """(32 d / j)^(1/3): four stretches of full jerk, +, −, −, +."""
    limits = ControlLimits(acceleration=[1e3], jerk=[6.0])
    task = MotionTask(cart(acceleration=1e3, velocity=1e3), [0.0], [1.5], limits=limits)
    found = optimize(task, effort=MotionEffort(intervals=48))
    # Acceleration is free at both ends: full jerk of one sign, then of the other one, and back.
    assert found.audit.jerk.max() <= 1.0 + 1e-4
    assert found.time <= (32 * 1.5 / 6.0) ** (1 / 3)


def test_least_squared_force_in_a_given_time() -> None:
    """q = d (3 s² − 2 s³): the force falls linearly from 6 d / T², and ∫ u² dt = 12 d² / T³."""
    cost = MotionObjective(0.0, longest=2.0)
    task = MotionTask(cart(acceleration=50.0), [0.0], [3.0], objective=cost)
    found = optimize(task, effort=MotionEffort(intervals=20))
    assert found.time == pytest.approx(2.0, rel=1e-6)
    assert found.energy() == pytest.approx(12 * 3.0**2 / 2.0**3, rel=1e-3)


@pytest.mark.parametrize("scheme", [SchemeKind.LINEAR, SchemeKind.HERMITE_SIMPSON])
def test_swing_up_with_torque_to_spare(scheme: SchemeKind) -> None:
    exact = strong_swing_up(15.0)
    found = optimize(swing_up(15.0), effort=MotionEffort(intervals=60, scheme=scheme))
    assert found.time == pytest.approx(exact, rel=1e-3)
    assert found.audit.torque_violation <= 1e-3


def test_swing_up_that_needs_a_run_up() -> None:
    found = optimize(
        swing_up(5.0), effort=MotionEffort(intervals=60, scheme=SchemeKind.HERMITE_SIMPSON)
    )
    exact = weak_swing_up(5.0, (0.72, 1.98), 2.386)
    assert found.time == pytest.approx(exact, rel=1e-3)
    # It swings away first.
    assert found.motion.at(found.motion.knots).min() < -0.2
