"""A warm start's first try: the new solution lies on the old one's active set, or nearly so."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..active_steps import ActiveSteps
from ..algebra.dense import is_dense
from ..given import Given
from ..problem.evaluation import Point
from ..problem.optimality import OptimalityResiduals
from ..problem.scaled import ScaledProblem
from ..qp.active_set import WorkingSet
from ..result import Result

_STEPS, _SYSTEMS, _REACH, _GAIN = 8, 8, 2.0, 10.0
_NO_MULTIPLIER = 1e-8


def hot_started(point: Point, given: Given) -> None:
    """Try Newton's steps from a warm start's active set; returns where they lead to no solution.

    A step counts only where the Lagrangian curves upwards along what is active, so that no maximum
    is walked to.

    Args:
        point: where it begins, with derivatives.

    Raises:
        SolutionEnd: the solution ends.
        CallableError: the Hessian has no value.
    """
    problem, options, progress = given.problem, given.options, given.progress
    warm = options.warm_start
    if warm is None or options.step_box is not None or not given.hessian.measured:
        return
    if len(warm.multipliers) != problem.nlp.m or len(warm.bound_multipliers) != problem.nlp.n:
        return
    known = given.workspace.hessian.known
    if known is not None and is_dense(known):
        return  # a step would cost as much as an iteration
    steps = ActiveSteps(given, _STEPS, _REACH, _SYSTEMS, _GAIN)

    def visited(at: Point, multipliers: FloatArray) -> OptimalityResiduals | None:
        if not steps.convex:
            return None
        progress.iterations += 1
        return progress.visit(at, multipliers, 1.0, "active_set", 0.0)

    y = problem.from_user(warm.multipliers)
    steps.solution(point, y, _active(warm, problem), judged=visited)


def _active(warm: Result, problem: ScaledProblem) -> WorkingSet:
    """The sides that push in a solution, and all that is fixed."""
    both = np.concatenate([warm.multipliers, warm.bound_multipliers])
    lower = np.concatenate([problem.c_lower, problem.x_lower])
    upper = np.concatenate([problem.c_upper, problem.x_upper])
    above = (lower == upper) | ((both > _NO_MULTIPLIER) & np.isfinite(upper))
    below = ~above & (both < -_NO_MULTIPLIER) & np.isfinite(lower)
    sides = np.where(above, 1, np.where(below, -1, 0)).astype(np.int8)
    return WorkingSet(len(warm.multipliers), sides)
