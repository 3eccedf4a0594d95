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

import time

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from .best import Best
from .feasibility import Feasibility, NowhereError
from .filter import Filter
from .model import Model, NoSubproblemError
from .multipliers import first_multipliers, own_curvature, steepest_descent
from .options import Callback, Options, StepBox, start_point
from .problem.errors import CallableError
from .problem.evaluation import Point
from .problem.hessians import HessianKind, choose_kind, make_source
from .problem.nlp import NLP
from .problem.optimality import OptimalityResiduals
from .problem.scaled import ScaledProblem
from .qp.backends import BackendKind, make_backends
from .qp.problem import QpSolution
from .restoration import Restoration, RestorationOutcome
from .result import Iteration, Result, Status, Timings
from .search import FilterStep, Search
from .verdict import Ending, Evidence, is_far, near, nothing_to_gain, verdict
from .workspace import Workspace, make_workspace

_LEAP, _MODEST = 10.0, 10.0
_STALLS = 4
_FAILURES = 8
_RESTARTS = 3
_DESCENTS = 20
_LESS = 1e-3
_ROUNDING = 1e-12


def solve(
    nlp: NLP,
    x0: ArrayLike,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 500,
    qp: BackendKind | str = BackendKind.CLARABEL,
    fallback: bool = True,
    hessian_kind: HessianKind | str | None = None,
    callback: Callback | None = None,
    warm_start: Result | None = None,
    step_box: StepBox | None = None,
) -> Result:
    """Solve a nonlinear program from x0.

    Args:
        nlp: the problem.
        x0: (n,) start; it is moved into the bounds.
        tolerance: on KKT residual and constraint violation, unscaled.
        max_iterations: of the outer iteration, those of restorations included.
        qp: back end for the subproblems: see `BackendKind`.
        fallback: whether another back end takes over where this one fails.
        hessian_kind: where the Hessian comes from; None for what suits the problem.
        callback: called with the start and the point after each iteration; True ends the
            solution (`Status.INTERRUPTED`), as the keyboard's interrupt does.
        warm_start: a result of this problem or one near to it, whose multipliers and workspace
            are taken over.
        step_box: number of the iteration and x (n,) → lower and upper limits of the step, each (n,)
            or a number, which enclose zero: for models that hold nearby only.

    Returns:
        The result; it never claims more than its residuals show.

    Raises:
        NlpError: x0, an option, or what a callable returns is wrong; the message names it.
    """
    options = Options(tolerance, max_iterations, callback, step_box, warm_start)
    start = start_point("x0", nlp, x0)
    kind = choose_kind(nlp, hessian_kind)
    before = None if warm_start is None else warm_start.workspace
    workspace = make_workspace(nlp, make_backends(qp, fallback), before)
    try:
        return _Solver(nlp, options, kind, workspace).run(start)
    finally:
        workspace.busy.release()


class _End(Exception):
    """The solution ends."""

    def __init__(self, ending: Ending) -> None:
        super().__init__(ending)
        self.ending = ending


