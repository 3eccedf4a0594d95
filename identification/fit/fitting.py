"""Fits a motion model to logged runs.

A parameter that the logs do not show stays as it was before the fit, and all others are fitted with
it there: what is handed out is what was fitted. Whether a figure may be left alone the loss without
it says, not its interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import FlybyError, InputError
from ...core.motion.model.motion_model import MotionModel
from ...core.motion.model.rules import ArcTurn
from .balanced_gears import begun_again
from .clocks import timed, told
from .emulation import Nuisance, Rows
from .intervals import SEEN, Interval, Unseen, clusters_of, intervals, loose, unseen
from .minimum import Minimum, Watch, minimise
from .parameters import ParameterSet
from .problem import Problem, Variables, first_nuisances
from .run_pool import RunPool
from .runs import PreparedRun, shown_turn

HALVINGS = 12
WORTH = 0.01
"""Share of the loss that a figure must be worth for the fit not to do without it."""


@dataclass(frozen=True, eq=False)
class Fit:
    """What came of a fit.

    Args:
        parameters: that were fitted, with their starts, on top of the model before the fit.
        values: (P,) of them.
        runs: all that took part.
        nuisances: of each run.
        intervals: of each parameter.
        unseen: what was to be fitted and is not shown by the logs; it stays as it was.
        before, after: mean robust loss per residual, of the model before the fit and of the
            fitted one; each with the runs' own that fits it best.
        iterations: of all solutions.
        converged: whether the last one went as far as it could.
        rough: parameters whose intervals say nothing, and that the logs are not explained without.
        rows: residuals of the runs and their derivatives, by the fitted parameters among others.
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
    rough: tuple[Unseen, ...] = ()
    rows: tuple[Rows, ...] = field(default=(), repr=False)

    @property
    def model(self) -> MotionModel:
        """The fitted one; along arcs the tool turns as most logs show."""
        made = self.parameters.model(self.values)
        return replace(made, arc_turn=self.turn or made.arc_turn)

    @property
    def scales(self) -> list[tuple[str, str]]:
        """Names of runs whose clock or speed override was fitted too, and what it is, in words."""
        return told(self.runs, self.nuisances)

    @property
    def turn(self) -> ArcTurn | None:
        """How the logs show that the tool turns along arcs; None if they do not."""
        return shown_turn(self.runs)


def fit(
    parameters: ParameterSet,
    runs: Sequence[PreparedRun],
    workers: int = 1,
    watch: Watch | None = None,
) -> Fit:
    """Fit parameters to runs, all in one problem.

    Parameters that the logs do not show are left as they were, and named.

    Args:
        parameters: to be fitted.
        runs: of one robot.
        workers: processes.
        watch: called after each iteration; True ends the fit.

    Raises:
        InputError: there is nothing to fit or to fit to, or a program cannot be driven at the
            start.
    """
    if not runs:
        raise InputError("there is no run to fit to")
    if not parameters.size:
        raise InputError("there is nothing to fit: name parameters")
    try:
        with RunPool(runs, workers) as pool:
            found = fit_with(pool, parameters, watch)
        made = timed(parameters, runs, found.after, workers)
        if made is None:
            return found
        with RunPool(made, workers) as pool:
            return fit_with(pool, parameters, watch)
    except NothingShown as error:
        scales = [
            f"{run.name}: {run.scale.told}; "
            for run in runs
            if run.scale is not None and run.scale.alone
        ]
        raise InputError("".join([*scales, str(error)])) from error


class NothingShown(InputError):
    """The logs show none of the parameters."""


