"""How hard a fit is held to the figures before it, as runs held back ask for.

A few runs do not show every figure of a motion model, and what they do not show must not follow
what the model gets wrong in them. So runs that the model before explains worse than most of them
count less (`evened`), and leaving what was before costs something
(`ParameterSet.hold`): little where runs are many or the robot differs, much where they are few and
it does not. Of several costs that one is taken with which runs held back are predicted best.
Whether they are predicted better than by the model before the fit is what the judgement says.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.motion.model.motion_model import MotionModel
from .fitting import Fit, fit, fit_with
from .judgement import FEWEST, NOTHING, Judgement, is_gain, judge
from .minimum import Watch, minimise
from .parameters import ParameterSet
from .problem import first_nuisances
from .run_pool import RunPool
from .runs import PreparedRun
from .selection import losses_of

HOLDS = (1.0, 0.1, 1e-2, 1e-3, 0.0)
"""What it costs to leave what was before, in shares of the loss before the fit, most first."""
FIRST = 1e-3
"""Of them, with which clocks are told from figures, and where nothing can be held back."""
PATIENCE = 2
"""Holds in a row that predict no better than the best, after which weaker ones are not tried where
whole runs judge."""


@dataclass(frozen=True, eq=False)
class HeldFit:
    """A fit, and how it predicts runs that were held back.

    Args:
        fit: to all runs.
        judgement: None where there is nothing to hold back.
        share: what it cost to leave what was before, in shares of the loss before.
    """

    fit: Fit
    judgement: Judgement | None
    share: float


def fit_held(
    parameters: ParameterSet,
    runs: Sequence[PreparedRun],
    workers: int = 1,
    watch: Watch | None = None,
    tell: Callable[[str], None] | None = None,
) -> HeldFit:
    """Fit parameters to runs, as near to what was before as runs held back ask for.

    Of all holds that may be handed out, or of all if none may, the strongest is taken than which
    the best is not clearly better. As the runs that choose it judge it, too, the judgement is a
    little too good.

    Args:
        parameters: to be fitted.
        runs: of one robot.
        workers: processes.
        watch: called after each iteration; True ends the fit.
        tell: called with how far the work is.

    Raises:
        InputError: as `fit` does.
    """
    runs, first = evened(parameters.base, runs, workers)
    found = fit(replace(parameters, hold=FIRST * first), runs, workers, watch)
    lonely = HeldFit(found, None, FIRST)
    judged: list[tuple[HeldFit, Judgement]] = []
    patience = PATIENCE if len(runs) >= FEWEST else len(HOLDS)
    with RunPool(found.runs, workers) as pool:
        for share in HOLDS:
            held = replace(found.parameters, hold=share * found.before)
            found = replace(fit_with(pool, held, watch, found), unseen=found.unseen)
            judgement = judge(found, workers, tell)
            if judgement is None:
                return lonely
            judged.append((HeldFit(found, judgement, share), judgement))
            gains = [one.gains.mean() for _, one in judged]
            if len(gains) - 1 - int(np.argmax(gains)) >= patience:
                break
    return chosen(judged)


def chosen(judged: Sequence[tuple[HeldFit, Judgement]]) -> HeldFit:
    """The fit, of several from the strongest hold to the weakest, that is handed out.

    A weaker hold may gain more in most runs and still lose too much in one, which a stronger one
    does not.
    """
    judged = [(made, one) for made, one in judged if one.better] or judged
    best = max((one.gains for _, one in judged), key=np.mean)
    return next(made for made, one in judged if not is_gain(best - one.gains))


def evened(
    model: MotionModel, runs: Sequence[PreparedRun], workers: int = 1
) -> tuple[list[PreparedRun], float]:
    """Runs that a model explains worse than most of them count less, so that what it has no
    figures for in some does not lead all others astray; and the mean loss that is left.

    Args:
        model: before the fit.
        runs: of one robot.
        workers: processes.

    Raises:
        InputError: a program cannot be driven.
    """
    with RunPool(runs, workers) as pool:
        alone = minimise(pool, ParameterSet(model, ()), first_nuisances(runs))
        whole, _ = losses_of(runs, pool.residuals(model, alone.nuisances))
    usual = max(float(np.median(whole)), NOTHING)
    share = [max(1.0, one / usual) for one in whole]
    made = [
        replace(run, weight=run.weight / np.sqrt(s)) for run, s in zip(runs, share, strict=True)
    ]
    with RunPool(made, workers) as pool:
        whole, _ = losses_of(made, pool.residuals(model, alone.nuisances))
    return made, float(np.mean(whole))
