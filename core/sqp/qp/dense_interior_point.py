"""Subproblems by an interior point on full matrices: for Gauss–Newton matrices of many residuals,
which have an entry almost everywhere, beside few and sparse rows.

Sides s = ±(bound − value) > 0 with multipliers z > 0 are eliminated, which leaves one matrix
P + Dᵀ diag(z/s) D of the size of the variables; Cholesky's factorisation of it, by LAPACK, is
nearly all of the work. Predictor and corrector are Mehrotra's (Nocedal and Wright, "Numerical
Optimization", section 16.6).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg import LinAlgError

from ...arrays import FloatArray, IntArray
from ..algebra.dense import Cholesky, array_of
from ..algebra.matrices import from_scipy
from .problem import QpSolution, QpStatus, QuadraticProgram, failed

_TO_BOUNDARY = 0.995
_REGULARISATION = 1e-12
_ENOUGH = 1e-6
_PATIENCE = 8


@dataclass(slots=True)
class _Sides:
    """The finite sides, of variables first, then of rows.

    Args:
        variables: (k,) the variable of each of the first sides.
        rows: (l,) the row of each of the others.
        sign: (k + l,) 1 for upper sides, -1 for lower ones.
        bound: (k + l,) sign times the bound.
    """

    variables: IntArray
    rows: IntArray
    sign: FloatArray
    bound: FloatArray


@dataclass(slots=True)
class _State:
    """Where the iteration is: d (n,), y (e,) of equalities, slack and multiplier of the sides."""

    d: FloatArray
    y: FloatArray
    slack: FloatArray
    multiplier: FloatArray


class DenseInteriorPointBackend:
    """The interior point.

    Args:
        accuracy: of residuals and of the mean product of slack and multiplier, in proportion to
            the size of what the problem gives.
        iterations: at most.
    """

    name = "dense_interior_point"
    worth = 2  # a system takes as long as an iteration, of which there are about ten

    def __init__(self, accuracy: float = 1e-9, iterations: int = 60) -> None:
        self._accuracy = accuracy
        self._iterations = iterations

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        """See `Backend.solve`; an interior point cannot use a guess. Nothing is proven of
        subproblems without a solution: they fail, and another back end says why."""
        if (qp.lower > qp.upper).any() or (qp.d_lower > qp.d_upper).any():
            return failed(qp, QpStatus.INFEASIBLE)
        try:
            run = _Run(qp)
            status = run.solved(self._accuracy, self._iterations)
        except LinAlgError:
            return failed(qp)
        return failed(qp) if status is QpStatus.FAILED else run.solution(status)


class _Run:
    """One subproblem: d = fixed values + the free variables."""

    def __init__(self, qp: QuadraticProgram) -> None:
        self.qp = qp
        fixed = qp.d_lower == qp.d_upper
        self.free = np.flatnonzero(~fixed)
        self.fixed = np.where(fixed, qp.d_lower, 0.0)
        full = array_of(qp.P)
        self.P = full if not fixed.any() else full[np.ix_(self.free, self.free)]
        A = sparse.csr_array(qp.A.scipy())[:, self.free]
        q = (qp.q + qp.P @ self.fixed)[self.free]
        offset = qp.A @ self.fixed
        self.cost = 1.0 / max(
            float(np.abs(q).max(initial=0.0)), float(np.abs(self.P).max()), 1e-300
        )
        self.P = np.ascontiguousarray(self.P * self.cost)
        self.q = q * self.cost
        equal = qp.lower == qp.upper
        self.equal = np.flatnonzero(equal)
        self.E = A[self.equal].toarray()
        self.b = (qp.lower - offset)[self.equal]
        self.sides = _sides(qp, self.free, np.flatnonzero(~equal), offset)
        self.rows = np.unique(self.sides.rows)
        self.A = from_scipy(A[self.rows])
        self.products = _Products(A[self.rows])
        self.of_row = np.searchsorted(self.rows, self.sides.rows)

    # ---------------------------------------------------------------- the sides' matrix

    def across(self, d: FloatArray) -> FloatArray:
        """The sides' values, signed."""
        values = np.concatenate((d[self.sides.variables], (self.A @ d)[self.of_row]))
        return np.asarray(self.sides.sign * values)

    def back(self, weights: FloatArray) -> FloatArray:
        """The transposed sides' matrix times weights."""
        signed = self.sides.sign * weights
        count = len(self.sides.variables)
        found: FloatArray = np.bincount(
            self.sides.variables, signed[:count], minlength=len(self.free)
        ).astype(np.float64)
        pushed = np.bincount(self.of_row, signed[count:], minlength=len(self.rows))
        found += self.A.transposed_times(pushed.astype(np.float64))
        return found

    def factorised(self, state: _State) -> _System:
        weights = state.multiplier / state.slack
        count = len(self.sides.variables)
        diagonal = np.bincount(self.sides.variables, weights[:count], minlength=len(self.free))
        of_rows = np.bincount(self.of_row, weights[count:], minlength=len(self.rows))
        matrix = self.P.copy()
        self.products.add(of_rows.astype(np.float64), matrix)
        matrix[np.diag_indices(len(diagonal))] += diagonal + _REGULARISATION
        return _System(matrix, self.E)

    # ------------------------------------------------------------------- the iteration

    def solved(self, accuracy: float, iterations: int) -> QpStatus:
        """Iterate; the state that came nearest is kept."""
        state = self._start()
        best, patience = np.inf, _PATIENCE
        self.best = state
        for _ in range(iterations):
            left = self._residuals(state)
            size = max(self._size(part) for part in left)
            gap = float(state.slack @ state.multiplier) / max(1, len(state.slack))
            error = max(size, gap)
            if not np.isfinite(error):
                break
            if error < best:
                best, self.best, patience = error, state, _PATIENCE
            else:
                patience -= 1
            if error <= accuracy:
                return QpStatus.SOLVED
            if not patience:
                break
            try:
                state = self._step(state, left)
            except LinAlgError:
                break
        return QpStatus.INEXACT if best <= _ENOUGH else QpStatus.FAILED

    def solution(self, status: QpStatus) -> QpSolution:
        """The solution in the problem's own terms."""
        qp, best = self.qp, self.best
        d = self.fixed.copy()
        d[self.free] = best.d
        count = len(self.sides.variables)
        signed = self.sides.sign * best.multiplier / self.cost
        y = np.bincount(self.sides.rows, signed[count:], minlength=len(qp.lower)).astype(float)
        y[self.equal] = best.y / self.cost
        z = np.zeros(len(d))
        z[self.free] = np.bincount(self.sides.variables, signed[:count], minlength=len(self.free))
        held = np.flatnonzero(qp.d_lower == qp.d_upper)
        slope = qp.P @ d + qp.q + qp.A.transposed_times(y)
        z[held] = -slope[held]
        return QpSolution(status, d, y, z)

    def _start(self) -> _State:
        """The least-squares point of the sides, its slacks and multipliers shifted until positive
        (L. Vandenberghe, "The CVXOPT linear and quadratic cone program solvers", section 5.3)."""
        ones = np.ones(len(self.sides.bound))
        system = self.factorised(_State(np.zeros(len(self.free)), np.zeros(0), ones, ones))
        d, y = system.solve(self.back(self.sides.bound) - self.q, self.b)
        over = self.across(d) - self.sides.bound
        return _State(d, y, _shifted(-over), _shifted(over))

    def _residuals(self, state: _State) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What is left of slope, equalities and sides."""
        slope = self.P @ state.d + self.q + self.E.T @ state.y + self.back(state.multiplier)
        return (
            slope,
            self.E @ state.d - self.b,
            self.across(state.d) + state.slack - self.sides.bound,
        )

    def _step(self, state: _State, left: tuple[FloatArray, FloatArray, FloatArray]) -> _State:
        system = self.factorised(state)
        products = state.slack * state.multiplier
        if not len(products):
            d, y = system.solve(-left[0], -left[1])
            return _State(state.d + d, state.y + y, state.slack, state.multiplier)
        step = self._direction(system, state, left, products, exact=False)
        before = float(products.mean())
        length = self._length(state, step)
        after = float(
            (
                (state.slack + length * step.slack) * (state.multiplier + length * step.multiplier)
            ).mean()
        )
        centre = before * min(1.0, max(after / before, 0.0) ** 3)
        wanted = products + step.slack * step.multiplier - centre
        step = self._direction(system, state, left, wanted)
        length = _TO_BOUNDARY * self._length(state, step)
        length = min(1.0, length)
        return _State(
            state.d + length * step.d,
            state.y + length * step.y,
            state.slack + length * step.slack,
            state.multiplier + length * step.multiplier,
        )

    def _direction(
        self,
        system: _System,
        state: _State,
        left: tuple[FloatArray, FloatArray, FloatArray],
        products: FloatArray,
        exact: bool = True,
    ) -> _State:
        """The step that removes what is left, and lowers the sides' products by ``products``."""
        gain = (state.multiplier * left[2] - products) / state.slack
        solve = system.solve if exact else system.once
        d, y = solve(-left[0] - self.back(gain), -left[1])
        slack = -left[2] - self.across(d)
        multiplier = -(products + state.multiplier * slack) / state.slack
        return _State(d, y, slack, multiplier)

    @staticmethod
    def _length(state: _State, step: _State) -> float:
        """How far the step may go until a slack or a multiplier is zero, at most 1 / 0.995."""
        longest = 1.0 / _TO_BOUNDARY
        for now, change in ((state.slack, step.slack), (state.multiplier, step.multiplier)):
            falling = change < 0.0
            if falling.any():
                longest = min(longest, float((now[falling] / -change[falling]).min()))
        return longest

    @staticmethod
    def _size(values: FloatArray) -> float:
        return float(np.abs(values).max(initial=0.0))


