"""Figures of the motion model that data lists state, and what of them is not emulated."""

from __future__ import annotations

import math
from typing import Any

from ....core.backup.contents import BackupNotes
from ....core.errors import InputError
from ..data_list import DataList


def motion_figures(
    config: DataList | None, machine: DataList | None, notes: BackupNotes
) -> dict[str, tuple[Any, str]]:
    """By their names in motion files, each with its value and its origin.

    The turn of the tool accelerates by ``DEF_ACC_ORI1`` of ``$config.dat``, what ``$ACC.ORI1`` is
    after ``BAS(#INITMOV)``. Lengths of set-point filters are noted: by how much they smooth is not
    known.
    """
    found: dict[str, tuple[Any, str]] = {}
    turn = _number(config, "DEF_ACC_ORI1")
    if config is not None and turn is not None:
        said = f"{config.name}: DEF_ACC_ORI1, {turn:g} degrees/s²"
        found["limit.reorientation_acceleration"] = (math.radians(turn), said)
    filters = {
        name: value
        for name in ("$DEF_FLT_PTP", "$DEF_FLT_CP")
        if (value := _number(machine, name)) is not None
    }
    if machine is not None and filters:
        told = " and ".join(f"{name} {value:g} ms" for name, value in filters.items())
        line = machine.data[next(iter(filters)), 0]
        notes.add(
            f"the controller filters its set-points over {told}; none of it is emulated, as how it "
            "does so is not published (time.smoothing_s of a motion file)",
            line.file,
            line.line,
        )
    return found


def _number(data: DataList | None, name: str) -> float | None:
    """A number above zero; None if there is none."""
    try:
        value = data.number(name) if data is not None and data.has(name) else None
    except InputError:
        return None
    return value if value is not None and 0.0 < value < 1e6 else None
