"""Input that other solvers call degenerate is ordinary here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, BackendKind, HessianKind, NlpError, Status

from .honesty import solved
from .jets import exp, log, sqrt
from .problem import at_least, at_most, between, equal, nlp_from

BACKENDS = pytest.mark.parametrize("qp", [BackendKind.CLARABEL, BackendKind.OSQP])


def optimum(nlp: NLP, x0, **options) -> FloatArray:
    result = solved(nlp, x0, **options)
    assert result.status is Status.OPTIMAL, result
    return result.x


# ------------------------------------------------------------- nothing to hold, or to lower


@BACKENDS
@pytest.mark.parametrize("kind", [HessianKind.EXACT, HessianKind.BFGS, HessianKind.DIFFERENCES])
def test_no_constraints(qp: BackendKind, kind: HessianKind) -> None:
    rosenbrock = nlp_from(lambda x, y: (100 * (y - x**2) ** 2 + (1 - x) ** 2, []), 2)
    x = optimum(rosenbrock, [-1.2, 1], qp=qp, hessian_kind=kind)
    np.testing.assert_allclose(x, [1, 1], atol=1e-5)


@BACKENDS
def test_no_objective_asks_for_a_feasible_point(qp: BackendKind) -> None:
    circle = nlp_from(lambda x, y: (0.0, [equal(x**2 + y**2, 25), equal(x * y, 12)]), 2)
    nlp = NLP(
        n=2,
        m=2,
        constraints=circle.constraints,
        jacobian=circle.jacobian,
        c_lower=circle.c_lower,
        c_upper=circle.c_upper,
    )
    result = solved(nlp, [5, 1], qp=qp)
    assert result.status is Status.OPTIMAL
    assert result.objective == 0
    np.testing.assert_allclose(sorted(result.x), [3, 4], atol=1e-6)


def test_neither_objective_nor_constraints_returns_the_start_within_the_bounds() -> None:
    result = solved(NLP(n=2, x_lower=[0, 0], x_upper=[1, 1]), [0.5, 7])
    assert result.status is Status.OPTIMAL
    np.testing.assert_array_equal(result.x, [0.5, 1.0])
    assert result.iterations == 0


def test_one_variable() -> None:
    nlp = nlp_from(lambda x: ((x - 3) ** 2, [at_most(x**2, 4)]), 1)
    np.testing.assert_allclose(optimum(nlp, [0]), [2], atol=1e-7)
    x = optimum(nlp_from(lambda x: (x**4 - x, []), 1), [5])
    np.testing.assert_allclose(x, [4 ** (-1 / 3)], atol=1e-6)


def test_bounds_alone() -> None:
    nlp = nlp_from(lambda x, y: ((x - 3) ** 2 + (y + 1) ** 2 + x * y, []), 2, 0, 1)
    np.testing.assert_allclose(optimum(nlp, [0.5, 0.5]), [1, 0], atol=1e-9)


# ------------------------------------------------------------------------- fixed variables


@BACKENDS
def test_fixed_variables_stay(qp: BackendKind) -> None:
    nlp = nlp_from(
        lambda x, y, z: ((x - 1) ** 2 + (y - 2) ** 2 + (z - 3) ** 2, [equal(x + y + z, 3)]),
        3,
        lower=[-np.inf, 0.5, -np.inf],
        upper=[np.inf, 0.5, np.inf],
    )
    x = optimum(nlp, [5, 5, 5], qp=qp)
    np.testing.assert_allclose(x, [0.25, 0.5, 2.25], atol=1e-7)
    assert x[1] == 0.5


@BACKENDS
def test_all_variables_fixed(qp: BackendKind) -> None:
    def at(total: float) -> NLP:
        return nlp_from(lambda x, y: (x * y, [equal(x + y, total)]), 2, [1, 2], [1, 2])

    feasible = solved(at(3), [0, 0], qp=qp)
    assert feasible.status is Status.OPTIMAL
    np.testing.assert_array_equal(feasible.x, [1, 2])
    wrong = solved(at(4), [0, 0], qp=qp)
    assert wrong.status is Status.INFEASIBLE
    np.testing.assert_array_equal(wrong.x, [1, 2])
    assert wrong.constraint_violation == pytest.approx(1)


# ------------------------------------------------------------ dependent and too many rows


@BACKENDS
def test_dependent_rows(qp: BackendKind) -> None:
    nlp = nlp_from(
        lambda x, y: (
            x**2 + y**2,
            [equal(x + y, 1), equal(2 * x + 2 * y, 2), at_least(x + y, 1), at_least(-x - y, -1)],
        ),
        2,
    )
    np.testing.assert_allclose(optimum(nlp, [3, 1], qp=qp), [0.5, 0.5], atol=1e-6)


@BACKENDS
def test_the_same_curved_row_three_times(qp: BackendKind) -> None:
    nlp = nlp_from(lambda x, y: (x + y, [at_most(x**2 + y**2, 2)] * 3), 2)
    np.testing.assert_allclose(optimum(nlp, [0.5, 0.1], qp=qp), [-1, -1], atol=1e-6)


@BACKENDS
def test_more_consistent_equalities_than_variables(qp: BackendKind) -> None:
    nlp = nlp_from(
        lambda x, y: (
            x,
            [equal(x**2 + y**2, 5), equal(x * y, 2), equal(x + y, 3), equal(x - y, 1)],
        ),
        2,
    )
    np.testing.assert_allclose(optimum(nlp, [3, 0.5], qp=qp), [2, 1], atol=1e-6)


def test_more_contradictory_equalities_than_variables_end_at_the_least_violation() -> None:
    nlp = nlp_from(lambda x, y: (x, [equal(x, 1), equal(x, 2), equal(y, 3), equal(x, 1.5)]), 2)
    result = solved(nlp, [0, 0])
    assert result.status is Status.INFEASIBLE
    np.testing.assert_allclose(result.x, [1.5, 3], atol=1e-5)  # the median violates least


def test_as_many_equalities_as_variables() -> None:
    nlp = nlp_from(lambda x, y: (x**2, [equal(x**2 + y, 3), equal(exp(x) - y, 1)]), 2)
    x = optimum(nlp, [1, 1])
    np.testing.assert_allclose([x[0] ** 2 + x[1], np.exp(x[0]) - x[1]], [3, 1], atol=1e-6)


# ----------------------------------------------------------------------- infeasible, unbounded


@BACKENDS
def test_infeasible_problems_end_at_a_least_violated_point(qp: BackendKind) -> None:
    disc = nlp_from(lambda x, y: (x + y, [at_most(x**2 + y**2, -1)]), 2)
    result = solved(disc, [1, 1], qp=qp)
    assert result.status is Status.INFEASIBLE
    assert result.constraint_violation == pytest.approx(1, abs=1e-4)
    line = nlp_from(lambda x, y: (x**2 + y**2, [at_least(x + y, 1), at_most(x + y, -1)]), 2)
    result = solved(line, [5, 3], qp=qp)
    assert result.status is Status.INFEASIBLE
    assert -1 - 1e-6 <= result.x.sum() <= 1 + 1e-6
    assert "violation" in result.message


def test_bounds_that_keep_a_row_from_holding() -> None:
    nlp = nlp_from(lambda x, y: (y, [at_least(x**2, 9)]), 2, 0, 2)
    result = solved(nlp, [1, 1])
    assert result.status is Status.INFEASIBLE
    assert result.x[0] == pytest.approx(2)
    assert result.constraint_violation == pytest.approx(5)


@BACKENDS
@pytest.mark.parametrize("kind", [HessianKind.EXACT, HessianKind.BFGS])
def test_unbounded(qp: BackendKind, kind: HessianKind) -> None:
    plain = nlp_from(lambda x, y: (-x + y**2, [at_least(x - y, 0)]), 2)
    assert solved(plain, [1, 1], qp=qp, hessian_kind=kind).status is Status.UNBOUNDED
    concave = nlp_from(lambda x, y: (-(x**2) + y**2, [at_most(y, 1)]), 2)
    assert solved(concave, [1, 1], qp=qp, hessian_kind=kind).status is Status.UNBOUNDED


def test_a_start_far_outside_the_bounds() -> None:
    nlp = nlp_from(lambda x, y: (x + 2 * y, [at_least(x * y, 1)]), 2, 0.1, 10)
    np.testing.assert_allclose(optimum(nlp, [-1e6, 1e8]), [np.sqrt(2), np.sqrt(0.5)], atol=1e-5)


# --------------------------------------------------------------------------- zero gradients


@BACKENDS
def test_zero_rows_that_hold_do_not_matter(qp: BackendKind) -> None:
    nlp = nlp_from(
        lambda x, y: (
            (x - 1) ** 2 + y**2,
            [equal(0.0, 0.0), between(0.0, -1, 1), at_least(x - y, 2)],
        ),
        2,
    )
    x = optimum(nlp, [0, 0], qp=qp)
    np.testing.assert_allclose(x, [1.5, -0.5], atol=1e-6)


def test_a_zero_row_that_cannot_hold_is_infeasible() -> None:
    nlp = nlp_from(lambda x, y: (x**2 + y**2, [equal(0.0, 2.0), at_least(x + y, 1)]), 2)
    result = solved(nlp, [0, 0])
    assert result.status is Status.INFEASIBLE
    assert result.constraint_violation == pytest.approx(2)


@BACKENDS
def test_a_gradient_that_vanishes_at_the_start(qp: BackendKind) -> None:
    """At the centre of a circle its equation has no slope: the objective leads away."""
    nlp = nlp_from(lambda x, y: ((x - 20) ** 2 + (y + 20) ** 2, [equal(x**2 + y**2, 100)]), 2)
    x = optimum(nlp, [0, 0], qp=qp)
    np.testing.assert_allclose(x, [50**0.5, -(50**0.5)], atol=1e-5)


@BACKENDS
def test_a_gradient_that_vanishes_at_the_solution(qp: BackendKind) -> None:
    """x² = 0 holds where its gradient is zero: no multiplier exists, yet x is found."""
    nlp = nlp_from(lambda x, y: (y**2 + (y - x), [equal(x**2, 0)]), 2)
    result = solved(nlp, [1, 1], qp=qp)
    assert result.constraint_violation <= 1e-6
    np.testing.assert_allclose(result.x, [0, -0.5], atol=5e-2)


def test_a_cusp() -> None:
    """Hock and Schittkowski's 13: at (1, 0) the constraints' gradients are opposed."""
    nlp = nlp_from(lambda x, y: ((x - 2) ** 2 + y**2, [at_least((1 - x) ** 3 - y, 0)]), 2, 0)
    result = solved(nlp, [-2, -2])
    assert result.constraint_violation <= 1e-6
    assert result.x[0] == pytest.approx(1, abs=2e-2)


def test_complementarity() -> None:
    """x y ≤ 0 with x, y ≥ 0 has no interior and no bounded multipliers at the corner."""
    nlp = nlp_from(lambda x, y: ((x - 1) ** 2 + (y - 2) ** 2, [at_most(x * y, 0)]), 2, 0)
    result = solved(nlp, [1, 1])
    assert result.success
    assert result.objective == pytest.approx(1, abs=1e-5)


# ---------------------------------------------------------------------------------- scales


@pytest.mark.parametrize("seed", range(60))
def test_variables_of_very_different_size(seed: int) -> None:
    unit = 10.0 ** np.random.default_rng(seed).uniform(-6, 6, 4)

    def formula(*z):
        a, b, c, d = (v / u for v, u in zip(z, unit, strict=True))
        return (a - 1) ** 2 + (b - 2) ** 2 + (c - 3) ** 2 + (d - 4) ** 2 + a * d, [
            equal(a + b + c, 3),
            at_most(c**2 + d**2, 9),
        ]

    nlp = nlp_from(formula, 4)
    for start in (unit, 0 * unit):
        result = solved(nlp, start)
        assert result.success
        assert result.objective == pytest.approx(5.070963, rel=1e-5)


def test_huge_multipliers() -> None:
    nlp = nlp_from(lambda x, y: (1e6 * (x + y), [at_most(1e-4 * (x**2 + y**2 - 2), 0)]), 2)
    result = solved(nlp, [0.5, 0.3])
    assert result.success
    np.testing.assert_allclose(result.x, [-1, -1], atol=1e-5)
    assert result.multipliers[0] == pytest.approx(5e9, rel=1e-4)


def test_large_values_of_constraints() -> None:
    nlp = nlp_from(lambda x, y: ((x - 5) ** 2 + y**2, [equal(1e8 * (x * y - 1), 0)]), 2)
    x = optimum(nlp, [3, 1])
    assert x[0] * x[1] == pytest.approx(1, abs=1e-12)


# ------------------------------------------------------------------------ functions with edges


@BACKENDS
@pytest.mark.parametrize("kind", [HessianKind.EXACT, HessianKind.BFGS])
def test_functions_without_a_value_a_step_away(qp: BackendKind, kind: HessianKind) -> None:
    far_step = nlp_from(lambda x: (x - log(x), []), 1)
    np.testing.assert_allclose(optimum(far_step, [3.5], qp=qp, hessian_kind=kind), [1], atol=1e-5)
    root = nlp_from(lambda x, y: (x + y, [at_least(sqrt(x) * y, 1), at_least(y, 0.2)]), 2)
    x = optimum(root, [9, 4], qp=qp, hessian_kind=kind)
    assert np.sqrt(x[0]) * x[1] == pytest.approx(1, abs=1e-5)
    pole = nlp_from(lambda x, y: (1 / x + x + y**2, [at_least(x + y, 1)]), 2)
    x = optimum(pole, [0.01, 3], qp=qp, hessian_kind=kind)
    np.testing.assert_allclose(x, [1, 0], atol=1e-4)


def test_overflow_a_step_away() -> None:
    nlp = nlp_from(lambda x: (exp(exp(x)) - 20 * x, []), 1)
    x = optimum(nlp, [-5])
    assert np.exp(x + np.exp(x)) == pytest.approx(20, rel=1e-6)


# ---------------------------------------------------------------------- shapes of the answers


def test_lists_whole_numbers_and_numbers_serve_as_arrays() -> None:
    nlp = NLP(
        n=2,
        m=1,
        objective=lambda x: np.array([[x[0] ** 2 + x[1] ** 2]]),
        gradient=lambda x: [2 * x[0], 2 * x[1]],
        constraints=lambda x: [x[0] + x[1]],
        jacobian=lambda x: [[1, 1]],
        hessian=lambda x, factor, y: [[2 * factor, 0], [0, 2 * factor]],
        x_lower=-5,
        x_upper=[5, 5],
        c_lower=np.array([1]),
        c_upper=2,
    )
    np.testing.assert_allclose(optimum(nlp, np.array([0, 3])), [0.5, 0.5], atol=1e-8)


def test_a_callable_may_reuse_its_array() -> None:
    plain = nlp_from(lambda x, y: (x**2 + 3 * y**2, [at_least(x * y, 1)]), 2)
    shelf = np.zeros(2)

    def gradient(x: FloatArray) -> FloatArray:
        assert plain.gradient is not None
        shelf[:] = plain.gradient(x)
        return shelf

    nlp = NLP(
        n=2,
        m=1,
        objective=plain.objective,
        gradient=gradient,
        constraints=plain.constraints,
        jacobian=plain.jacobian,
        c_lower=1,
    )
    np.testing.assert_allclose(optimum(nlp, [2, 2]), optimum(plain, [2, 2]), atol=1e-5)


@pytest.mark.parametrize("form", [sparse.csr_array, sparse.coo_array, sparse.csc_matrix])
def test_any_sparse_format(form) -> None:
    plain = nlp_from(lambda x, y: (x**2 + 3 * y**2, [at_least(x * y, 1)]), 2)
    assert plain.jacobian is not None and plain.hessian is not None
    jacobian, hessian = plain.jacobian, plain.hessian
    nlp = NLP(
        n=2,
        m=1,
        objective=plain.objective,
        gradient=plain.gradient,
        constraints=plain.constraints,
        jacobian=lambda x: form(jacobian(x)),
        hessian=lambda x, factor, y: form(hessian(x, factor, y)),
        c_lower=1,
    )
    np.testing.assert_allclose(optimum(nlp, [2, 2]), optimum(plain, [2, 2]), atol=1e-6)


def _outside_a_disc(slope: FloatArray) -> NLP:
    """Leave the disc of radius 2; zeros are left out of the Jacobian."""
    return NLP(
        n=2,
        m=1,
        objective=lambda x: slope @ x + x @ x,
        gradient=lambda x: slope + 2 * x,
        constraints=lambda x: np.array([x @ x]),
        jacobian=lambda x: sparse.csc_array(np.array([2 * x])),
        c_lower=4,
    )


def test_entries_may_vanish_from_a_sparse_jacobian() -> None:
    result = solved(_outside_a_disc(np.array([-1.0, 0.0])), [3, 1])
    assert result.status is Status.OPTIMAL
    np.testing.assert_allclose(result.x, [2, 0], atol=1e-5)


def test_entries_may_not_appear_in_a_sparse_jacobian() -> None:
    with pytest.raises(NlpError, match=r"jacobian: entry \(0, 1\) .*pattern"):
        solved(_outside_a_disc(np.array([-1.0, -2.0])), [3, 0])
