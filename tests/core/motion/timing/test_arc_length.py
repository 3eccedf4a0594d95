"""Zones whose law is flat at its ends are stamped over a parameter that runs evenly."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.blend import PARABOLA, Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.path.tcp_samples import States
from flyby.core.motion.timing.timing import along_path
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

SECOND = Blend(alpha=(0, 0, 0, 10, -15, 6))
FAST = Speed(tcp=7.0, reorientation=20.0)


def model(law: Blend) -> MotionModel:
    return MotionModel(tcp=law, joint=law, orientation=law)


def joint_program(arm, radius) -> Program:
    zone = Radius(radius)
    ends = ([0.3, 0.2, 0, 0, 0, 0], [0.5, -0.2, 0.2, 0, 0.1, 0], [0.9, 0.1, 0, 0, 0.3, 0])
    zones = (zone, zone, FINE)
    moves = (MoveJ(arm.joints(q), FAST, z) for q, z in zip(ends, zones, strict=True))
    return Program(tuple(moves), start=arm.start)


def tcp_program(arm, radius) -> Program:
    zone = Radius(radius)
    ends = (((1, 0, 0), zone), ((1, 1, 0), zone), ((0, 1.5, 0.5), FINE))
    return Program(tuple(MoveL(arm.target(p), FAST, z) for p, z in ends), start=arm.start)


PROGRAMS = {"joint": joint_program, "tcp": tcp_program}


@pytest.mark.parametrize("kind", sorted(PROGRAMS))
def test_the_default_sampling_finds_the_time(arm, kind) -> None:
    program = PROGRAMS[kind](arm, 0.4 * arm.leg)
    controller = arm.controller(model(SECOND))
    coarse = controller.run(program).duration
    controller.sampling = Sampling(step=0.005, joint=0.01, blend=48, halvings=14)
    fine = controller.run(program).duration
    assert fine == pytest.approx(coarse, rel=0.01)


@pytest.mark.parametrize("kind", sorted(PROGRAMS))
def test_rates_are_even_in_zones(arm, kind) -> None:
    run = arm.controller(model(SECOND)).run(PROGRAMS[kind](arm, 0.3 * arm.leg))
    along, path = run.timing.along, run.path
    assert len(along.zones) == 2
    for first, last, joint in along.zones:
        rows = slice(first, last + 1)

        def size(states: States, rows=rows, joint=joint):
            if joint:
                return np.linalg.norm(states.dq[rows] * np.sqrt(along.weights), axis=1)
            turn = np.linalg.norm(states.v[rows, 3:], axis=1)
            return np.hypot(np.linalg.norm(states.v[rows, :3], axis=1), 0.1 * turn)

        after, before = size(along.states), size(path.states)
        even = np.linspace(0.0, 1.0, len(after)) * (after[-1] - after[0]) + after[0]
        assert (np.abs(after / even - 1) < np.abs(before / even - 1).max()).all()
        assert np.ptp(after) < 0.5 * np.ptp(before)
        assert along.rate[first] == pytest.approx(1.0)
        assert along.rate[last] == pytest.approx(1.0)


def test_the_parabola_keeps_its_parameter(arm) -> None:
    run = arm.controller(model(PARABOLA)).run(joint_program(arm, 0.3 * arm.leg))
    assert len(run.timing.along.zones) == 0
    np.testing.assert_array_equal(run.timing.along.states.dq, run.path.states.dq)
    left = run.path.pieces.interval_samples
    np.testing.assert_array_equal(run.timing.along.spacing, np.diff(run.path.sigma)[left])


@pytest.mark.parametrize("kind", sorted(PROGRAMS))
def test_sigma_passes_every_sample_at_its_time(arm, kind) -> None:
    run = arm.controller(model(SECOND)).run(PROGRAMS[kind](arm, 0.3 * arm.leg))
    left = run.path.pieces.interval_samples
    q, sigma = run.timing.states_at(run.timing.begin)[0], run.timing.place_at(run.timing.begin)
    np.testing.assert_allclose(sigma, run.path.sigma[left], atol=1e-9)
    np.testing.assert_allclose(q, run.path.q[left], atol=1e-9)
    times = np.linspace(0.0, run.duration, 2000)
    assert (np.diff(run.timing.place_at(times)) >= -1e-12).all()


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**31 - 1), kind=st.sampled_from(sorted(PROGRAMS)))
def test_reverse_equals_differences(arm, seed, kind) -> None:
    rng = np.random.default_rng(seed)
    path = arm.controller(model(SECOND)).plan(PROGRAMS[kind](arm, 0.3 * arm.leg))
    limits = arm.robot.limits.acceleration
    along = along_path(path, limits)
    bar = States(*(rng.normal(size=array.shape) for array in path.states))
    spacing_bar = rng.normal(size=len(along.spacing))
    change = States(*(rng.normal(size=array.shape) for array in path.states))

    def value(step: float) -> float:
        for array, direction in zip(path.states, change, strict=True):
            array += step * direction
        found = along_path(path, limits)
        total = sum(float(np.sum(b * a)) for b, a in zip(bar, found.states, strict=True))
        for array, direction in zip(path.states, change, strict=True):
            array -= step * direction
        return total + float(spacing_bar @ found.spacing)

    step = 1e-6
    expected = (value(step) - value(-step)) / (2 * step)
    copied = States(*(array.copy() for array in bar))
    pulled = along.pull(
        path.pieces, path.sigma, path.states, copied, spacing_bar, np.zeros(len(path.sigma))
    )
    got = sum(float(np.sum(p * c)) for p, c in zip(pulled, change, strict=True))
    assert got == pytest.approx(expected, rel=1e-5, abs=1e-3)
