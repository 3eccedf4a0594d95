"""``flyby view``: a program in its cell, looked at in a browser."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import typer

from ..core.errors import OptionError
from ..core.program.entry_point import ALL
from ..tasks.emulate import EmulateOptions, emulate_with
from ..tasks.pages.of_results import page_bytes
from ..tasks.pages.show import open_page, temporary_page
from ..tasks.read import SourceOptions, read_with
from .output.console import print_rich, progress, warn
from .parameters import ProgramFile, with_options


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
        read = read_with(program, source)
        run = emulate_with(read, replace(options, report=say))
        say("making the page")
        path = temporary_page(page_bytes(run), program.stem)
    print_rich(str(path))
    if not no_browser and not open_page(path):
        warn("no browser was found: open the page yourself")
