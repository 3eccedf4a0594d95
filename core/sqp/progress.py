"""What a solution keeps of its iterations, whichever method makes them: the best point, the
verdict's evidence, the user's callback, the end."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from .best import Best
from .options import Options
from .problem.errors import CallableError
from .problem.evaluation import Point
from .problem.optimality import OptimalityResiduals
from .problem.scaled import ScaledProblem
from .result import Iteration
from .verdict import Ending, Evidence, is_far, is_low, near


class SolutionEnd(Exception):
    """The solution ends."""

    def __init__(self, ending: Ending) -> None:
        super().__init__(ending)
        self.ending = ending


class SolutionProgress:
    """The course of one solution.

    Args:
        problem: the problem.
        options: of the solution.

    Attributes:
        iterations: number of them.
        best: the best point seen.
        gain: what steepest descent promises at the best point; infinite where that is not known.
        trouble: of the callables, where their having no value kept the last steps from being taken.
    """

    def __init__(self, problem: ScaledProblem, options: Options) -> None:
        self._problem = problem
        self._options = options
        self.iterations = 0
        self.gain = np.inf
        self.trouble: CallableError | None = None
        self.best: Best

    def begin(self, point: Point, multipliers: FloatArray) -> None:
        """Take note of the start, a point with derivatives."""
        at = self._problem.residuals(point, multipliers)
        self.best = self.as_best(point, multipliers, at)
        self._first_farthest = float(np.abs(point.x).max())
        self._first_feasible: float | None = None
        self._last_x = point.x

    def visit(
        self,
        point: Point,
        multipliers: FloatArray,
        length: float,
        kind: str,
        shift: float,
        last: bool = True,
    ) -> OptimalityResiduals:
        """Take note of a point at the beginning of an iteration.

        Args:
            point: with derivatives.
            multipliers: (m,).
            length, kind, shift: of the step that led there; see `Iteration`.
            last: whether to end where the residuals are within the tolerance.

        Raises:
            SolutionEnd: nothing is left to do.
        """
        at = self._problem.residuals(point, multipliers)
        self._remember(point, multipliers, at)
        self._report(point, at, length, kind, shift)
        self._last_x = point.x
        if last and at.within(self._options.tolerance):
            raise self.converged(point, multipliers, at)
        if not self._problem.closed and self._is_away(point):
            raise SolutionEnd(Ending.AWAY)
        if self.iterations >= self._options.max_iterations:
            raise SolutionEnd(Ending.LIMIT)
        return at

    def converged(
        self, point: Point, multipliers: FloatArray, at: OptimalityResiduals
    ) -> SolutionEnd:
        """The end at a solution."""
        self.best = self.as_best(point, multipliers, at)
        return SolutionEnd(Ending.CONVERGED)

    def as_best(self, point: Point, multipliers: FloatArray, at: OptimalityResiduals) -> Best:
        """A point with what is known of it."""
        likely = near(at, self._options.tolerance)
        return Best(point, multipliers, self._problem.objective(point), at, likely)

    def evidence(self, at: OptimalityResiduals, objective: float) -> Evidence:
        """What is known of the best point.

        Args:
            at, objective: there.
        """
        first = self._first_feasible
        return Evidence(
            at=at,
            tolerance=self._options.tolerance,
            objective=objective,
            first_objective=objective if first is None else first,
            farthest=float(np.abs(self.best.point.x).max()),
            first_farthest=self._first_farthest,
            closed=self._problem.closed,
            gain=self.gain,
            trouble="" if self.trouble is None else str(self.trouble),
            boxed=self._options.step_box is not None,
            iterations=self.iterations,
        )

    def _is_away(self, point: Point) -> bool:
        far = is_far(float(np.abs(point.x).max()), self._first_farthest)
        best = self.best
        return far or (is_low(best.objective) and self.evidence(best.at, best.objective).away)

    def _remember(self, point: Point, multipliers: FloatArray, at: OptimalityResiduals) -> None:
        seen = self.as_best(point, multipliers, at)
        if self._first_feasible is None and at.violation <= self._options.tolerance:
            self._first_feasible = seen.objective
        if self.best.beaten_by(seen, self._options.tolerance):
            self.best = seen

    def _report(
        self, point: Point, at: OptimalityResiduals, length: float, kind: str, shift: float
    ) -> None:
        if self._options.callback is None:
            return
        seen = Iteration(
            self.iterations,
            point.x.copy(),
            self._problem.objective(point),
            at.violation,
            at.kkt,
            float(np.abs(point.x - self._last_x).max()),
            length,
            shift,
            kind,
        )
        if self._options.callback(seen):
            raise SolutionEnd(Ending.CALLBACK)
