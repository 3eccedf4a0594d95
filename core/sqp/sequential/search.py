"""How much of a model's step is taken: the filter line search."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ..filter import Filter
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from ..problem.scaled import ScaledProblem
from ..qp.problem import QpSolution
from .model import Model

_HALVINGS = 30
_NEAR_MISSES = 12
_LEAST_LENGTH = 1e-9
_CORRECTIONS = 3
_CORRECTED_ENOUGH = 0.99
_ROUNDING = 1e-15


@dataclass(slots=True)
class FilterStep:
    """A step that the filter took.

    Args:
        point: where it leads, with derivatives.
        length: share of the model's step.
        multipliers: (m,) there.
        kind: see `Iteration`.
    """

    point: Point
    length: float
    multipliers: FloatArray
    kind: str


@dataclass(slots=True)
class _Attempt:
    """A model's step on trial.

    Args:
        origin: where it begins.
        theta: violation there.
        found: the model's solution.
        multipliers: (m,) before.
        kind: of the model.
    """

    origin: Point
    theta: float
    found: QpSolution
    multipliers: FloatArray
    kind: str

    @property
    def slope(self) -> float:
        return float(self.origin.g @ self.found.d)


class Search:
    """Line searches of one solution.

    Args:
        problem: the problem.
        model: gives second-order corrections, and learns how far its steps were taken.
        filter_: which points count as progress.

    Attributes:
        trouble: of the callables at the shortest step tried last; None where they had values.
    """

    def __init__(self, problem: ScaledProblem, model: Model, filter_: Filter) -> None:
        self._problem = problem
        self._model = model
        self._filter = filter_
        self.trouble: CallableError | None = None

    def along(
        self, point: Point, found: QpSolution, multipliers: FloatArray, kind: str
    ) -> FilterStep | None:
        """As much of a step as the filter takes; None if it takes nothing."""
        self.trouble = None
        attempt = _Attempt(point, self._problem.theta(point.c), found, multipliers, kind)
        size = float(np.abs(found.d).max())
        tiny = _ROUNDING * max(1.0, float(np.abs(point.x).max()))
        if size <= 10 * tiny:
            return FilterStep(point, 1.0, found.y, kind)
        length = 1.0
        for halving in range(_HALVINGS):
            trial = self._trial(point, found.d, length)
            if trial is not None:
                step = self._judged(attempt, trial, found, length)
                if step is None and halving == 0:
                    step = self._corrected(attempt, trial)
                if step is not None:
                    return step
            length *= 0.5
            if length * size <= tiny or (halving >= _NEAR_MISSES and length < _LEAST_LENGTH):
                break
        return None

    def _trial(self, point: Point, d: FloatArray, length: float) -> Point | None:
        """Values there; None where a callable has none."""
        x = np.clip(point.x + length * d, self._problem.x_lower, self._problem.x_upper)
        self.trouble = None
        try:
            return self._problem.evaluation.point(x)
        except CallableError as error:
            self.trouble = error
            return None

    def _judged(
        self, attempt: _Attempt, trial: Point, found: QpSolution, length: float
    ) -> FilterStep | None:
        """The step to a trial point if the filter takes it."""
        before = (attempt.theta, attempt.origin.f)
        after = (self._problem.theta(trial.c), trial.f)
        descends = self._filter.judge(before, after, attempt.slope, length)
        if descends is None or not self._differentiable(trial):
            return None
        if not descends:
            self._filter.add(*before)
        self._model.taken(attempt.origin, found.d, length)
        multipliers = attempt.multipliers + length * (found.y - attempt.multipliers)
        kind = attempt.kind if found is attempt.found else "corrected"
        return FilterStep(trial, length, multipliers, kind)

    def _differentiable(self, trial: Point) -> bool:
        """Whether a trial point has derivatives, which it has from then on."""
        try:
            self._problem.evaluation.differentiate(trial)
        except CallableError as error:
            self.trouble = error
            return False
        return True

    def _corrected(self, attempt: _Attempt, trial: Point) -> FilterStep | None:
        """Second-order correction: the same model, with the constraints' values after the step."""
        theta = self._problem.theta(trial.c)
        if theta < attempt.theta or not len(trial.c):
            return None
        point, c_after, d = attempt.origin, trial.c, attempt.found.d
        for _ in range(_CORRECTIONS):
            corrected = self._model.corrected(c_after - point.J @ d, attempt.found)
            after = None if corrected is None else self._trial(point, corrected.d, 1.0)
            if corrected is None or after is None:
                return None
            step = self._judged(attempt, after, corrected, 1.0)
            if step is not None:
                return step
            theta_after = self._problem.theta(after.c)
            if theta_after > _CORRECTED_ENOUGH * theta:
                return None
            theta, c_after, d = theta_after, after.c, corrected.d
        return None
