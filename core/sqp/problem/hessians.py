"""Hessians of the Lagrangian: exact, Gauss–Newton, damped BFGS, coloured differences."""

from __future__ import annotations

from enum import StrEnum
from typing import Protocol

import numpy as np

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix
from .damped_update import observed
from .differences import Differences
from .errors import NlpError
from .evaluation import Evaluation, Point
from .limited_memory import LimitedMemory
from .nlp import NLP

LARGEST_DENSE = 400
"""Variables up to which a quasi-Newton matrix is a dense one."""
_CURVATURE = 1e-8


class HessianKind(StrEnum):
    """Where the Hessian comes from."""

    EXACT = "exact"
    """``NLP.hessian``."""
    GAUSS_NEWTON = "gauss_newton"
    """JᵀJ of the residuals; the constraints' curvature is left out."""
    BFGS = "bfgs"
    """Powell's damped BFGS, dense (Nocedal and Wright, procedure 18.2)."""
    LBFGS = "lbfgs"
    """BFGS of the last steps alone, for the interior point: a few columns beside a diagonal."""
    DIFFERENCES = "differences"
    """Differences of the Lagrangian's gradient, columns that do not meet taken together (Curtis,
    Powell and Reid 1974): sparse, and as good as exact, at some gradients an iteration."""


class HessianSource(Protocol):
    """Gives the scaled Lagrangian's Hessian, or what stands for it.

    Attributes:
        measured: whether its curvature comes from derivatives at the point, not from a guess that
            steps improve.
    """

    measured: bool

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        """(n, n), both triangles."""
        ...

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        """A step was taken."""
        ...

    def restart(self, diagonal: FloatArray) -> None:
        """What steps have taught leads nowhere: begin again from a positive diagonal (n,)."""
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
        return full_or_sparse(nlp)
    try:
        kind = HessianKind(wanted)
    except ValueError:
        raise NlpError(f"hessian_kind: one of {', '.join(HessianKind)}, not {wanted!r}") from None
    if kind is HessianKind.EXACT and nlp.hessian is None:
        raise NlpError("hessian_kind 'exact' needs NLP.hessian")
    if kind is HessianKind.GAUSS_NEWTON and nlp.residuals is None:
        raise NlpError("hessian_kind 'gauss_newton' needs NLP.residuals")
    return kind


def full_or_sparse(nlp: NLP) -> HessianKind:
    """The kind for a problem of which nothing but first derivatives is known."""
    return HessianKind.BFGS if nlp.n <= LARGEST_DENSE else HessianKind.DIFFERENCES


def make_source(kind: HessianKind, evaluation: Evaluation) -> HessianSource:
    """The source of a kind for one solution."""
    if kind is HessianKind.EXACT:
        return _Exact(evaluation)
    if kind is HessianKind.GAUSS_NEWTON:
        return _GaussNewton(evaluation)
    if kind is HessianKind.BFGS:
        return _Bfgs(evaluation)
    if kind is HessianKind.LBFGS:
        return LimitedMemory(evaluation.nlp.n)
    return Differences(evaluation)


class _Exact:
    measured = True

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        return self._evaluation.lagrangian_hessian(point.x, multipliers)

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        pass

    def restart(self, diagonal: FloatArray) -> None:
        pass


class _GaussNewton:
    measured = True

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        return self._evaluation.hessian_pattern.array(self._evaluation.residual_hessian(point.x))

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        pass

    def restart(self, diagonal: FloatArray) -> None:
        pass


class _Bfgs:
    measured = False

    def __init__(self, evaluation: Evaluation) -> None:
        self._evaluation = evaluation
        self._B = np.eye(evaluation.nlp.n)
        self._fresh = True

    def matrix(self, point: Point, multipliers: FloatArray) -> SparseMatrix:
        return self._evaluation.hessian_pattern.array(self._B)

    def moved(self, old: Point, new: Point, multipliers: FloatArray) -> None:
        step = observed(old, new, multipliers)
        if step is None:
            return
        if self._fresh:
            if step.curvature > _CURVATURE * step.size:
                largest = float(np.abs(step.y).max())  # y·y may overflow
                scale = largest * float(step.y @ (step.y / largest)) / step.curvature
                self._B *= float(np.clip(scale, 1e-6, 1e6))
            self._fresh = False
        Bs = self._B @ step.s
        r = step.damped(Bs)
        if r is None:
            return
        self._B += np.outer(r, r / float(step.s @ r)) - np.outer(Bs, Bs / float(step.s @ Bs))
        self._B = 0.5 * (self._B + self._B.T)

    def restart(self, diagonal: FloatArray) -> None:
        self._B = np.diag(diagonal)
        self._fresh = False
