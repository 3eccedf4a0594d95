"""How one arm of UR differs from the nominal one of its type: ``calibration.conf``, programs.

The controller keeps ``calibration.conf`` beside ``urcontrol.conf``; an INI file of which the
section ``[mounting]`` is read:

    [mounting]
    delta_theta = [ 4.6e-08, 1.5e-05, … ]   six of each: rad, m, m, rad
    delta_a = [ … ]
    delta_d = [ … ]
    delta_alpha = [ … ]

A program or an installation of PolyScope states all of its arm's table in ``kinematics``.

The values of ``calibration.conf`` add to the rows of the type's Denavit–Hartenberg table: the frame
behind joint i is Rz(qᵢ + δθᵢ) Tz(dᵢ + δdᵢ) Tx(aᵢ + δaᵢ) Rx(αᵢ + δαᵢ). What a controller has
linearised has d of hundreds of metres along the parallel axes 2, 3 and 4, which cancel.
"""

from __future__ import annotations

import configparser
import re
from pathlib import Path

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.files.reading import read_text
from ...core.robot.model import Robot
from .calibration import calibrated, nominal_table
from .urp.kinematics import DhTable, table_of
from .urp.xml_file import child, read_xml

_ROWS = "theta", "a", "d", "alpha"
_LARGEST = 1 << 20
_POLYSCOPE = (".urp", ".installation")
_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*")


def with_machine_data(robot: Robot, file: Path) -> Robot:
    """The robot as its calibration says it is.

    Args:
        robot: of this type, nominal.
        file: ``calibration.conf``, or a program or installation of PolyScope that was saved on the
            robot.

    Raises:
        InputError: the file cannot be read, states no calibration, or that of another type of arm.
    """
    if file.suffix.casefold() in _POLYSCOPE:
        table = table_of(child(read_xml(file), "kinematics", "Kinematics"))
        if table is None:
            raise InputError(f"{file}: states no kinematics of its arm")
        return calibrated(robot, table, file)
    nominal = nominal_table(robot)
    rows = np.array(nominal.rows) + _deltas(file, robot.arm_size)
    return calibrated(
        robot, DhTable(tuple((t, a, d, s) for t, a, d, s in rows.tolist())), str(file)
    )


def _deltas(file: Path, count: int) -> FloatArray:
    """(count, 4), of each row of the table: δθ rad, δa m, δd m, δα rad."""
    parser = configparser.ConfigParser(
        interpolation=None, strict=False, inline_comment_prefixes=("#", ";")
    )
    try:
        parser.read_string(read_text(file, _LARGEST))
    except configparser.Error as error:
        reason = str(error).splitlines()[0]
        raise InputError(f"{file}: not a calibration.conf: {reason}") from error
    columns = []
    for name in _ROWS:
        stated = parser.get("mounting", f"delta_{name}", fallback=None)
        if stated is None:
            raise InputError(f"{file}: [mounting] delta_{name} is missing")
        parts = stated.strip().removeprefix("[").removesuffix("]").split(",")
        if len(parts) != count or not all(_NUMBER.fullmatch(part) for part in parts):
            raise InputError(
                f"{file}: [mounting] delta_{name} must be {count} numbers, not {stated.strip()!r}"
            )
        columns.append([float(part) for part in parts])
    return np.array(columns).T
