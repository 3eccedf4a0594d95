"""Figures of the motion model that data lists state."""

from __future__ import annotations

import math
from typing import Any

from ....core.errors import InputError
from ..data_list import DataList
from ..machine_data.filters import filters


def motion_figures(config: DataList | None, machine: DataList | None) -> dict[str, tuple[Any, str]]:
    """By their names in motion files, each with its value and its origin.

    The turn of the tool accelerates by ``DEF_ACC_ORI1`` of ``$config.dat``, what ``$ACC.ORI1`` is
    after ``BAS(#INITMOV)``; filters of set-points are those of ``$machine.dat``.
    """
    found: dict[str, tuple[Any, str]] = {} if machine is None else filters(machine)
    turn = _number(config, "DEF_ACC_ORI1")
    if config is not None and turn is not None:
        said = f"{config.name}: DEF_ACC_ORI1, {turn:g} degrees/s²"
        found["limit.reorientation_acceleration"] = (math.radians(turn), said)
    return found


def _number(data: DataList | None, name: str) -> float | None:
    """A number above zero; None if there is none."""
    try:
        value = data.number(name) if data is not None and data.has(name) else None
    except InputError:
        return None
    return value if value is not None and 0.0 < value < 1e6 else None
