"""Logs of a laboratory's own recorder: ``#joint-trace``, then ms and degrees with ``;`` between."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flyby.core.errors import InputError
from flyby.core.hookspec import LogRegister, hookimpl
from flyby.core.plugins.parts import LogForm
from flyby.core.robot.model import Robot
from flyby.identification.logs.samples import LogSamples, in_order

HEAD = b"#joint-trace"


def recognises(path: Path) -> bool:
    """Whether a file begins as such logs do."""
    with path.open("rb") as file:
        return file.read(len(HEAD)) == HEAD


def read(path: Path, robot: Robot) -> LogSamples:
    """The samples of a file.

    Raises:
        InputError: a line is none.
    """
    rows, lines = [], []
    for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            try:
                rows.append([float(value) for value in line.split(";")])
            except ValueError:
                raise InputError(f"{path}:{number}: {line!r} is no time and joints") from None
            lines.append(number)
            if len(rows[-1]) != 1 + robot.size or not np.isfinite(rows[-1]).all():
                raise InputError(
                    f"{path}:{number}: a time and {robot.size} joints should stand here"
                )
    table = np.array(rows).reshape(len(rows), 1 + robot.size)
    return in_order(table[:, 0] / 1000, np.radians(table[:, 1:]), np.array(lines), str(path))


@hookimpl
def flyby_register_logs(register: LogRegister) -> None:
    """Hand over the form."""
    register.add(LogForm("joint-trace", "logs of our recorder", recognises, read), api=1)
