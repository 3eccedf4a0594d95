"""Whether a fitted model predicts better than the one before it: runs held back judge.

With three runs and more they are held back in turns, each predicted by a fit to the others. With
one or two it is every other corner: that says nothing of other speeds, zones and places. Both
models have what runs have of their own (offsets, sizes of zones that nobody recorded) fitted to
what they predict.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import FloatArray
from .fitting import Fit
from .minimum import minimise
from .parameters import ParameterSet
from .run_pool import RunPool
from .runs import PreparedRun
from .selection import TRAITS, LeftOut, leave_out, losses_of

FOLDS = 5
FEWEST = 3
"""Runs that can be held back whole."""
SLACK, PATH_SLACK = 0.01, 0.1
"""Share of the loss that is no difference, of all and of the TCP's path, which fewer tell of."""
SURE = 0.9
"""Probability with which a gain of runs held back is one of others, too."""
NOTHING = 1e-3
"""Loss that nobody minds: that of places off by less than half a micrometre."""


@dataclass(frozen=True)
class Judgement:
    """How a fit predicts what it was not fitted to, beside the model before the fit.

    Args:
        names: of the runs.
        before, after: mean robust loss per residual of each run.
        path_before, path_after: the same over what shows the TCP's path.
        by_corners: whether corners were held back, not runs.
        helpful: what further runs would tell more, in words.
    """

    names: tuple[str, ...]
    before: tuple[float, ...]
    after: tuple[float, ...]
    path_before: tuple[float, ...]
    path_after: tuple[float, ...]
    by_corners: bool
    helpful: tuple[str, ...] = ()

    @property
    def better(self) -> bool:
        """Whether the fitted model may take the place of the other."""
        no_worse = _no_worse(self.before, self.after, SLACK) and _no_worse(
            self.path_before, self.path_after, PATH_SLACK
        )
        small = float(np.mean(self.after)) <= NOTHING
        return no_worse and (small or is_gain(self.gains))

    @property
    def gains(self) -> FloatArray:
        """What each run gains, whole and path alike: the logarithm of its loss before over that
        after. A run that is predicted badly by both models counts no more than others."""
        pairs = ((self.before, self.after), (self.path_before, self.path_after))
        each = [np.log((np.array(b) + NOTHING) / (np.array(a) + NOTHING)) for b, a in pairs]
        return np.asarray(np.mean(each, axis=0))

    @property
    def worse(self) -> tuple[str, ...]:
        """Runs that the fitted model predicts worse."""
        rows = zip(
            self.names, self.before, self.after, self.path_before, self.path_after, strict=True
        )
        worse = (
            name
            for name, b, a, pb, pa in rows
            if not (_no_worse([b], [a], SLACK) and _no_worse([pb], [pa], PATH_SLACK))
        )
        return tuple(dict.fromkeys(worse))

    @property
    def verdict(self) -> str:
        """How the fitted model predicts, beside the one before it."""
        if self.better:
            return "predicts better than"
        lost = self.worse or self.gains.mean() <= 0.0
        return "predicts worse than" if lost else "is not sure to predict better than"

    @property
    def told(self) -> str:
        """In a sentence."""
        held = "every other corner held back is" if self.by_corners else "runs held back are"
        return (
            f"{held} predicted with a loss of {np.mean(self.before):.4g} → "
            f"{np.mean(self.after):.4g}, on the TCP's path alone {np.mean(self.path_before):.4g} → "
            f"{np.mean(self.path_after):.4g}"
        )


def _no_worse(before: Sequence[float], after: Sequence[float], slack: float) -> bool:
    return float(np.mean(after)) <= (1.0 + slack) * float(np.mean(before)) + NOTHING


def is_gain(gains: FloatArray) -> bool:
    """Whether gains of runs are more than chance: beyond their standard error times Student's t for
    `SURE`; of two halves of a run, which say nothing of chance, whether they are any."""
    from scipy.stats import t as student

    if len(gains) < FEWEST:
        return bool(gains.mean() > 0.0)
    error = float(gains.std(ddof=1)) / np.sqrt(len(gains))
    return bool(gains.mean() > student.ppf(SURE, len(gains) - 1) * error)


def judge(
    fitted: Fit, workers: int = 1, tell: Callable[[str], None] | None = None
) -> Judgement | None:
    """Predict each run, or corner, by a fit to others; None where there is nothing to hold back.

    Args:
        fitted: the fit.
        workers: processes.
        tell: called with how far the work is.

    Raises:
        InputError: a program cannot be driven.
    """
    near = fitted.parameters.starting_at(fitted.values)
    if len(fitted.runs) < FEWEST:
        return _by_corners(fitted, near, workers)
    folds = min(len(fitted.runs), FOLDS)
    groups = [tuple(range(k, len(fitted.runs), folds)) for k in range(folds)]
    made = leave_out(fitted.runs, fitted.nuisances, near, groups, workers, tell, fitted.rows)
    return _judged(fitted, list(fitted.runs), made, False)


def _by_corners(fitted: Fit, near: ParameterSet, workers: int) -> Judgement | None:
    runs: list[PreparedRun] = []
    made: list[LeftOut] = []
    for half in (0, 1):
        masks = [run.cluster % 2 == half for run in fitted.runs]
        if not all(mask.any() and not mask.all() for mask in masks):
            return None
        taught = [run.only(mask) for run, mask in zip(fitted.runs, masks, strict=True)]
        held = [run.only(~mask) for run, mask in zip(fitted.runs, masks, strict=True)]
        with RunPool(taught, workers) as pool:
            rows = [one.only(mask) for one, mask in zip(fitted.rows, masks, strict=True)]
            end = minimise(pool, near, fitted.nuisances, known=rows or None)
        indices = tuple(range(len(runs), len(runs) + len(held)))
        runs += held
        made.append(LeftOut.of(held, indices, fitted.nuisances, near, end))
    return _judged(fitted, runs, made, True)


def _judged(
    fitted: Fit, runs: Sequence[PreparedRun], made: Sequence[LeftOut], by_corners: bool
) -> Judgement:
    """What left-out runs say, beside the model before the fit."""
    base = ParameterSet(fitted.parameters.base, ())
    own = [fitted.nuisances[k % len(fitted.nuisances)] for k in range(len(runs))]
    with RunPool(runs, 1) as pool:
        first = minimise(pool, base, own)
        before, path_before = losses_of(runs, pool.residuals(base.base, first.nuisances))
    after, path_after = np.empty(len(runs)), np.empty(len(runs))
    for one in made:
        after[list(one.indices)] = one.loss
        path_after[list(one.indices)] = one.path
    found = Judgement(
        tuple(run.name for run in runs),
        before,
        tuple(map(float, after)),
        path_before,
        tuple(map(float, path_after)),
        by_corners,
    )
    return replace(found, helpful=_helpful(fitted.runs, found.worse))


def _helpful(runs: Sequence[PreparedRun], worse: Sequence[str]) -> tuple[str, ...]:
    """Kinds of runs of which there are too few to hold one back."""
    if len(runs) < FEWEST:
        return ("runs of other speeds, zones, kinds of moves and places",)
    found: dict[str, None] = {}
    for run in runs:
        if run.name not in worse:
            continue
        alone = [
            trait
            for trait, of in TRAITS.items()
            if trait != "run" and sum(of(other) == of(run) for other in runs) == 1
        ]
        what = (
            f"with the {' and '.join(alone)}" if alone else "of other speeds and places than those"
        )
        found[f"runs {what} of {run.name}"] = None
    return tuple(found) or ("more runs of these kinds",)
