"""Subproblems with full matrices: the interior point against Clarabel, LAPACK's paths against the
sparse ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from flyby.core.sqp import NLP, BackendKind, Status, solve
from flyby.core.sqp.algebra import dense as full
from flyby.core.sqp.algebra.linear import Definiteness, Saddle
from flyby.core.sqp.algebra.matrices import SparseMatrix, Sparsity, from_scipy
from flyby.core.sqp.qp import active_set
from flyby.core.sqp.qp.clarabel_backend import ClarabelBackend
from flyby.core.sqp.qp.dense_interior_point import DenseInteriorPointBackend
from flyby.core.sqp.qp.problem import QpSolution, QpStatus, QuadraticProgram

SEEDS = st.integers(0, 10_000)


def filled(array: np.ndarray) -> SparseMatrix:
    """The array with an entry everywhere."""
    rows, columns = array.shape
    pattern = Sparsity(
        array.shape, np.tile(np.arange(rows), columns), np.arange(columns + 1) * rows
    )
    return SparseMatrix(pattern, array.T.flatten())


def program(seed: int, n: int, m: int, rank: int) -> QuadraticProgram:
    """Feasible at some point: rows of every kind, some variables fixed, some sides missing."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(rank, n))
    A = sparse.random_array((m, n), density=min(1.0, 4 / n), rng=rng)
    point = rng.normal(size=n)
    at = np.asarray(A @ point).reshape(m)
    lower, upper = at - rng.uniform(0, 1, m), at + rng.uniform(0, 1, m)
    equal, open_below = rng.random(m) < 0.1, rng.random(m) < 0.3
    lower[equal] = upper[equal] = at[equal]
    lower[open_below & ~equal] = -np.inf
    d_lower, d_upper = point - rng.uniform(0, 1, n), point + rng.uniform(0, 1, n)
    fixed = rng.random(n) < 0.1
    d_lower[fixed] = d_upper[fixed] = point[fixed]
    return QuadraticProgram(
        filled(root.T @ root), 3 * rng.normal(size=n), from_scipy(A), lower, upper, d_lower, d_upper
    )


def value(qp: QuadraticProgram, found: QpSolution) -> float:
    return float(0.5 * found.d @ (qp.P @ found.d) + qp.q @ found.d)


@settings(max_examples=40)
@given(SEEDS, st.integers(10, 40), st.floats(0.0, 0.5), st.floats(0.2, 1.5))
def test_as_good_as_clarabel(seed, n, rows, share):
    qp = program(seed, n, int(rows * n), max(1, int(share * n)))
    found = DenseInteriorPointBackend().solve(qp, None)
    other = ClarabelBackend().solve(qp, None)
    assert found.status is QpStatus.SOLVED
    assert value(qp, found) == pytest.approx(value(qp, other), rel=1e-5, abs=1e-5)
    slope = np.abs(qp.q).max()  # of weakly active sides, which polishing settles
    assert active_set.error(qp, found) <= 1e-3 * slope


@pytest.mark.parametrize("seed", range(3))
def test_large_ones_are_polished_by_lapack(seed):
    qp = program(seed, 130, 40, 60)
    assert full.is_dense(qp.P.pattern)
    result = solve(
        NLP(
            n=130,
            m=40,
            objective=lambda x: float(0.5 * x @ (qp.P @ x) + qp.q @ x),
            gradient=lambda x: qp.P @ x + qp.q,
            hessian=lambda x, factor, y: factor * full.array_of(qp.P),
            constraints=lambda x: qp.A @ x,
            jacobian=lambda x: qp.A.scipy(),
            x_lower=qp.d_lower,
            x_upper=qp.d_upper,
            c_lower=qp.lower,
            c_upper=qp.upper,
        ),
        np.zeros(130),
        qp=BackendKind.DENSE_INTERIOR_POINT,
        tolerance=1e-7,
    )
    assert result.status is Status.OPTIMAL
    assert result.objective == pytest.approx(value(qp, ClarabelBackend().solve(qp, None)), rel=1e-6)


@settings(max_examples=10)
@given(SEEDS)
def test_saddles_are_those_of_the_sparse_path(seed):
    rng = np.random.default_rng(seed)
    n, m = 120, 30
    root = rng.normal(size=(150, n))
    P, q = filled(root.T @ root), rng.normal(size=n)
    entries = sparse.random_array(
        (m, n), density=0.05, rng=rng, data_sampler=lambda size: rng.uniform(0.1, 1.0, size)
    )
    A = from_scipy(entries + sparse.eye_array(m, n))
    rows, fixed = rng.random(m) < 0.5, rng.random(n) < 0.2
    target, values = rng.normal(size=m), rng.normal(size=n)
    found = Saddle().solve(P, q, A, rows, target, fixed, values)
    assert found is not None
    d, y = found
    assert np.allclose(d[fixed], values[fixed])
    free = ~fixed
    active = rows & (np.abs(A.scipy().toarray()[:, free]).sum(axis=1) > 0)
    assert np.allclose((A @ d)[active], target[active], atol=1e-8)
    slope = P @ d + q + A.transposed_times(y)
    assert np.abs(slope[free]).max() <= 1e-7 * np.abs(q).max()
    assert not y[~rows].any()


@settings(max_examples=20)
@given(SEEDS, st.booleans())
def test_definiteness_by_lapack(seed, positive):
    rng = np.random.default_rng(seed)
    n = 110
    basis, _ = np.linalg.qr(rng.normal(size=(n, n)))
    sizes = rng.uniform(0.1, 1.0, n)
    if not positive:
        sizes[0] = -0.05
    matrix = filled(basis @ np.diag(sizes) @ basis.T)
    assert full.is_dense(matrix.pattern)
    assert Definiteness().holds(matrix) is positive


def test_what_cannot_be_is_not_called_solved():
    qp = program(1, 10, 5, 10)
    qp.lower[0], qp.upper[0] = 1.0, -1.0
    assert DenseInteriorPointBackend().solve(qp, None).status is QpStatus.INFEASIBLE
    n = 4
    row = from_scipy(sparse.csc_array(np.ones((1, n))))
    far = QuadraticProgram(
        filled(np.eye(n)),
        np.zeros(n),
        row,
        np.array([100.0]),
        np.array([np.inf]),
        np.full(n, -1.0),
        np.full(n, 1.0),
    )
    assert DenseInteriorPointBackend().solve(far, None).status is QpStatus.FAILED
