"""Hessians that the solver makes itself."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, HessianKind
from flyby.core.sqp.problem.differences import Differences
from flyby.core.sqp.problem.patterns import Pattern
from flyby.core.sqp.problem.scaled import ScaledProblem

from .honesty import solved
from .jets import log
from .problem import nlp_from


def by_differences(nlp: NLP, x: list[float], multipliers: list[float]) -> FloatArray:
    """The Hessian at x, whose pattern was found at the start, zero."""
    shapes = (nlp.m, nlp.n), (nlp.n, nlp.n)
    problem = ScaledProblem(
        nlp, Pattern("jacobian", shapes[0]), Pattern("hessian", shapes[1], growing=True)
    )
    start = problem.first_point(np.zeros(nlp.n))
    source = Differences(problem.evaluation)
    source.matrix(start, np.zeros(nlp.m))
    point = problem.evaluation.point(np.array(x))
    problem.evaluation.differentiate(point)
    return source.matrix(point, np.array(multipliers)).scipy().toarray()


def test_couplings_that_vanish_at_the_start_are_found() -> None:
    nlp = nlp_from(lambda x, y, z: (x**2 * y**2 + y**3 * z - x - y - z, []), 3)
    found = by_differences(nlp, [1.0, 2.0, 3.0], [])
    expected = [[8.0, 8.0, 0.0], [8.0, 2.0 + 36.0, 12.0], [0.0, 12.0, 0.0]]
    np.testing.assert_allclose(found, expected, atol=1e-4)


def test_couplings_of_residuals_are_found() -> None:
    def residual_jacobian(x: FloatArray) -> FloatArray:
        return np.array([[x[1], x[0], 0.0], [0.0, 0.0, 1.0]])

    nlp = NLP(
        n=3,
        residuals=lambda x: np.array([x[0] * x[1] - 1.0, x[2] - 2.0]),
        residual_jacobian=residual_jacobian,
    )
    found = by_differences(nlp, [2.0, 3.0, 0.0], [])
    np.testing.assert_allclose(found, [[9, 11, 0], [11, 4, 0], [0, 0, 1]], atol=1e-4)


@pytest.mark.parametrize("kind", [HessianKind.BFGS, HessianKind.DIFFERENCES])
def test_least_squares_by_any_hessian(kind: HessianKind) -> None:
    random = np.random.default_rng(0)
    A = random.standard_normal((6, 4))

    def residual_jacobian(x: FloatArray) -> FloatArray:
        J = A.copy()
        J[:, 0] += 0.1 * x[1]
        J[:, 1] += 0.1 * x[0]
        return J

    nlp = NLP(
        n=4,
        residuals=lambda x: A @ x + 0.1 * x[0] * x[1] - 1.0,
        residual_jacobian=residual_jacobian,
    )
    plain = solved(nlp, np.ones(4))
    other = solved(nlp, np.ones(4), hessian_kind=kind)
    assert plain.success and other.success
    assert other.objective == pytest.approx(plain.objective, rel=1e-6)


def test_fixed_variables_are_not_moved() -> None:
    """The logarithm has no value beyond the bound that fixes x."""
    nlp = nlp_from(lambda x, y: (-log(1 - x) + y**2 + x * y, []), 2, [1 - 1e-9, -5], [1 - 1e-9, 5])
    result = solved(nlp, [0.5, 1.0], hessian_kind=HessianKind.DIFFERENCES)
    assert result.success
    assert result.x[1] == pytest.approx(-0.5, abs=1e-6)


def test_updates_that_would_teach_nothing_are_left_out() -> None:
    """A linear objective: differences of slopes, and soon the update's denominators, are zero."""
    u = 10.0 ** np.array([-4, -2, 0, 2, 4])
    nlp = NLP(
        n=5,
        objective=lambda x: float((x / u).sum()),
        gradient=lambda x: 1 / u,
        x_lower=-u,
        x_upper=u,
    )
    result = solved(nlp, 0.3 * u)
    assert result.success
    np.testing.assert_allclose(result.x, -u)
