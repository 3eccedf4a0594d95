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
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .evaluation import CallableError, Point
from .filter import Filter
from .hessians import HessianKind, choose_kind, make_source
from .kkt import Residuals, residuals
from .model import Model, NoSubproblemError, StepBox
from .multipliers import first_multipliers, last_multipliers
from .nlp import NLP, FloatArray, NlpError
from .qp.backends import BackendKind, make_backends
from .qp.problem import QpSolution
from .restoration import Outcome, restore
from .result import Iteration, Result, Status, Timings
from .scaled import ScaledProblem
from .search import Search, Step
from .workspace import Workspace, make_workspace

Callback = Callable[[Iteration], bool | None]

_UNBOUNDED = 1e20
_FAR = 1e8
_ACCEPTABLE = 1e3
_LEAP, _MODEST = 10.0, 10.0
_STALLS = 4
_FAILURES = 8
_RESTARTS = 3
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
        max_iterations: of the outer iteration.
        qp: back end for the subproblems: see `BackendKind`.
        fallback: whether another back end takes over where this one fails.
        hessian_kind: where the Hessian comes from; None for what suits the problem.
        callback: is called before each iteration; True ends the solution (`Status.INTERRUPTED`),
            as the keyboard's interrupt does.
        warm_start: a result of this problem or one near to it, whose multipliers and workspace
            are taken over.
        step_box: number of the iteration and x (n,) → lower and upper limits (n,) of the step,
            which enclose zero: for models that hold nearby only.

    Returns:
        The result; it never claims more than its residuals show.

    Raises:
        NlpError: x0, an option or a callable's shape is wrong; the message names it.
    """
    options = _Options(tolerance, max_iterations, callback, step_box)
    _check_options(options)
    start = _start(nlp, x0)
    kind = choose_kind(nlp, hessian_kind)
    before = None if warm_start is None else warm_start.workspace
    workspace = make_workspace(nlp, make_backends(qp, fallback), before)
    return _Solver(nlp, options, kind, workspace).run(start, warm_start)


@dataclass(frozen=True, slots=True)
class _Options:
    tolerance: float
    max_iterations: int
    callback: Callback | None
    step_box: StepBox | None


@dataclass(slots=True)
class _Best:
    """The best point seen: the least violated one; of those within the tolerance the nearest to
    a solution, or the lowest where none is near to one.

    Args:
        acceptable: whether it may count as a solution where no better one is found.
    """

    point: Point
    multipliers: FloatArray
    violation: float
    objective: float
    kkt: float
    acceptable: bool

    def beaten_by(self, other: _Best, tolerance: float) -> bool:
        mine, its = self.violation <= tolerance, other.violation <= tolerance
        if mine != its:
            return its
        if not its:
            return other.violation < self.violation
        if self.acceptable != other.acceptable:
            return other.acceptable
        noise = 1e-12 * max(1.0, abs(other.objective))
        if self.acceptable or abs(other.objective - self.objective) <= noise:
            return other.kkt < self.kkt
        return other.objective < self.objective


class _End(Exception):
    """The solution ends."""

    def __init__(self, status: Status, message: str) -> None:
        super().__init__(message)
        self.status = status
        self.message = message


class _Solver:
    """One solution."""

    def __init__(
        self, nlp: NLP, options: _Options, kind: HessianKind, workspace: Workspace
    ) -> None:
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

    # ------------------------------------------------------------------------ the run

    def run(self, x0: FloatArray, warm: Result | None) -> Result:
        begin = time.perf_counter()
        try:
            point = self.problem.first_point(x0)
        except CallableError as error:
            return self._nothing(x0, str(error), begin)
        if warm is not None and len(warm.multipliers) == self.nlp.m:
            self.multipliers = self.problem.from_user(warm.multipliers)
            if len(warm.bound_multipliers) == self.nlp.n:
                self.model.expect(warm.bound_multipliers * self.problem.evaluation.objective_factor)
        else:
            self.multipliers = first_multipliers(point, self.problem)
        theta = max(1.0, self.problem.theta(point.c))
        self.filter = Filter(10.0 * theta, 1e-4 * theta)
        self.search = Search(self.problem, self.model, self.filter)
        at = self.problem.residuals(point, self.multipliers)
        self.best = self._best(point, self.multipliers, at)
        self.first_objective = self.best.objective
        try:
            self._iterate(point)
        except _End as end:
            return self._result(end.status, end.message, begin)
        except CallableError as error:
            return self._result(Status.CALLABLE_ERROR, str(error), begin)
        except NoSubproblemError as error:
            last = self._no_progress()
            told = str(error) if last.status is Status.ITERATION_LIMIT else last.message
            return self._result(last.status, told, begin)
        except KeyboardInterrupt:
            return self._result(Status.INTERRUPTED, "interrupted from the keyboard", begin)
        raise AssertionError("the iteration ends by an exception")

    def _iterate(self, point: Point) -> None:
        size, length, kind = 0.0, 0.0, ""
        while True:
            at = self.problem.residuals(point, self.multipliers)
            self._remember(point, at)
            self._report(point, at, size, length, kind)
            self._check_end(point, at)
            step = self._step(point, at)
            old, point = point, step.point
            length, kind = step.length, step.kind
            size = float(np.abs(point.x - old.x).max())
            if point is not old:
                self.problem.evaluation.differentiate(point)
            self.multipliers = self._sober(step.multipliers, point)
            self.hessian.moved(old, point, self.multipliers)
            still = size <= _ROUNDING * max(1.0, float(np.abs(point.x).max()))
            self.stalls = self.stalls + 1 if still else 0
            self.iterations += 1

    def _step(self, point: Point, at: Residuals) -> Step:
        """The next step, whatever it takes."""
        found, kind = self.model.step(point, self.multipliers, self.iterations)
        if found is None:
            return self._restored(point)
        refined = self.problem.residuals(point, found.y)
        if refined.kkt < at.kkt and self._done(refined):
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
        others = last_multipliers(point, self.problem, self.workspace.subproblems)
        if others is None or float(np.abs(others).max(initial=0.0)) >= size:
            return multipliers
        return others

    # ---------------------------------------------------------------------- the end

    def _done(self, at: Residuals) -> bool:
        return at.kkt <= self.options.tolerance and at.violation <= self.options.tolerance

    def _check_end(self, point: Point, at: Residuals) -> None:
        tolerance = self.options.tolerance
        if self._done(at):
            raise self._optimal(point, self.multipliers, at)
        if self.stalls >= _STALLS:
            raise self._no_progress()
        feasible = at.violation <= tolerance
        if feasible and self.problem.objective(point) < -_UNBOUNDED:
            raise _End(Status.UNBOUNDED, "the objective falls below -1e20 at a feasible point")
        if np.abs(point.x).max() > _UNBOUNDED:
            raise _End(Status.UNBOUNDED, "a variable grows beyond 1e20")
        if self.iterations >= self.options.max_iterations:
            raise _End(
                Status.ITERATION_LIMIT, f"{self.iterations} iterations did not reach the tolerance"
            )

    def _optimal(self, point: Point, multipliers: FloatArray, at: Residuals) -> _End:
        self.best = self._best(point, multipliers, at)
        return _End(Status.OPTIMAL, "residuals are within the tolerance")

    def _no_progress(self) -> _End:
        """No step helps any more: by rounding, or because the model is wrong."""
        best, tolerance = self.best, self.options.tolerance
        at = self.problem.residuals(best.point, best.multipliers)
        others = last_multipliers(best.point, self.problem, self.workspace.subproblems)
        if others is not None:
            other = self.problem.residuals(best.point, others)
            if other.kkt < at.kkt:
                at = other
                self.best = self._best(best.point, others, other)
        if self._done(at):
            return self._optimal(best.point, self.best.multipliers, at)
        if at.violation <= tolerance and self._fell_far(best):
            return _End(
                Status.UNBOUNDED,
                f"the objective falls to {best.objective:.3g}, where models fail",
            )
        if at.violation <= tolerance and self._near(at):
            return _End(
                Status.ACCEPTABLE,
                f"no step helps any more at a KKT residual of {at.kkt:.2g} (multipliers of "
                f"size {at.size:.2g})",
            )
        return _End(Status.ITERATION_LIMIT, "no step makes progress: are the derivatives right?")

    def _fell_far(self, best: _Best) -> bool:
        """Whether the objective has fallen as far as arithmetic goes."""
        far = float(np.abs(best.point.x).max()) > _FAR
        return far and best.objective < -_FAR * max(1.0, abs(self.first_objective))

    def _report(self, point: Point, at: Residuals, step: float, length: float, kind: str) -> None:
        if self.options.callback is None:
            return
        seen = Iteration(
            self.iterations,
            point.x.copy(),
            self.problem.objective(point),
            at.violation,
            at.kkt,
            step,
            length,
            self.model.shift,
            kind,
        )
        if self.options.callback(seen):
            raise _End(Status.INTERRUPTED, "interrupted by the callback")

    # ------------------------------------------------------------ where nothing is taken

    def _after_failure(self, point: Point, found: QpSolution) -> Step:
        """The model is wrong nearby: feasibility first, or a smaller region."""
        if self.problem.violation(point) > self.options.tolerance:
            return self._restored(point)
        size = self.model.shrink(point, found.d)
        self.failures += 1
        if self.failures > _FAILURES or size < 1e-10:
            raise self._no_progress()
        return Step(point, 0.0, found.y, "normal")

    def _restored(self, point: Point) -> Step:
        """Feasibility restored as far as the filter wants it."""
        if not self.nlp.m:
            raise self._no_progress()
        self.filter.add(self.problem.theta(point.c), point.f)
        limit = self.options.max_iterations - self.iterations
        found = restore(
            point,
            self.problem.evaluation,
            (self.problem.c_lower, self.problem.c_upper),
            self.workspace.elastic,
            lambda p, theta: self.filter.admits(theta, p.f),
            lambda x: self.model.limits(x, self.iterations),
            max(1, limit),
            1e-2 * self.options.tolerance,
        )
        self.iterations += found.iterations - 1
        if found.outcome is Outcome.RESTORED:
            self.model.forget()
            return Step(found.point, 1.0, np.zeros(self.nlp.m), "restoration")
        at = self.problem.residuals(found.point, self.multipliers)
        self._remember(found.point, at)
        if at.violation <= self.options.tolerance:
            # Feasible, but the filter wants a better objective, which no step here gives.
            self.filter.entries.clear()
            self.restarts += 1
            if self.restarts > _RESTARTS:
                raise self._no_progress()
            return Step(found.point, 1.0, np.zeros(self.nlp.m), "restoration")
        if found.outcome is Outcome.STATIONARY:
            aside = self._aside(point) if found.point is point else None
            if aside is not None:
                return aside
            raise _End(
                Status.INFEASIBLE,
                f"the violation cannot be made smaller than {at.violation:.3g} from here",
            )
        raise _End(Status.ITERATION_LIMIT, "restoration of feasibility did not come to an end")

    def _aside(self, point: Point) -> Step | None:
        """A step that lowers the objective at a point where the violation is stationary: its
        gradient may only be zero by chance there."""
        found = self.model.sideways()
        return None if found is None else self.search.along(point, found, found.y, "elastic")

    # ----------------------------------------------------------------------- the result

    def _best(self, point: Point, multipliers: FloatArray, at: Residuals) -> _Best:
        objective = self.problem.objective(point)
        return _Best(point, multipliers, at.violation, objective, at.kkt, self._near(at))

    def _near(self, at: Residuals) -> bool:
        """Whether a point is as near to a solution as arithmetic may allow."""
        tolerance = self.options.tolerance
        return at.kkt <= max(_ACCEPTABLE * tolerance, tolerance * at.size)

    def _remember(self, point: Point, at: Residuals) -> None:
        seen = self._best(point, self.multipliers, at)
        if self.best.beaten_by(seen, self.options.tolerance):
            self.best = seen

    def _result(self, status: Status, message: str, begin: float) -> Result:
        """The best point, with residuals from the callables in the user's own scale."""
        point, evaluation = self.best.point, self.problem.evaluation
        y = self.problem.to_user(self.best.multipliers)
        f, c, g, J = evaluation.unscaled(point.x)
        at = residuals(point.x, c, g, J, y, self.nlp.bounds)
        return Result(
            point.x.copy(),
            f,
            status,
            message,
            y,
            at.bound_multipliers,
            at.kkt,
            at.violation,
            self.iterations,
            dict(evaluation.counts),
            Timings(
                time.perf_counter() - begin, evaluation.seconds, self.workspace.subproblems.seconds
            ),
            self.workspace.subproblems.used,
            self.workspace,
        )

    def _nothing(self, x0: FloatArray, message: str, begin: float) -> Result:
        """The result where not even the start could be evaluated."""
        nlp = self.nlp
        return Result(
            x0,
            np.nan,
            Status.CALLABLE_ERROR,
            f"at the start: {message}",
            np.zeros(nlp.m),
            np.zeros(nlp.n),
            np.inf,
            np.inf,
            0,
            dict(self.problem.evaluation.counts),
            Timings(time.perf_counter() - begin, self.problem.evaluation.seconds, 0.0),
            self.workspace.subproblems.used,
        )


def _start(nlp: NLP, x0: ArrayLike) -> FloatArray:
    try:
        x = np.array(x0, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise NlpError(f"x0 is no array of numbers: {error}") from None
    if x.shape != (nlp.n,):
        raise NlpError(f"x0 has shape {x.shape}, expected ({nlp.n},)")
    if not np.isfinite(x).all():
        raise NlpError(f"x0[{int(np.flatnonzero(~np.isfinite(x))[0])}] is not finite")
    return x


def _check_options(options: _Options) -> None:
    if not (np.isfinite(options.tolerance) and options.tolerance > 0):
        raise NlpError(f"tolerance is above zero, not {options.tolerance}")
    if options.max_iterations < 0:
        raise NlpError(f"max_iterations is zero or more, not {options.max_iterations}")
    for name in ("callback", "step_box"):
        value = getattr(options, name)
        if value is not None and not callable(value):
            raise NlpError(f"{name} is a callable, not {value!r}")
