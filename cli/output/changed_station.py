"""What commands that change programs do with a station: all of its programs change."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from ...core.door import spelt
from ...core.errors import OptionError
from ...tasks.files.outputs import write_in
from ...tasks.files.places import FilePlaces
from ...tasks.pages.file import check_page, write_page
from .console import print_json, print_rich, print_table, progress, warn_of

if TYPE_CHECKING:
    from ...tasks.options.entries import TaskOptions
    from ...tasks.station.changed import ChangedStation


def is_station(path: Path) -> bool:
    """Whether a command's program is a station file."""
    return path.suffix.casefold() == ".toml" and path.is_file()


def changed_station(
    file: Path,
    make: Callable[[Callable[[str], object]], ChangedStation],
    places: FilePlaces,
    json: bool,
    page: Path | None = None,
) -> None:
    """Improve a station's programs, write them, and tell.

    Args:
        file: the station file.
        make: does it; is given what tells what is being done.
        places: where the files go.
        json: whether the report is JSON.
        page: the file of its page; None for none.

    Raises:
        typer.Exit: a robot is not proven to keep clear of its cell.
    """
    places.check()
    check_page(page, places.inputs, places.replace_existing)
    written: list[Path] = []
    with progress("reading the station") as say:
        made = make(say)
        if made.changed and made.proven:
            written = _written(made, places)
        if page is not None:
            say("making the page")
            written = [*written, *write_page(page, made)]
    if json:
        print_json({**made.as_json(), "files": [str(path) for path in written]})
    else:
        _tell(file, made, places, written)
    if not made.proven:
        raise typer.Exit(1)


def refuse_given(options: Sequence[TaskOptions], taken: Sequence[str], **others: object) -> None:
    """Refuse options of commands on one program that a station's own file answers.

    Args:
        options: as they were given.
        taken: names of those that a station takes too.
        others: further options by name, false or None where they are not given.

    Raises:
        OptionError: naming the first.
    """
    for name, value in others.items():
        if value:
            raise OptionError(f"{spelt(name)} does not go with a station")
    for one in options:
        usual = type(one)()
        for field in fields(one):
            name = field.name
            if name in ("report", *taken) or getattr(one, name) == getattr(usual, name):
                continue
            raise OptionError(
                f"{spelt(name)} does not go with a station: its file says of each robot what holds "
                "for it"
            )


def _written(made: ChangedStation, places: FilePlaces) -> list[Path]:
    if places.out is not None:
        files = {Path(name): data for name, data in made.files_in(places.out).items()}
        return write_in(spelt("out"), places.out, files, [*places.inputs], places.replace_existing)
    written: list[Path] = []
    if places.in_place:
        made.refuse_shared()
        for solution in made.solutions.values():
            written += places.write(solution.texts, solution.original)
    return written


def _tell(file: Path, made: ChangedStation, places: FilePlaces, written: Sequence[Path]) -> None:
    from ...tasks.station.changed import ROBOTS

    print_table(ROBOTS, made.robot_rows())
    warn_of(made.notes)
    print_rich(
        f"{file}: station time {made.before.duration:.3f} s → {made.after.duration:.3f} s "
        f"({-made.gain:+.1f} %)"
    )
    if made.changed and not places.anywhere:
        print_rich("nothing was written: --in-place or --out FOLDER writes the new programs")
    for path in written:
        print_rich(f"wrote {path}")
