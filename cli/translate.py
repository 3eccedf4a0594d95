"""``flyby translate``: carry a program to another vendor's robot."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from . import values
from .console import print_json, print_rich, print_table, progress
from .installed import registry
from .loading import Source, robot_of
from .options import AnswersFile, AsJson, CellFile, Entry, Force, OtherFiles, Out, ProgramFile
from .outputs import check_folder, encoded, write_in
from .places import note_json, short_place
from .translation import carried, party_of

if TYPE_CHECKING:
    from ..core.errors import Note
    from ..core.robot.model import Robot
    from ..core.translation.translate import Translation
    from ..core.vendor import Vendor

COLUMNS = (("line", "left"), ("what could not be carried over", "left"))
LINES_WIDTH = 30
"""Characters of a row of line numbers."""


def translate(
    program: ProgramFile,
    robot: Annotated[
        str, typer.Option("--robot", help="The new robot, such as kuka/kr30-3 ('flyby robots').")
    ],
    to: Annotated[
        str | None, typer.Option("--to", help="The new robot's vendor, such as kuka.")
    ] = None,
    old: Annotated[
        str | None, typer.Option("--from", help="The robot that the program is for now.")
    ] = None,
    cell: CellFile = None,
    base: Annotated[
        str | None,
        typer.Option(
            "--base",
            help="The new robot's base in the old one's world: x,y,z,rx,ry,rz in mm and degrees. "
            "Without it both stand at the same place.",
        ),
    ] = None,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    out: Out = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Carry a program to another robot: targets, zones and speeds in its vendor's terms."""
    check_folder("--out", out)
    source = Source.of(program, entry, io, others)
    place = None if base is None else values.pose(base, "--base")
    with progress("reading the program") as say:
        before, after = _old(program, old, cell), _new(robot, to)
        parsed = source.read(*before)
        say(f"translating {len(parsed.moves)} moves")
        made = carried(parsed, before, after, place)
        sources = after[0].write(made.program, after[1])
        written: list[Path] = []
        if out is not None:
            written = write_in("--out", out, encoded(sources), source.inputs(cell), force)
    if json:
        print_json(_json(made, before[1], after[1], written))
    else:
        _tell(program, made, after[1], list(sources), written)


def _old(program: Path, name: str | None, cell: Path | None) -> tuple[Vendor, Robot]:
    if name is None and cell is None:
        vendor = registry().reader_of(program).name
        raise InputError(
            f"which robot is {program} for now? Give --from ('flyby robots {vendor}' lists those "
            f"of {vendor}) or --cell: corners and times are taken from its motion"
        )
    return robot_of(name, cell)


def _new(robot: str, vendor: str | None) -> tuple[Vendor, Robot]:
    arm = party_of(robot if vendor is None or "/" in robot else f"{vendor}/{robot}")
    if vendor is not None and vendor != arm[0].name:
        raise InputError(f"--to {vendor}: {robot} is a robot of {arm[0].name}")
    return arm


def _tell(
    program: Path, made: Translation, robot: Robot, names: list[str], written: list[Path]
) -> None:
    alike: dict[str, list[Note]] = {}
    for note in made.losses:
        alike.setdefault(note.message, []).append(note)
    if alike:
        print_table(COLUMNS, [(_lines(program, notes), what) for what, notes in alike.items()])
    count = len(made.losses)
    lost = "everything was carried over" if not count else f"{count} could not be carried over"
    print_rich(f"{len(made.program.moves)} moves for {robot.name}: {lost}")
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
