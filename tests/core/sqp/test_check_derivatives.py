"""`check_derivatives` finds a wrong entry, names it, and passes right ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.sqp import NLP, NlpError, check_derivatives

from .known_points import known_point

N, M = 4, 3


def parts(seed: int) -> dict:
    nlp = known_point(seed, N, M).nlp()
    names = ("n", "m", "objective", "gradient", "constraints", "jacobian", "hessian")
    return {name: getattr(nlp, name) for name in names}


@given(seed=st.integers(0, 1000), as_sparse=st.booleans())
def test_right_derivatives_pass(seed: int, as_sparse: bool) -> None:
    known = known_point(seed, N, M)
    found = check_derivatives(known.nlp(as_sparse=as_sparse), known.start(0.5))
    assert found.passed, str(found)
    assert {m.derivative for m in found.worst} == {"gradient", "jacobian", "hessian"}
    assert "too large" not in str(found)


entries = st.tuples(st.integers(0, N - 1), st.integers(0, N - 1))
errors = st.sampled_from([1e-2, -0.5, 30.0])


@given(entry=entries, error=errors, name=st.sampled_from(["gradient", "jacobian", "hessian"]))
def test_a_wrong_entry_is_named(entry: tuple[int, int], error: float, name: str) -> None:
    plain = parts(seed=5)
    row, column = entry
    row = {"gradient": 0, "jacobian": row % M, "hessian": row}[name]

    def wrong(*arguments):
        value = np.array(plain[name](*arguments))
        value[column if name == "gradient" else (row, column)] += error
        return value

    # A wrong gradient or Jacobian spoils the differences that the Hessian is held against.
    hessian = wrong if name == "hessian" else None
    changes = {"hessian": hessian} if name == "hessian" else {name: wrong, "hessian": None}
    found = check_derivatives(NLP(**{**plain, **changes}), np.full(N, 0.3))
    assert not found.passed
    worst = max(found.worst, key=lambda m: m.error)
    assert (worst.derivative, worst.row, worst.column) == (name, row, column)
    assert worst.claimed - worst.differences == pytest.approx(error, abs=1e-4)
    assert f"{name}[{row}, {column}]" in str(found)
    assert "too large" in str(found)


def test_a_hessian_that_forgets_the_constraints_is_found() -> None:
    known = known_point(5, N, M)
    changes = {"hessian": lambda x, factor, y: known.hessian(x, factor, 0 * y)}
    assert not check_derivatives(NLP(**{**parts(5), **changes}), np.zeros(N)).passed


def test_a_hessian_that_forgets_the_factor_is_found() -> None:
    known = known_point(5, N, M)
    changes = {"hessian": lambda x, factor, y: known.hessian(x, 1.0, y)}
    assert not check_derivatives(NLP(**{**parts(5), **changes}), np.zeros(N)).passed


def test_nan_does_not_pass() -> None:
    changes = {"gradient": lambda x: np.full(N, np.nan)}
    assert not check_derivatives(NLP(**{**parts(5), **changes}), np.zeros(N)).passed


def test_residuals_are_checked() -> None:
    def nlp(slope: float) -> NLP:
        return NLP(
            n=1,
            residuals=lambda x: np.array([np.sin(x[0]), x[0] ** 2]),
            residual_jacobian=lambda x: np.array([[np.cos(x[0])], [slope * x[0]]]),
        )

    assert check_derivatives(nlp(2.0), [0.7]).passed
    found = check_derivatives(nlp(2.1), [0.7])
    assert [(m.derivative, m.row, m.column) for m in found.worst] == [("residual_jacobian", 1, 0)]
    assert not found.passed


def test_the_tolerance_is_the_callers() -> None:
    nlp = NLP(n=1, objective=lambda x: x[0] ** 2, gradient=lambda x: 2.001 * x)
    assert not check_derivatives(nlp, [3.0]).passed
    assert check_derivatives(nlp, [3.0], tolerance=1e-2).passed


def test_nothing_to_check_passes() -> None:
    found = check_derivatives(NLP(n=2), [0, 0])
    assert found.passed and found.worst == ()


def test_small_derivatives_count_too() -> None:
    nlp = NLP(n=1, objective=lambda x: 1e-4 * x[0] ** 2, gradient=lambda x: -7e-4 * x)
    assert not check_derivatives(nlp, [1.0]).passed
    cubic = NLP(n=1, objective=lambda x: x[0] ** 3, gradient=lambda x: 3 * x**2)
    assert check_derivatives(cubic, [0.0]).passed  # differences are never quite zero


@pytest.mark.parametrize("x", [0.0, 1e-7, 1.0, 1.0 - 1e-7, 0.5, -3.0])
def test_differences_stay_within_bounds(x: float) -> None:
    asked: list[float] = []

    def objective(p: np.ndarray) -> float:
        asked.append(float(p[0]))
        return float(p[0] ** 3)

    nlp = NLP(n=1, objective=objective, gradient=lambda p: 3 * p**2, x_lower=0, x_upper=1)
    assert check_derivatives(nlp, [x]).passed
    assert min(asked) >= 0 and max(asked) <= 1


def test_fixed_variables_are_left_out() -> None:
    nlp = NLP(
        n=2,
        objective=lambda x: x[0] ** 2 + np.sqrt(x[1]),
        gradient=lambda x: np.array([2 * x[0], 77.0]),
        x_lower=[-1, 0],
        x_upper=[1, 0],
    )
    assert check_derivatives(nlp, [0.3, 0.0]).passed


def test_what_solve_accepts_is_accepted() -> None:
    nlp = NLP(
        n=2,
        m=2,
        objective=lambda x: np.array([[x @ x]]),
        gradient=lambda x: (2 * x)[:, None],
        constraints=lambda x: (x**2)[:, None],
        jacobian=lambda x: np.diag(2 * x),
    )
    assert check_derivatives(nlp, [1.0, 2.0]).passed
    one = NLP(n=2, m=1, constraints=lambda x: x @ x, jacobian=lambda x: 2 * x[None, :])
    assert check_derivatives(one, [1.0, 2.0]).passed


@pytest.mark.parametrize("x", [[np.nan, 1.0], ["a", 1.0], [1.0]])
def test_wrong_points_are_refused(x: list) -> None:
    with pytest.raises(NlpError, match=r"^x"):
        check_derivatives(NLP(n=2), x)
