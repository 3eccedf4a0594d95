"""Callbacks, limits, boxes for steps, warm starts, back ends."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, BackendKind, HessianKind, Iteration, NlpError, Status, solve
from flyby.validation.textbook import DoubleIntegrator

from .honesty import solved
from .jets import exp, sin
from .known_points import known_point
from .problem import at_least, at_most, equal, nlp_from


def curved() -> NLP:
    """Rosenbrock's valley outside of a disc: some iterations from (−1.2, 1)."""
    return nlp_from(
        lambda x, y: (
            100 * (y - x**2) ** 2 + (1 - x) ** 2,
            [at_most(x**2 + y**2, 1.5), at_least(x + 2 * y, 0.1)],
        ),
        2,
    )


START = [-1.2, 1]


# ------------------------------------------------------------------- callbacks and limits


def test_a_callback_sees_each_iteration() -> None:
    seen: list[Iteration] = []

    def callback(iteration: Iteration) -> None:
        seen.append(iteration)

    nlp = curved()
    result = solved(nlp, START, callback=callback)
    assert [i.number for i in seen] == list(range(len(seen)))
    assert 0 <= result.iterations - seen[-1].number <= 1
    np.testing.assert_array_equal(seen[0].x, START)
    assert nlp.objective is not None and nlp.constraints is not None
    for iteration in seen:
        assert iteration.objective == pytest.approx(nlp.objective(iteration.x), rel=1e-12)
        c = nlp.constraints(iteration.x)
        violation = np.maximum(nlp.bounds[2] - c, c - nlp.bounds[3]).max(initial=0)
        assert iteration.constraint_violation == pytest.approx(violation, abs=1e-12)
        assert np.isfinite(iteration.kkt_residual)
    for before, after in pairwise(seen):
        assert after.step == pytest.approx(np.abs(after.x - before.x).max())
        assert 0 < after.step_length <= 1 and after.kind


def test_what_a_callback_does_to_its_point_does_not_matter() -> None:
    def spoil(iteration: Iteration) -> None:
        iteration.x[:] = 1e9

    assert solved(curved(), START, callback=spoil).x == pytest.approx(solved(curved(), START).x)


def test_a_callback_interrupts() -> None:
    result = solved(curved(), START, callback=lambda iteration: iteration.number == 3)
    assert result.status is Status.INTERRUPTED
    assert result.iterations == 3
    assert np.isfinite(result.objective)


@pytest.mark.parametrize("name", ["callback", "objective", "jacobian"])
def test_the_keyboard_interrupts(name: str) -> None:
    calls = 0

    def interrupting(function):
        def call(*arguments):
            nonlocal calls
            calls += 1
            if calls == 4:
                raise KeyboardInterrupt
            return function(*arguments)

        return call

    nlp = curved()
    if name == "callback":
        result = solved(nlp, START, callback=interrupting(lambda iteration: False))
    else:
        fields = ("n", "m", "objective", "gradient", "constraints", "jacobian", "hessian")
        fields = (*fields, "c_lower", "c_upper")
        values = {field: getattr(nlp, field) for field in fields}
        result = solved(NLP(**{**values, name: interrupting(values[name])}), START)
    assert result.status is Status.INTERRUPTED
    assert np.isfinite(result.x).all()


def test_an_exception_from_a_callback_passes_through() -> None:
    def broken(iteration: Iteration) -> None:
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        solved(curved(), START, callback=broken)


def test_no_iterations_judge_the_start() -> None:
    result = solved(curved(), START, max_iterations=0)
    assert result.status is Status.ITERATION_LIMIT
    assert result.iterations == 0
    np.testing.assert_array_equal(result.x, START)
    optimum = solved(curved(), START)
    plain = nlp_from(lambda x: ((x - 2) ** 2, []), 1)
    assert solved(plain, [2], max_iterations=0).status is Status.OPTIMAL
    assert optimum.success


@pytest.mark.parametrize("limit", [1, 2, 5])
def test_the_limit_returns_the_best_point_seen(limit: int) -> None:
    seen: list[Iteration] = []
    result = solved(curved(), START, max_iterations=limit, callback=seen.append)
    assert result.status is Status.ITERATION_LIMIT
    assert result.iterations <= limit
    feasible = [i.objective for i in seen if i.constraint_violation <= 1e-6]
    if feasible:
        assert result.constraint_violation <= 1e-6
        assert result.objective <= min(feasible) + 1e-12
    else:
        least = min(i.constraint_violation for i in seen)
        assert result.constraint_violation <= least + 1e-12


# --------------------------------------------------------------------------- boxes for steps


