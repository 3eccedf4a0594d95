"""Restoration: the constraints alone, until the filter takes the point or nothing helps.

The sum of violations is lowered by a trust-region method on its piecewise linear model. Variables
are measured by what they do to the constraints, so that no unit of one decides which it moves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto

import numpy as np

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix, Sparsity
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from ..problem.optimality import at_bounds
from ..problem.scaled import ScaledProblem
from ..qp.problem import QpSolution, QpStatus, QuadraticProgram
from .elastic import Elastic

Limits = tuple[FloatArray, FloatArray]

_ENOUGH = 0.9
_ACCEPT, _GOOD = 1e-4, 0.75
_GROW, _SHRINK = 3.0, 0.25
_LEAST_RADIUS = 1e-12
_STATIONARY = 1e-7
_PROVEN = 1e-3
_CURVATURE = 1e-3
_PATIENCE = 10
_LEAST_WEIGHT = 1e-8


class RestorationOutcome(Enum):
    """How restoration ended."""

    RESTORED = auto()
    """The main iteration can go on."""
    STATIONARY = auto()
    """Multipliers prove that no step lowers the linearised violation."""
    NO_STEP = auto()
    """No step helps, but that is no proof: callables without values, wrong derivatives, the user's
    box or a back end's failure may be behind it."""


@dataclass(slots=True)
class Restored:
    """Where restoration ended.

    Args:
        outcome: how.
        point: with derivatives.
        multipliers: (m,) of the violations at a stationary point, from -1 to 1.
        trouble: of the callables, where their having no value kept the last steps from being taken.
    """

    outcome: RestorationOutcome
    point: Point
    multipliers: FloatArray
    trouble: CallableError | None = None


@dataclass(slots=True)
class _State:
    """A restoration on its way.

    Args:
        point: with derivatives.
        theta: violation there.
        radius: of the region, in reaches; 0 at first.
        length: share of the last model's step that was taken.
        idle: steps in a row that the model did not want to go.
        trouble: see `Restored`.
    """

    point: Point
    theta: float
    radius: float = 0.0
    length: float = 0.0
    idle: int = 0
    trouble: CallableError | None = None


