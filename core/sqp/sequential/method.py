"""Sequential quadratic programming with a filter line search.

    minimise f(x)   subject to   c_lower ≤ c(x) ≤ c_upper,   x_lower ≤ x ≤ x_upper

Each iteration solves a convex quadratic model (`qp`, `convexify`) within the bounds, takes as much
of its step as the filter admits (`filter`), with a second-order correction where the constraints'
curvature spoils it, an elastic model where linearised constraints contradict each other
(`elastic`), and a restoration of feasibility where nothing else helps (`restoration`). Sources:
Nocedal and Wright, "Numerical Optimization", chapter 18; Fletcher and Leyffer (2002); Wächter and
Biegler (2006).
"""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from ...arrays import FloatArray
from ..filter import Filter
from ..given import Given
from ..problem.evaluation import Point
from ..problem.optimality import OptimalityResiduals
from ..progress import SolutionEnd
from ..qp.problem import QpSolution
from ..verdict import Ending, nothing_to_gain
from .creep import Creep, CreepError
from .feasibility import Feasibility, NowhereError
from .hot_start import hot_started
from .model import Model
from .multipliers import first_multipliers, own_curvature, steepest_descent
from .restoration import Restoration, RestorationOutcome
from .search import FilterStep, Search

_LEAP, _MODEST = 10.0, 10.0
_STALLS = 4
_FAILURES = 8
_RESTARTS = 3
_DESCENTS = 20
_LESS = 1e-3
_ROUNDING = 1e-12


