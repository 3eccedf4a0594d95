"""What becomes of a changed program: files, notes on code beside it, the exit status."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from ..tasks.files.not_executed import not_executed_notes, refuse_not_executed
from ..tasks.files.places import FilePlaces
from .console import print_rich

if TYPE_CHECKING:
    from ..core.vendor import Vendor
    from ..problems.improve.solution import Solution


@dataclass(frozen=True)
class Delivery:
    """A solution whose files are written.

    Args:
        made: the solution.
        vendor: whose language it is.
        places: where the files were to go.
        written: the files.
    """

    made: Solution
    vendor: Vendor
    places: FilePlaces
    written: Sequence[Path]

    def end(self, told: bool) -> None:
        """Say that nothing was written, if nothing was to be, and give the exit status.

        Args:
            told: whether words are wanted, not JSON alone.

        Raises:
            InputError: files were to be changed in place that other code depends on.
            typer.Exit: the program is not proven.
        """
        if told and self.made.changed and not self.places.anywhere:
            print_rich("nothing was written: --in-place or --out FOLDER writes the new program")
        if self.places.in_place:
            refuse_not_executed(not_executed_notes(self.made, self.vendor))
        if not self.made.proven:
            raise typer.Exit(1)


def deliver(made: Solution, vendor: Vendor, places: FilePlaces, unproven: bool) -> Delivery:
    """Write the files of a changed program that is proven.

    Args:
        made: with the texts of its program.
        vendor: whose language it is.
        places: where they go.
        unproven: whether a program that is not proven is written as well.

    Raises:
        InputError: see `FilePlaces.write`.
    """
    refused = places.in_place and bool(not_executed_notes(made, vendor))
    written: list[Path] = []
    if made.changed and (made.proven or unproven) and not refused:
        written = places.write(made.texts, made.original)
    return Delivery(made, vendor, places, written)