class Restoration:
    """Restorations of one solution.

    Args:
        problem: the problem.
        start: of the solution, with derivatives.
        elastic: solves the models.
        identity: pattern (n, n).
        limits: x (n,) → lower and upper limits (n,) of a step, the user's box included.
        moved: called after every iteration: the point that it led to, and the share of the model's
            step that was taken. It may end the solution by an exception.
        tolerance: violation that counts as none.
    """

    def __init__(
        self,
        problem: ScaledProblem,
        start: Point,
        elastic: Elastic,
        identity: Sparsity,
        limits: Callable[[FloatArray], Limits],
        moved: Callable[[Point, float], None],
        tolerance: float,
    ) -> None:
        self._problem = problem
        self._elastic = elastic
        self._identity = identity
        self._limits = limits
        self._moved = moved
        self._tolerance = tolerance
        self._slopes = _column_norms(start)

    def run(self, point: Point, accepted: Callable[[Point, float], bool]) -> Restored:
        """Lower the violation.

        Args:
            point: where to begin, with derivatives.
            accepted: point and its violation → whether the main iteration can go on from there.
        """
        at = _State(point, self._problem.theta(point.c))
        first = at.theta
        while True:
            reach = self._reach(at.point)
            at.radius = at.radius or max(1.0, 0.1 * float((np.abs(point.x) / reach).max()))
            found = self._modelled(at.point, reach, at.radius, self._limits(at.point.x))
            if found is None:
                return _stuck(at)
            predicted = at.theta - self._problem.theta(at.point.c + at.point.J @ found.d)
            if predicted <= _STATIONARY * min(1.0, at.radius) * max(at.theta, self._tolerance):
                ended = self._idle(at, reach, found)
                if ended is not None:
                    return ended
            elif self._step(at, found.d, reach, predicted):
                enough = at.theta <= _ENOUGH * first or at.theta <= self._tolerance
                if enough and accepted(at.point, at.theta):
                    return Restored(RestorationOutcome.RESTORED, at.point, found.y)
            elif at.radius < _LEAST_RADIUS * max(1.0, float((np.abs(at.point.x) / reach).max())):
                return self._proven(at, reach, found) or _stuck(at)
            self._moved(at.point, at.length)

    def _step(self, at: _State, d: FloatArray, reach: FloatArray, predicted: float) -> bool:
        """Take a model's step d (n,), or shrink the region; whether it was taken."""
        problem, size = self._problem, float((np.abs(d) / reach).max())
        trial, at.trouble = self._trial(at.point, d)
        theta = np.inf if trial is None else problem.theta(trial.c)
        ratio = (at.theta - theta) / predicted
        if trial is None or ratio <= _ACCEPT:
            at.length, at.radius = 0.0, _SHRINK * min(at.radius, size)
            return False
        at.point, at.theta, at.length, at.idle = trial, theta, 1.0, 0
        if ratio > _GOOD and size > 0.9 * at.radius:
            at.radius *= _GROW
        return True

    def _idle(self, at: _State, reach: FloatArray, found: QpSolution) -> Restored | None:
        """The end where the model predicts nothing; None where the region or the user's box is why,
        which may open."""
        proven = self._proven(at, reach, found)
        if proven is not None:
            return proven
        at.idle += 1
        span = self._span(at, reach)
        if at.radius >= span and not self._boxed(at.point):
            return _stuck(at)
        at.radius, at.length = max(at.radius, span), 0.0
        return _stuck(at) if at.idle >= _PATIENCE else None

    def _reach(self, point: Point) -> FloatArray:
        """Changes of the variables (n,) that move the constraints alike, about 1 each.

        The largest slopes seen so far count: where one vanishes it says nothing of distances.
        """
        self._slopes = np.maximum(self._slopes, _column_norms(point))
        there = self._slopes > 0
        if not there.any():
            return np.ones(len(point.x))
        middle = float(np.exp(np.log(self._slopes[there]).mean()))
        slopes = np.where(there, self._slopes, middle)
        return middle / np.maximum(slopes, _LEAST_WEIGHT * middle)

    def _modelled(
        self, point: Point, reach: FloatArray, radius: float, limits: Limits
    ) -> QpSolution | None:
        """The solution of the piecewise linear model within a region; None if it has none."""
        problem = self._problem
        found = self._elastic.solve(
            QuadraticProgram(
                SparseMatrix(self._identity, _CURVATURE / reach**2),
                np.zeros(len(reach)),
                point.J,
                problem.c_lower - point.c,
                problem.c_upper - point.c,
                np.maximum(limits[0], -radius * reach),
                np.minimum(limits[1], radius * reach),
            ),
            1.0,
        )
        return found if found.status is QpStatus.SOLVED else None

    def _trial(self, point: Point, d: FloatArray) -> tuple[Point | None, CallableError | None]:
        """Where a step leads, with derivatives; or why there is nothing."""
        problem = self._problem
        try:
            trial = problem.evaluation.point(np.clip(point.x + d, problem.x_lower, problem.x_upper))
            problem.evaluation.differentiate(trial)
        except CallableError as error:
            return None, error
        return trial, None

    # --------------------------------------------------------------------- nothing helps

    def _proven(self, at: _State, reach: FloatArray, found: QpSolution) -> Restored | None:
        """The end at a stationary point, where the multipliers of the model, or those of one
        without the region and the user's box, prove it one."""
        point, span = at.point, self._span(at, reach)
        mu = np.clip(found.y, -1.0, 1.0)
        if not self._proves(point, span * reach, mu):
            free = self._modelled(point, reach, span, self._bounds(point))
            mu = mu if free is None else np.clip(free.y, -1.0, 1.0)
            if free is None or not self._proves(point, span * reach, mu):
                return None
        return Restored(RestorationOutcome.STATIONARY, point, mu)

    def _span(self, at: _State, reach: FloatArray) -> float:
        """How many reaches away a single variable might undo the violation."""
        steepest = float((self._slopes * reach).max())
        return max(1.0, at.theta / steepest) if steepest > 0 else 1.0

    def _proves(self, point: Point, reach: FloatArray, multipliers: FloatArray) -> bool:
        """Whether multipliers μ from -1 to 1 bound the linearised violation from below, by all but
        a small share of what it is, for all steps d within the reach: it is at least
        Σ μᵢ (cᵢ − sideᵢ) + (Jᵀμ)·d."""
        problem = self._problem
        mu = multipliers
        side = np.where(mu > 0, problem.c_upper, problem.c_lower)
        pushing = (mu != 0) & np.isfinite(side)
        mu = np.where(pushing, mu, 0.0)
        held = float(mu @ np.where(pushing, point.c - side, 0.0))
        slope = point.J.transposed_times(mu)
        lower, upper = self._bounds(point)
        d = np.where(slope > 0, np.maximum(lower, -reach), np.minimum(upper, reach))
        theta = problem.theta(point.c)
        return held + float(slope @ d) >= (1.0 - _PROVEN) * theta

    def _bounds(self, point: Point) -> Limits:
        """Limits (n,) of a step by the problem's bounds alone; at a bound it leads nowhere."""
        problem = self._problem
        at_lower, at_upper = at_bounds(point.x, problem.x_lower, problem.x_upper)
        lower = np.where(at_lower, 0.0, problem.x_lower - point.x)
        upper = np.where(at_upper, 0.0, problem.x_upper - point.x)
        return np.minimum(lower, 0.0), np.maximum(upper, 0.0)

    def _boxed(self, point: Point) -> bool:
        """Whether the user's box keeps steps shorter than the bounds do."""
        lower, upper = self._limits(point.x)
        free_lower, free_upper = self._bounds(point)
        return bool((lower > free_lower).any() or (upper < free_upper).any())


def _stuck(at: _State) -> Restored:
    return Restored(RestorationOutcome.NO_STEP, at.point, np.zeros(len(at.point.c)), at.trouble)


def _column_norms(point: Point) -> FloatArray:
    J = point.J
    return np.sqrt(np.bincount(J.pattern.columns, J.data**2, minlength=len(point.x)))
