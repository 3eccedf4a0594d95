"""What becomes of a changed program: its files, code for another vendor beside them, the status."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from ...core.door import called
from ...core.errors import FlybyError, Note
from ...tasks.files.not_executed import not_executed_notes, refuse_not_executed
from ...tasks.files.outputs import check_outputs, picture_kind, write_all, write_in
from ...tasks.files.places import FilePlaces
from ...tasks.pages.file import write_page
from ...tasks.setup import Setup
from ...tasks.translate import carried
from .console import print_rich

if TYPE_CHECKING:
    from ...core.cell.cell import Cell
    from ...core.language import Sources
    from ...core.program.program import Program
    from ...problems.improve.solution import Solution


@dataclass(frozen=True)
class Delivery:
    """A solution whose files are written.

    Args:
        made: the solution.
        setup: its robot, and whose language it is.
        places: where the files were to go.
        written: the files.
    """

    made: Solution
    setup: Setup
    places: FilePlaces
    written: Sequence[Path]

    def with_page(self, file: Path | None, say: Callable[[str], object], cell: Cell) -> Delivery:
        """The same with the page of the solution in its cell, if it has a file."""
        if file is None:
            return self
        say("making the page")
        return replace(self, written=[*self.written, *write_page(file, self.made, cell=cell)])

    def with_picture(self, plot: Path, cell: Cell) -> Delivery:
        """The delivery with a picture of the cell with the path before and after."""
        from ...tasks.results.changed_picture import draw_change

        drawn = draw_change(self.made, cell, self.setup, picture_kind(plot, "--plot"))
        write_all("--plot", {plot: drawn})
        return replace(self, written=[*self.written, plot])

    def end(self, told: bool) -> None:
        """Say that nothing was written, if nothing was, and give the exit status.

        Args:
            told: whether words are wanted, not JSON alone.

        Raises:
            InputError: files were to be changed in place that other code depends on.
            typer.Exit: the program is not proven.
        """
        made = self.made
        if told and made.changed and not self.places.anywhere:
            print_rich("nothing was written: --in-place or --out FOLDER writes the new program")
        if told and not made.changed and self.places.anywhere:
            print_rich("nothing was written: the program stays as it is")
        if self.places.in_place:
            refuse_not_executed(not_executed_notes(made.original, made.program, self.setup.vendor))
        if not made.proven:
            raise typer.Exit(1)


def deliver(made: Solution, setup: Setup, places: FilePlaces, unproven: bool) -> Delivery:
    """Write the files of a changed program that is proven.

    Args:
        made: with the texts of its program.
        setup: its robot, and whose language it is.
        places: where they go.
        unproven: whether a program that is not proven is written as well.

    Raises:
        InputError: see `FilePlaces.write`.
    """
    noted = not_executed_notes(made.original, made.program, setup.vendor) if places.in_place else ()
    written: list[Path] = []
    if made.changed and (made.proven or unproven) and not noted:
        written = places.write(made.texts, made.original)
    return Delivery(made, setup, places, written)


@dataclass(frozen=True)
class OtherVendor:
    """Where code for another vendor's robot goes: into a folder of the vendor's name.

    Args:
        before, after: the robot of the program, and of the code.
        out: folder of the program's own files.
        places: of these.
    """

    before: Setup
    after: Setup
    out: Path
    places: FilePlaces

    @property
    def folder(self) -> Path:
        """The folder."""
        return self.out / self.after.vendor.name

    def check(self, program: Program) -> None:
        """Refuse, before work begins, what cannot be carried over even as it is.

        Raises:
            FlybyError: the translation must refuse the program, or its files must not be written.
        """
        sources, _ = self._carried(program)
        if self.folder.is_dir():
            paths = {"--also": [self.folder / name for name in sources]}
            check_outputs(paths, self.places.inputs, self.places.replace_existing)

    def written(self, delivery: Delivery) -> Delivery:
        """The delivery with this code written too, if its own is, and notes on what is lost."""
        if not delivery.written:
            return delivery
        robot = self.after.robot.name
        paths: list[Path] = []
        try:
            sources, losses = self._carried(delivery.made.program)
        except FlybyError as error:
            notes = [Note(f"nothing was written for {robot}: {error}")]
        else:
            given = self.places.inputs, self.places.replace_existing
            files = {Path(name): text.encode() for name, text in sources.items()}
            paths = write_in("--also", self.folder, files, *given)
            notes = [replace(note, message=f"for {robot}: {note.message}") for note in losses]
            notes.append(
                Note(
                    f"nothing is proven of the program for {robot}: {called('optimize')} proves it "
                    "with a cell of that robot"
                )
            )
        made = replace(delivery.made, notes=(*delivery.made.notes, *notes))
        return replace(delivery, made=made, written=[*delivery.written, *paths])

    def _carried(self, program: Program) -> tuple[Sources, tuple[Note, ...]]:
        """The files, and what could not be carried over."""
        made = carried(program, self.before, self.after)
        return self.after.vendor.write(made.program, self.after.robot), made.losses
