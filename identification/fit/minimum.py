"""Minimises the robust sum of all runs over parameters and what runs have of their own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.sqp import Iteration, Result, Status, solve
from .emulation import Nuisance
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
        first, last: the robust sum at start and end, per residual.
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
    def nuisances(self) -> tuple[Nuisance, ...]:
        """Of each run."""
        return self.variables.nuisances(self.x)


def minimise(
    pool: RunPool,
    parameters: ParameterSet,
    nuisances: Sequence[Nuisance],
    watch: Watch | None = None,
) -> Minimum:
    """Find the parameters and nuisances with the least robust sum.

    Raises:
        InputError: a program cannot be driven at the start.
    """
    variables = Variables.of(parameters, pool.runs, nuisances)
    if variables.size == 0:
        rest = Problem(pool, variables).residuals(np.zeros(0))
        whole = 0.5 * float(rest @ rest)
        return Minimum(variables, np.zeros(0), whole, whole, 0, True)
    gains = _Gains(watch)
    result: Result = solve(
        Problem(pool, variables).nlp(),
        np.zeros(variables.size),
        tolerance=TOLERANCE,
        max_iterations=MOST_ITERATIONS,
        callback=gains,
    )
    if result.status is Status.CALLABLE_ERROR:
        raise InputError(f"the fit cannot begin: {result.message}")
    converged = gains.exhausted or result.success
    return Minimum(variables, result.x, gains.first, result.objective, result.iterations, converged)


class _Gains:
    """Ends a solution that gains nothing any more."""

    def __init__(self, watch: Watch | None) -> None:
        self.first = np.inf
        self.exhausted = False
        self._watch = watch
        self._last = np.inf
        self._small = 0

    def __call__(self, iteration: Iteration) -> bool:
        if iteration.number == 0:
            self.first = iteration.objective
        elif self._last - iteration.objective < LEAST_GAIN * iteration.objective:
            self._small += 1
        else:
            self._small = 0
        self._last = iteration.objective
        self.exhausted = self._small >= 2
        wanted = self._watch(iteration) if self._watch is not None else False
        return self.exhausted or bool(wanted)
