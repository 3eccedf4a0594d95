"""Fits motion models to logged runs: alignment in time, parameters, intervals, model comparison."""

from .file import motion_file
from .fitting import Fit, fit
from .holding import HeldFit, fit_held
from .intervals import Interval, Unseen
from .judgement import Judgement, judge
from .layers import fit_usual, servo_parameters
from .outcome import Outcome, outcomes
from .parameters import FittedParameter, ParameterSet, usual_parameters
from .runs import PreparedRun, prepare

__all__ = [
    "Fit",
    "FittedParameter",
    "HeldFit",
    "Interval",
    "Judgement",
    "Outcome",
    "ParameterSet",
    "PreparedRun",
    "Unseen",
    "fit",
    "fit_held",
    "fit_usual",
    "judge",
    "motion_file",
    "outcomes",
    "prepare",
    "servo_parameters",
    "usual_parameters",
]
