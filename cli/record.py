"""``flyby record``: source that drives a program and logs itself."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..core.errors import InputError
from .console import print_rich, progress
from .loading import Source, robot_of
from .options import AnswersFile, CellFile, Entry, Force, OtherFiles, ProgramFile, RobotName
from .outputs import check_folder, encoded, write_in

LEAST_PERIOD = 1e-3
"""s. No controller logs its own joints faster."""


def record(
    program: ProgramFile,
    out: Annotated[Path, typer.Option("--out", help="Folder to write the files to.")],
    robot: RobotName = None,
    cell: CellFile = None,
    period: Annotated[float, typer.Option(help="Seconds between logged samples.")] = 0.012,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    force: Force = False,
) -> None:
    """Write a program that drives the same moves and logs joints with time on the controller."""
    if not LEAST_PERIOD <= period < float("inf"):
        raise InputError(f"--period must be at least {LEAST_PERIOD:g} s, not {period}")
    check_folder("--out", out)
    source = Source.of(program, entry, io, others)
    with progress("reading the program"):
        vendor, arm = robot_of(robot, cell)
        parsed = source.read(vendor, arm)
        sources = vendor.record(parsed, arm, period)
        written = write_in("--out", out, encoded(sources), source.inputs(cell), force)
    for path in written:
        print_rich(f"wrote {path}")
