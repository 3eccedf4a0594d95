"""Best speeds along a path: as good as another solver's, within limits, with a bound that holds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from flyby.core.errors import InputError
from flyby.problems.paint.coating.coat import coat
from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.spray.footprint import ring
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.thickness.speeds import best_speeds

from .paint_cases import TARGET, bumpy, plate_case, wandering

SLOWEST, FASTEST = 0.05, 0.8


def test_the_plate_reaches_its_certified_optimum():
    deposition, trajectory = plate_case(0.25, 51)
    found = best_speeds(deposition, trajectory, TARGET, SLOWEST, FASTEST)
    after = coat(deposition, found.trajectory, TARGET)
    assert found.objective == pytest.approx(after.squared_error, rel=1e-9)
    assert 0.0 <= found.duality_gap <= 1e-6
    before = coat(deposition, trajectory, TARGET)
    assert found.objective < 0.6 * before.squared_error


@settings(max_examples=15)
@given(st.integers(0, 10_000))
def test_as_good_as_a_bounded_least_squares_solver(seed):
    deposition = Deposition(bumpy(12, seed), ring(0.2).scaled(3e-5), 2)
    trajectory = wandering(7, seed)
    found = best_speeds(deposition, trajectory, TARGET, SLOWEST, FASTEST)
    root = np.sqrt(deposition.samples.areas)
    lengths = trajectory.lengths
    scale = trajectory.duration
    other = lsq_linear(
        root[:, None] * deposition.rates(trajectory).toarray() * scale / TARGET,
        root,
        (lengths / FASTEST / scale, lengths / SLOWEST / scale),
        method="bvls",
        tol=1e-14,
    )
    best = 2.0 * other.cost * TARGET**2
    assert found.objective == pytest.approx(best, rel=1e-7)
    assert found.bound <= best * (1 + 1e-9)
    assert (found.trajectory.speeds <= FASTEST * (1 + 1e-12)).all()
    assert (found.trajectory.speeds >= SLOWEST * (1 - 1e-12)).all()


@settings(max_examples=10)
@given(st.integers(0, 10_000))
def test_the_bound_is_below_whatever_is_tried(seed):
    deposition = Deposition(bumpy(12, seed), ring(0.2).scaled(3e-5), 2)
    trajectory = wandering(7, seed)
    found = best_speeds(deposition, trajectory, TARGET, SLOWEST, FASTEST)
    rng = np.random.default_rng(seed)
    for _ in range(10):
        speeds = rng.uniform(SLOWEST, FASTEST, trajectory.segments)
        tried = trajectory.with_durations(trajectory.lengths / speeds)
        assert coat(deposition, tried, TARGET).squared_error >= found.bound


def test_time_costs_what_it_is_said_to():
    deposition, trajectory = plate_case(0.25, 31)
    free = best_speeds(deposition, trajectory, TARGET, SLOWEST, FASTEST)
    weight = 0.05 * free.objective
    hurried = best_speeds(deposition, trajectory, TARGET, SLOWEST, FASTEST, time_weight=weight)
    assert hurried.trajectory.total_duration < free.trajectory.total_duration - 0.1
    assert hurried.duality_gap <= 1e-6
    error = coat(deposition, hurried.trajectory, TARGET).squared_error
    total = error + weight * hurried.trajectory.total_duration
    assert hurried.objective == pytest.approx(total, rel=1e-9)


def test_idle_segments_keep_their_time():
    deposition, trajectory = plate_case(0.25, 21)
    flow = trajectory.flow.copy()
    flow[12:15] = 0.0
    idle = trajectory.with_flow(flow)
    found = best_speeds(deposition, idle, TARGET, SLOWEST, FASTEST)
    assert np.allclose(found.trajectory.duration[12:15], idle.duration[12:15])
    assert found.duality_gap <= 1e-6


def test_targets_out_of_reach_are_named():
    deposition, trajectory = plate_case(0.25, 11)
    limits = (0.2, 0.3)
    assert not best_speeds(deposition, trajectory, TARGET, *limits).notes
    (thin,) = best_speeds(deposition, trajectory, 2 * TARGET, *limits).notes
    assert "at the least speed of 200 mm/s along the first curve the coat is 62.5 µm" in str(thin)
    (thick,) = best_speeds(deposition, trajectory, 0.5 * TARGET, *limits).notes
    assert "at the largest speed of 300 mm/s along the first curve the coat is 41.67 µm" in str(
        thick
    )


def test_refusals():
    deposition, trajectory = plate_case(0.25, 11)
    with pytest.raises(InputError, match="slowest < fastest"):
        best_speeds(deposition, trajectory, TARGET, 0.5, 0.1)
    with pytest.raises(InputError, match="target"):
        best_speeds(deposition, trajectory, 0.0, 0.1, 0.5)
    standing = PaintTrajectory(
        np.zeros((2, 3)), np.tile((0.0, 0.0, -1.0), (2, 1)), np.ones(1), np.ones(1)
    )
    with pytest.raises(InputError, match="segment 1 has no length"):
        best_speeds(deposition, standing, TARGET, 0.1, 0.5)
