"""``flyby record``: source that drives a program and logs itself."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..tasks.files.outputs import check_folder, write_in
from ..tasks.read import SourceOptions, read_with
from ..tasks.record import RecordOptions, record_with
from .output.console import print_rich, progress
from .parameters import Force, ProgramFile, with_options


@with_options
def record(
    program: ProgramFile,
    source: SourceOptions,
    options: RecordOptions,
    out: Annotated[Path, typer.Option("--out", help="Folder to write the files to.")],
    force: Force = False,
) -> None:
    """Write a program that drives the same moves and logs joints with time on the controller."""
    check_folder("--out", out)
    with progress("reading the program"):
        made = record_with(read_with(program, source), options)
        files = {Path(name): data for name, data in made.files.items()}
        written = write_in("--out", out, files, [program, *source.inputs()], force)
    for path in written:
        print_rich(f"wrote {path}")
