"""Where the files of a changed program go: into a folder, or in the place of those read."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import spelt, switched
from ...core.errors import InputError, OptionError
from .outputs import check_folder, check_outputs, write_all

if TYPE_CHECKING:
    from ...core.backup.backup import Backup
    from ...core.program.program import Program
    from ...core.source.reading import Files


@dataclass(frozen=True)
class FilePlaces:
    """Where changed files go.

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
        """Refuse, before work begins, places that files cannot go to.

        Raises:
            InputError: both places are asked for, or the folder cannot take the program's file.
        """
        if self.out is not None and self.out.suffix.lower() == ".zip":
            check_outputs({spelt("out"): self.out}, self.inputs, self.replace_existing)
        else:
            check_folder(spelt("out"), self.out)
        if self.out is None:
            if self.in_place and self.inputs:
                there = self.inputs[0]
                check_folder(switched("in_place"), there if there.is_dir() else there.parent)
            return
        if self.in_place:
            raise OptionError(
                f"{spelt('out')} and {switched('in_place')}: the files go to one place or the other"
            )
        if self.out.is_dir() and self.inputs:
            path = self.out / self.inputs[0].name
            check_outputs({spelt("out"): path}, self.inputs, self.replace_existing)

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
        if self.out is None:
            return self._replace(files, original) if self.in_place else []
        from ...core.source.patch.runnable import runnable_files

        backup = _backup_of(files, original)
        if backup is not None:
            return self._copy(backup, files)
        paths = {self.out / name: data for name, data in runnable_files(original, files).items()}
        check_outputs({spelt("out"): paths}, self.inputs, self.replace_existing, self.out)
        write_all(spelt("out"), paths, self.out)
        return list(paths)

    def _copy(self, backup: Backup, files: Files) -> list[Path]:
        """Write a copy of a backup with changed files; returns where these went."""
        from ..backup.copy import ARCHIVE, copy_of

        assert self.out is not None
        changed = {Path(file.name): file.data for file in files.values()}
        copy = copy_of(backup, changed, self.out)
        folder = None if self.out.suffix.lower() == ARCHIVE else self.out
        check_outputs({spelt("out"): copy.files}, self.inputs, self.replace_existing, folder)
        write_all(spelt("out"), copy.files, folder)
        return list(copy.changed)

    def _replace(self, files: Files, original: Program) -> list[Path]:
        from ...core.source.patch.edits import reading_of

        backup = _backup_of(files, original)
        if backup is not None and backup.unpacked is not None:
            raise InputError(
                f"{switched('in_place')}: {backup.source} is an archive, of which a copy "
                f"alone is written: name it, or a folder, by {spelt('out')}"
            )
        paths = {Path(file.name): file.data for file in files.values()}
        _check_unchanged(paths, reading_of(original).files)
        write_all(switched("in_place"), paths)
        return list(paths)


def _backup_of(files: Files, original: Program) -> Backup | None:
    """The backup that a program was read of, or that its file is, as a ``.urp`` for a robot that
    was named, if all its changed files are of it."""
    from ...core.source.patch.edits import reading_of
    from ..backup.finding import find_backup
    from ..catalogue import registry

    if not files:
        return None
    backup = getattr(original.setup, "backup", None)
    main = Path(reading_of(original).main)
    if backup is None and main.is_file():
        backup = find_backup(main, registry(), marked=True)
    if backup is None:
        return None
    own = all(Path(file.name).is_relative_to(backup.root) for file in files.values())
    return backup if own else None


def _check_unchanged(paths: Iterable[Path], read: Files) -> None:
    """Refuse to write over what somebody has saved since the files were read."""
    from ...core.files.reading import read_bytes
    from ...core.source.text.files import LARGEST_FILE

    in_place = switched("in_place")
    for path in paths:
        try:
            now = read_bytes(path, LARGEST_FILE)
        except InputError as error:
            raise InputError(f"{in_place}: {error}") from error
        if str(path) in read and now != read[str(path)].data:
            raise InputError(
                f"{in_place}: {path} has changed since it was read, and stays as it is: run again, "
                f"or name a folder by {spelt('out')}"
            )
