"""Motor figures from a file of the user's."""

from __future__ import annotations

from pathlib import Path

from ...files.tables import TomlTable
from .consumption import Motors


def load_motors(file: str | Path) -> Motors:
    """Motors from a TOML file.

    Keys: ``copper_w_per_nm2``, a list, W lost in each joint's windings per (N m)² at the joint;
    ``recuperation``, the share of what is left over that goes back to the mains, 0 if not said.

    Raises:
        InputError: the file cannot be read, or a key or value is wrong; it names file and key.
    """
    table = TomlTable.read(file)
    copper = table.numbers("copper_w_per_nm2")
    if min(copper, default=0.0) < 0.0:
        raise table.error("copper_w_per_nm2", f"must be zero or more, not {min(copper):g}")
    recuperation = table.number("recuperation", 0.0)
    if not 0.0 <= recuperation <= 1.0:
        raise table.error("recuperation", f"must be from 0 to 1, not {recuperation:g}")
    table.finish()
    return Motors(copper, recuperation)
