"""Reads a log whatever its form."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.files.reading import settle
from ...core.plugins.parts import LogForm
from ...core.registry import installed
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
    other = None if columns is not None else _of_a_plugin(path)
    if other is not None:
        return _checked(other.read(path, robot), other, path)
    text = read_text(path)
    if columns is not None:
        return columns.samples(parse_table(text, str(path), columns.delimiter))
    if is_rsi(text):
        return parse_rsi(text, str(path), robot)
    table = parse_table(text, str(path))
    return recognise(table.names, robot, str(path)).samples(table)


def _of_a_plugin(path: Path) -> LogForm | None:
    """The form that a plugin knows a file by; None for one of flyby's own.

    Raises:
        InputError: several plugins take it.
    """
    settle(path)
    found = [form for form in installed().offers.logs.values() if form.recognises(path)]
    if len(found) > 1:
        names = " and ".join(form.name for form in found)
        raise InputError(f"{path}: {names} both take it for theirs: uninstall one of these plugins")
    return found[0] if found else None


def _checked(samples: object, form: LogForm, path: Path) -> LogSamples:
    """What a plugin has read, if it is what it should be.

    Raises:
        InputError: it is not; the plugin is at fault.
    """
    fault = f"{path}: the plugin that reads {form.name} logs is at fault"
    if not isinstance(samples, LogSamples):
        raise InputError(f"{fault}: it gives no LogSamples, but {type(samples).__name__}")
    t, q = samples.t, samples.q
    if t.ndim != 1 or q.ndim != 2 or len(t) != len(q) or len(t) < 2:
        raise InputError(f"{fault}: t has the shape {t.shape} and q {q.shape}, not (T,) and (T, N)")
    if not (np.isfinite(t).all() and np.isfinite(q).all() and (np.diff(t) > 0).all()):
        raise InputError(f"{fault}: times increase, and all numbers are finite")
    return samples
