"""``flyby translate``: carry a program to another vendor's robot."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..core.errors import FlybyError, InputError, OptionError
from ..core.program.entry_point import ALL
from ..tasks.backup.finding import find_backup
from ..tasks.catalogue import registry
from ..tasks.files.outputs import check_folder, encoded, write_in
from ..tasks.files.source_places import note_json, short_place
from ..tasks.options.guessed_robot import with_robot
from ..tasks.pages.file import check_page, write_page
from ..tasks.read import SourceOptions, TextOptions, read_with
from ..tasks.setup import setup_of_program
from ..tasks.translate import TranslateOptions, place_of, target_of, translate_with
from ..tasks.translate import written as written_of
from .output.console import fail, print_json, print_rich, print_table, progress
from .parameters import AsJson, Force, Out, PageFile, ProgramFile, with_options

if TYPE_CHECKING:
    from ..core.errors import Note
    from ..core.language import Sources
    from ..core.program.program import Program
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
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Carry a program to another robot: targets, zones and speeds in its vendor's terms."""
    check_folder("--out", out)
    check_page(report, [program], force)
    if old is None and cell is None and find_backup(program, registry()) is None:
        vendor = registry().reader_of(program).name
        with progress("looking for the robot"):
            with_robot(program, text.for_robot(None, None), writes=True, option="--from")
        raise OptionError(
            f"which robot is {program} for now? Give --from ('flyby robots {vendor}' lists those "
            f"of {vendor}) or --cell: corners and times are taken from its motion"
        )
    source = text.for_robot(old, cell)
    check_page(report, source.inputs(), force)
    if source.entry == ALL:
        if report is not None:
            raise OptionError("--report is of one program: name one entry, not all")
        if json:
            raise OptionError("--json is of one program: name one entry, not all")
        _each(program, source, options, out, force)
        return
    with progress("reading the program") as say:
        after = target_of(options)
        read, made, sources = _translated(program, source, replace(options, report=say))
        written = _put(out, encoded(sources), [program, *source.inputs()], force)
        if report is not None:
            say("making the page")
        place = place_of(options, setup_of_program(read))
        paged = write_page(report, made, place=place, sources=sources)
    if json:
        print_json(_json(made, setup_of_program(read).robot, after.robot, written))
    else:
        _tell(program, made, after.robot, list(sources), written)
        for path in paged:
            print_rich(f"wrote {path}")


def _translated(
    program: Path, source: SourceOptions, options: TranslateOptions
) -> tuple[Program, Translation, Sources]:
    """A program, what has become of it, and the files of that."""
    read = read_with(program, source)
    made = translate_with(read, options)
    options.say("driving what is written")
    return read, made, written_of(made)


def _each(
    program: Path,
    source: SourceOptions,
    options: TranslateOptions,
    out: Path | None,
    force: bool,
) -> None:
    """Translate every routine that a program may begin with, each into a folder of its name."""
    with progress("reading the program"):
        after = target_of(options)
        entries = [entry for entry in read_with(program, source).entries if entry.moves]
    if not entries:
        raise InputError(f"{program}: no routine in it moves the robot")
    files: dict[Path, bytes] = {}
    failed = False
    for entry in entries:
        print_rich(f"\n{entry}")
        if entry.parameters:
            print_rich(f"takes arguments: --entry '{entry.name}({', '.join(entry.parameters)})'")
            continue
        one = replace(source, entry=entry.name)
        try:
            with progress(f"translating {entry.name}") as say:
                _, made, sources = _translated(program, one, replace(options, report=say))
        except FlybyError as error:
            fail(str(error))
            failed = True
            continue
        files |= {Path(entry.name) / name: data for name, data in encoded(sources).items()}
        _tell(program, made, after.robot, list(sources), None)
    for path in _put(out, files, [program, *source.inputs()], force):
        print_rich(f"wrote {path}")
    if out is None:
        print_rich("nothing was written: --out names a folder, in which each gets one of its own")
    if failed:
        raise typer.Exit(1)


def _put(
    out: Path | None, files: Mapping[Path, bytes], inputs: Sequence[Path], force: bool
) -> list[Path]:
    """Write files, if there is a place for them."""
    return [] if out is None else write_in("--out", out, files, inputs, force)


def _tell(
    program: Path, made: Translation, robot: Robot, names: list[str], written: list[Path] | None
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
    if made.unmapped:
        print_rich(_signals(made))
    for path in written or ():
        print_rich(f"wrote {path}")
    if written == []:
        print_rich(f"nothing was written: --out names a folder for {', '.join(names)}")


def _signals(made: Translation) -> str:
    """What is to be written into the answers so that signals are carried over."""
    return "\n".join(
        [
            "signals that are not carried over, as nobody says what they are on the new robot; the "
            "lines for it, to be filled in, of a file that --io takes:",
            "[signals]",
            *(f"{_quoted(name)} = {_quoted(other)}" for name, other in made.unmapped.items()),
        ]
    )


def _quoted(name: str) -> str:
    return f'"{name}"'


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
        "unmapped_signals": dict(made.unmapped),
        "files": [str(path) for path in written],
    }
