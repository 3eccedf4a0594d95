"""``flyby view`` and ``flyby cspace``: a program in its cell, and in the space of two joints."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from ..core.errors import Note, OptionError
from ..core.program.entry_point import ALL
from ..tasks.cspace import CspaceOptions, cspace_with
from ..tasks.emulate import EmulateOptions, emulate_with
from ..tasks.files.outputs import check_outputs, picture_kind, write_all
from ..tasks.pages.of_results import page_bytes
from ..tasks.pages.show import open_page, temporary_page
from ..tasks.read import SourceOptions
from .output.console import print_json, print_rich, progress, warn, warn_of
from .output.told_robot import read_for_robot
from .parameters import AsJson, Force, ProgramFile, with_options


@with_options
def view(
    program: ProgramFile,
    source: SourceOptions,
    options: EmulateOptions,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Only write the page, and say where.")
    ] = False,
) -> None:
    """Look at a program in a browser: the cell with playback, the source, plots, what limits it.

    The page goes into a temporary folder; `flyby emulate --report FILE` keeps it.
    """
    if source.entry == ALL:
        raise OptionError("--entry all: a page is of one program: name one entry")
    with progress("reading the program") as say:
        read = read_for_robot(program, source)
        run = emulate_with(read, replace(options, report=say))
        say("making the page")
        path = temporary_page(page_bytes(run), program.stem)
    print_rich(str(path))
    if not no_browser and not open_page(path):
        warn("no browser was found: open the page yourself")


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
        found = cspace_with(read_for_robot(program, source), replace(options, report=say))
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
            f"{100.0 * found.plane.free:.0f} % of the plane",
            f"wrote {plot}",
        )
    warn_of(Note(note) for note in found.notes)
