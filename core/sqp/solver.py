"""`solve`: which method, and what came of it."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from .algebra.dense import LEAST_SIZE, is_dense
from .best import Best
from .given import Given
from .interior_point.solution import InteriorSolution
from .methods import SolverMethod, chosen
from .options import Callback, Options, StepBox, start_point
from .problem.errors import CallableError
from .problem.evaluation import Point
from .problem.hessians import HessianKind, choose_kind, full_or_sparse, make_source
from .problem.limited_memory import LimitedMemory
from .problem.nlp import NLP
from .problem.scaled import ScaledProblem
from .progress import SolutionEnd, SolutionProgress
from .qp.backends import BackendKind
from .result import Result, Status, Timings
from .sequential.creep import CreepError
from .sequential.method import Sequential
from .sequential.model import NoSubproblemError
from .verdict import Ending, verdict
from .workspace import Workspace, make_workspace

_NEARLY = 0.5
"""Power of the tolerance up to which a point is violated so little that the interior point is
worth a second try from there: its steps are far cheaper than the other method's."""


def solve(
    nlp: NLP,
    x0: ArrayLike,
    *,
    method: SolverMethod | str = SolverMethod.AUTO,
    tolerance: float = 1e-6,
    max_iterations: int = 500,
    qp: BackendKind | str = BackendKind.CLARABEL,
    fallback: bool = True,
    hessian_kind: HessianKind | str | None = None,
    callback: Callback | None = None,
    warm_start: Result | None = None,
    step_box: StepBox | None = None,
    structure_of: Result | None = None,
) -> Result:
    """Solve a nonlinear program from x0.

    Args:
        nlp: the problem.
        x0: (n,) start; it is moved into the bounds.
        method: sequential quadratic programming, the interior point, or which of them suits: see
            `SolverMethod`.
        tolerance: on KKT residual and constraint violation, unscaled.
        max_iterations: of the outer iteration, those of restorations included.
        qp: back end for the subproblems of sequential quadratic programming: see `BackendKind`.
        fallback: whether another back end takes over where this one fails.
        hessian_kind: where the Hessian comes from; None for what suits the problem.
        callback: called with the start and the point after each iteration; True ends the
            solution (`Status.INTERRUPTED`), as the keyboard's interrupt does.
        warm_start: a result of this problem or one near to it, whose multipliers and workspace
            are taken over.
        step_box: number of the iteration and x (n,) → lower and upper limits of the step, each (n,)
            or a number, which enclose zero: for models that hold nearby only, with sequential
            quadratic programming.
        structure_of: a result of a problem with the same sparsity, whose workspace is taken over
            and nothing else: the solution is a cold one that saves the symbolic work.

    Returns:
        The result; it never claims more than its residuals show.

    Raises:
        NlpError: x0, an option, or what a callable returns is wrong; the message names it.
    """
    options = Options(tolerance, max_iterations, callback, step_box, warm_start)
    start = start_point("x0", nlp, x0)
    kind = choose_kind(nlp, hessian_kind)
    first = chosen(method, nlp, kind, options)
    earlier = structure_of if warm_start is None else warm_start
    before = None if earlier is None else earlier.workspace
    workspace = make_workspace(nlp, qp, fallback, before)
    try:
        return _Solution(nlp, options, kind, workspace, first, first == method).run(start)
    finally:
        workspace.busy.release()


