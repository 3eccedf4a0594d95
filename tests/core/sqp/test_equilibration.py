"""Subproblems in other units stay the same ones; answers that cannot be true are not believed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy import sparse

from flyby.core.sqp.algebra.matrices import SparseMatrix, empty, from_scipy, identity
from flyby.core.sqp.qp import active_set
from flyby.core.sqp.qp.backends import make_backends
from flyby.core.sqp.qp.equilibration import units_of
from flyby.core.sqp.qp.problem import QpSolution, QpStatus, QuadraticProgram, failed
from flyby.core.sqp.qp.subproblems import Subproblems

seeds = st.integers(0, 2**32 - 1)


def program(seed: int, spread: float) -> QuadraticProgram:
    """A convex subproblem of variables and rows in units of ``spread`` decades each way."""
    random = np.random.default_rng(seed)
    n, m = int(random.integers(1, 7)), int(random.integers(0, 6))
    x_unit = 10.0 ** random.uniform(-spread, spread, n)
    c_unit = 10.0 ** random.uniform(-spread, spread, m)
    root = random.standard_normal((n, n))
    A = c_unit[:, None] * random.standard_normal((m, n)) * x_unit
    d = random.standard_normal(n) / x_unit
    P = np.outer(x_unit, x_unit) * (root @ root.T + 0.1 * np.eye(n))
    return QuadraticProgram(
        from_scipy(sparse.csc_array(P)),
        x_unit * random.standard_normal(n),
        from_scipy(sparse.csc_array(A)) if m else empty(n),
        A @ d - c_unit * random.random(m),
        A @ d + c_unit * random.random(m),
        d - random.random(n) / x_unit,
        d + random.random(n) / x_unit,
    )


@given(seed=seeds)
def test_rows_of_like_size_stay_as_they_are(seed: int) -> None:
    random = np.random.default_rng(seed)
    qp = program(seed, 0.0)
    qp.P.data[:] = random.uniform(0.5, 2.0, len(qp.P.data))
    qp.A.data[:] = random.uniform(0.5, 2.0, len(qp.A.data))
    assert units_of(qp) is None


@given(seed=seeds)
def test_units_make_rows_alike_and_round_nothing(seed: int) -> None:
    qp = program(seed, 6.0)
    units = units_of(qp)
    assume(units is not None)
    scaled = units.scaled(qp)
    for before, after in ((qp.P, scaled.P), (qp.A, scaled.A)):
        mantissas = [np.frexp(m.data)[0] for m in (before, after)]
        np.testing.assert_array_equal(*mantissas)
    sizes = np.zeros(len(qp.q))
    for matrix in (scaled.P, scaled.A):
        np.maximum.at(sizes, matrix.pattern.columns, np.abs(matrix.data))
    assert sizes.max() <= 100 * sizes.min()


@given(seed=seeds, spread=st.sampled_from([0.0, 3.0, 6.0]))
def test_solutions_are_those_of_the_subproblem_itself(seed: int, spread: float) -> None:
    qp = program(seed, spread)
    found = Subproblems(make_backends("clarabel", True)).solve(qp)
    assert found.status is QpStatus.SOLVED
    units = units_of(qp)
    if units is None:
        assert active_set.error(qp, found) <= 1e-4
        return
    guess = units.scaled_guess(found)
    assert guess is not None
    assert active_set.error(units.scaled(qp), guess) <= 1e-4 * (1 + np.abs(guess.y).max(initial=0))
    back = units.unscaled(guess)
    for one, other in ((found.d, back.d), (found.y, back.y), (found.z, back.z)):
        np.testing.assert_array_equal(one, other)


def test_a_diagonal_over_eight_decades_is_solved_exactly() -> None:
    P = SparseMatrix(identity(3), np.array([2e4, 2.0, 2e-4]))
    reach = np.array([1e3, 5e4, 5e8])
    none = np.zeros(0)
    for limits in ((-reach, reach), (np.full(3, -np.inf), np.full(3, np.inf))):
        qp = QuadraticProgram(P, np.full(3, 98.0), empty(3), none, none, *limits)
        found = Subproblems(make_backends("clarabel", True)).solve(qp)
        assert found.status is QpStatus.SOLVED
        np.testing.assert_allclose(found.d, -98.0 / P.data, rtol=1e-9)


@pytest.mark.parametrize("noise", [0.0, 1e-31, 1e-16])
def test_what_rounding_leaves_of_a_row_is_not_blown_up(noise: float) -> None:
    """A circle's row at its centre; blown up, its side would lie at 1e16 and farther."""
    root = np.random.default_rng(1).normal(size=(130, 110))
    rows = np.zeros((2, 110))
    rows[0], rows[1, :2] = 1.0, noise
    n = np.ones(110)
    qp = QuadraticProgram(
        from_scipy(sparse.csc_array(root.T @ root)),
        root.sum(axis=0),
        from_scipy(sparse.csc_array(rows)),
        np.array([-1.0, -np.inf]),
        np.array([1e-5, 1.0]),
        -n,
        n,
    )
    units = units_of(qp)
    assert units is None or units.rows[1] == 1.0
    for kind in ("dense_interior_point", "clarabel"):
        assert Subproblems(make_backends(kind, False)).solve(qp).status is QpStatus.SOLVED


class _Claims:
    """A back end that claims a status, whatever it is asked."""

    name = "claims"
    worth = 0

    def __init__(self, status: QpStatus) -> None:
        self._status = status

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        return failed(qp, self._status)


@pytest.mark.parametrize("status", [QpStatus.UNBOUNDED, QpStatus.INFEASIBLE])
def test_a_claim_that_cannot_be_true_calls_the_fallback(status: QpStatus) -> None:
    """Every variable is bounded, and d = 0 is feasible."""
    one = SparseMatrix(identity(1), np.ones(1))
    bounds = np.array([-1.0]), np.array([1.0])
    qp = QuadraticProgram(one, np.array([-5.0]), one, *bounds, *bounds)
    (backend,) = make_backends("clarabel", False)
    found = Subproblems((_Claims(status), backend)).solve(qp)
    assert found.status is QpStatus.SOLVED
    np.testing.assert_allclose(found.d, [1.0])


def test_a_guess_that_leads_nowhere_rests(monkeypatch: pytest.MonkeyPatch) -> None:
    solver = Subproblems(make_backends("clarabel", False))
    qp = program(3, 0.0)
    first = solver.solve(qp)
    tried = []
    monkeypatch.setattr(active_set, "settled", lambda *_: tried.append(1))
    monkeypatch.setattr(solver, "_polished", lambda _, found: found)
    for _ in range(40):
        assert solver.solve(qp, first).status is QpStatus.SOLVED
    assert len(tried) == 6  # the 1st, 3rd, 7th, 15th, 24th and 33rd
    monkeypatch.undo()
    for _ in range(20):
        assert solver.solve(qp, first).status is QpStatus.SOLVED
    assert solver._pause == 0
