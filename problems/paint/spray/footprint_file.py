"""Footprints in files: a profile, or measured strokes to which one is fitted."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ....core.errors import InputError, Note
from ....core.files.reading import read_toml
from .footprint import Footprint
from .footprint_fit import FootprintFit, fit_footprint
from .strokes import Stroke

_MM, _MICRON = 1e-3, 1e-6
_CONE = {"reference_distance_mm", "near_radius_mm", "near_distance_mm"}
_PROFILE = {"radius_mm", "growth_um_s", "slope_um_s_mm", "aspect"}
_FIT = {"far_radius_mm", "pieces", "stroke"}
_STROKE = {"across_mm", "thickness_um", "distance_mm", "speed_mm_s", "flow"}


@dataclass(frozen=True, eq=False)
class FootprintSource:
    """A footprint and where it comes from.

    Args:
        footprint: at nominal flow.
        strokes: that were measured; empty for a given profile.
        fit: how well it explains them; None for a given profile.
    """

    footprint: Footprint
    strokes: tuple[Stroke, ...] = ()
    fit: FootprintFit | None = None

    @property
    def notes(self) -> tuple[Note, ...]:
        """What is odd about the fit."""
        return () if self.fit is None else tuple(map(Note, self.fit.warnings))


def load_footprint(file: Path) -> FootprintSource:
    """The footprint in a TOML file.

    ``reference_distance_mm``, and the cone's nearer circle ``near_radius_mm`` at
    ``near_distance_mm`` (0, the TCP, if not said). Then a profile: ``radius_mm`` and
    ``growth_um_s``, lists from the centre to the rim, with ``slope_um_s_mm`` (0 everywhere if not
    said) and ``aspect``; or measurements: ``far_radius_mm`` of the rim, ``pieces`` of the spline,
    and a table ``[[stroke]]`` for each: ``across_mm``, ``thickness_um``, ``distance_mm``,
    ``speed_mm_s``, ``flow`` (1 if not said).

    Raises:
        InputError: the file cannot be read, or a key or value is wrong; it names file and key.
    """
    table = read_toml(file)
    try:
        return _fitted(table) if "stroke" in table else _given(table)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error


def _given(table: dict[str, Any]) -> FootprintSource:
    _check_keys(table, _CONE | _PROFILE)
    lists = {key: _list(table, key) for key in ("radius_mm", "growth_um_s")}
    slopes = None
    if "slope_um_s_mm" in table:
        lists["slope_um_s_mm"] = _list(table, "slope_um_s_mm")
        slopes = [_MICRON / _MM * slope for slope in lists["slope_um_s_mm"]]
    if len({len(values) for values in lists.values()}) > 1 or len(lists["radius_mm"]) < 2:
        raise InputError(f"{', '.join(lists)}: as many numbers in each, from the centre to the rim")
    return FootprintSource(
        Footprint.of_cone(
            [_MM * radius for radius in lists["radius_mm"]],
            [_MICRON * growth for growth in lists["growth_um_s"]],
            _MM * _value(table, "reference_distance_mm"),
            _MM * _value(table, "near_radius_mm"),
            _MM * _value(table, "near_distance_mm", 0.0),
            slopes=slopes,
            aspect=_value(table, "aspect", 1.0),
        )
    )


def _fitted(table: dict[str, Any]) -> FootprintSource:
    _check_keys(table, _CONE | _FIT)
    rows = table["stroke"]
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise InputError("stroke: one table [[stroke]] for each measured cross section")
    strokes = tuple(_stroke(row, k + 1) for k, row in enumerate(rows))
    fit = fit_footprint(
        strokes,
        _MM * _value(table, "reference_distance_mm"),
        _MM * _value(table, "far_radius_mm"),
        _MM * _value(table, "near_radius_mm"),
        _MM * _value(table, "near_distance_mm", 0.0),
        pieces=int(_value(table, "pieces")) if "pieces" in table else None,
    )
    return FootprintSource(fit.footprint, strokes, fit)


def _stroke(row: dict[str, Any], number: int) -> Stroke:
    try:
        _check_keys(row, _STROKE)
        return Stroke(
            _MM * np.array(_list(row, "across_mm")),
            _MICRON * np.array(_list(row, "thickness_um")),
            _MM * _value(row, "distance_mm"),
            _MM * _value(row, "speed_mm_s"),
            _value(row, "flow", 1.0),
        )
    except InputError as error:
        raise InputError(f"stroke {number}: {error}") from error


def _check_keys(table: dict[str, Any], known: set[str]) -> None:
    unknown = sorted(set(table) - known)
    if unknown:
        raise InputError(f"no such key: {unknown[0]}; there are {', '.join(sorted(known))}")


def _value(table: dict[str, Any], key: str, default: float | None = None) -> float:
    value = table.get(key, default)
    if value is None:
        raise InputError(f"{key} is missing")
    if not _is_number(value):
        raise InputError(f"{key} is a finite number, not {value!r}")
    return float(value)


def _list(table: dict[str, Any], key: str) -> list[float]:
    values = table.get(key)
    if values is None:
        raise InputError(f"{key} is missing")
    if not isinstance(values, list) or not all(map(_is_number, values)):
        raise InputError(f"{key} is a list of finite numbers, not {values!r}")
    return [float(value) for value in values]


def _is_number(value: Any) -> bool:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and math.isfinite(value)
