"""Fits motion models to logged runs: alignment in time, parameters, intervals, model comparison."""

from .file import motion_file
from .fitting import Fit, fit
from .intervals import Interval, Unseen
from .outcome import Outcome, outcomes
from .parameters import Parameter, ParameterSet, usual_parameters
from .runs import PreparedRun, prepare

__all__ = [
    "Fit",
    "Interval",
    "Outcome",
    "Parameter",
    "ParameterSet",
    "PreparedRun",
    "Unseen",
    "fit",
    "motion_file",
    "outcomes",
    "prepare",
    "usual_parameters",
]
