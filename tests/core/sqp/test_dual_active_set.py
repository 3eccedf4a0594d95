"""Small subproblems by the dual active-set method, beside an interior point."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.sqp.algebra.matrices import SparseMatrix, Sparsity, identity
from flyby.core.sqp.qp.clarabel_backend import ClarabelBackend
from flyby.core.sqp.qp.dual_active_set import DiagonalProgram, minimum
from flyby.core.sqp.qp.problem import QpStatus, QuadraticProgram


def programs(seed: int) -> DiagonalProgram:
    """At random, some with rows that are nearly or quite alike, all with a point within."""
    random = np.random.default_rng(seed)
    n, m = int(random.integers(1, 25)), int(random.integers(0, 80))
    h = 10.0 ** random.uniform(-3.0, 1.0, n)
    h[-1] = 1e-6
    A, inside = random.normal(size=(m, n)), random.uniform(-1.0, 1.0, n)
    half = m // 2
    if seed % 3 == 0:
        A[1:half] = A[:1] + 1e-3 * random.normal(size=(max(half - 1, 0), n))
    if seed % 5 == 0 and half:
        A[half:] = A[random.integers(0, half, m - half)]
    room = random.random(m) * (random.random(m) > 0.5)
    lower, upper = -np.ones(n), np.where(random.random(n) < 0.2, np.inf, 1.0)
    return DiagonalProgram(h, random.normal(size=n), A, A @ inside - room, lower, upper)


@given(seed=st.integers(0, 100_000))
@settings(max_examples=60, deadline=None)
def test_the_solution_is_that_of_an_interior_point(seed: int) -> None:
    program = programs(seed)
    found = minimum(program)
    assert found is not None
    d, multipliers = found
    m, n = program.A.shape

    pattern = Sparsity((m, n), np.tile(np.arange(m), n), m * np.arange(n + 1))
    peer = ClarabelBackend().solve(
        QuadraticProgram(
            SparseMatrix(identity(n), program.h),
            program.q,
            SparseMatrix(pattern, program.A.T.ravel()),
            program.b,
            np.full(m, np.inf),
            program.lower,
            program.upper,
        ),
        None,
    )
    assert peer.status is QpStatus.SOLVED
    its, ours = (0.5 * x @ (program.h * x) + program.q @ x for x in (peer.d, d))
    assert np.isclose(ours, its, rtol=1e-6, atol=1e-6)
    assert (program.A @ d - program.b).min(initial=0.0) > -1e-7
    assert ((d >= program.lower) & (d <= program.upper)).all()

    # Where a variable is within its bounds, the rows' pushes hold it there.
    assert (multipliers >= 0.0).all()
    slope = program.h * d + program.q - multipliers @ program.A
    within = (d > program.lower + 1e-6) & (d < program.upper - 1e-6)
    assert np.abs(slope[within]).max(initial=0.0) < 1e-5 * (1.0 + multipliers.sum())


def test_sides_that_contradict_each_other_have_no_solution() -> None:
    rows, least = np.array([[1.0, 1.0], [-1.0, -1.0]]), np.array([1.0, 1.0])
    program = DiagonalProgram(np.ones(2), np.zeros(2), rows, least, -np.ones(2), np.ones(2))
    assert minimum(program) is None
