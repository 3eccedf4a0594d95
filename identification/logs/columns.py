"""Which columns of a log are time and joints, and in which units: a small TOML file says so.

    delimiter = ";"                                    # found by itself if left out
    time = { column = "stamp", unit = "ms" }           # without stamps: { period = 4, unit = "ms" }
    joints = { columns = ["J1", "J2", "J3", "J4", "J5", "J6"], unit = "deg" }
    external = { columns = ["E1"], unit = "mm" }       # if the robot has external axes

A column is its name or, as in a file without a header, its number from 1.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...core.files.reading import read_toml
from .samples import LogSamples, in_order
from .table import Table

TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
AXIS_UNITS = {"rad": 1.0, "deg": math.pi / 180, "m": 1.0, "mm": 1e-3}
_KEYS = {
    "delimiter": None,
    "time": {"column", "period", "unit"},
    "joints": {"columns", "unit"},
    "external": {"columns", "unit"},
}


@dataclass(frozen=True)
class Columns:
    """Time and joints among the columns of a table.

    Args:
        axes: column of each axis, joints first.
        scales: rad or m in one of the unit of each axis.
        time: column of time; None if samples come every ``period``.
        time_scale: s in one of time's unit.
        period: s, if there is no column of time.
        delimiter: between cells; None to find it.
    """

    axes: tuple[str | int, ...]
    scales: tuple[float, ...]
    time: str | int | None
    time_scale: float = 1.0
    period: float = 0.0
    delimiter: str | None = None

    def __post_init__(self) -> None:
        if not self.axes:
            raise InputError("no column of joints is named")
        if len(self.axes) != len(self.scales):
            raise InputError(f"{len(self.axes)} axes with {len(self.scales)} units")
        if self.time is None and not 0 < self.period < math.inf:
            raise InputError("without a column of time the period must be above zero")

    def samples(self, table: Table) -> LogSamples:
        """The samples of a table.

        Raises:
            InputError: naming file, line and column.
        """
        wanted = self.axes if self.time is None else (self.time, *self.axes)
        if not table.rows:
            raise InputError(f"{table.file}: a log needs at least two samples")
        values = table.numbers(wanted)
        q = np.asarray(values[:, -len(self.axes) :] * np.array(self.scales), dtype=float)
        if self.time is None:
            t = self.period * np.arange(len(q), dtype=float)
        else:
            # Stamps since 1970 lose digits in products; their first is as good a zero.
            t = np.asarray(values[:, 0] - values[0, 0], dtype=float) * self.time_scale
        return in_order(t, q, table.lines, table.file, table.notes)


def load_columns(path: Path) -> Columns:
    """Columns as a TOML file names them.

    Raises:
        InputError: naming file and key.
    """
    data = read_toml(path)
    try:
        return _columns(data)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _columns(data: Mapping[str, Any]) -> Columns:
    for key, value in data.items():
        if key not in _KEYS:
            raise InputError(f"unknown key {key!r}; known: {', '.join(_KEYS)}")
        known = _KEYS[key]
        if known is None:
            continue
        if not isinstance(value, dict) or not value.keys() <= known:
            raise InputError(f"{key} must be a table with keys of {', '.join(sorted(known))}")
    for key in ("time", "joints"):
        if key not in data:
            raise InputError(f"{key} is missing")
    delimiter = data.get("delimiter")
    if delimiter is not None and not (isinstance(delimiter, str) and len(delimiter) == 1):
        raise InputError("delimiter must be one character")
    axes, scales = _axes(data, "joints", "rad")
    more, further = _axes(data, "external", "m") if "external" in data else ((), ())
    time = data["time"]
    factor = _unit(time, TIME_UNITS, "time", "s")
    if ("column" in time) == ("period" in time):
        raise InputError("time needs either a column or a period")
    if "period" in time:
        period = time["period"]
        if isinstance(period, bool) or not isinstance(period, int | float):
            raise InputError("time.period must be a number")
        column, period = None, factor * period
    else:
        column, period = _column(time["column"], "time.column"), 0.0
    return Columns((*axes, *more), (*scales, *further), column, factor, period, delimiter)


def _axes(
    data: Mapping[str, Any], key: str, usual: str
) -> tuple[tuple[str | int, ...], tuple[float, ...]]:
    columns = data[key].get("columns")
    if not isinstance(columns, list):
        raise InputError(f"{key}.columns must be a list of columns")
    names = tuple(_column(column, f"{key}.columns") for column in columns)
    factor = _unit(data[key], AXIS_UNITS, key, usual)
    return names, (factor,) * len(names)


def _column(value: object, where: str) -> str | int:
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise InputError(f"{where}: a column is a name, or a number from 1")
    return value


def _unit(data: Mapping[str, Any], units: Mapping[str, float], key: str, usual: str) -> float:
    unit = data.get("unit", usual)
    if not isinstance(unit, str) or unit not in units:
        raise InputError(f"{key}.unit must be one of {', '.join(units)}, not {unit!r}")
    return units[unit]
