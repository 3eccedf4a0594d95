"""Derivatives of the transcription against difference quotients, and bounds against samples."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.motion.model.consumption import SQUARED_TORQUE, Consumption, Motors
from flyby.core.robot.inertia import Inertia
from flyby.core.spatial.pose import Pose
from flyby.core.sqp import NLP
from flyby.problems.free_motion.optimal_control import (
    ControlLimits,
    Motion,
    MotionObjective,
    MotionTask,
    SchemeKind,
    TorqueLine,
)
from flyby.problems.free_motion.optimal_control.motion.first_guess import (
    Guess,
    Polyline,
    first_guess,
)
from flyby.problems.free_motion.optimal_control.motion.scheme import Scheme, bernstein
from flyby.problems.free_motion.optimal_control.search.refinement import refined
from flyby.problems.free_motion.optimal_control.task.limits import MotionLimits
from flyby.problems.free_motion.optimal_control.task.sampled import Plant, State, TcpSpeed
from flyby.problems.free_motion.optimal_control.task.torque_bounds import BendBounds
from flyby.problems.free_motion.optimal_control.transcription.transcription import (
    Bounds,
    Transcription,
)

from .control_tasks import ARM, END, START, TORQUE, arm_task, middle

LOAD = Inertia(30.0, (0.0, 0.0, 0.2), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.5)))
STEP = 1e-6


def everything(scheme: SchemeKind) -> MotionTask:
    jerk = None if scheme is SchemeKind.CONSTANT else [200.0] * 6
    limits = ControlLimits(
        torque=TORQUE, tcp_speed=2.0, jerk=jerk, curves=(TorqueLine("J2", 5000.0, 500.0),)
    )
    objective = MotionObjective(0.5, Motors((1e-4,) * 6, 0.3), smoothing=0.2)
    return arm_task(
        waypoints=(middle(),),
        loads=(None, LOAD),
        limits=limits,
        objective=objective,
        start_velocity=[0.1] * 6,
        tcp=Pose((0.1, 0.0, 0.3)),
    )


def program(
    task: MotionTask, scheme: SchemeKind, group: int | None, indefinite: bool = False
) -> tuple[Guess, NLP]:
    limits, plant = MotionLimits.of(task), Plant(task)
    line = Polyline.direct(task)
    guess = first_guess(task, limits, plant, line, Scheme(scheme), 8, group)
    made = Transcription(task, limits, guess.layout, guess.scale, 10.0, plant, None, indefinite)
    points = guess.layout.points
    bounds = Bounds(np.tile(limits.lower, (points, 1)), np.tile(limits.upper, (points, 1)))
    return guess, made.nlp(bounds)


@pytest.mark.parametrize("group", [None, 1])
@pytest.mark.parametrize("scheme", list(SchemeKind))
def test_derivatives(scheme: SchemeKind, group: int | None) -> None:
    guess, nlp = program(everything(scheme), scheme, group, indefinite=True)
    rng = np.random.default_rng(3)
    x = guess.x + 1e-3 * rng.standard_normal(len(guess.x))
    way, y = rng.standard_normal(len(x)), rng.standard_normal(nlp.m)
    up, down = x + STEP * way, x - STEP * way
    _agree(nlp.jacobian(x) @ way, (nlp.constraints(up), nlp.constraints(down)))
    _agree(nlp.gradient(x) @ way, (nlp.objective(up), nlp.objective(down)))

    def slope(z: FloatArray) -> FloatArray:
        return np.asarray(nlp.gradient(z) + nlp.jacobian(z).T @ y)

    H = nlp.hessian(x, 1.0, y)
    assert abs(H - H.T).max() <= 1e-9 * abs(H).max()
    _agree(H @ way, (slope(up), slope(down)), 1e-4)


def _agree(exact: object, sides: tuple[object, object], share: float = 1e-6) -> None:
    numeric = (np.asarray(sides[0]) - np.asarray(sides[1])) / (2 * STEP)
    size = max(1e-2, float(np.abs(numeric).max()))
    assert float(np.abs(np.asarray(exact) - numeric).max()) <= share * size


@pytest.mark.parametrize("consumption", [SQUARED_TORQUE, Motors((1e-4,) * 6)], ids=str)
def test_the_hessian_that_is_used_is_convex_on_a_fixed_grid(consumption: Consumption) -> None:
    task = arm_task(objective=MotionObjective(0.5, consumption))
    guess, nlp = program(task, SchemeKind.LINEAR, None)
    y = np.abs(np.random.default_rng(1).standard_normal(nlp.m))
    hessian = nlp.hessian(guess.x, 1.0, y).toarray()
    assert np.linalg.eigvalsh(hessian).min() >= -1e-8
    assert np.abs(hessian - nlp.hessian(guess.x, 0.0, y).toarray()).max() > 1e-3


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=6))
def test_bernstein_coefficients_bound_a_polynomial(values: list[float]) -> None:
    u = np.linspace(0, 1, 50)
    hull = bernstein(np.array(values))
    found = np.polynomial.polynomial.polyval(u, values)
    assert hull.min() - 1e-9 <= found.min() and found.max() <= hull.max() + 1e-9
    assert hull[0] == pytest.approx(found[0]) and hull[-1] == pytest.approx(found[-1], abs=1e-9)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(list(SchemeKind)))
def test_a_finer_grid_holds_the_same_motion(seed: int, scheme: SchemeKind) -> None:
    task = arm_task(waypoints=(middle(),))
    guess = first_guess(
        task, MotionLimits.of(task), None, Polyline.direct(task), Scheme(scheme), 10, None
    )
    rng = np.random.default_rng(seed)
    parts = rng.integers(1, 4, len(guess.layout.grid))
    stretched = guess.x.copy()
    stretched[0] = rng.uniform(0.5, 2.0)
    coarse = dataclasses.replace(guess, x=stretched)
    fine = refined(task, coarse, parts)
    t = np.linspace(0, coarse.motion.duration, 301)[1:-1] + 1e-7
    for order in range(3):
        assert np.allclose(coarse.motion.at(t, order), fine.motion.at(t, order), atol=1e-6)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_bends_of_torques_and_of_the_tcp_are_bounded(seed: int) -> None:
    rng = np.random.default_rng(seed)
    coefficients = rng.standard_normal((1, 4, 6)) * np.array([1.0, 0.5, 0.3, 0.2])[None, :, None]
    motion = Motion(np.array([0.0, 0.5]), coefficients, np.zeros(1, dtype=np.int64))
    tcp = Pose((0.1, 0.0, 0.3))
    task = MotionTask(ARM, START, END, loads=(LOAD,), tcp=tcp)
    rates = np.zeros((1, 6, 5))
    for order in range(5):
        shares = bernstein(np.moveaxis(motion.differentiated(order), 1, 0))
        rates[0, :, order] = np.abs(shares[:, 0]).max(axis=0)
    bounds = BendBounds(ARM, LOAD, tcp, rates)
    step = 1e-3
    t = np.linspace(2 * step, 0.5 - 2 * step, 40)
    plant, speed = Plant(task), TcpSpeed(task, 1.0)

    def torque(at: FloatArray) -> FloatArray:
        q, dq, ddq = (motion.at(at, k) for k in range(3))
        return plant.torques(State(q, dq, ddq, np.zeros(len(at), dtype=np.int64)))

    def velocity(at: FloatArray) -> FloatArray:
        return speed.velocity(motion.at(at), motion.at(at, 1))

    for function, bound in ((torque, bounds.torques()[0]), (velocity, bounds.tcp()[0])):
        bend = (function(t + step) - 2 * function(t) + function(t - step)) / step**2
        if function is velocity:
            bend = np.linalg.norm(bend, axis=1)[:, None]
        assert (np.abs(bend).max(axis=0) <= bound * (1 + 1e-3) + 1e-3).all()
