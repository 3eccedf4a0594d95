"""Velocity tuning: how fast a path whose geometry is fixed is best passed."""

from .cones import TuningError
from .drives import JointDrive, TorqueCurve, drives_of
from .path import FixedPath, Rigid
from .result import Tuned, Way
from .task import TuningObjective, TuningTask
from .tune import tune, tune_by_cones, tune_by_sweeps, tune_in_sequence

__all__ = [
    "FixedPath",
    "JointDrive",
    "Rigid",
    "TorqueCurve",
    "Tuned",
    "TuningError",
    "TuningObjective",
    "TuningTask",
    "Way",
    "drives_of",
    "tune",
    "tune_by_cones",
    "tune_by_sweeps",
    "tune_in_sequence",
]
