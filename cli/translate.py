"""``flyby translate``: carry a program to another vendor's robot."""

from __future__ import annotations

import textwrap
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..core.errors import OptionError
from ..tasks.catalogue import registry
from ..tasks.files.outputs import check_folder, write_in
from ..tasks.files.source_places import note_json, short_place
from ..tasks.read import TextOptions, read_with
from ..tasks.setup import setup_of_program
from ..tasks.translate import TranslateOptions, target_of, translate_with
from .console import print_json, print_rich, print_table, progress
from .parameters import AsJson, Force, Out, ProgramFile, with_options

if TYPE_CHECKING:
    from ..core.errors import Note
    from ..core.robot.model import Robot
    from ..core.translation.translate import Translation

LINES_WIDTH = 30
"""Characters of a row of line numbers."""


@with_options
def translate(
    program: ProgramFile,
    options: TranslateOptions,
    text: TextOptions,
    old: Annotated[
        str | None, typer.Option("--from", help="The robot that the program is for now.")
    ] = None,
    cell: Annotated[
        Path | None, typer.Option("--cell", help="Cell file: robot, base and external axes.")
    ] = None,
    out: Out = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Carry a program to another robot: targets, zones and speeds in its vendor's terms."""
    check_folder("--out", out)
    if old is None and cell is None:
        vendor = registry().reader_of(program).name
        raise OptionError(
            f"which robot is {program} for now? Give --from ('flyby robots {vendor}' lists those "
            f"of {vendor}) or --cell: corners and times are taken from its motion"
        )
    source = text.for_robot(old, cell)
    with progress("reading the program") as say:
        after = target_of(options)
        read = read_with(program, source)
        made = translate_with(read, replace(options, report=say))
        sources = after.vendor.write(made.program, after.robot)
        written: list[Path] = []
        if out is not None:
            files = {Path(name): code.encode() for name, code in sources.items()}
            written = write_in("--out", out, files, [program, *source.inputs()], force)
    if json:
        print_json(_json(made, setup_of_program(read).robot, after.robot, written))
    else:
        _tell(program, made, after.robot, list(sources), written)


def _tell(
    program: Path, made: Translation, robot: Robot, names: list[str], written: list[Path]
) -> None:
    alike: dict[str, list[Note]] = {}
    for note in made.losses:
        alike.setdefault(note.message, []).append(note)
    if alike:
        from ..core.translation.translate import LOSSES

        print_table(LOSSES, [(_lines(program, notes), what) for what, notes in alike.items()])
    count = len(made.losses)
    lost = "everything was carried over" if not count else f"{count} could not be carried over"
    print_rich(f"{counted(made.program.moves, 'move')} for {robot.name}: {lost}")
    for path in written:
        print_rich(f"wrote {path}")
    if not written:
        print_rich(f"nothing was written: --out names a folder for {', '.join(names)}")


def _lines(program: Path, notes: list[Note]) -> str:
    """The lines of one and the same loss, file by file."""
    spans = [note.span for note in notes if note.span is not None]
    rows: list[str] = []
    for file in dict.fromkeys(span.file for span in spans):
        first = min((span for span in spans if span.file == file), key=lambda span: span.line)
        lines = sorted({span.line for span in spans if span.file == file} - {first.line})
        places = ", ".join([short_place(program, first), *map(str, lines)])
        rows += textwrap.wrap(places, LINES_WIDTH, break_long_words=False)
    return "\n".join(rows)


def _json(made: Translation, before: Robot, after: Robot, written: list[Path]) -> dict[str, Any]:
    return {
        "program": made.program.name,
        "from": before.name,
        "to": after.name,
        "moves": len(made.program.moves),
        "losses": [note_json(note) for note in made.losses],
        "files": [str(path) for path in written],
    }
