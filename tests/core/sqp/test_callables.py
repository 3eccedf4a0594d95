"""What callables may do wrong, and what the solver says then."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.sqp import NLP, NlpError, Status, solve
from flyby.core.sqp.nlp import FloatArray

from .honesty import solved

NAN, INF = float("nan"), float("inf")


def parts() -> dict:
    """Minimise (x − 1)² + (y − 2)² with x + y² ≤ 3."""
    return {
        "n": 2,
        "m": 1,
        "objective": lambda x: (x[0] - 1) ** 2 + (x[1] - 2) ** 2,
        "gradient": lambda x: np.array([2 * (x[0] - 1), 2 * (x[1] - 2)]),
        "constraints": lambda x: np.array([x[0] + x[1] ** 2]),
        "jacobian": lambda x: np.array([[1.0, 2 * x[1]]]),
        "hessian": lambda x, factor, y: np.diag([2 * factor, 2 * factor + 2 * y[0]]),
        "c_upper": 3,
    }


@pytest.mark.parametrize("bad", [NAN, INF, -INF])
@pytest.mark.parametrize("name", ["objective", "gradient", "constraints", "jacobian"])
def test_what_is_not_finite_at_the_start_is_named(name: str, bad: float) -> None:
    good = parts()[name]
    nlp = NLP(**{**parts(), name: lambda x: bad * np.ones_like(good(x))})
    result = solve(nlp, [0, 0])
    assert result.status is Status.CALLABLE_ERROR
    assert not result.success
    assert name in result.message and "start" in result.message
    np.testing.assert_array_equal(result.x, [0, 0])


def test_a_hessian_that_is_not_finite_is_named() -> None:
    nlp = NLP(**{**parts(), "hessian": lambda x, factor, y: np.full((2, 2), NAN)})
    result = solved(nlp, [0, 0])
    assert result.status is Status.CALLABLE_ERROR
    assert "hessian" in result.message


def test_derivatives_that_are_not_finite_a_step_away_are_named() -> None:
    good = parts()["gradient"]
    nlp = NLP(**{**parts(), "gradient": lambda x: good(x) if x[0] == 0 else np.full(2, NAN)})
    result = solved(nlp, [0, 0])
    assert result.status is Status.CALLABLE_ERROR
    assert "gradient" in result.message


def _raising(error: type[Exception], beyond: float) -> NLP:
    """Minimise (x − 2)² + y² for x ≤ 1.25; the objective raises an error beyond some x."""

    def objective(x: FloatArray) -> float:
        if x[0] > beyond:
            raise error("too far")
        return float((x[0] - 2) ** 2 + x[1] ** 2)

    return NLP(
        n=2,
        m=1,
        objective=objective,
        gradient=lambda x: np.array([2 * (x[0] - 2), 2 * x[1]]),
        constraints=lambda x: np.array([x[0] ** 3]),
        jacobian=lambda x: np.array([[3 * x[0] ** 2, 0.0]]),
        hessian=lambda x, factor, y: np.diag([2 * factor + 6 * y[0] * x[0], 2 * factor]),
        c_upper=1.25**3,
    )


@pytest.mark.parametrize("error", [ZeroDivisionError, OverflowError, FloatingPointError])
def test_arithmetic_errors_count_as_missing_values(error: type[ArithmeticError]) -> None:
    nlp = _raising(error, beyond=1.5)
    np.testing.assert_allclose(solved(nlp, [0.1, 1]).x, [1.25, 0], atol=1e-6)
    result = solve(_raising(error, beyond=-1.0), [0, 1])
    assert result.status is Status.CALLABLE_ERROR
    assert "objective" in result.message and "too far" in result.message


@pytest.mark.parametrize("error", [RuntimeError, KeyError, ValueError, TypeError])
@pytest.mark.parametrize("name", ["objective", "gradient", "constraints", "jacobian", "hessian"])
def test_other_exceptions_pass_through(name: str, error: type[Exception]) -> None:
    def broken(*arguments: object) -> None:
        raise error("mine")

    with pytest.raises(error, match="mine"):
        solve(NLP(**{**parts(), name: broken}), [0, 0])


WRONG_SHAPES = {
    "objective": lambda x: np.zeros(2),
    "gradient": lambda x: np.zeros(3),
    "constraints": lambda x: np.zeros(2),
    "jacobian": lambda x: np.zeros((2, 2)),
    "hessian": lambda x, factor, y: np.zeros((3, 3)),
}


@pytest.mark.parametrize("name", WRONG_SHAPES)
def test_wrong_shapes_name_the_callable(name: str) -> None:
    with pytest.raises(NlpError, match=rf"{name} gave shape"):
        solve(NLP(**{**parts(), name: WRONG_SHAPES[name]}), [0, 0])


def test_calls_are_counted_and_timed() -> None:
    calls: dict[str, int] = {}

    def counted(name: str, function):
        def call(*arguments):
            calls[name] = calls.get(name, 0) + 1
            return function(*arguments)

        return call

    names = ("objective", "gradient", "constraints", "jacobian", "hessian")
    nlp = NLP(**{**parts(), **{name: counted(name, parts()[name]) for name in names}})
    result = solve(nlp, [0, 0])
    assert result.status is Status.OPTIMAL
    assert result.evaluations == calls
    assert 0 < result.timings.callables < result.timings.total
    assert 0 < result.timings.subproblems < result.timings.total
