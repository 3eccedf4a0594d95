"""Hessians of the Lagrangian: exact, Gauss–Newton, damped BFGS, coloured differences."""

from __future__ import annotations

from enum import StrEnum
from typing import Protocol

import numpy as np
from scipy import sparse

from .evaluation import Evaluation, Point
from .matrices import SparseMatrix
from .nlp import NLP, FloatArray, NlpError

LARGEST_DENSE = 400
"""Variables up to which a quasi-Newton matrix is a dense one."""
_DAMPING = 0.2
_CURVATURE = 1e-8


class HessianKind(StrEnum):
    """Where the Hessian comes from."""

    EXACT = "exact"
    """``NLP.hessian``."""
    GAUSS_NEWTON = "gauss_newton"
    """JᵀJ of the residuals; the constraints' curvature is left out."""
    BFGS = "bfgs"
    """Powell's damped BFGS, dense (Nocedal and Wright, procedure 18.2)."""
    DIFFERENCES = "differences"
    """Differences of the Lagrangian's gradient, columns that do not meet taken together (Curtis,
    Powell and Reid 1974): sparse, and as good as exact, at some gradients an iteration."""


class HessianSource(Protocol):
    """Gives the scaled Lagrangian's Hessian, or what stands for it.

    Attributes:
        faithful: whether its curvature is the Lagrangian's, not one made up at first.
    """

    faithful: bool

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        """(n, n), both triangles."""
        ...

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        """A step was taken."""
        ...


def choose_kind(nlp: NLP, wanted: HessianKind | str | None) -> HessianKind:
    """The wanted kind, or the one that suits a problem.

    Raises:
        NlpError: the problem does not supply what the kind needs.
    """
    if wanted is None:
        if nlp.residuals is not None:
            return HessianKind.GAUSS_NEWTON
        if nlp.hessian is not None:
            return HessianKind.EXACT
        return HessianKind.BFGS if nlp.n <= LARGEST_DENSE else HessianKind.DIFFERENCES
    try:
        kind = HessianKind(wanted)
    except ValueError:
        raise NlpError(f"hessian_kind: one of {', '.join(HessianKind)}, not {wanted!r}") from None
    if kind is HessianKind.EXACT and nlp.hessian is None:
        raise NlpError("hessian_kind 'exact' needs NLP.hessian")
    if kind is HessianKind.GAUSS_NEWTON and nlp.residuals is None:
        raise NlpError("hessian_kind 'gauss_newton' needs NLP.residuals")
    return kind


def make_source(kind: HessianKind, evaluation: Evaluation) -> HessianSource:
    """The source of a kind for one solution."""
    if kind is HessianKind.EXACT:
        return _Exact(evaluation)
    if kind is HessianKind.GAUSS_NEWTON:
        return _GaussNewton(evaluation)
    if kind is HessianKind.BFGS:
        return _Bfgs(evaluation)
    return _Differences(evaluation)


class _Exact:
    faithful = True

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        return self._evaluation.lagrangian_hessian(point.x, multipliers)

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        pass


class _GaussNewton:
    faithful = True

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        return self._evaluation.hessian_pattern.array(self._evaluation.residual_hessian(point.x))

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        pass


class _Bfgs:
    faithful = False

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation
        self._B = np.eye(evaluation.nlp.n)
        self._fresh = True

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        return self._evaluation.hessian_pattern.array(self._B)

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        s = new.x - old.x
        y = new.g - old.g
        if len(multipliers):
            y = y + new.J.transposed_times(multipliers) - old.J.transposed_times(multipliers)
        size = float(s @ s)
        if size < 1e-28:
            return
        curvature = float(s @ y)
        if self._fresh:
            if curvature > _CURVATURE * size:
                scale = float(np.clip(float(y @ y) / curvature, 1e-6, 1e6))
                self._B *= scale
            self._fresh = False
        Bs = self._B @ s
        expected = float(s @ Bs)
        theta = 1.0
        if curvature < _DAMPING * expected:
            theta = (1.0 - _DAMPING) * expected / (expected - curvature)
        r = theta * y + (1.0 - theta) * Bs
        self._B += np.outer(r, r) / float(s @ r) - np.outer(Bs, Bs) / expected
        self._B = 0.5 * (self._B + self._B.T)


class _Differences:
    """The pattern is that of the constraints' rows and of the objective's own couplings, found by
    differences at the first point."""

    faithful = True

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation
        self._groups: list[np.ndarray] = []
        self._pattern: sparse.csc_array | None = None

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        if self._pattern is None:
            self._pattern = self._find_pattern(point)
            self._groups = colour(self._pattern)
            self._evaluation.hessian_pattern.array(
                self._pattern
            )  # where no entry happens to be zero
        base = self._slope(point, multipliers)
        pattern = self._pattern
        data = np.zeros(pattern.nnz)
        columns = np.repeat(np.arange(pattern.shape[1]), np.diff(pattern.indptr))
        x_lower, x_upper, *_ = self._evaluation.nlp.bounds
        for group in self._groups:
            step = _steps(point.x, x_lower, x_upper)[group]
            moved = Point(point.x.copy(), 0.0, point.c)
            moved.x[group] += step
            self._evaluation.differentiate(moved)
            change = self._slope(moved, multipliers) - base
            inverse = np.zeros(len(point.x))
            inverse[group] = 1.0 / step
            mine = inverse[columns] != 0
            data[mine] = change[pattern.indices[mine]] * inverse[columns[mine]]
        H = sparse.csc_array((data, pattern.indices, pattern.indptr), shape=pattern.shape)
        return self._evaluation.hessian_pattern.array((H + H.T) * 0.5)

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        pass

    def _slope(self, point: Point, multipliers: FloatArray) -> FloatArray:
        return point.g + point.J.transposed_times(multipliers) if len(multipliers) else point.g

    def _find_pattern(self, point: Point) -> sparse.csc_array:
        n = len(point.x)
        x_lower, x_upper, *_ = self._evaluation.nlp.bounds
        steps = _steps(point.x, x_lower, x_upper)
        rows, columns = [np.arange(n)], [np.arange(n)]
        if self._evaluation.nlp.objective is not None:
            for j in range(n):
                moved = Point(point.x.copy(), 0.0, point.c)
                moved.x[j] += steps[j]
                self._evaluation.differentiate(moved)
                touched = np.flatnonzero(moved.g != point.g)
                rows.append(touched)
                columns.append(np.full(len(touched), j))
        ones = np.ones(sum(map(len, rows)))
        own = sparse.coo_array((ones, (np.concatenate(rows), np.concatenate(columns))), (n, n))
        J = SparseMatrix(point.J.pattern, np.ones(point.J.pattern.size)).scipy()
        total = sparse.csc_array(own + own.T + J.T @ J)
        total.sort_indices()
        return total


def _steps(x: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Differences that stay within bounds."""
    step = 1.5e-8 * np.maximum(1.0, np.abs(x)) * 4.0
    return np.where((x + step > upper) & (x - step >= lower), -step, step)


def colour(pattern: sparse.csc_array) -> list[np.ndarray]:
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
