"""Reads a log whatever its form."""

from __future__ import annotations

from pathlib import Path

from ...core.errors import InputError
from ...core.robot.model import Robot
from .columns import Columns
from .formats import recognise
from .rsi import is_rsi, parse_rsi
from .samples import LogSamples
from .table import parse_table
from .text import read_text


def read_samples(path: Path, robot: Robot, columns: Columns | None = None) -> LogSamples:
    """The samples of a log.

    Args:
        path: a file in one of the forms of `flyby.identification.logs.formats`, or frames of RSI.
        robot: whose log it is.
        columns: where time and joints stand; None for a known form.

    Raises:
        InputError: naming file and line, or what does not fit the robot.
    """
    samples = _read(path, robot, columns)
    count = samples.q.shape[1]
    if count != robot.size:
        raise InputError(
            f"{path}: {count} joints are logged, but {robot.name} has {robot.size} axes "
            f"({', '.join(robot.axis_names)}): wrong robot, or columns are missing"
        )
    return samples


def _read(path: Path, robot: Robot, columns: Columns | None) -> LogSamples:
    text = read_text(path)
    if columns is not None:
        return columns.samples(parse_table(text, str(path), columns.delimiter))
    if is_rsi(text):
        return parse_rsi(text, str(path), robot)
    table = parse_table(text, str(path))
    return recognise(table.names, robot, str(path)).samples(table)