def fit_with(
    pool: RunPool, parameters: ParameterSet, watch: Watch | None = None, near: Fit | None = None
) -> Fit:
    """See `fit`.

    Args:
        pool: knows the runs.
        parameters: to be fitted.
        watch: called after each iteration.
        near: a fit of these parameters to the same runs, held otherwise, to begin at.
    """
    lost: list[Unseen] = []
    rough: set[str] = set()
    kept = parameters
    if near is None:
        first = minimise(pool, ParameterSet(parameters.base, ()), first_nuisances(pool.runs))
        before = first.last
        while found := _seen_at(pool, kept, first.nuisances):
            kept = _without(kept, found, lost)
        end = begun_again(pool, kept, minimise(pool, kept, first.nuisances, watch), watch)
    else:
        before, begin = near.before, kept.starting_at(near.values)
        end = minimise(pool, begin, near.nuisances, watch, near.rows)
    iterations = end.iterations
    if near is None and end.last > before:
        # A start that leads astray: what was before is better, and a start as well.
        other = minimise(pool, kept.starting_at(kept.before), first.nuisances, watch)
        iterations += other.iterations
        end = min(end, other, key=lambda one: one.last)
    while True:
        linearised = Problem(pool, end.variables).linearised(end.x)
        samples = sum(rows.values.size for rows, _ in linearised)
        known = intervals(kept, end.values, clusters_of(pool.runs, linearised), samples)
        # What runs show was found out by the fit near by.
        found = unseen(kept, pool.runs, linearised) or loose(kept, known) if near is None else []
        doubted = [one for one in found if one.name not in rough]
        if not doubted or not end.converged:
            break
        made = _spared(pool, kept, end, doubted, watch)
        if made is None and len(doubted) > 1:
            doubted = doubted[:1]
            made = _spared(pool, kept, end, doubted, watch)
        if made is None:
            rough.add(doubted[0].name)
            end = _drawn_back(pool, kept, end, doubted[0].name, linearised)
            continue
        kept, end = _without(kept, doubted, lost), made
        iterations += made.iterations
    return Fit(
        kept,
        end.values,
        pool.runs,
        end.nuisances,
        tuple(known),
        tuple(lost),
        before,
        end.rest,
        iterations,
        end.converged,
        tuple(one for one in found if one.name in rough),
        tuple(rows for rows, _ in linearised),
    )


def _drawn_back(
    pool: RunPool,
    parameters: ParameterSet,
    end: Minimum,
    name: str,
    linearised: Sequence[tuple[Rows, FloatArray]],
) -> Minimum:
    """A fit with a parameter that nothing changes with any more, such as a limit that is reached
    nowhere, as near to what it was before as the logs allow."""
    k = [one.name for one in parameters.parameters].index(name)
    if max(float(np.abs(J[..., k]).max()) for _, J in linearised) >= SEEN:
        return end
    problem, near = Problem(pool, end.variables), end.variables.parameters
    before = (parameters.before[k] - near.start[k]) / near.scale[k]
    allowed, refused = end.x.copy(), before
    for _ in range(HALVINGS):
        x = allowed.copy()
        x[k] = 0.5 * (allowed[k] + refused)
        rest = problem.residuals(x)
        if 0.5 * float(rest @ rest) <= (1.0 + 0.1 * WORTH) * end.last:
            allowed = x
        else:
            refused = x[k]
    rest = problem.residuals(allowed)
    return replace(end, x=allowed, last=0.5 * float(rest @ rest))


def _without(parameters: ParameterSet, found: Sequence[Unseen], lost: list[Unseen]) -> ParameterSet:
    """The parameters without those found to be unseen, which are added to the lost ones.

    Raises:
        InputError: none is left.
    """
    lost += found
    kept = parameters.without(one.name for one in found)
    if not kept.size:
        reasons = "; ".join(f"{one.name}: {one.reason}" for one in lost)
        raise NothingShown(f"the logs show none of the parameters: {reasons}")
    return kept


def _spared(
    pool: RunPool,
    parameters: ParameterSet,
    end: Minimum,
    doubted: Sequence[Unseen],
    watch: Watch | None,
) -> Minimum | None:
    """The fit without some parameters, which stay as they were before; None where the logs are
    explained worse without them."""
    near = parameters.starting_at(end.values).without(one.name for one in doubted)
    try:
        made = minimise(pool, near, end.nuisances, watch)
    except FlybyError:
        return None
    return made if made.last <= (1.0 + WORTH) * end.last else None


def _seen_at(
    pool: RunPool, parameters: ParameterSet, nuisances: Sequence[Nuisance]
) -> list[Unseen]:
    variables = Variables.of(parameters, pool.runs, nuisances)
    linearised = Problem(pool, variables).linearised(np.zeros(variables.size))
    return unseen(parameters, pool.runs, linearised)