class _Solver:
    """One solution."""

    def __init__(self, nlp: NLP, options: Options, kind: HessianKind, workspace: Workspace) -> None:
        self.nlp = nlp
        self.options = options
        self.workspace = workspace
        self.problem = ScaledProblem(nlp, workspace.jacobian, workspace.hessian)
        self.hessian = make_source(kind, self.problem.evaluation)
        self.model = Model(
            self.problem, self.hessian, workspace, options.step_box, options.tolerance
        )
        self.iterations = 0
        self.stalls = 0
        self.failures = 0
        self.restarts = 0
        self.descents = 0
        self.gain = np.inf
        self.trouble: CallableError | None = None

    # ------------------------------------------------------------------------ the run

    def run(self, x0: FloatArray) -> Result:
        begin = time.perf_counter()
        try:
            point = self.problem.first_point(x0)
        except CallableError as error:
            return self._nothing(x0, str(error), begin)
        self._prepare(point)
        try:
            self._iterate(point)
        except _End as end:
            ending = end.ending
        except CallableError as error:  # of the Hessian: nothing shorter can be tried
            ending, self.trouble = Ending.NO_STEP, error
        except NoSubproblemError:
            ending = Ending.NO_MODEL
        except KeyboardInterrupt:
            ending = Ending.KEYBOARD
        return self._result(ending, begin)

    def _prepare(self, point: Point) -> None:
        """What the iteration begins with."""
        problem, workspace = self.problem, self.workspace
        self.multipliers = self._first_multipliers(point)
        theta = max(1.0, problem.theta(point.c))
        self.filter = Filter(10.0 * theta, 1e-4 * theta)
        self.search = Search(problem, self.model, self.filter)

        def limits(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            return self.model.limits(x, self.iterations)

        restoration = Restoration(
            problem,
            point,
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
        at = problem.residuals(point, self.multipliers)
        self.best = self._best(point, self.multipliers, at)
        self.first_farthest = float(np.abs(point.x).max())
        self.first_feasible: float | None = None
        self.last_x = point.x

    def _first_multipliers(self, point: Point) -> FloatArray:
        warm = self.options.warm_start
        if warm is None or len(warm.multipliers) != self.nlp.m:
            return first_multipliers(point, self.problem, self.workspace.identity)
        if len(warm.bound_multipliers) == self.nlp.n:
            self.model.expect(warm.bound_multipliers * self.problem.evaluation.objective_factor)
        return self.problem.from_user(warm.multipliers)

    def _iterate(self, point: Point) -> None:
        """Steps until the solution ends by an exception."""
        length, kind = 0.0, ""
        while True:
            at = self._visit(point, length, kind)
            step = self._step(point, at)
            old, point = point, step.point
            length, kind = step.length, step.kind
            self.multipliers = self._sober(step.multipliers, point)
            self.hessian.moved(old, point, self.multipliers)
            size = float(np.abs(point.x - old.x).max())
            still = size <= _ROUNDING * max(1.0, float(np.abs(point.x).max()))
            self.stalls = self.stalls + 1 if still else 0
            self.iterations += 1

    def _visit(self, point: Point, length: float, kind: str) -> OptimalityResiduals:
        """Take note of a point at the beginning of an iteration.

        Raises:
            _End: nothing is left to do.
        """
        at = self.problem.residuals(point, self.multipliers)
        self._remember(point, at)
        self._report(point, at, length, kind)
        self.last_x = point.x
        if at.within(self.options.tolerance):
            raise self._optimal(point, self.multipliers, at)
        if self._evidence(self.best.at, self.best.objective).away or self._is_away(point):
            raise _End(Ending.AWAY)
        if self.iterations >= self.options.max_iterations:
            raise _End(Ending.LIMIT)
        return at

    def _is_away(self, point: Point) -> bool:
        return is_far(float(np.abs(point.x).max()), self.first_farthest) and not self.problem.closed

    def _moved(self, point: Point, length: float) -> None:
        """An iteration of a restoration is over."""
        self.iterations += 1
        self._visit(point, length, "restoration")

    def _report(self, point: Point, at: OptimalityResiduals, length: float, kind: str) -> None:
        if self.options.callback is None:
            return
        seen = Iteration(
            self.iterations,
            point.x.copy(),
            self.problem.objective(point),
            at.violation,
            at.kkt,
            float(np.abs(point.x - self.last_x).max()),
            length,
            self.model.shift,
            kind,
        )
        if self.options.callback(seen):
            raise _End(Ending.CALLBACK)

    # ------------------------------------------------------------------------- a step

    def _step(self, point: Point, at: OptimalityResiduals) -> FilterStep:
        """The next step, whatever it takes."""
        if self.stalls >= _STALLS:
            return self._last_step(point)
        found, kind = self.model.step(point, self.multipliers, self.iterations)
        if found is None:
            return self._restored(point)
        refined = self.problem.residuals(point, found.y)
        if refined.kkt < at.kkt and refined.within(self.options.tolerance):
            raise self._optimal(point, found.y, refined)
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
        self.trouble = self.search.trouble
        size = self.model.shrink(point, found.d)
        self.failures += 1
        if self.failures > _FAILURES or size < 1e-10:
            return self._last_step(point)
        return FilterStep(point, 0.0, found.y, "normal")

    def _restored(self, point: Point) -> FilterStep:
        """A step to where feasibility is restored as far as the filter wants it.

        Raises:
            _End: there is none.
        """
        if not self.nlp.m:
            return self._last_step(point)
        try:
            return self.feasibility.restored(point)
        except NowhereError as nowhere:
            found = nowhere.found
        self.trouble = found.trouble
        stationary = found.outcome is RestorationOutcome.STATIONARY
        at = self.problem.residuals(found.point, self.multipliers)
        if at.violation <= self.options.tolerance:
            raise _End(Ending.NO_STEP)
        theta = self.problem.theta(self.best.point.c)
        if theta >= (1.0 - _LESS) * self.problem.theta(found.point.c):
            if stationary:
                self.best = self._best(found.point, self.multipliers, at)
            raise _End(Ending.STATIONARY_VIOLATION if stationary else Ending.NO_STEP)
        self.restarts += 1  # points seen on the way were less violated
        if self.options.step_box is not None or self.restarts > _RESTARTS:
            raise _End(Ending.NO_STEP)
        self.filter.entries.clear()
        return FilterStep(self.best.point, 1.0, self.best.multipliers, "restoration")

    # ---------------------------------------------------------------------- the end

    def _last_step(self, point: Point) -> FilterStep:
        """Steepest descent, where no model's step helps any more and it promises to gain something.

        Raises:
            _End: it does not help either.
        """
        self._refine_best()
        tolerance = self.options.tolerance
        idle = nothing_to_gain(self.gain, self.best.objective, tolerance)
        self.descents += 1
        if idle or self.descents > _DESCENTS or self.problem.violation(point) > tolerance:
            raise _End(Ending.NO_STEP)
        diagonal = own_curvature(point, self.problem, self.multipliers)
        found = self._descent(point, diagonal, self.model.limits(point.x, self.iterations))
        step = None if found is None else self.search.along(point, found, found.y, "descent")
        if step is None or step.point is point:
            self.trouble = self.search.trouble or self.trouble
            raise _End(Ending.NO_STEP)
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
            _End: with them it is a solution.
        """
        best = self.best
        own = own_curvature(best.point, self.problem, best.multipliers)
        for diagonal in (np.ones(self.nlp.n), own):
            found = self._descent(best.point, diagonal)
            if found is None:
                continue
            at = self.problem.residuals(best.point, found.y)
            if at.kkt < self.best.at.kkt:
                self.best = self._best(best.point, found.y, at)
            if diagonal is own:
                fall = -float(best.point.g @ found.d + 0.5 * (own * found.d) @ found.d)
                self.gain = fall / self.problem.evaluation.objective_factor
        if self.best.at.within(self.options.tolerance):
            raise _End(Ending.CONVERGED)

    def _optimal(self, point: Point, multipliers: FloatArray, at: OptimalityResiduals) -> _End:
        self.best = self._best(point, multipliers, at)
        return _End(Ending.CONVERGED)

    def _best(self, point: Point, multipliers: FloatArray, at: OptimalityResiduals) -> Best:
        likely = near(at, self.options.tolerance)
        return Best(point, multipliers, self.problem.objective(point), at, likely)

    def _remember(self, point: Point, at: OptimalityResiduals) -> None:
        seen = self._best(point, self.multipliers, at)
        if self.first_feasible is None and at.violation <= self.options.tolerance:
            self.first_feasible = seen.objective
        if self.best.beaten_by(seen, self.options.tolerance):
            self.best = seen

    def _evidence(self, at: OptimalityResiduals, objective: float) -> Evidence:
        """What is known of the best point.

        Args:
            at, objective: there.
        """
        first = self.first_feasible
        return Evidence(
            at=at,
            tolerance=self.options.tolerance,
            objective=objective,
            first_objective=objective if first is None else first,
            farthest=float(np.abs(self.best.point.x).max()),
            first_farthest=self.first_farthest,
            closed=self.problem.closed,
            gain=self.gain,
            trouble="" if self.trouble is None else str(self.trouble),
            boxed=self.options.step_box is not None,
            iterations=self.iterations,
        )

    def _result(self, ending: Ending, begin: float) -> Result:
        """The best point, judged by residuals from the callables in the user's own scale."""
        x, evaluation, subproblems = (
            self.best.point.x,
            self.problem.evaluation,
            self.workspace.subproblems,
        )
        y = self.problem.to_user(self.best.multipliers)
        objective, at = self.problem.result_residuals(x, y)
        status, message = verdict(ending, self._evidence(at, objective))
        return Result(
            x.copy(),
            objective,
            status,
            message,
            y,
            at.bound_multipliers,
            at.kkt,
            at.violation,
            self.iterations,
            dict(evaluation.counts),
            Timings(time.perf_counter() - begin, evaluation.seconds, subproblems.seconds),
            subproblems.used,
            self.workspace,
        )

    def _nothing(self, x0: FloatArray, message: str, begin: float) -> Result:
        """The result where not even the start could be evaluated."""
        evaluation, subproblems = self.problem.evaluation, self.workspace.subproblems
        return Result(
            x0,
            np.nan,
            Status.CALLABLE_ERROR,
            f"at the start: {message}",
            np.zeros(self.nlp.m),
            np.zeros(self.nlp.n),
            np.inf,
            np.inf,
            0,
            dict(evaluation.counts),
            Timings(time.perf_counter() - begin, evaluation.seconds, 0.0),
            subproblems.used,
        )
