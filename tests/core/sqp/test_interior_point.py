"""Our interior point on subproblems: optimality conditions, agreement with Clarabel, and what it
says of subproblems without a solution."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp.algebra.matrices import from_scipy
from flyby.core.sqp.qp.clarabel_backend import ClarabelBackend
from flyby.core.sqp.qp.interior_point import InteriorPointBackend
from flyby.core.sqp.qp.problem import QpSolution, QpStatus, QuadraticProgram

seeds = st.integers(0, 2**32 - 1)


def program(
    P: FloatArray,
    q: FloatArray,
    A: FloatArray,
    rows: tuple[FloatArray, FloatArray],
    bounds: tuple[FloatArray, FloatArray],
) -> QuadraticProgram:
    return QuadraticProgram(
        from_scipy(sparse.csc_array(P)), q, from_scipy(sparse.csc_array(A)), *rows, *bounds
    )


def random_program(seed: int, n: int, m: int, spread: float) -> QuadraticProgram:
    """Feasible and bounded: with rows of all kinds, fixed and free variables, rows that repeat
    others, P of any rank, and units ``spread`` decades apart."""
    random = np.random.default_rng(seed)
    root = random.standard_normal((n, random.integers(0, n + 1)))
    A = random.standard_normal((m, n)) * (random.random((m, n)) < 0.6)
    if m > 2:
        A[-1] = 2.0 * A[0]  # depends on another
    x_unit = 10.0 ** random.uniform(-spread, spread, n)
    c_unit = 10.0 ** random.uniform(-spread, spread, m)
    A = c_unit[:, None] * A * x_unit
    P = root @ root.T * np.outer(x_unit, x_unit)
    inside = random.standard_normal(n)

    def sides(value: FloatArray, open_share: float) -> tuple[FloatArray, FloatArray]:
        away = random.exponential(1.0, (2, len(value)))
        away[random.random(away.shape) < 0.2] = 0.0
        away[random.random(away.shape) < open_share] = np.inf
        away[:, random.random(len(value)) < 0.15] = 0.0
        return -away[0], away[1]

    low, high = sides(inside, 0.0)
    row_low, row_high = sides(np.zeros(m), 0.4)
    at = A @ (inside / x_unit)
    bounds = (inside + low) / x_unit, (inside + high) / x_unit
    return program(
        P,
        random.standard_normal(n) * x_unit,
        A,
        (at + c_unit * row_low, at + c_unit * row_high),
        bounds,
    )


def objective(qp: QuadraticProgram, d: FloatArray) -> float:
    return float(0.5 * d @ (qp.P @ d) + qp.q @ d)


def assert_optimal(qp: QuadraticProgram, found: QpSolution, tolerance: float) -> None:
    """The optimality conditions, each in proportion to its terms; the gap to the objective."""
    slope = qp.P @ found.d + qp.q + qp.A.transposed_times(found.y) + found.z
    size = max(1.0, *(float(np.abs(v).max(initial=0.0)) for v in (qp.q, found.y, found.z)))
    assert np.abs(slope).max() <= tolerance * size
    value = np.concatenate([qp.A @ found.d, found.d])
    lower = np.concatenate([qp.lower, qp.d_lower])
    upper = np.concatenate([qp.upper, qp.d_upper])
    outside = np.maximum(value - upper, lower - value).max(initial=0.0)
    assert outside <= tolerance * max(1.0, float(np.abs(value).max()))
    pull = np.concatenate([found.y, found.z])
    with np.errstate(invalid="ignore"):
        gap = np.where(pull > 0, pull * (upper - value), pull * (value - lower))
    gap = np.where(np.abs(pull) > 1e-12 * size, gap, 0.0)
    assert np.abs(gap).sum() <= 10 * tolerance * max(size, abs(objective(qp, found.d)))


UNSURE = (QpStatus.INEXACT, QpStatus.FAILED)
"""What may be said of a solvable program now and then: another back end takes over."""


@settings(max_examples=150, deadline=None)
@given(seed=seeds, n=st.integers(1, 12), m=st.integers(0, 12))
def test_solutions_are_optimal_and_agree_with_clarabel(seed: int, n: int, m: int) -> None:
    qp = random_program(seed, n, m, 0.0)
    found = InteriorPointBackend().solve(qp, None)
    if found.status is not QpStatus.SOLVED:
        assert found.status in UNSURE
        return
    assert_optimal(qp, found, 1e-7)
    peer = ClarabelBackend().solve(qp, None)
    if peer.status is QpStatus.SOLVED:
        assert objective(qp, found.d) == pytest.approx(objective(qp, peer.d), rel=1e-6, abs=1e-6)


def test_nearly_all_degenerate_programs_are_solved() -> None:
    sizes = ((1, 3), (3, 4), (5, 5), (5, 9), (8, 4), (12, 6))
    programs = [random_program(seed, n, m, 0.0) for n, m in sizes for seed in range(100)]
    ended = [InteriorPointBackend().solve(qp, None).status for qp in programs]
    assert ended.count(QpStatus.SOLVED) >= 0.99 * len(ended)


@settings(max_examples=80, deadline=None)
@given(seed=seeds, n=st.integers(1, 12), m=st.integers(0, 12))
def test_units_do_not_matter(seed: int, n: int, m: int) -> None:
    qp = random_program(seed, n, m, 2.0)
    found = InteriorPointBackend().solve(qp, None)
    if found.status is QpStatus.SOLVED:
        assert_optimal(qp, found, 1e-5)
    else:
        assert found.status in UNSURE


@settings(max_examples=80, deadline=None)
@given(seed=seeds, n=st.integers(1, 12), m=st.integers(0, 12), noise=st.floats(0.0, 100.0))
def test_a_guess_changes_the_way_but_not_the_end(seed: int, n: int, m: int, noise: float) -> None:
    qp = random_program(seed, n, m, 0.0)
    backend = InteriorPointBackend()
    cold = backend.solve(qp, None)
    random = np.random.default_rng(seed)
    guess = QpSolution(
        QpStatus.SOLVED,
        np.zeros(n),
        cold.y + noise * random.standard_normal(m),
        cold.z + noise * random.standard_normal(n),
    )
    warm = backend.solve(qp, guess)
    if cold.status is not QpStatus.SOLVED or warm.status is not QpStatus.SOLVED:
        assert {cold.status, warm.status} <= {QpStatus.SOLVED, *UNSURE}
        return
    assert objective(qp, warm.d) == pytest.approx(objective(qp, cold.d), rel=1e-6, abs=1e-6)


@settings(max_examples=60, deadline=None)
@given(seed=seeds, n=st.integers(1, 10), m=st.integers(1, 10))
def test_contradictory_rows_are_never_solved(seed: int, n: int, m: int) -> None:
    """A row and its double, held a unit apart from each other."""
    qp = random_program(seed, n, m, 0.0)
    random = np.random.default_rng(seed)
    row = random.standard_normal(n)
    A = np.vstack([qp.A.scipy().toarray(), row, 2.0 * row])
    lower = np.concatenate([qp.lower, [-np.inf, 2.0]])
    upper = np.concatenate([qp.upper, [0.0, np.inf]])
    whole = program(qp.P.scipy().toarray(), qp.q, A, (lower, upper), (qp.d_lower, qp.d_upper))
    found = InteriorPointBackend().solve(whole, None)
    assert found.status in (QpStatus.INFEASIBLE, QpStatus.FAILED)


def test_infeasibility_is_proven_early() -> None:
    backend = InteriorPointBackend()
    for seed in range(30):
        random = np.random.default_rng(seed)
        A = np.vstack([random.standard_normal((3, 4)), np.ones(4)])
        rows = np.array([-1.0, -1.0, -1.0, 10.0]), np.array([1.0, 1.0, 1.0, np.inf])
        qp = program(np.eye(4), np.ones(4), A, rows, (np.zeros(4), np.ones(4)))
        assert backend.solve(qp, None).status is QpStatus.INFEASIBLE
        assert backend.taken <= 20


def test_bounds_that_contradict_each_other() -> None:
    none = np.zeros((0, 2))
    qp = program(
        np.eye(2), np.ones(2), none, (np.zeros(0),) * 2, (np.array([1.0, 0.0]), np.zeros(2))
    )
    assert InteriorPointBackend().solve(qp, None).status is QpStatus.INFEASIBLE


def test_unbounded_objectives_are_told() -> None:
    bounds = np.array([-np.inf, 0.0]), np.array([np.inf, 1.0])
    A = np.array([[-1.0, 1.0]])
    rows = np.array([-np.inf]), np.array([3.0])
    qp = program(np.diag([0.0, 1.0]), np.array([-1.0, 1.0]), A, rows, bounds)
    assert InteriorPointBackend().solve(qp, None).status is QpStatus.UNBOUNDED


def test_more_equalities_than_variables_that_agree() -> None:
    random = np.random.default_rng(5)
    A = random.standard_normal((9, 4))
    x = random.standard_normal(4)
    open_ = np.full(4, np.inf)
    qp = program(np.zeros((4, 4)), np.ones(4), A, (A @ x, A @ x), (-open_, open_))
    found = InteriorPointBackend().solve(qp, None)
    assert found.status is QpStatus.SOLVED
    np.testing.assert_allclose(found.d, x, atol=1e-8)


def test_a_linear_program_whose_solution_is_an_edge() -> None:
    """Minimise −x − y with x + y ≤ 1 in the unit square: any point of the edge, multiplier 1."""
    qp = program(
        np.zeros((2, 2)),
        -np.ones(2),
        np.ones((1, 2)),
        (np.array([-np.inf]), np.array([1.0])),
        (np.zeros(2), np.ones(2)),
    )
    found = InteriorPointBackend().solve(qp, None)
    assert found.status is QpStatus.SOLVED
    assert found.d.sum() == pytest.approx(1.0, abs=1e-8)
    np.testing.assert_allclose(found.y, [1.0], atol=1e-7)


def test_fixed_variables_get_the_multiplier_that_holds_them() -> None:
    qp = program(
        np.eye(2),
        np.array([3.0, 0.0]),
        np.zeros((0, 2)),
        (np.zeros(0),) * 2,
        (np.array([2.0, -1.0]), np.array([2.0, 1.0])),
    )
    found = InteriorPointBackend().solve(qp, None)
    np.testing.assert_allclose(found.d, [2.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(found.z, [-5.0, 0.0], atol=1e-7)


def test_subproblems_of_several_patterns_take_turns() -> None:
    backend = InteriorPointBackend()
    programs = [random_program(seed, n, m, 0.0) for seed, n, m in ((1, 3, 2), (2, 6, 4), (3, 2, 5))]
    programs += [random_program(4, 8, 8, 0.0)]
    for qp in [*programs, *reversed(programs)]:
        alone = InteriorPointBackend().solve(qp, None)
        np.testing.assert_array_equal(backend.solve(qp, None).d, alone.d)


def test_numbers_that_are_not_finite_are_no_solution() -> None:
    qp = program(
        np.eye(2),
        np.array([np.nan, 0.0]),
        np.zeros((0, 2)),
        (np.zeros(0),) * 2,
        (-np.ones(2), np.ones(2)),
    )
    assert InteriorPointBackend().solve(qp, None).status is QpStatus.FAILED
