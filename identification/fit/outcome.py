"""Each run of a fit, before and after it: what tables and reports show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...core.motion.model.motion_model import MotionModel
from ..prediction import Prediction, predict
from .emulation import Nuisance
from .fitting import Fit
from .runs import PreparedRun


@dataclass(frozen=True, eq=False)
class Outcome:
    """One run.

    Args:
        run: as the fit saw it.
        nuisance: of the run, fitted; its clock has been taken off the logs below.
        before, after: the log beside the emulation with the models before and after the fit.
    """

    run: PreparedRun
    nuisance: Nuisance
    before: Prediction
    after: Prediction


def outcomes(fitted: Fit, start: MotionModel | None = None) -> list[Outcome]:
    """All runs of a fit.

    Args:
        fitted: the fit.
        start: the model to compare with; None for the one before the fit.

    Raises:
        FlybyError: a run cannot be emulated with one of the models.
    """
    first = fitted.parameters.base if start is None else start
    return [
        Outcome(run, own, predicted(run, first, own), predicted(run, fitted.model, own))
        for run, own in zip(fitted.runs, fitted.nuisances, strict=True)
    ]


def predicted(run: PreparedRun, model: MotionModel, nuisance: Nuisance) -> Prediction:
    """A run's log, its clock put right, beside what a model makes of its program."""
    return predict(
        run.controller(model),
        run.name,
        run.program(nuisance.size),
        run.corrected(nuisance.clock),
        override=nuisance.override,
    )


def worst(outcomes: Sequence[Outcome]) -> Outcome:
    """The run whose path is off the most."""
    return max(outcomes, key=lambda one: one.after.figures.path_max)
