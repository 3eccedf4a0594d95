"""Properties on random problems: optima known by construction or from another solver, invariance
under order and scale, signs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy import sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, BackendKind, HessianKind, Status

from .honesty import solved
from .known_points import KnownPoint, known_point

seeds = st.integers(0, 2**32 - 1)
backends = st.sampled_from((BackendKind.INTERIOR_POINT, BackendKind.CLARABEL, BackendKind.OSQP))


# ------------------------------------------------------------------------------- convex QPs


@dataclass(frozen=True)
class QuadraticProgram:
    """Minimise ½xᵀPx + q·x with c_lower ≤ Ax ≤ c_upper and x_lower ≤ x ≤ x_upper."""

    P: FloatArray
    q: FloatArray
    A: FloatArray
    bounds: tuple[FloatArray, FloatArray, FloatArray, FloatArray]

    def nlp(self, as_sparse: bool) -> NLP:
        kind = sparse.csr_array if as_sparse else np.array
        x_lower, x_upper, c_lower, c_upper = self.bounds
        m, n = self.A.shape
        return NLP(
            n=n,
            m=m,
            objective=lambda x: 0.5 * x @ self.P @ x + self.q @ x,
            gradient=lambda x: self.P @ x + self.q,
            constraints=(lambda x: self.A @ x) if m else None,
            jacobian=(lambda x: kind(self.A)) if m else None,
            hessian=lambda x, factor, y: kind(factor * self.P),
            x_lower=x_lower,
            x_upper=x_upper,
            c_lower=c_lower if m else None,
            c_upper=c_upper if m else None,
        )

    def optimum(self) -> float:
        import cvxpy  # a second, which collecting the tests need not take

        m, n = self.A.shape
        x = cvxpy.Variable(n)
        x_lower, x_upper, c_lower, c_upper = self.bounds
        sides = [(x, x_lower, x_upper)]
        if m:
            sides.append((self.A @ x, c_lower, c_upper))
        rows = []
        for value, lower, upper in sides:
            low, high = np.isfinite(lower), np.isfinite(upper)
            rows += [value[low] >= lower[low]] if low.any() else []
            rows += [value[high] <= upper[high]] if high.any() else []
        objective = cvxpy.Minimize(0.5 * cvxpy.quad_form(x, cvxpy.psd_wrap(self.P)) + self.q @ x)
        whole = cvxpy.Problem(objective, rows)
        whole.solve(solver="CLARABEL", tol_gap_abs=1e-10, tol_gap_rel=1e-10, tol_feas=1e-10)
        assert whole.status == "optimal"
        return float(whole.value)


@st.composite
def convex_programs(draw: st.DrawFn) -> QuadraticProgram:
    n, m = draw(st.integers(1, 8)), draw(st.integers(0, 8))
    random = np.random.default_rng(draw(seeds))
    root = random.standard_normal((n, draw(st.integers(0, n))))
    A = random.standard_normal((m, n)) * (random.random((m, n)) < 0.7)
    feasible = random.standard_normal(n)

    def sides(value: FloatArray, share_open: float) -> tuple[FloatArray, FloatArray]:
        away = random.exponential(1.0, (2, len(value)))
        away[random.random(away.shape) < share_open] = np.inf
        return value - away[0], value + away[1]

    x_lower, x_upper = sides(feasible, 0.0)  # bounded, whatever the rank of P
    c_lower, c_upper = sides(A @ feasible, 0.4)
    equal = random.random(m) < 0.3
    c_lower[equal] = c_upper[equal] = (A @ feasible)[equal]
    bounds = (x_lower, x_upper, c_lower, c_upper)
    return QuadraticProgram(root @ root.T, random.standard_normal(n), A, bounds)


@settings(max_examples=60)
@given(program=convex_programs(), as_sparse=st.booleans(), backend=backends)
def test_convex_programs_end_where_cvxpy_does(
    program: QuadraticProgram, as_sparse: bool, backend: BackendKind
) -> None:
    nlp = program.nlp(as_sparse)
    result = solved(nlp, np.zeros(nlp.n), qp=backend)
    assert result.status is Status.OPTIMAL
    assert result.iterations <= 5
    assert result.objective == pytest.approx(program.optimum(), rel=1e-5, abs=1e-5)


# ------------------------------------------------------------------------ known KKT points

sizes = st.tuples(st.integers(1, 10), st.integers(1, 8))


@settings(max_examples=60)
@given(seed=seeds, size=sizes, backend=backends, as_sparse=st.booleans())
def test_a_known_optimum_is_found_from_nearby(
    seed: int, size: tuple[int, int], backend: BackendKind, as_sparse: bool
) -> None:
    known = known_point(seed, *size)
    result = solved(known.nlp(as_sparse=as_sparse), known.start(0.02), qp=backend, tolerance=1e-8)
    assert result.success
    np.testing.assert_allclose(result.x, known.x, atol=1e-5)
    np.testing.assert_allclose(result.multipliers, known.multipliers, atol=1e-4)
    np.testing.assert_allclose(result.bound_multipliers, known.bound_multipliers, atol=1e-4)


@pytest.mark.parametrize("kind", [HessianKind.EXACT, HessianKind.BFGS, HessianKind.DIFFERENCES])
def test_far_starts_lead_to_an_optimum_too(kind: HessianKind) -> None:
    ended = []
    for seed in range(40):
        known = known_point(seed, 6, 5)
        result = solved(known.nlp(), known.start(2.0, seed), hessian_kind=kind)
        ended.append(result.status)
        if result.success and kind is HessianKind.EXACT:
            assert result.iterations <= 60
    assert ended.count(Status.OPTIMAL) >= 38, ended


@settings(max_examples=40)
@given(seed=seeds, size=sizes)
def test_multipliers_have_the_sign_of_their_side(seed: int, size: tuple[int, int]) -> None:
    known = known_point(seed, *size)
    nlp = known.nlp()
    result = solved(nlp, known.start(0.02))
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    for multipliers, lower, upper in (
        (result.multipliers, c_lower, c_upper),
        (result.bound_multipliers, x_lower, x_upper),
    ):
        open_above, open_below = np.isposinf(upper), np.isneginf(lower)
        assert (multipliers[open_above] <= 1e-6).all()
        assert (multipliers[open_below] >= -1e-6).all()
    slope = known.gradient(result.x) + known.jacobian(result.x).T @ result.multipliers
    np.testing.assert_allclose(slope + result.bound_multipliers, 0.0, atol=1e-6)


def test_the_sign_of_multipliers_on_a_problem_done_by_hand() -> None:
    """Minimise −x − 2y with x + y ≤ 1 and y ≤ 0.25: λ = 1 on the row, ν = 1 on y."""
    nlp = NLP(
        n=2,
        m=1,
        objective=lambda x: -x[0] - 2 * x[1],
        gradient=lambda x: np.array([-1.0, -2.0]),
        constraints=lambda x: np.array([x[0] + x[1]]),
        jacobian=lambda x: np.array([[1.0, 1.0]]),
        hessian=lambda x, factor, y: np.zeros((2, 2)),
        x_upper=[np.inf, 0.25],
        c_upper=1,
    )
    result = solved(nlp, [0, 0])
    np.testing.assert_allclose(result.x, [0.75, 0.25], atol=1e-9)
    np.testing.assert_allclose(result.multipliers, [1.0], atol=1e-8)
    np.testing.assert_allclose(result.bound_multipliers, [0.0, 1.0], atol=1e-8)


# ------------------------------------------------------------------------------ invariance


def _permuted(known: KnownPoint, variables: np.ndarray, rows: np.ndarray) -> NLP:
    back = np.argsort(variables)
    x_lower, x_upper, c_lower, c_upper = known.bounds
    return NLP(
        n=len(variables),
        m=len(rows),
        objective=lambda z: known.objective(z[back]),
        gradient=lambda z: known.gradient(z[back])[variables],
        constraints=lambda z: known.constraints(z[back])[rows],
        jacobian=lambda z: known.jacobian(z[back])[rows][:, variables],
        hessian=lambda z, factor, y: known.hessian(z[back], factor, y[np.argsort(rows)])[
            np.ix_(variables, variables)
        ],
        x_lower=x_lower[variables],
        x_upper=x_upper[variables],
        c_lower=c_lower[rows],
        c_upper=c_upper[rows],
    )


@settings(max_examples=30)
@given(seed=seeds, size=sizes, backend=backends)
def test_the_order_of_variables_and_constraints_does_not_matter(
    seed: int, size: tuple[int, int], backend: BackendKind
) -> None:
    known = known_point(seed, *size)
    random = np.random.default_rng(seed)
    variables, rows = random.permutation(size[0]), random.permutation(size[1])
    start = known.start(0.02)
    plain = solved(known.nlp(), start, qp=backend, tolerance=1e-8)
    other = solved(_permuted(known, variables, rows), start[variables], qp=backend, tolerance=1e-8)
    np.testing.assert_allclose(other.x, plain.x[variables], atol=1e-6)
    np.testing.assert_allclose(other.multipliers, plain.multipliers[rows], atol=1e-5)


def _scaled(known: KnownPoint, x_unit: FloatArray, c_unit: FloatArray, f_unit: float) -> NLP:
    """The problem in other units: x = x_unit z, c = c_unit times the old one, f likewise."""
    x_lower, x_upper, c_lower, c_upper = known.bounds
    return NLP(
        n=len(x_unit),
        m=len(c_unit),
        objective=lambda z: f_unit * known.objective(x_unit * z),
        gradient=lambda z: f_unit * x_unit * known.gradient(x_unit * z),
        constraints=lambda z: c_unit * known.constraints(x_unit * z),
        jacobian=lambda z: c_unit[:, None] * known.jacobian(x_unit * z) * x_unit,
        hessian=lambda z, factor, y: (
            known.hessian(x_unit * z, factor * f_unit, y * c_unit) * np.outer(x_unit, x_unit)
        ),
        x_lower=x_lower / x_unit,
        x_upper=x_upper / x_unit,
        c_lower=c_lower * c_unit,
        c_upper=c_upper * c_unit,
    )


@settings(max_examples=40)
@given(seed=seeds, size=sizes)
@example(seed=9727, size=(5, 2))  # solved with an active row 2e-6 from its bound
def test_units_do_not_matter(seed: int, size: tuple[int, int]) -> None:
    known = known_point(seed, *size)
    random = np.random.default_rng(seed)
    # With three decades each way one in 150 crawls: rounding of the objective hides progress.
    x_unit = 10.0 ** random.uniform(-2, 2, size[0])
    c_unit = 10.0 ** random.uniform(-2, 2, size[1])
    f_unit = 10.0 ** random.uniform(-2, 2)
    nlp = _scaled(known, x_unit, c_unit, f_unit)
    tolerance = 1e-6
    result = solved(nlp, known.start(0.01) / x_unit, tolerance=tolerance)
    assert result.success
    # What residuals within the tolerance leave to be gained: slopes by the least curvature (0.3),
    # violations by their multipliers, and active rows and bounds kept at a distance, as the product
    # of multiplier and distance is what counts.
    slope = tolerance / (f_unit * x_unit)
    active = np.count_nonzero(known.multipliers) + np.count_nonzero(known.bound_multipliers)
    left = np.sum(slope**2) / (2 * 0.3) + np.sum(np.abs(known.multipliers) * tolerance / c_unit)
    left += active * tolerance / f_unit
    if result.status is Status.OPTIMAL:
        assert known.objective(result.x * x_unit) == pytest.approx(0.0, abs=10 * left + 1e-9)


@settings(max_examples=20)
@given(seed=seeds, size=sizes)
def test_dense_and_sparse_matrices_give_the_same(seed: int, size: tuple[int, int]) -> None:
    known = known_point(seed, *size)
    start = known.start(0.5)
    dense = solved(known.nlp(as_sparse=False), start)
    thin = solved(known.nlp(as_sparse=True), start)
    assert thin.status is dense.status
    np.testing.assert_allclose(thin.x, dense.x, atol=1e-6)


def _in_units(program: QuadraticProgram, x_unit: FloatArray, c_unit: FloatArray) -> NLP:
    """The program with x = x_unit z and its rows times c_unit."""
    x_lower, x_upper, c_lower, c_upper = program.bounds
    A = c_unit[:, None] * program.A * x_unit
    bounds = (x_lower / x_unit, x_upper / x_unit, c_unit * c_lower, c_unit * c_upper)
    P = program.P * np.outer(x_unit, x_unit)
    return QuadraticProgram(P, program.q * x_unit, A, bounds).nlp(as_sparse=False)


@settings(max_examples=60)
@given(program=convex_programs(), seed=seeds, exact=st.booleans())
def test_in_far_apart_units_nothing_false_is_claimed(
    program: QuadraticProgram, seed: int, exact: bool
) -> None:
    """Feasible, bounded and convex: there is one optimum, which need not be reached."""
    random = np.random.default_rng(seed)
    m, n = program.A.shape
    x_unit = 10.0 ** random.uniform(-6, 6, n)
    nlp = _in_units(program, x_unit, 10.0 ** random.uniform(-3, 3, m))
    kind = HessianKind.EXACT if exact else HessianKind.BFGS
    start = random.standard_normal(n) / x_unit
    result = solved(nlp, start, hessian_kind=kind, max_iterations=60)
    assert result.status in (Status.OPTIMAL, Status.ACCEPTABLE, Status.ITERATION_LIMIT)
    if result.success:
        # By convexity a slope of the Lagrangian loses at most its product with the distance.
        x_lower, x_upper, *_ = nlp.bounds
        size = np.abs(program.P * np.outer(x_unit, x_unit)) @ np.abs(result.x)
        size += np.abs(program.q * x_unit) + np.abs(result.multipliers).sum()
        slope = 1e-5 * np.maximum(1.0, size)
        lost = float(slope @ (x_upper - x_lower)) + 1e-4 * np.abs(result.multipliers).sum()
        assert result.objective <= program.optimum() + lost + 1e-5