def _shifted(values: FloatArray) -> FloatArray:
    """The values, raised by one amount until the least is at least 1 if one is not positive."""
    least = float(values.min(initial=np.inf))
    return values if least > 0.0 else values + (1.0 - least)


class _Products:
    """Aᵀ diag(w) A of a sparse A (l, n), added to full matrices."""

    def __init__(self, A: sparse.csr_array) -> None:
        counts = np.diff(A.indptr)
        each = np.repeat(counts, counts)
        first = np.repeat(np.arange(A.nnz), each)
        within = np.arange(len(first)) - np.repeat(np.cumsum(each) - each, each)
        second = np.repeat(A.indptr[:-1], counts).repeat(each) + within
        self._rows = np.repeat(np.arange(A.shape[0]), counts)[first]
        self._values = A.data[first] * A.data[second]
        keys = A.indices[first].astype(np.int64) * A.shape[1] + A.indices[second]
        self._places, self._of = np.unique(keys, return_inverse=True)

    def add(self, weights: FloatArray, matrix: FloatArray) -> None:
        """Add it for weights (l,) to a contiguous matrix (n, n)."""
        values = np.bincount(self._of, weights[self._rows] * self._values, len(self._places))
        matrix.reshape(-1)[self._places] += values


class _System:
    """[M, Eᵀ; E, 0] with M factorised.

    Raises:
        LinAlgError: M is not definite to rounding, as happens when sides close in on a solution.
    """

    def __init__(self, matrix: FloatArray, E: FloatArray) -> None:
        self._full, self._matrix, self._E = matrix, Cholesky(matrix), E
        self._spread = self._matrix.solve(E.T)
        shift = _REGULARISATION * np.eye(len(E))
        self._rows = Cholesky(E @ self._spread + shift) if len(E) else None

    def solve(self, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The solution, refined once: weights of sides span twenty orders near the end."""
        d, y = self.once(first, second)
        left = first - self._full @ d - self._E.T @ y
        change, of_y = self.once(left, second - self._E @ d)
        return d + change, y + of_y

    def once(self, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The same unrefined: enough for a step that only says how far the next may go."""
        d = self._matrix.solve(first)
        if self._rows is None:
            return d, np.zeros(0)
        y = self._rows.solve(self._E @ d - second)
        return d - self._spread @ y, y


def _sides(qp: QuadraticProgram, free: IntArray, rows: IntArray, offset: FloatArray) -> _Sides:
    parts = []
    for bounds, at in (
        ((qp.d_lower[free], qp.d_upper[free]), np.arange(len(free))),
        ((qp.lower[rows] - offset[rows], qp.upper[rows] - offset[rows]), rows),
    ):
        for bound, sign in zip(bounds, (-1.0, 1.0), strict=True):
            there = np.isfinite(bound)
            parts.append((at[there], np.full(int(there.sum()), sign), sign * bound[there]))
    return _Sides(
        np.concatenate((parts[0][0], parts[1][0])),
        np.concatenate((parts[2][0], parts[3][0])),
        np.concatenate([part[1] for part in parts]),
        np.concatenate([part[2] for part in parts]),
    )
