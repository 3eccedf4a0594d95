"""Changed programs in the user's own files: patched, read again, written where the user says."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import InputError
from .outputs import check_folder, check_outputs, write_all

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from ..core.source.reading import Files
    from ..core.vendor import Vendor


class Patching:
    """Patches a program's files and keeps what the last patch made of them.

    Args:
        vendor: whose language it is.
        robot: whose program.
        own: whether moves get data of their own where the text has no place for a change.
    """

    def __init__(self, vendor: Vendor, robot: Robot, own: bool) -> None:
        self._vendor = vendor
        self._robot = robot
        self._options = {"shared": "own", "derived": "own"} if own else {}
        self.files: Files = {}

    def read_back(self, program: Program) -> Program:
        """Patch the files of a program and read them again.

        Raises:
            FlybyError: a change has no place in the text.
        """
        from ..core.source.patch.edits import reading_of

        self.files = self._vendor.patch(program, self._robot, self._options)
        return reading_of(program).again(self.files)


@dataclass(frozen=True)
class Places:
    """Where patched files go.

    Args:
        out: folder for them, made if it is missing; None for none.
        in_place: whether they take the place of what is read.
        inputs: files that are read, the program first.
        replace_existing: see `check_outputs`; with ``in_place`` inputs are replaced.
    """

    out: Path | None
    in_place: bool
    inputs: Sequence[Path]
    replace_existing: bool

    @property
    def anywhere(self) -> bool:
        """Whether there is a place at all."""
        return self.in_place or self.out is not None

    def check(self) -> None:
        """Refuse, before work begins, places that patched files cannot go to.

        Raises:
            InputError: both places are asked for, or the folder cannot take the program's file.
        """
        check_folder("--out", self.out)
        if self.out is None:
            return
        if self.in_place:
            raise InputError("--out and --in-place: the files go to one place or the other")
        if self.out.is_dir():
            path = self.out / self.inputs[0].name
            check_outputs({f"--out: {path.name}": path}, self.inputs, self.replace_existing)

    def write(self, files: Files, original: Program) -> list[Path]:
        """Write changed files; into a folder with all that they run with, changed or not.

        Args:
            files: as a patch or a writer hands them out.
            original: the program as it was read.

        Returns:
            The files that were written; none if there is no place for them.

        Raises:
            InputError: one of them must not be written, cannot be encoded, or has changed since
                it was read; then none is.
        """
        from ..core.source.patch.edits import reading_of, runnable_set
        from ..core.source.reading import named_apart

        if not self.anywhere:
            return []
        if self.out is None:
            paths = {Path(file.name): file.data for file in files.values()}
            _check_unchanged(paths, reading_of(original).files)
            write_all("--in-place", paths)
            return list(paths)
        if all(file.name in reading_of(original).files for file in files.values()):
            files = named_apart(runnable_set(original, files))
        paths = {self.out / name: file.data for name, file in files.items()}
        named = {f"--out: {path.name}": path for path in paths}
        check_outputs(named, self.inputs, self.replace_existing, self.out)
        write_all("--out", paths, self.out)
        return list(paths)


def _check_unchanged(paths: Iterable[Path], read: Files) -> None:
    """Refuse to write over what somebody has saved since the files were read."""
    from ..core.files.reading import read_bytes
    from ..core.source.text.files import LARGEST_FILE

    for path in paths:
        try:
            now = read_bytes(path, LARGEST_FILE)
        except InputError as error:
            raise InputError(f"--in-place: {error}") from error
        if str(path) in read and now != read[str(path)].data:
            raise InputError(
                f"--in-place: {path} has changed since it was read, and stays as it is: run again, "
                "or name a folder by --out"
            )