@pytest.mark.parametrize("qp", [BackendKind.CLARABEL, BackendKind.OSQP])
@pytest.mark.parametrize("kind", [HessianKind.EXACT, HessianKind.BFGS])
def test_steps_stay_in_their_box(qp: BackendKind, kind: HessianKind) -> None:
    asked: list[tuple[int, FloatArray]] = []
    seen: list[FloatArray] = []

    def box(number: int, x: FloatArray) -> tuple[list[float], list[float]]:
        asked.append((number, x))
        return [-0.05, -0.02 * (1 + number % 2)], [0.04, 0.1]

    def callback(iteration: Iteration) -> None:
        seen.append(iteration.x)

    result = solved(curved(), START, step_box=box, callback=callback, qp=qp, hessian_kind=kind)
    assert result.success
    assert result.x == pytest.approx(solved(curved(), START).x, abs=1e-4)
    steps = np.diff(np.array([*seen, result.x]), axis=0)
    slack = 1e-7
    assert (steps >= np.array([-0.05, -0.04]) - slack).all()
    assert (steps <= np.array([0.04, 0.1]) + slack).all()
    assert len(steps) >= 20  # the way is long for such steps
    for number, x in asked:
        np.testing.assert_array_equal(x, seen[number])


def test_a_box_of_no_size_holds_a_variable() -> None:
    seen: list[float] = []
    solved(
        curved(),
        START,
        step_box=lambda number, x: ([0, -1], [0, 1]),
        callback=lambda iteration: seen.append(float(iteration.x[0])),
        max_iterations=20,
    )
    assert seen and all(x == START[0] for x in seen)


def test_an_open_box_changes_nothing() -> None:
    free = solved(curved(), START)
    boxed = solved(curved(), START, step_box=lambda number, x: ([-np.inf] * 2, [np.inf] * 2))
    np.testing.assert_array_equal(boxed.x, free.x)
    assert boxed.iterations == free.iterations


# ------------------------------------------------------------------------------ warm starts


def chained(shift: float) -> NLP:
    """Ten variables in a chain; ``shift`` perturbs data of rows and objective."""

    def formula(*x):
        pairs = list(pairwise(x))
        f = sum((a - 1 - shift) ** 2 + 0.5 * exp(0.3 * a * b) for a, b in pairs)
        equalities = [equal(a + sin(b) * b, 1 + shift) for a, b in pairs[::3]]
        return f, [*equalities, *(at_most(a**2 + b**2, 1.2 + shift) for a, b in pairs[2::2])]

    return nlp_from(formula, 10)


@pytest.mark.parametrize("qp", [BackendKind.CLARABEL, BackendKind.OSQP])
@pytest.mark.parametrize("shift", [1e-3, 1e-2, 0.05])
def test_warm_starts_take_no_more_iterations(qp: BackendKind, shift: float) -> None:
    before = solved(chained(0.0), np.full(10, 0.4), qp=qp)
    cold = solved(chained(shift), np.full(10, 0.4), qp=qp)
    warm = solved(chained(shift), before.x, warm_start=before, qp=qp)
    assert cold.success and warm.success
    assert warm.iterations < cold.iterations
    assert warm.objective == pytest.approx(cold.objective, rel=1e-6)


def test_the_solution_itself_needs_no_iteration() -> None:
    before = solved(chained(0.0), np.full(10, 0.4))
    again = solved(chained(0.0), before.x, warm_start=before)
    assert again.status is Status.OPTIMAL
    assert again.iterations == 0
    np.testing.assert_array_equal(again.x, before.x)


def test_warm_starts_of_random_problems_with_perturbed_data() -> None:
    totals = [0, 0]
    for seed in range(15):
        known = known_point(seed, 8, 6)
        nlp = known.nlp()
        cold = solved(nlp, known.start(1.0, seed))
        near = solved(nlp, known.start(1e-3, seed), warm_start=cold)
        totals[0] += cold.iterations
        totals[1] += near.iterations
        assert near.success
    assert totals[1] <= 0.6 * totals[0]


@settings(max_examples=15, deadline=None)
@given(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))
def test_a_moved_switching_point_takes_few_steps_and_no_back_end(x: float, v: float) -> None:
    """The active set of a minimum-time motion is a vertex: what enters it makes another leave."""
    before = DoubleIntegrator(60)
    known = solve(before.nlp(), before.initial_guess())
    moved = DoubleIntegrator(60, start=(4.0 + x, 1.0 + v))
    warm = solved(moved.nlp(), known.x, warm_start=known)
    cold = solved(moved.nlp(), moved.initial_guess())
    assert warm.success and warm.objective == pytest.approx(cold.objective, rel=1e-5)
    assert warm.iterations <= 6 and warm.timings.subproblems == 0.0


