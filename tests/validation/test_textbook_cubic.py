"""The cubic problem, its misprint, and what the thesis's figures 2.3 and 2.4 show."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.sqp import check_derivatives, solve
from flyby.validation.textbook import CUBIC_OPTIMUM, CUBIC_START, barrier_path, cubic
from flyby.validation.textbook.cubic import barrier, constraints, objective

coordinate = st.floats(-6.0, 6.0)


def feasible(x: np.ndarray) -> bool:
    first, second = constraints(x)
    return bool(first <= 0.0 <= second)


@given(st.tuples(coordinate, coordinate))
def test_derivatives(x: tuple[float, float]) -> None:
    assert check_derivatives(cubic(), x).passed


def test_the_optimum_is_where_the_curves_cross() -> None:
    assert constraints(CUBIC_OPTIMUM) == pytest.approx([0.0, 0.0], abs=1e-12)
    assert objective(CUBIC_OPTIMUM) == pytest.approx(-2.28258, abs=5e-6)


def test_the_start_is_feasible_only_with_the_misprint_corrected() -> None:
    first, second = constraints(CUBIC_START)
    assert first <= 0.0 <= second
    assert not second <= 0.0  # as printed


def test_sqp_finds_the_optimum_as_fast_as_in_the_figure() -> None:
    seen = []
    result = solve(cubic(), CUBIC_START, callback=lambda at: seen.append(at.x))
    assert result.success
    assert result.x == pytest.approx(CUBIC_OPTIMUM, abs=1e-6)
    assert result.iterations <= 8
    # "even if the initial point was feasible", a step leads out of the feasible set; then quickly
    # to the optimum.
    assert feasible(seen[0]) and not all(feasible(x) for x in seen[1:4])
    assert np.abs(seen[6] - CUBIC_OPTIMUM).max() < 0.02


def test_the_barrier_path_leads_to_the_optimum_from_within() -> None:
    weights = 10.0 * 0.3 ** np.arange(9)
    path = barrier_path(weights)
    assert all(np.isfinite(barrier(x, 1.0)) for x in path)
    values = np.array([objective(x) for x in path])
    assert (np.diff(values) < 0).all()
    # To first order the optimum is exceeded by the weight for each active constraint.
    assert values[-1] - objective(CUBIC_OPTIMUM) == pytest.approx(2.0 * weights[-1], rel=0.1)


@given(st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)))
def test_barrier_minimisers_are_minimisers(step: tuple[float, float]) -> None:
    for weight, x in zip((10.0, 1.0), barrier_path((10.0, 1.0)), strict=True):
        assert barrier(x + step, weight) >= barrier(x, weight) - 1e-9


def test_the_barrier_forbids_what_the_constraints_do() -> None:
    assert barrier(np.array([1.0, 1.0]), 1.0) == np.inf
