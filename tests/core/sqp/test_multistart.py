"""The best of several starts."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.sqp import NLP, Result, Status, scattered_starts, solve, solve_from
from flyby.validation.textbook import DoubleIntegrator

from .honesty import assert_honest
from .jets import cos, log
from .problem import at_least, at_most, nlp_from


def waves() -> NLP:
    """Many local minima on a line, and a disc to stay in; the lowest near x = 0."""
    return nlp_from(
        lambda x, y: (0.1 * x**2 - 2 * cos(3 * x) + y**2, [at_most(x**2 + y**2, 100)]), 2
    )


STARTS = [[6.0, 1.0], [-4.2, 0.5], [0.4, 2.0], [9.0, 0.0]]


def test_the_best_is_the_lowest() -> None:
    found = solve_from(waves(), STARTS)
    assert len(found.results) == len(STARTS)
    assert all(r.success for r in found.results)
    assert len({round(r.objective, 3) for r in found.results}) > 1
    assert found.result is found.results[found.best]
    assert found.result.objective == min(r.objective for r in found.results)
    assert found.result.objective == pytest.approx(-2)


def test_results_come_in_the_order_of_the_starts_and_are_honest() -> None:
    nlp = waves()
    for start, result in zip(STARTS, solve_from(nlp, STARTS).results, strict=True):
        assert_honest(nlp, result)
        alone = solve_from(nlp, [start]).result
        np.testing.assert_array_equal(alone.x, result.x)


def test_in_parallel_the_results_are_the_same() -> None:
    one, two = (solve_from(waves(), STARTS, workers=workers) for workers in (1, 2))
    assert one.best == two.best
    for a, b in zip(one.results, two.results, strict=True):
        np.testing.assert_array_equal(a.x, b.x)
        assert (a.status, a.iterations) == (b.status, b.iterations)


@pytest.mark.parametrize("workers", [1, 2])
def test_options_reach_the_solver(workers: int) -> None:
    found = solve_from(waves(), STARTS[:2], workers=workers, max_iterations=0)
    assert [r.status for r in found.results] == [Status.ITERATION_LIMIT] * 2


def test_failures_of_some_starts_do_not_matter() -> None:
    """√ has no value left of zero: those starts fail at once."""

    def objective(x: np.ndarray) -> float:
        return float(np.sqrt(x[0]) + (x[0] - 2) ** 2)

    nlp = NLP(
        n=1,
        objective=objective,
        gradient=lambda x: np.array([0.5 / np.sqrt(x[0]) + 2 * (x[0] - 2)]),
        x_upper=5,
    )
    found = solve_from(nlp, [[-1.0], [3.0], [-2.0]])
    assert [r.status for r in found.results].count(Status.CALLABLE_ERROR) == 2
    assert found.best == 1 and found.result.success


def test_without_a_success_the_least_violated_point_is_the_best() -> None:
    nlp = nlp_from(lambda x, y: (x, [at_least(x**2 + y**2, 10), at_most(x + y, 10)]), 2, 0, 2)
    found = solve_from(nlp, [[0.0, 0.1], [1.0, 1.0]])
    assert not any(r.success for r in found.results)
    least = min(r.constraint_violation for r in found.results)
    assert found.result.constraint_violation == least == pytest.approx(2)


def test_a_certificate_may_refuse_results() -> None:
    def on_the_right(result: Result) -> bool:
        return bool(result.x[0] > 1)

    found = solve_from(waves(), STARTS, accept=on_the_right)
    assert found.result.x[0] > 1
    right = [r.objective for r in found.results if on_the_right(r)]
    assert found.result.objective == min(right)


def test_what_a_certificate_refuses_is_not_handed_out() -> None:
    shown: list[Result] = []

    def refuse(result: Result) -> bool:
        shown.append(result)
        return False

    nlp = nlp_from(lambda x: (x - log(x), []), 1)
    found = solve_from(nlp, [[-1.0], [3.0]], accept=refuse)
    assert found.best is None and found.result is None
    assert found.accepted == (False, False)
    assert [r.success for r in shown] == [True]  # failures are not asked about
    assert solve_from(nlp, [[-1.0], [3.0]], accept=lambda r: True).accepted == (False, True)


def test_the_same_seed_gives_the_same_starts() -> None:
    nlp = NLP(n=3, x_lower=0, x_upper=[1, np.inf, 1])
    a, b, c = (scattered_starts(nlp, [0.5, 0.5, 7], 6, seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(a, b)
    assert np.abs(np.array(a) - np.array(c)).max() > 1e-3
    np.testing.assert_array_equal(a[0], [0.5, 0.5, 1])
    assert len(a) == 6
    assert (np.array(a) >= 0).all() and (np.array(a)[:, [0, 2]] <= 1).all()


def test_the_spread_is_that_of_each_variable() -> None:
    starts = np.array(scattered_starts(NLP(n=2), [5, 5], 400, spread=[0.1, 3.0], seed=3))
    assert starts[1:].std(axis=0) == pytest.approx([0.1, 3.0], rel=0.15)
    assert starts[1:].mean(axis=0) == pytest.approx([5, 5], abs=0.6)


def test_scattered_starts_find_the_lowest_minimum() -> None:
    nlp = waves()
    starts = scattered_starts(nlp, [6.0, 1.0], 30, spread=4.0, seed=0)
    alone = solve_from(nlp, starts[:1]).result
    best = solve_from(nlp, starts).result
    assert best.objective == pytest.approx(-2)
    assert best.objective < alone.objective - 1


def _two_wells() -> NLP:
    return nlp_from(lambda x, y: ((x**2 - 1) ** 2 + 0.1 * x + y**2, [at_most(y, 3)]), 2)


@pytest.mark.parametrize("workers", [1, 2])
def test_different_optima_are_kept_apart(workers: int) -> None:
    starts = [(1.0, 0.0), (0.8, 1.0), (-0.7, 0.5), (-1.2, -1.0), (1.1, 0.2)]
    found = solve_from(_two_wells(), starts, workers=workers)
    assert len(found.distinct) == 2
    assert found.distinct[0] == found.best
    assert found.results[found.distinct[0]].x[0] < 0 < found.results[found.distinct[1]].x[0]


def test_it_stops_where_nothing_new_is_found() -> None:
    starts = [(1.0, 0.0), (-0.7, 0.5)] + [(1.0, 0.1 * k) for k in range(20)]
    found = solve_from(_two_wells(), starts, patience=4)
    assert len(found.results) == 6
    assert len(found.distinct) == 2


def test_starts_share_the_symbolic_work() -> None:
    problem = DoubleIntegrator(30)
    nlp, start = problem.nlp(), problem.initial_guess()
    first = solve(nlp, start)
    again = solve(nlp, start, structure_of=first)
    assert again.workspace is first.workspace
    assert again.method == "interior_point"
    np.testing.assert_array_equal(again.x, first.x)
