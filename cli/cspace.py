"""``flyby cspace``: the configuration space of two joints with a program's path in it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from ..core.errors import Note
from ..tasks.cspace import CspaceOptions, cspace_with
from ..tasks.files.outputs import check_outputs, picture_kind, write_all
from ..tasks.read import SourceOptions, read_with
from .output.console import print_json, print_rich, progress, warn_of
from .parameters import AsJson, Force, ProgramFile, with_options


@with_options
def cspace(
    program: ProgramFile,
    source: SourceOptions,
    options: CspaceOptions,
    plot: Annotated[Path, typer.Option("--plot", help="The picture: PNG, PDF or SVG.")],
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Draw where the arm is free while two joints vary, with the path of a program in it."""
    kind = picture_kind(plot, "--plot")
    check_outputs({"--plot": plot}, [program, *source.inputs()], force)
    with progress("reading the program") as say:
        found = cspace_with(read_with(program, source), replace(options, report=say))
        say("drawing")
        write_all("--plot", {plot: found.picture(kind)})
    first, second = found.names
    if json:
        print_json(
            {
                "robot": found.robot.name,
                "joints": [first, second],
                "held_rad": found.plane.held.tolist(),
                "free": found.plane.free,
                "notes": list(found.notes),
                "files": [str(plot)],
            }
        )
    else:
        print_rich(
            f"{first} and {second} of {found.robot.name}, with {found.held}: nothing touches in "
            f"{found.plane.free:.0%} of the plane",
            f"wrote {plot}",
        )
    warn_of(Note(note) for note in found.notes)
