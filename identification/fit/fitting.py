"""Fits a motion model to logged runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.motion.model import MotionModel
from ...core.sqp import Iteration, Result, Status, solve
from .crew import Crew
from .emulation import Nuisance
from .intervals import Interval, Unseen, clusters_of, intervals, loose, unseen
from .parameters import ParameterSet
from .problem import Problem, Variables, first_nuisances
from .runs import PreparedRun

FloatArray = NDArray[np.float64]
Watch = Callable[[Iteration], bool | None]

LEAST_GAIN = 1e-4
"""Share of the robust sum that an iteration must gain, or the next one, for the fit to go on."""
MOST_ITERATIONS = 40
TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Fit:
    """What came of a fit.

    Args:
        parameters: that were fitted, with their starts.
        values: (P,) of them.
        runs: all that took part.
        nuisances: of each run.
        intervals: of each parameter.
        unseen: what was to be fitted and is not shown by the logs; it stays at its start.
        before, after: mean robust loss per residual.
        iterations: of all solutions.
        converged: whether the last one went as far as it could.
    """

    parameters: ParameterSet
    values: FloatArray
    runs: tuple[PreparedRun, ...]
    nuisances: tuple[Nuisance, ...]
    intervals: tuple[Interval, ...]
    unseen: tuple[Unseen, ...]
    before: float
    after: float
    iterations: int
    converged: bool

    @property
    def model(self) -> MotionModel:
        """The fitted one."""
        return self.parameters.model(self.values)


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


def fit(
    parameters: ParameterSet,
    runs: Sequence[PreparedRun],
    workers: int = 1,
    watch: Watch | None = None,
) -> Fit:
    """Fit parameters to runs, all in one problem.

    Parameters that the logs do not show are left at their start, and named.

    Args:
        parameters: to be fitted.
        runs: of one robot.
        workers: processes.
        watch: is told of each iteration; True ends the fit.

    Raises:
        InputError: there is nothing to fit or to fit to, or a program cannot be driven at the
            start.
    """
    if not runs:
        raise InputError("there is no run to fit to")
    if not parameters.size:
        raise InputError("there is nothing to fit: name parameters")
    with Crew(runs, workers) as crew:
        return fit_with(crew, parameters, watch)


def fit_with(crew: Crew, parameters: ParameterSet, watch: Watch | None = None) -> Fit:
    """See `fit`; the crew knows the runs."""
    kept, nuisances = parameters, first_nuisances(crew.runs)
    lost: list[Unseen] = []
    iterations, first = 0, None
    while True:
        found = _seen_at(crew, kept, nuisances)
        if found:
            kept = _left(kept, found, lost)
            continue
        end = minimise(crew, kept, nuisances, watch)
        iterations += end.iterations
        first = end.first if first is None else first
        linearised = Problem(crew, end.variables).linearised(end.x)
        known = intervals(kept, end.values, clusters_of(crew.runs, linearised))
        found = unseen(kept, crew.runs, linearised) or loose(kept, known)
        if not found or not end.converged:
            break
        kept = _left(kept.starting_at(end.values), found, lost)
        nuisances = end.nuisances
    return Fit(
        parameters.holding(one.name for one in lost),
        end.values,
        crew.runs,
        end.nuisances,
        tuple(known),
        tuple(lost),
        first,
        end.last,
        iterations,
        end.converged,
    )


def _left(parameters: ParameterSet, found: Sequence[Unseen], lost: list[Unseen]) -> ParameterSet:
    """The parameters without those found to be unseen, which are added to the lost ones.

    Raises:
        InputError: none is left.
    """
    lost += found
    kept = parameters.holding(one.name for one in found)
    if not kept.size:
        reasons = "; ".join(f"{one.name}: {one.reason}" for one in lost)
        raise InputError(f"the logs show none of the parameters: {reasons}")
    return kept


def minimise(
    crew: Crew,
    parameters: ParameterSet,
    nuisances: Sequence[Nuisance],
    watch: Watch | None = None,
) -> Minimum:
    """Find the parameters and nuisances with the least robust sum.

    Raises:
        InputError: a program cannot be driven at the start.
    """
    variables = Variables.of(parameters, crew.runs, nuisances)
    if variables.size == 0:
        rest = Problem(crew, variables).residuals(np.zeros(0))
        whole = 0.5 * float(rest @ rest)
        return Minimum(variables, np.zeros(0), whole, whole, 0, True)
    gains = _Gains(watch)
    result: Result = solve(
        Problem(crew, variables).nlp(),
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


def _seen_at(crew: Crew, parameters: ParameterSet, nuisances: Sequence[Nuisance]) -> list[Unseen]:
    variables = Variables.of(parameters, crew.runs, nuisances)
    linearised = Problem(crew, variables).linearised(np.zeros(variables.size))
    return unseen(parameters, crew.runs, linearised)


__all__ = ["Fit", "Minimum", "fit", "fit_with", "minimise"]
