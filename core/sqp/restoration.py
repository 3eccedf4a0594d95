"""Restoration: the constraints alone, until the filter takes the point or nothing helps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto

import numpy as np

from .elastic import Elastic, violation
from .evaluation import CallableError, Evaluation, Point
from .matrices import SparseMatrix, identity
from .nlp import FloatArray
from .qp.problem import QpStatus, QuadraticProgram

_ENOUGH = 0.9
_ACCEPT, _GOOD = 1e-4, 0.75
_GROW, _SHRINK = 3.0, 0.25
_LEAST_RADIUS = 1e-12
_STATIONARY = 1e-7
_CURVATURE = 1e-3


class Outcome(Enum):
    """How restoration ended."""

    RESTORED = auto()
    STATIONARY = auto()
    LIMIT = auto()


@dataclass(slots=True)
class Restored:
    """Where restoration ended; derivatives are there."""

    outcome: Outcome
    point: Point
    iterations: int


def restore(
    point: Point,
    evaluation: Evaluation,
    rows: tuple[FloatArray, FloatArray],
    elastic: Elastic,
    accepted: Callable[[Point, float], bool],
    limits: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
    budget: int,
    tolerance: float,
) -> Restored:
    """Lower the sum of violations by a trust-region method on its piecewise linear model.

    Args:
        point: where to begin, with derivatives.
        evaluation: the problem's functions.
        rows: c_lower, c_upper (m,), scaled.
        elastic: solves the models.
        accepted: point and its violation → whether the main iteration can go on from there.
        limits: x (n,) → lower and upper limits (n,) of a step.
        budget: iterations at most.
        tolerance: violation that counts as none.
    """
    x_lower, x_upper, *_ = evaluation.nlp.bounds
    lower, upper = rows
    n = len(point.x)
    theta = first = violation(point.c, lower, upper)
    radius = max(1.0, 0.1 * float(np.abs(point.x).max()))
    P = SparseMatrix(identity(n), np.full(n, _CURVATURE))
    for count in range(1, budget + 1):
        d_lower, d_upper = limits(point.x)
        qp = QuadraticProgram(
            P,
            np.zeros(n),
            point.J,
            lower - point.c,
            upper - point.c,
            np.maximum(d_lower, -radius),
            np.minimum(d_upper, radius),
        )
        found = elastic.solve(qp, 1.0)
        if found.status is not QpStatus.SOLVED:
            return Restored(Outcome.LIMIT, point, count)
        d = found.d
        predicted = theta - violation(point.c + point.J @ d, lower, upper)
        if predicted <= _STATIONARY * min(1.0, radius) * max(theta, tolerance):
            return Restored(Outcome.STATIONARY, point, count)
        trial = _trial(evaluation, np.clip(point.x + d, x_lower, x_upper))
        theta_trial = np.inf if trial is None else violation(trial.c, lower, upper)
        ratio = (theta - theta_trial) / predicted
        if trial is not None and ratio > _ACCEPT:
            try:
                evaluation.differentiate(trial)
            except CallableError:
                trial, ratio = None, -1.0
        if trial is not None and ratio > _ACCEPT:
            point, theta = trial, theta_trial
            if (theta <= _ENOUGH * first or theta <= tolerance) and accepted(point, theta):
                return Restored(Outcome.RESTORED, point, count)
            if ratio > _GOOD and float(np.abs(d).max()) > 0.9 * radius:
                radius *= _GROW
        else:
            radius = _SHRINK * min(radius, float(np.abs(d).max()))
            if radius < _LEAST_RADIUS * max(1.0, float(np.abs(point.x).max())):
                return Restored(Outcome.STATIONARY, point, count)
    return Restored(Outcome.LIMIT, point, budget)


def _trial(evaluation: Evaluation, x: FloatArray) -> Point | None:
    try:
        return evaluation.point(x)
    except CallableError:
        return None
