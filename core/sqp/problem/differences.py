"""Hessians of the Lagrangian by differences of its gradient.

Columns that do not meet are taken together: Curtis, Powell and Reid, "On the estimation of sparse
Jacobian matrices" (1974).
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from ...arrays import BoolArray, FloatArray, IntArray
from ..algebra.matrices import SparseMatrix
from .errors import CallableError
from .evaluation import Evaluation, Point
from .optimality import lagrangian_slope

_STEP = 6e-8
_ASIDE = 1e-2
_COUPLING_STEP = 1e-3
_NEARER = 1e-2


class Differences:
    """The pattern is that of the constraints' rows and of the objective's own couplings."""

    measured = True

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation
        self._groups: list[IntArray] = []
        self._pattern: sparse.csc_array | None = None

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        if self._pattern is None:
            self._pattern = self._find_pattern(point)
            movable = self._movable()
            groups = [group[movable[group]] for group in colour(self._pattern)]
            self._groups = [group for group in groups if len(group)]
            self._evaluation.hessian_pattern.array(self._pattern)  # none happens to be zero here
        base = lagrangian_slope(point.g, point.J, multipliers)
        pattern = self._pattern
        data = np.zeros(pattern.nnz)
        columns = np.repeat(np.arange(pattern.shape[1]), np.diff(pattern.indptr))
        steps = self._steps(point.x, _STEP)
        for group in self._groups:
            moved = self._differentiated(point, group, steps[group])
            change = lagrangian_slope(moved.g, moved.J, multipliers) - base
            inverse = np.zeros(len(point.x))
            inverse[group] = 1.0 / steps[group]
            mine = inverse[columns] != 0
            data[mine] = change[pattern.indices[mine]] * inverse[columns[mine]]
        H = sparse.csc_array((data, pattern.indices, pattern.indptr), shape=pattern.shape)
        return self._evaluation.hessian_pattern.array((H + H.T) * 0.5)

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        pass

    def restart(self, diagonal: FloatArray) -> None:
        pass

    def _find_pattern(self, point: Point) -> sparse.csc_array:
        own = self._couplings(point)
        J = SparseMatrix(point.J.pattern, np.ones(point.J.pattern.size)).scipy()
        total = sparse.csc_array(own + own.T + J.T @ J)
        total.sort_indices()
        return total

    def _couplings(self, point: Point) -> sparse.csc_array:
        """Which variables the objective couples (n, n), found aside of the point, where couplings
        may vanish by chance."""
        evaluation, n = self._evaluation, len(point.x)
        identity = sparse.csc_array(sparse.eye_array(n))
        if evaluation.nlp.objective is None and evaluation.nlp.residuals is None:
            return identity
        origin = self._aside(point)
        if evaluation.nlp.residuals is not None:
            H = evaluation.residual_hessian(origin.x)
            return sparse.csc_array(identity + abs(H))
        rows, columns = [], []
        steps = self._steps(origin.x, _COUPLING_STEP)
        for j in np.flatnonzero(self._movable()):
            moved = self._differentiated(origin, np.array([j]), steps[[j]])
            touched = np.flatnonzero(moved.g != origin.g)
            rows.append(touched)
            columns.append(np.full(len(touched), j))
        places = (np.concatenate([[], *rows]), np.concatenate([[], *columns]))
        ones = np.ones(len(places[0]))
        return identity + sparse.csc_array((ones, np.array(places, dtype=np.int64)), (n, n))

    def _aside(self, point: Point) -> Point:
        """A point near to another one, in no special position, with derivatives."""
        x_lower, x_upper, *_ = self._evaluation.nlp.bounds
        random = np.random.default_rng(0)
        direction = random.uniform(0.5, 1.0, len(point.x)) * np.maximum(1.0, np.abs(point.x))
        direction *= np.where(x_upper - point.x >= point.x - x_lower, 1.0, -1.0)
        length = _ASIDE
        while length > _STEP:
            x = np.clip(point.x + length * direction, x_lower, x_upper)
            try:
                moved = self._evaluation.point(x)
                self._evaluation.differentiate(moved)
            except CallableError:
                length *= _NEARER
                continue
            return moved
        return point

    def _differentiated(self, point: Point, variables: IntArray, steps: FloatArray) -> Point:
        """Derivatives where some variables are changed by steps."""
        moved = Point(point.x.copy(), 0.0, point.c)
        moved.x[variables] += steps
        self._evaluation.differentiate(moved)
        return moved

    def _movable(self) -> BoolArray:
        """Which variables (n,) are not fixed: no other one's curvature counts."""
        lower, upper, *_ = self._evaluation.nlp.bounds
        return upper > lower

    def _steps(self, x: FloatArray, share: float) -> FloatArray:
        """Differences (n,) of a share of each variable's size, which stay within bounds."""
        lower, upper, *_ = self._evaluation.nlp.bounds
        step = share * np.maximum(1.0, np.abs(x))
        room = np.maximum(upper - x, x - lower)
        step = np.minimum(step, room)
        return np.where((x + step > upper) & (x - step >= lower), -step, step)


def colour(pattern: sparse.csc_array) -> list[IntArray]:
    """Groups of columns no two of which have an entry in one row, found greedily."""
    n = pattern.shape[1]
    rows = pattern.tocsr()
    taken = np.full(n, -1)
    order = np.argsort(-np.diff(pattern.indptr), kind="stable")
    for j in order:
        mine = pattern.indices[pattern.indptr[j] : pattern.indptr[j + 1]]
        forbidden: set[int] = set()
        for i in mine:
            neighbours = rows.indices[rows.indptr[i] : rows.indptr[i + 1]]
            forbidden.update(taken[neighbours].tolist())
        choice = 0
        while choice in forbidden:
            choice += 1
        taken[j] = choice
    return [np.flatnonzero(taken == k) for k in range(int(taken.max()) + 1)]
