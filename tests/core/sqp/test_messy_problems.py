"""Problems as they come: whatever the method, its verdict holds against the callables."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.sqp import NLP, SolverMethod, Status, solve

from .honesty import solved

INF = float("inf")
all_methods = pytest.mark.parametrize("method", tuple(SolverMethod))


@all_methods
def test_values_that_are_missing_beside_the_way_do_not_matter(method: str) -> None:
    """The logarithm has none for x < 1; the row keeps x y ≤ 2."""
    nlp = NLP(
        n=2,
        m=1,
        objective=lambda x: float(-np.log(x[0] - 1.0) + x[0] ** 2 + (x[1] - 2.0) ** 2),
        gradient=lambda x: np.array([-1.0 / (x[0] - 1.0) + 2.0 * x[0], 2.0 * (x[1] - 2.0)]),
        constraints=lambda x: np.array([x[0] * x[1]]),
        jacobian=lambda x: np.array([[x[1], x[0]]]),
        c_upper=2.0,
    )
    result = solved(nlp, [5.0, 0.1], method=method)
    assert result.success
    assert result.x[0] * result.x[1] == pytest.approx(2.0)


@all_methods
def test_values_that_are_missing_where_rows_would_hold_are_named(method: str) -> None:
    nlp = NLP(
        n=1,
        m=1,
        objective=lambda x: float(x[0]),
        gradient=lambda x: np.ones(1),
        constraints=lambda x: np.sqrt(x),
        jacobian=lambda x: 0.5 / np.sqrt(x)[None],
        c_upper=-1.0,
    )
    result = solved(nlp, [4.0], method=method)
    assert result.status is Status.CALLABLE_ERROR
    assert "constraints gave nan" in result.message


@all_methods
def test_a_minimum_at_a_kink_is_found_but_not_proven(method: str) -> None:
    def gradient(x):
        signs = np.sign([x[0], x[1] - x[0]])
        return np.array([signs[0] - signs[1], signs[1] + 0.1])

    nlp = NLP(
        n=2,
        objective=lambda x: float(abs(x[0]) + abs(x[1] - x[0]) + 0.1 * x[1]),
        gradient=gradient,
    )
    result = solved(nlp, [3.0, -2.0], method=method)
    assert not result.success
    assert result.objective < 1e-6


@all_methods
def test_a_jacobian_of_the_wrong_sign_proves_nothing(method: str) -> None:
    nlp = NLP(
        n=2,
        m=1,
        objective=lambda x: float(x @ x),
        gradient=lambda x: 2.0 * x,
        constraints=lambda x: np.array([x[0] + x[1]]),
        jacobian=lambda x: np.array([[1.0, -1.0]]),
        c_lower=1.0,
        c_upper=1.0,
    )
    result = solved(nlp, [3.0, 1.0], method=method)
    assert result.status is Status.ITERATION_LIMIT
    assert "are the derivatives right?" in result.message


@all_methods
def test_a_gradient_of_the_wrong_sign_proves_nothing(method: str) -> None:
    nlp = NLP(n=2, objective=lambda x: float(x @ x), gradient=lambda x: -2.0 * x)
    assert solved(nlp, [3.0, 3.0], method=method).status is Status.ITERATION_LIMIT


@all_methods
def test_noise_proves_nothing(method: str) -> None:
    """Neither values nor slopes come out the same twice."""
    random = np.random.default_rng(0)
    nlp = NLP(
        n=2,
        m=1,
        objective=lambda x: float(x @ x + 1e-3 * random.normal()),
        gradient=lambda x: 2.0 * x + 1e-3 * random.normal(size=2),
        constraints=lambda x: np.array([x[0] + x[1]]),
        jacobian=lambda x: np.ones((1, 2)),
        c_lower=1.0,
    )
    assert not solve(nlp, [3.0, 3.0], method=method).success


@all_methods
@pytest.mark.parametrize(("gap", "infeasible"), [(1e-7, False), (1e-5, True)])
def test_a_gap_below_the_tolerance_is_none(method: str, gap: float, infeasible: bool) -> None:
    nlp = NLP(
        n=2,
        m=2,
        objective=lambda x: float(x @ x),
        gradient=lambda x: 2.0 * x,
        constraints=lambda x: np.full(2, x.sum()),
        jacobian=lambda x: np.ones((2, 2)),
        hessian=lambda x, factor, y: 2.0 * factor * np.eye(2),
        c_lower=[1.0 + gap, -INF],
        c_upper=[INF, 1.0],
    )
    result = solved(nlp, [0.0, 0.0], method=method)
    assert result.status is (Status.INFEASIBLE if infeasible else Status.OPTIMAL)


@all_methods
def test_rows_that_say_the_same_in_different_units(method: str) -> None:
    units = np.array([1.0, 2.0, -3.0, 1e-3, 1e3, 1.0])
    nlp = NLP(
        n=3,
        m=6,
        objective=lambda x: float(x.sum()),
        gradient=lambda x: np.ones(3),
        constraints=lambda x: units * (x @ x - 1.0),
        jacobian=lambda x: 2.0 * units[:, None] * x[None],
        hessian=lambda x, factor, y: 2.0 * float(units @ y) * np.eye(3),
        c_lower=0.0,
        c_upper=0.0,
    )
    result = solved(nlp, [1.0, 0.2, 0.1], method=method)
    assert result.status is Status.OPTIMAL
    assert result.x == pytest.approx(np.full(3, -(3.0**-0.5)), abs=1e-6)


@all_methods
def test_a_violation_that_is_flat_at_its_least(method: str) -> None:
    nlp = NLP(
        n=1,
        m=1,
        constraints=lambda x: x**4 + 1e-4,
        jacobian=lambda x: 4.0 * x[None] ** 3,
        hessian=lambda x, factor, y: 12.0 * y[:, None] * x**2,
        c_upper=0.0,
    )
    assert solved(nlp, [1.0], method=method).status is Status.INFEASIBLE


@all_methods
@pytest.mark.parametrize("factor", [1e8, 1e-8])
def test_objectives_of_any_size(method: str, factor: float) -> None:
    """At 1e-8 every slope is below the tolerance, and at 1e8 its rounding is above."""
    goal = np.array([3.0, 2.0])
    nlp = NLP(
        n=2,
        m=1,
        objective=lambda x: float(factor * (x - goal) @ (x - goal)),
        gradient=lambda x: 2.0 * factor * (x - goal),
        constraints=lambda x: np.array([x @ x]),
        jacobian=lambda x: 2.0 * x[None],
        hessian=lambda x, of_f, y: 2.0 * (of_f * factor + y[0]) * np.eye(2),
        c_upper=1.0,
    )
    result = solved(nlp, [0.3, 0.1], method=method)
    assert result.success
    assert factor < 1.0 or result.x == pytest.approx(goal / np.linalg.norm(goal), abs=1e-6)


@given(value=st.floats(-1e6, 1e6), share=st.floats(0.0, 9e-15))
def test_bounds_that_cross_by_rounding_fix(value: float, share: float) -> None:
    lower = value + share * abs(value)
    nlp = NLP(n=2, x_lower=[lower, 0.0], x_upper=[value, 1.0])
    x_lower, x_upper, *_ = nlp.bounds
    assert x_lower[0] == x_upper[0] == value
    assert x_lower[1] == 0.0 and x_upper[1] == 1.0


@all_methods
def test_a_variable_whose_bounds_cross_by_rounding(method: str) -> None:
    goal = np.array([1.0, 0.5])
    nlp = NLP(
        n=2,
        objective=lambda x: float((x - goal) @ (x - goal)),
        gradient=lambda x: 2.0 * (x - goal),
        x_lower=[0.1 + 0.2, 0.0],  # above 0.3
        x_upper=[0.3, 1.0],
    )
    assert solved(nlp, [0.0, 0.0], method=method).x == pytest.approx([0.3, 0.5])