class _Solution:
    """One solution."""

    def __init__(
        self,
        nlp: NLP,
        options: Options,
        kind: HessianKind,
        workspace: Workspace,
        first: SolverMethod,
        wished: bool,
    ) -> None:
        self._nlp = nlp
        self._options = options
        self._workspace = workspace
        self._first = first
        self._wished = wished
        self._used: list[SolverMethod] = []
        self._problem = ScaledProblem(nlp, workspace.jacobian, workspace.hessian)
        self._hessian = make_source(kind, self._problem.evaluation)
        self._progress = SolutionProgress(self._problem, options)
        self._begin = time.perf_counter()

    def run(self, x0: FloatArray) -> Result:
        try:
            point = self._problem.first_point(x0)
        except CallableError as error:
            return self._nothing(x0, f"at the start: {error}")
        self._progress.begin(point, np.zeros(self._nlp.m))
        try:
            ending = self._iterate(point)
        except SolutionEnd as end:
            ending = end.ending
        except CallableError as error:  # of the Hessian: nothing shorter can be tried
            ending, self._progress.trouble = Ending.NO_STEP, error
        except NoSubproblemError:
            ending = Ending.NO_MODEL
        except KeyboardInterrupt:
            ending = Ending.KEYBOARD
        return self._result(ending)

    def _iterate(self, point: Point) -> Ending:
        """Iterate until the end, which is an exception."""
        of_solution = self._workspace, self._options, self._progress
        given = Given(self._problem, self._hessian, *of_solution)
        best = None
        if self._first is SolverMethod.INTERIOR_POINT and not self._full(point):
            best = self._by_interior_point(given, point)
            if best.point is not point and best.at.violation <= self._options.tolerance**_NEARLY:
                best = self._by_interior_point(given, best.point)  # less violated than it is now
            if isinstance(self._hessian, LimitedMemory):
                kind = full_or_sparse(self._nlp)
                given = replace(given, hessian=make_source(kind, self._problem.evaluation))
        try:
            self._by_subproblems(Sequential(given), best, point)
        except CreepError:
            best = self._by_interior_point(given, self._progress.best.point)
        self._by_subproblems(Sequential(given, patient=True), best, point)
        raise AssertionError("methods end by an exception")

    def _by_interior_point(self, given: Given, point: Point) -> Best:
        """The best point where the interior point gave up."""
        self._used.append(SolverMethod.INTERIOR_POINT)
        InteriorSolution(given).run(point)
        self._progress.iterations += 1
        return self._progress.best

    def _by_subproblems(self, method: Sequential, best: Best | None, start: Point) -> None:
        """Sequential quadratic programming, from the best point of another method where there is
        one: it goes on, or says why not."""
        self._used.append(SolverMethod.SQP)
        if best is None:
            method.run(start)
        else:
            method.go_on(best.point, best.multipliers, start)

    def _full(self, point: Point) -> bool:
        """Whether the Hessian has an entry almost everywhere, where the method is not the user's
        wish: the sparse factorisations of an interior point are no good for it."""
        if self._wished or self._nlp.n < LEAST_SIZE:
            return False
        return is_dense(self._hessian.matrix(point, np.zeros(self._nlp.m)).pattern)

    def _result(self, ending: Ending) -> Result:
        """The best point, judged by residuals from the callables in the user's own scale."""
        progress, evaluation = self._progress, self._problem.evaluation
        subproblems = self._workspace.subproblems
        point = progress.best.point
        y = self._problem.to_user(progress.best.multipliers)
        objective, at = self._problem.result_residuals(point, y)
        status, message = verdict(ending, progress.evidence(at, objective))
        return Result(
            point.x.copy(),
            objective,
            status,
            message,
            y,
            at.bound_multipliers,
            at.kkt,
            at.violation,
            progress.iterations,
            dict(evaluation.counts),
            Timings(time.perf_counter() - self._begin, evaluation.seconds, subproblems.seconds),
            subproblems.used,
            " and ".join(dict.fromkeys(self._used)),
            self._workspace,
        )

    def _nothing(self, x0: FloatArray, message: str) -> Result:
        """The result where not even the start could be evaluated."""
        evaluation, subproblems = self._problem.evaluation, self._workspace.subproblems
        return Result(
            x0,
            np.nan,
            Status.CALLABLE_ERROR,
            message,
            np.zeros(self._nlp.m),
            np.zeros(self._nlp.n),
            np.inf,
            np.inf,
            0,
            dict(evaluation.counts),
            Timings(time.perf_counter() - self._begin, evaluation.seconds, 0.0),
            subproblems.used,
        )
