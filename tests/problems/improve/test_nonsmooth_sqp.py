"""The search on functions with kinks whose optima are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray, IntArray
from flyby.problems.improve.nonsmooth_sqp import SearchEffort, search, violation


@dataclass(frozen=True)
class At:
    x: FloatArray
    objective: float
    constraints: FloatArray


class Largest:
    """The largest of planes and paraboloids aᵢ·x + ½ hᵢ|x|² + bᵢ, where normal·x ≥ least."""

    def __init__(
        self, slopes: FloatArray, bends: FloatArray, normal: FloatArray, least: float
    ) -> None:
        self.slopes, self.bends, self.normal, self.least = slopes, bends, normal, least
        n = slopes.shape[1]
        self.lower, self.upper, self.scale = -np.ones(n), np.ones(n), np.full(n, 0.1)

    def _pieces(self, x: FloatArray) -> FloatArray:
        return np.asarray(self.slopes @ x + 0.5 * self.bends * (x @ x))

    def point(self, x: FloatArray) -> At | None:
        room = np.array([self.normal @ x - self.least])
        return At(x, float(self._pieces(x).max()), room)

    def gradient(self, point: At) -> FloatArray:
        i = int(np.argmax(self._pieces(point.x)))
        return np.asarray(self.slopes[i] + self.bends[i] * point.x)

    def jacobian(self, point: At, rows: IntArray) -> FloatArray:
        return self.normal[None][rows]

    def candidates(self, point: At, box: FloatArray) -> IntArray:
        return np.arange(1)


@given(seed=st.integers(0, 10_000), n=st.integers(2, 6))
@settings(max_examples=30, deadline=None)
def test_kinks_are_followed_to_the_optimum(seed: int, n: int) -> None:
    random = np.random.default_rng(seed)
    slopes = random.normal(size=(2 * n, n))
    # With every slope its opposite, the optimum without the constraint is the origin.
    slopes = np.concatenate([slopes, -slopes])
    problem = Largest(slopes, np.ones(len(slopes)), random.normal(size=n), -10.0)
    start = problem.point(random.uniform(-0.8, 0.8, n))
    assert start is not None
    found = search(problem, start, SearchEffort(iterations=200, tolerance=1e-9))
    assert found.point.objective < 1e-3 * max(1.0, start.objective)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_what_is_found_holds_the_constraint_and_is_not_worse(seed: int) -> None:
    random = np.random.default_rng(seed)
    slopes = random.normal(size=(6, 3))
    normal = random.normal(size=3)
    problem = Largest(slopes, np.full(6, 0.5), normal, 0.3 * float(np.abs(normal).sum()))
    feasible = problem.point(0.6 * np.sign(normal))
    assert feasible is not None and violation(feasible) == 0.0
    found = search(problem, feasible, SearchEffort(iterations=60))
    assert found.violation <= 1e-6
    assert found.point.objective <= feasible.objective
    assert (np.abs(found.point.x) <= 1.0 + 1e-12).all()


def test_an_infeasible_start_becomes_feasible() -> None:
    problem = Largest(np.array([[1.0, 0.0]]), np.array([0.1]), np.array([1.0, 1.0]), 0.5)
    start = problem.point(np.array([-0.9, -0.9]))
    assert start is not None
    found = search(problem, start, SearchEffort(iterations=60))
    assert found.violation <= 1e-6
    # x₁ as small as the bound on x₂ lets it be.
    assert found.point.x == pytest.approx([-0.5, 1.0], abs=0.05)


def test_a_search_goes_on_where_it_ended() -> None:
    random = np.random.default_rng(3)
    slopes = random.normal(size=(8, 4))
    problem = Largest(np.concatenate([slopes, -slopes]), np.ones(16), np.ones(4), -10.0)
    start = problem.point(np.full(4, 0.5))
    assert start is not None
    first = search(problem, start, SearchEffort(iterations=5))
    again = problem.point(first.memory.x)
    assert again is not None
    second = search(problem, again, SearchEffort(iterations=20), first.memory)
    assert second.point.objective < first.point.objective


def test_a_search_goes_on_from_where_it_stands_with_what_is_known_there() -> None:
    random = np.random.default_rng(5)
    slopes = random.normal(size=(8, 4))
    problem = Largest(np.concatenate([slopes, -slopes]), np.ones(16), np.ones(4), -10.0)
    start = problem.point(np.full(4, 0.5))
    assert start is not None
    first = search(problem, start, SearchEffort(iterations=5))
    anew = problem.point(first.memory.x)
    assert anew is not None
    effort = SearchEffort(iterations=20)
    evaluated = search(problem, anew, effort, first.memory)
    gradients: list[At] = []

    class Counting(Largest):
        def gradient(self, point: At) -> FloatArray:
            gradients.append(point)
            return super().gradient(point)

    counting = Counting(problem.slopes, problem.bends, problem.normal, problem.least)
    stand = first.stand
    known = search(counting, stand.point, effort, first.memory, stand.gradient)
    assert (known.point.x == evaluated.point.x).all()
    assert gradients and not any((point.x == stand.point.x).all() for point in gradients)