class Sequential:
    """One solution.

    Args:
        given: of the solution.
        patient: whether to go on where steps creep.
    """

    def __init__(self, given: Given, patient: bool = False) -> None:
        self.given = given
        self.nlp = given.problem.nlp
        self.options = given.options
        self.workspace = given.workspace
        self.problem = given.problem
        self.hessian = given.hessian
        self.progress = given.progress
        self.model = Model(given)
        boxed = given.options.step_box is not None
        self.creep = None if patient or boxed or not self.hessian.measured else Creep()
        self.stalls = 0
        self.failures = 0
        self.restarts = 0
        self.descents = 0

    def run(self, point: Point) -> NoReturn:
        """Begin at a point with derivatives.

        Raises:
            SolutionEnd: when the solution ends.
            CallableError: the Hessian has no value.
            CreepError: steps creep.
            NoSubproblemError: no back end solves a subproblem.
        """
        self.go_on(point, self._first_multipliers(point), point)

    def go_on(self, point: Point, multipliers: FloatArray, start: Point) -> NoReturn:
        """The same where another method gave up.

        Args:
            multipliers: (m,).
            start: where that began, with derivatives: its slopes are a measure of distances.
        """
        self.multipliers = multipliers
        at = self._visit(point, 0.0, "")
        if not self.progress.iterations:
            hot_started(point, self.given)
        self._prepare(point, start)
        self._iterate(point, at)

    def _prepare(self, point: Point, start: Point) -> None:
        """What the iteration begins with."""
        problem, workspace = self.problem, self.workspace
        theta = max(1.0, problem.theta(point.c))
        self.filter = Filter(10.0 * theta, 1e-4 * theta)
        self.search = Search(problem, self.model, self.filter)

        def limits(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            return self.model.limits(x, self.progress.iterations)

        restoration = Restoration(
            problem,
            start,
            workspace.elastic,
            workspace.identity,
            limits,
            self._moved,
            1e-2 * self.options.tolerance,
        )
        self.feasibility = Feasibility(
            problem,
            self.model,
            self.search,
            self.filter,
            restoration,
            limits,
            self._moved,
            self.options.tolerance,
        )

    def _first_multipliers(self, point: Point) -> FloatArray:
        warm = self.options.warm_start
        if warm is None or len(warm.multipliers) != self.nlp.m:
            return first_multipliers(point, self.problem, self.workspace.identity)
        if len(warm.bound_multipliers) == self.nlp.n:
            self.model.expect(warm.bound_multipliers * self.problem.evaluation.objective_factor)
        return self.problem.from_user(warm.multipliers)

    def _iterate(self, point: Point, at: OptimalityResiduals) -> NoReturn:
        """Steps until the solution ends by an exception."""
        while True:
            step = self._step(point, at)
            old, point = point, step.point
            self.multipliers = self._sober(step.multipliers, point)
            self.hessian.moved(old, point, self.multipliers)
            size = float(np.abs(point.x - old.x).max())
            still = size <= _ROUNDING * max(1.0, float(np.abs(point.x).max()))
            self.stalls = self.stalls + 1 if still else 0
            self.progress.iterations += 1
            at = self._visit(point, step.length, step.kind)
            whole = step.kind == "normal" and step.length == 1.0 and self.model.shift > 0.0
            if self.creep is not None and self.creep.seen(size, old.f - point.f, whole):
                raise CreepError

    def _visit(self, point: Point, length: float, kind: str) -> OptimalityResiduals:
        return self.progress.visit(point, self.multipliers, length, kind, self.model.shift)

    def _moved(self, point: Point, length: float) -> None:
        """An iteration of a restoration is over."""
        self.progress.iterations += 1
        self._visit(point, length, "restoration")

    # ------------------------------------------------------------------------- a step

    def _step(self, point: Point, at: OptimalityResiduals) -> FilterStep:
        """The next step, whatever it takes."""
        if self.stalls >= _STALLS:
            return self._last_step(point)
        found, kind = self.model.step(point, self.multipliers, self.progress.iterations)
        if found is None:
            return self._restored(point)
        refined = self.problem.residuals(point, found.y)
        if refined.kkt < at.kkt and refined.within(self.options.tolerance):
            raise self.progress.converged(point, found.y, refined)
        step = self.search.along(point, found, self.multipliers, kind)
        return self._after_failure(point, found) if step is None else step

    def _sober(self, multipliers: FloatArray, point: Point) -> FloatArray:
        """The multipliers; where they have leapt up, which nearly contradictory linearisations make
        them do, rather those of least squares."""
        before = float(np.abs(self.multipliers).max(initial=0.0))
        size = float(np.abs(multipliers).max(initial=0.0))
        if size <= _LEAP * max(_MODEST, before):
            return multipliers
        found = self._descent(point, np.ones(len(point.x)))
        if found is None or float(np.abs(found.y).max(initial=0.0)) >= size:
            return multipliers
        return found.y

    def _after_failure(self, point: Point, found: QpSolution) -> FilterStep:
        """The model is wrong nearby: feasibility first, or a smaller region."""
        if self.problem.violation(point) > self.options.tolerance:
            return self._restored(point)
        self.progress.trouble = self.search.trouble
        size = self.model.shrink(point, found.d)
        self.failures += 1
        if self.failures > _FAILURES or size < 1e-10:
            return self._last_step(point)
        return FilterStep(point, 0.0, found.y, "normal")

    def _restored(self, point: Point) -> FilterStep:
        """A step to where feasibility is restored as far as the filter wants it.

        Raises:
            SolutionEnd: there is none.
        """
        if not self.nlp.m:
            return self._last_step(point)
        try:
            return self.feasibility.restored(point)
        except NowhereError as nowhere:
            found = nowhere.found
        self.progress.trouble = found.trouble
        stationary = found.outcome is RestorationOutcome.STATIONARY
        at = self.problem.residuals(found.point, self.multipliers)
        if at.violation <= self.options.tolerance:
            raise SolutionEnd(Ending.NO_STEP)
        theta = self.problem.theta(self.progress.best.point.c)
        if theta >= (1.0 - _LESS) * self.problem.theta(found.point.c):
            if stationary:
                self.progress.best = self.progress.as_best(found.point, self.multipliers, at)
            raise SolutionEnd(Ending.STATIONARY_VIOLATION if stationary else Ending.NO_STEP)
        self.restarts += 1  # points seen on the way were less violated
        if self.options.step_box is not None or self.restarts > _RESTARTS:
            raise SolutionEnd(Ending.NO_STEP)
        self.filter.entries.clear()
        return FilterStep(
            self.progress.best.point, 1.0, self.progress.best.multipliers, "restoration"
        )

    # ---------------------------------------------------------------------- the end

    def _last_step(self, point: Point) -> FilterStep:
        """Steepest descent, where no model's step helps any more and it promises to gain something.

        Raises:
            SolutionEnd: it does not help either.
        """
        self._refine_best()
        tolerance = self.options.tolerance
        idle = nothing_to_gain(self.progress.gain, self.progress.best.objective, tolerance)
        self.descents += 1
        if idle or self.descents > _DESCENTS or self.problem.violation(point) > tolerance:
            raise SolutionEnd(Ending.NO_STEP)
        diagonal = own_curvature(point, self.problem, self.multipliers)
        found = self._descent(point, diagonal, self.model.limits(point.x, self.progress.iterations))
        step = None if found is None else self.search.along(point, found, found.y, "descent")
        if step is None or step.point is point:
            self.progress.trouble = self.search.trouble or self.progress.trouble
            raise SolutionEnd(Ending.NO_STEP)
        self.hessian.restart(diagonal)
        self.model.forget()
        self.failures = self.stalls = 0
        return step

    def _descent(
        self,
        point: Point,
        diagonal: FloatArray,
        limits: tuple[FloatArray, FloatArray] | None = None,
    ) -> QpSolution | None:
        workspace = self.workspace
        return steepest_descent(
            point, self.problem, workspace.subproblems, workspace.identity, diagonal, limits
        )

    def _refine_best(self) -> None:
        """The multipliers that leave least of the slope at the best point, and what is left to be
        gained there.

        Raises:
            SolutionEnd: with them it is a solution.
        """
        best = self.progress.best
        own = own_curvature(best.point, self.problem, best.multipliers)
        for diagonal in (np.ones(self.nlp.n), own):
            found = self._descent(best.point, diagonal)
            if found is None:
                continue
            at = self.problem.residuals(best.point, found.y)
            if at.kkt < self.progress.best.at.kkt:
                self.progress.best = self.progress.as_best(best.point, found.y, at)
            if diagonal is own:
                fall = -float(best.point.g @ found.d + 0.5 * (own * found.d) @ found.d)
                self.progress.gain = fall / self.problem.evaluation.objective_factor
        if self.progress.best.at.within(self.options.tolerance):
            raise SolutionEnd(Ending.CONVERGED)
