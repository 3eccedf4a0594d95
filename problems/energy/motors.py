"""Motor figures from a file of the user's."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.motion.consumption import Motors

_KEYS = ("copper_w_per_nm2", "recuperation")


def load_motors(file: Path) -> Motors:
    """Motors from a TOML file.

    Keys: ``copper_w_per_nm2``, a list, W lost in each joint's windings per (N m)² at the joint;
    ``recuperation``, the share of what is left over that goes back to the mains, 0 if not said.

    Raises:
        InputError: the file cannot be read, or a key or value is wrong; it names file and key.
    """
    try:
        table = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{file}: cannot be read as TOML: {error}") from error
    unknown = sorted(set(table) - set(_KEYS))
    if unknown:
        raise InputError(f"{file}: no such key: {unknown[0]}; there are {' and '.join(_KEYS)}")
    if "copper_w_per_nm2" not in table:
        raise InputError(f"{file}: copper_w_per_nm2 is missing: one number a joint")
    copper = table["copper_w_per_nm2"]
    if not isinstance(copper, list) or not all(map(_number, copper)):
        raise InputError(
            f"{file}: copper_w_per_nm2 is a list of finite numbers, zero or more, not {copper!r}"
        )
    recuperation = table.get("recuperation", 0.0)
    if not _number(recuperation) or recuperation > 1.0:
        raise InputError(f"{file}: recuperation is a number from 0 to 1, not {recuperation!r}")
    return Motors(tuple(map(float, copper)), float(recuperation))


def _number(value: Any) -> bool:
    """Whether a value is a finite number, zero or more."""
    return (
        isinstance(value, int | float) and not isinstance(value, bool) and 0.0 <= value < math.inf
    )
