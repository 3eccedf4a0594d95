"""Minimises the robust sum of all runs over parameters and what runs have of their own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.sqp import Iteration, Result, SolverMethod, Status, solve
from .emulation import Nuisance, Rows
from .loss import loss
from .parameters import ParameterSet
from .problem import Problem, Variables
from .run_pool import RunPool

Watch = Callable[[Iteration], bool | None]

LEAST_GAIN = 1e-4
"""Share of the robust sum that an iteration must gain, or the next one, for the fit to go on."""
MOST_ITERATIONS = 40
TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where a minimisation ended.

    Args:
        variables: of the problem.
        x: (n,) of them.
        first, last: the robust sum at start and end, per residual, and what it costs to leave what
            was before (`ParameterSet.hold`).
        iterations: that it took.
        converged: whether it went as far as it could.
    """

    variables: Variables
    x: FloatArray
    first: float
    last: float
    iterations: int
    converged: bool

    @property
    def values(self) -> FloatArray:
        """(P,), of the parameters."""
        return self.variables.values(self.x)

    @property
    def rest(self) -> float:
        """The robust sum at the end alone, per residual."""
        p = self.variables.parameters
        if p.hold == 0.0:
            return self.last
        return self.last - p.hold * float(loss(p.departures(self.values)[0]).sum())

    @property
    def nuisances(self) -> tuple[Nuisance, ...]:
        """Of each run."""
        return self.variables.nuisances(self.x)


def minimise(
    pool: RunPool,
    parameters: ParameterSet,
    nuisances: Sequence[Nuisance],
    watch: Watch | None = None,
    known: Sequence[Rows] | None = None,
) -> Minimum:
    """Find the parameters and nuisances with the least robust sum.

    Args:
        pool: emulates the runs.
        parameters: to be found.
        nuisances: of the runs, where theirs begin.
        watch: called after each iteration; True ends the search.
        known: residuals and derivatives of each run at the start, if they are known; the search
            then ends without evaluating any where those that were carried on lead no further.

    Raises:
        InputError: a program cannot be driven at the start.
    """
    variables = Variables.of(parameters, pool.runs, nuisances)
    if variables.size == 0:
        rest = Problem(pool, variables).residuals(np.zeros(0))
        whole = 0.5 * float(rest @ rest)
        return Minimum(variables, np.zeros(0), whole, whole, 0, True)
    problem = Problem(pool, variables, known)
    gains = _Gains(problem, watch, loosely=known is not None)
    result = _solved(problem, np.zeros(variables.size), gains)
    iterations, first = result.iterations, gains.first
    if not (gains.exhausted or gains.stopped or result.success):
        # Derivatives that were carried on may be what leads no further.
        problem.carries = False
        gains = _Gains(problem, watch)
        result = _solved(problem, result.x, gains)
        iterations += result.iterations
    converged = gains.exhausted or result.success
    return Minimum(variables, result.x, first, result.objective, iterations, converged)


def _solved(problem: Problem, start: FloatArray, gains: _Gains) -> Result:
    # However many runs there are: the interior point asks for three times the emulations, and a
    # barrier leads figures away from where they are nearly right.
    result: Result = solve(
        problem.nlp(),
        start,
        method=SolverMethod.SQP,
        tolerance=TOLERANCE,
        max_iterations=MOST_ITERATIONS,
        callback=gains,
    )
    if result.status is Status.CALLABLE_ERROR:
        raise InputError(f"the fit cannot begin: {result.message}")
    return result


class _Gains:
    """Ends a solution that gains nothing any more, with a Jacobian that was evaluated, unless
    `loosely`."""

    def __init__(self, problem: Problem, watch: Watch | None, loosely: bool = False) -> None:
        self.first = np.inf
        self.exhausted = self.stopped = False
        self._problem = problem
        self._carries = problem.carries
        self._watch = watch
        self._last = np.inf
        self._small = 0
        self._loosely = loosely
        self._exact = self._led = True

    def __call__(self, iteration: Iteration) -> bool:
        if iteration.number == 0:
            self.first = iteration.objective
        elif self._last - iteration.objective < LEAST_GAIN * iteration.objective:
            self._small += 1
            self._exact |= self._led
        else:
            self._small, self._exact = 0, self._loosely
        self._last = iteration.objective
        self._led = self._problem.exact
        self.exhausted = self._small >= 2 and self._exact
        self._problem.carries = self._carries and (self._exact or not self._small)
        self.stopped = bool(self._watch(iteration)) if self._watch is not None else False
        return self.exhausted or self.stopped