def test_a_warm_start_leads_to_no_maximum() -> None:
    nlp = nlp_from(lambda x: (-(x**2), []), 1, lower=[-1.0], upper=[2.0])
    top = solve(nlp, [0.0])
    assert top.x[0] == 0.0
    found = solved(nlp, [0.1], warm_start=top)
    assert found.objective <= -1.0


@pytest.mark.parametrize("most", [0, 1])
def test_a_warm_start_keeps_to_the_iterations_that_it_may_take(most: int) -> None:
    before = solved(chained(0.0), np.full(10, 0.4))
    seen: list[int] = []
    solve(
        chained(0.05),
        before.x,
        warm_start=before,
        max_iterations=most,
        callback=lambda it: seen.append(it.number),
    )
    assert seen == list(range(most + 1))


def test_a_warm_start_from_another_problem_does_no_harm() -> None:
    other = solved(known_point(3, 4, 3).nlp(), np.zeros(4))
    result = solved(chained(0.0), np.full(10, 0.4), warm_start=other)
    assert result.objective == pytest.approx(solved(chained(0.0), np.full(10, 0.4)).objective)


# --------------------------------------------------------------------------- back ends, kinds


@pytest.mark.parametrize("fallback", [True, False])
@pytest.mark.parametrize("qp", [BackendKind.CLARABEL, BackendKind.OSQP, "clarabel", "osqp"])
def test_either_back_end_alone_or_helped(qp: BackendKind | str, fallback: bool) -> None:
    result = solved(curved(), START, qp=qp, fallback=fallback)
    assert result.status is Status.OPTIMAL
    if not fallback:
        assert result.backend == str(BackendKind(qp))


@pytest.mark.parametrize("tolerance", [1e-4, 1e-8])
def test_the_tolerance_is_met(tolerance: float) -> None:
    result = solved(curved(), START, tolerance=tolerance)
    assert result.status is Status.OPTIMAL
    assert max(result.kkt_residual, result.constraint_violation) <= tolerance


# ---------------------------------------------------------------------------- least squares

TIMES = np.linspace(0, 2, 25)


def fit(truth: FloatArray, noise: float, *, tied: bool) -> NLP:
    """Amplitude and rate of a decay; tied: with their product given."""
    random = np.random.default_rng(7)
    data = truth[0] * np.exp(-truth[1] * TIMES) + noise * random.standard_normal(len(TIMES))
    ties = {
        "m": 1,
        "constraints": lambda x: np.array([x[0] * x[1]]),
        "jacobian": lambda x: np.array([[x[1], x[0]]]),
        "c_lower": 3.0,
        "c_upper": 3.0,
    }

    def residual_jacobian(x: FloatArray) -> FloatArray:
        decay = np.exp(-x[1] * TIMES)
        return np.stack([decay, -x[0] * TIMES * decay], axis=1)

    return NLP(
        n=2,
        residuals=lambda x: x[0] * np.exp(-x[1] * TIMES) - data,
        residual_jacobian=residual_jacobian,
        **(ties if tied else {}),
    )


@pytest.mark.parametrize("kind", [None, HessianKind.GAUSS_NEWTON, HessianKind.BFGS])
def test_least_squares(kind: HessianKind | None) -> None:
    truth = np.array([2.0, 1.5])
    exact = solved(fit(truth, 0.0, tied=False), [1, 0.5], hessian_kind=kind)
    np.testing.assert_allclose(exact.x, truth, atol=1e-5)
    assert exact.objective == pytest.approx(0, abs=1e-9)
    tied = solved(fit(truth, 0.05, tied=True), [1, 1], hessian_kind=kind)
    assert tied.status is Status.OPTIMAL
    assert tied.x.prod() == pytest.approx(3)
    np.testing.assert_allclose(tied.x, truth, atol=0.1)


def test_gauss_newton_needs_few_iterations_where_residuals_are_small() -> None:
    nlp = fit(np.array([2.0, 1.5]), 0.01, tied=False)
    newton = solved(nlp, [1, 0.5])
    assert newton.iterations <= 10
    assert newton.iterations <= solved(nlp, [1, 0.5], hessian_kind="bfgs").iterations


def test_residual_jacobians_have_the_residuals_shape() -> None:
    nlp = NLP(n=2, residuals=lambda x: np.zeros(3), residual_jacobian=lambda x: np.eye(2))
    with pytest.raises(NlpError, match="residual_jacobian gave shape"):
        solved(nlp, [0, 0])
