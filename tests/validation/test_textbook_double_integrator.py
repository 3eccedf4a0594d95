"""The double integrator: derivatives, known optima, and the exact answer as the limit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.sqp import check_derivatives, solve
from flyby.validation.textbook import DoubleIntegrator, Scheme, minimum_time

schemes = st.sampled_from(list(Scheme))
starts = st.tuples(st.floats(-5.0, 5.0), st.floats(-2.0, 2.0)).filter(
    lambda s: minimum_time(*s).time > 0.5
)


def optimum(
    nodes: int,
    scheme: Scheme,
    start: tuple[float, float] = (4.0, 1.0),
    tolerance: float = 1e-8,
) -> float:
    problem = DoubleIntegrator(nodes, scheme, start)
    result = solve(problem.nlp(), problem.initial_guess(), tolerance=tolerance)
    assert result.success
    return result.objective


@given(schemes, st.integers(2, 8), st.integers(0, 2**32 - 1))
@settings(max_examples=25)
def test_derivatives(scheme: Scheme, nodes: int, seed: int) -> None:
    problem = DoubleIntegrator(nodes, scheme)
    w = np.random.default_rng(seed).normal(size=problem.n)
    assert check_derivatives(problem.nlp(), w).passed


@pytest.mark.parametrize(
    ("nodes", "time"), [(40, 5.246503637), (41, 5.246407579), (200, 5.242729316)]
)
def test_known_optima_of_the_thesis_discretisation(nodes: int, time: float) -> None:
    assert optimum(nodes, Scheme.TRAPEZOIDAL) == pytest.approx(time, abs=2e-8)


def test_the_exact_time_from_the_thesis_start() -> None:
    exact = minimum_time(4.0, 1.0)
    assert exact.time == pytest.approx(1.0 + 2.0 * np.sqrt(4.5), abs=1e-12)
    assert exact.first_force == -1.0


@given(st.floats(-5.0, 5.0), st.floats(-3.0, 3.0), st.floats(0.2, 4.0))
def test_the_exact_answer_ends_at_rest_and_switches_on_the_curve(
    x1: float, x2: float, force: float
) -> None:
    exact = minimum_time(x1, x2, force)
    assert 0.0 <= exact.switch <= exact.time + 1e-9
    end, at_switch = exact.state(np.array([exact.time, exact.switch]))
    assert end[:2] == pytest.approx([0.0, 0.0], abs=1e-6)
    place, speed = at_switch[:2]
    assert place == pytest.approx(-speed * abs(speed) / (2.0 * force), abs=1e-6)
    assert abs(exact.first_force) == force


@pytest.mark.parametrize("scheme", Scheme)
def test_both_schemes_converge_to_the_exact_time(scheme: Scheme) -> None:
    exact = minimum_time(4.0, 1.0).time
    excess = {nodes: optimum(nodes, scheme) - exact for nodes in (10, 20, 40, 80, 160)}
    assert all(-1e-9 <= over <= 8.0 / nodes**2 for nodes, over in excess.items())


@given(starts)
@settings(max_examples=10)
def test_no_discretisation_beats_the_exact_time(start: tuple[float, float]) -> None:
    constant, mean = (
        optimum(16, scheme, start, 1e-6) for scheme in (Scheme.CONSTANT_FORCE, Scheme.TRAPEZOIDAL)
    )
    assert minimum_time(*start).time - 1e-5 <= constant <= mean + 1e-5


def test_the_discretised_force_switches_where_the_exact_one_does() -> None:
    problem = DoubleIntegrator(40)
    result = solve(problem.nlp(), problem.initial_guess())
    t, states = problem.trajectory(result.x)
    exact = minimum_time(4.0, 1.0)
    away = np.abs(t - exact.switch) > 1.5 * t[1]
    assert states[away, 2] == pytest.approx(exact.state(t)[away, 2], abs=1e-3)
    assert states[:, 0] == pytest.approx(exact.state(t)[:, 0], abs=0.02)


def test_matrices_share_their_pattern() -> None:
    problem = DoubleIntegrator(9)
    one, other = (problem.jacobian(np.full(problem.n, v)) for v in (0.0, 1.0))
    assert np.array_equal(one.indices, other.indices)
    assert not np.array_equal(one.data, other.data)  # nor do they share their values
