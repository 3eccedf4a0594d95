"""What callables may do wrong, and what the solver says then."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, NlpError, Status, solve

from .honesty import solved
from .problem import nlp_from

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


RAGGED = [[1.0], [1.0, 2.0]]
WRONG_VALUES = {
    "objective": [None, "a", {}, 1j, [1.0, 2.0]],
    "gradient": [None, ["a", "b"], np.array([1j, 0]), RAGGED, sparse.csc_array([[1.0, 2.0]])],
    "constraints": [None, "a", np.array([1j]), RAGGED],
    "jacobian": ["abc", None, RAGGED, np.ones(2), sparse.coo_array(np.ones(2))],
    "hessian": ["abc", None, np.full((2, 2), 1j), sparse.csc_array(np.full((2, 2), 1j))],
}


@pytest.mark.parametrize(
    ("name", "value"), [(name, value) for name in WRONG_VALUES for value in WRONG_VALUES[name]]
)
def test_what_is_no_array_of_numbers_names_the_callable(name: str, value: object) -> None:
    with pytest.raises(NlpError, match=rf"^{name}"):
        solve(NLP(**{**parts(), name: lambda *arguments: value}), [0, 0])


@pytest.mark.parametrize("value", [None, np.ones(2), np.full((2, 2), 1j), RAGGED])
def test_wrong_residual_jacobians_are_named(value: object) -> None:
    nlp = NLP(n=2, residuals=lambda x: x, residual_jacobian=lambda x: value)
    with pytest.raises(NlpError, match=r"^residual_jacobian"):
        solve(nlp, [0, 0])


@pytest.mark.parametrize("error", [ValueError, np.linalg.LinAlgError])
def test_errors_a_step_away_count_as_missing_values(error: type[Exception]) -> None:
    """A callable that has given values and then cannot is outside of its domain."""
    nlp = _raising(error, beyond=1.5)
    np.testing.assert_allclose(solved(nlp, [0.1, 1]).x, [1.25, 0], atol=1e-6)


@pytest.mark.parametrize("name", ["objective", "gradient", "constraints", "jacobian", "hessian"])
def test_what_callables_do_to_their_arguments_does_not_matter(name: str) -> None:
    good = parts()[name]

    def spoiling(*arguments):
        value = good(*arguments)
        for argument in arguments:
            if isinstance(argument, np.ndarray):
                argument[:] = 7.0
        return value

    start = np.zeros(2)
    found = solve(NLP(**{**parts(), name: spoiling}), start)
    np.testing.assert_array_equal(found.x, solve(NLP(**parts()), [0, 0]).x)
    np.testing.assert_array_equal(start, 0.0)


def test_an_objective_without_values_but_at_the_start_is_named() -> None:
    nlp = NLP(
        n=1,
        objective=lambda x: 1.0 if x[0] == 1 else NAN,
        gradient=lambda x: np.ones(1),
    )
    result = solved(nlp, [1.0])
    assert result.status is Status.CALLABLE_ERROR
    assert "objective" in result.message


@pytest.mark.parametrize("name", ["constraints", "jacobian"])
def test_constraints_without_values_but_at_the_start_are_named(name: str) -> None:
    good = {"constraints": lambda x: x.copy(), "jacobian": lambda x: np.ones((1, 1))}
    bad = {name: lambda x: good[name](x) if x[0] == 1 else NAN * good[name](x)}
    nlp = NLP(n=1, m=1, **{**good, **bad}, c_lower=0, c_upper=0)
    result = solved(nlp, [1.0])
    assert result.status is Status.CALLABLE_ERROR
    assert name in result.message


def test_a_step_to_where_the_gradient_is_infinite_is_shortened() -> None:
    nlp = NLP(
        n=1, objective=lambda x: np.sqrt(x[0]), gradient=lambda x: 0.5 / np.sqrt(x), x_lower=0
    )
    result = solved(nlp, [1.0])
    assert result.success
    assert result.objective <= 1e-5


@pytest.mark.parametrize("triangle", [np.tril, np.triu])
def test_hessians_need_both_triangles(triangle) -> None:
    nlp = nlp_from(lambda x, y: (100 * (y - x**2) ** 2 + (1 - x) ** 2, []), 2)
    hessian = nlp.hessian
    assert hessian is not None
    half = NLP(
        n=2,
        objective=nlp.objective,
        gradient=nlp.gradient,
        hessian=lambda x, factor, y: triangle(hessian(x, factor, y)),
    )
    with pytest.raises(NlpError, match=r"hessian gave one triangle"):
        solve(half, [-1.2, 1])


def test_hessians_are_symmetric() -> None:
    wrong = {"hessian": lambda x, factor, y: np.array([[2.0, 1.0], [-1.0, 2.0]])}
    with pytest.raises(NlpError, match="hessian is not symmetric"):
        solve(NLP(**{**parts(), **wrong}), [0, 0])


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
