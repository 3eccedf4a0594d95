"""What becomes of a changed program: notes on code beside it, files, the exit status."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

import typer

from .bystanders import bystander_notes, refuse_bystanders
from .console import print_rich
from .patching import Places

if TYPE_CHECKING:
    from ..core.errors import Note
    from ..core.source.reading import Files
    from ..core.vendor import Vendor
    from ..problems.improve.solution import Solution

Made = TypeVar("Made", bound="Solution")


@dataclass(frozen=True)
class Delivery(Generic[Made]):
    """A solution whose files are written.

    Args:
        made: with notes on code that was not driven.
        concerned: these notes.
        written: the files.
        places: where they were to go.
    """

    made: Made
    concerned: Sequence[Note]
    written: Sequence[Path]
    places: Places

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
            refuse_bystanders(self.concerned)
        if not self.made.proven:
            raise typer.Exit(1)


def deliver(
    made: Made, vendor: Vendor, files: Files, places: Places, unproven: bool
) -> Delivery[Made]:
    """Write the files of a changed program that is proven.

    Args:
        made: with the program as it is read from its new text.
        vendor: whose language it is.
        files: that text.
        places: where it goes.
        unproven: whether a program that is not proven is written as well.

    Raises:
        InputError: see `Places.write`.
    """
    concerned = bystander_notes(made, vendor)
    made = replace(made, notes=(*made.notes, *concerned))
    written: list[Path] = []
    refused = places.in_place and bool(concerned)
    if made.changed and (made.proven or unproven) and not refused:
        written = places.write(files, made.original)
    return Delivery(made, concerned, written, places)
