"""Hessians that the solver makes itself."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, HessianKind, NlpError, solve
from flyby.core.sqp.algebra.matrices import LowRankSum, SparseMatrix, empty
from flyby.core.sqp.problem.differences import Differences
from flyby.core.sqp.problem.evaluation import Point
from flyby.core.sqp.problem.limited_memory import LimitedMemory
from flyby.core.sqp.problem.patterns import Pattern
from flyby.core.sqp.problem.scaled import ScaledProblem

from .honesty import solved
from .jets import log
from .problem import equal, nlp_from


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


def _points(B: FloatArray, count: int, seed: int) -> list[Point]:
    """Points of a quadratic function with this Hessian (n, n)."""
    random = np.random.default_rng(seed)
    n = len(B)
    x = random.standard_normal((count, n))
    return [Point(v, 0.0, np.zeros(0), B @ v, empty(n)) for v in x]


def _full(matrix: SparseMatrix) -> FloatArray:
    dense = np.asarray(matrix.scipy().toarray())
    if isinstance(matrix, LowRankSum):
        dense = dense + matrix.wide @ np.linalg.solve(matrix.middle, matrix.wide.T)
    return dense


@given(n=st.integers(2, 7), seed=st.integers(0, 10_000), curved=st.booleans())
def test_limited_memory_is_definite_and_has_the_last_secant(
    n: int, seed: int, curved: bool
) -> None:
    A = np.random.default_rng(seed).standard_normal((n, n))
    B = A @ A.T + np.eye(n) if curved else A + A.T
    source = LimitedMemory(n)
    points = _points(B, 16, seed)
    for old, new in pairwise(points):
        before = _full(source.matrix(old, np.zeros(0)))
        source.moved(old, new, np.zeros(0))
        found = _full(source.matrix(new, np.zeros(0)))
        np.testing.assert_allclose(found, found.T, atol=1e-9 * np.abs(found).max())
        assert np.linalg.eigvalsh(found).min() > 0.0
        s, y = new.x - old.x, new.g - old.g
        if old is not points[0] and s @ y > 0.3 * s @ before @ s:  # not damped
            np.testing.assert_allclose(found @ s, y, atol=1e-6 * np.abs(y).max())


def test_limited_memory_forgets_all_but_the_last_steps() -> None:
    B = np.diag(np.arange(1.0, 41.0))
    source = LimitedMemory(40)
    for old, new in pairwise(_points(B, 30, 0)):
        source.moved(old, new, np.zeros(0))
    found = source.matrix(new, np.zeros(0))
    assert isinstance(found, LowRankSum)
    assert found.wide.shape == (40, 24)


@pytest.mark.parametrize("options", [{"method": "sqp"}, {"step_box": lambda k, x: (-1.0, 1.0)}])
def test_limited_memory_needs_the_interior_point(options: dict) -> None:
    nlp = nlp_from(lambda x, y: (x**2 + y**2, []), 2)
    with pytest.raises(NlpError, match="lbfgs"):
        solve(nlp, [1.0, 1.0], hessian_kind="lbfgs", **options)


def test_limited_memory_with_held_variables_and_an_equality() -> None:
    nlp = nlp_from(
        lambda *x: (sum((v - k) ** 4 + v**2 for k, v in enumerate(x)), [equal(x[0] + x[4], 1.0)]),
        6,
        lower=[-9, 2, -9, -9, -9, 0],
        upper=[9, 2, 9, 9, 9, 1],
    )
    by_steps, exact = (solved(nlp, np.zeros(6), hessian_kind=kind) for kind in ("lbfgs", "exact"))
    assert by_steps.success
    np.testing.assert_allclose(by_steps.x, exact.x, atol=1e-5)
    assert by_steps.x[1] == 2.0
