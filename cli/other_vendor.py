"""An optimised program's code for another vendor's robot, beside its own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import FlybyError, Note
from ..tasks.files.outputs import check_outputs, write_in
from ..tasks.files.places import FilePlaces
from ..tasks.setup import Setup
from ..tasks.translate import carried
from .delivery import Delivery

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.vendor import Sources


@dataclass(frozen=True)
class OtherVendor:
    """Where such code goes: into a folder of the vendor's name.

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
        paths = {f"--vendor: {name}": self.folder / name for name in sources}
        if self.folder.is_dir():
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
            paths = write_in("--vendor", self.folder, files, *given)
            notes = [replace(note, message=f"for {robot}: {note.message}") for note in losses]
            notes.append(
                Note(
                    f"nothing is proven of the program for {robot}: 'flyby optimize' proves it "
                    "with a cell of that robot"
                )
            )
        made = replace(delivery.made, notes=(*delivery.made.notes, *notes))
        return replace(delivery, made=made, written=[*delivery.written, *paths])

    def _carried(self, program: Program) -> tuple[Sources, tuple[Note, ...]]:
        """The files, and what could not be carried over."""
        made = carried(program, self.before, self.after)
        return self.after.vendor.write(made.program, self.after.robot), made.losses
