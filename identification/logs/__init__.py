"""Logs of controllers: files in many forms become times and joints in SI units."""

from .cleaning import CleanLog, Hole, clean
from .columns import Columns, load_columns
from .reading import read_samples
from .records import load_run
from .run import LoggedRun
from .samples import LogSamples

__all__ = [
    "CleanLog",
    "Columns",
    "Hole",
    "LogSamples",
    "LoggedRun",
    "clean",
    "load_columns",
    "load_run",
    "read_samples",
]
