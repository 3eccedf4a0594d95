"""A copy of a backup with changed files: every other file as it is, byte for byte."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from ...core.errors import InputError
from ...core.files.reading import read_bytes

if TYPE_CHECKING:
    from ...core.backup.backup import Backup

ARCHIVE = ".zip"
_LARGEST = 1_000_000_000
"""Bytes of one file."""


@dataclass(frozen=True)
class BackupCopy:
    """A copy of a backup.

    Args:
        files: contents of all of its files, by where they go.
        changed: those of them that are not as in the backup.
    """

    files: Mapping[Path, bytes]
    changed: tuple[Path, ...]


def copy_of(backup: Backup, changed: Mapping[Path, bytes], out: Path) -> BackupCopy:
    """A copy of a backup in which some files are others.

    Args:
        backup: of which it is one.
        changed: contents of these files, by their paths on disk.
        out: a folder, or the name of an archive if the backup is one.

    Returns:
        All files of what the user named as the backup, README and pictures included; of an archive
        one file; of a single file that one, what it is read with and what has changed around it.

    Raises:
        InputError: a folder cannot become an archive, the copy would lie in the backup itself, or
            a file cannot be read.
    """
    source = backup.source
    if out.suffix.lower() == ARCHIVE:
        if backup.unpacked is None:
            raise InputError(
                f"{out}: the backup {source} is no archive: name a folder for its copy"
            )
        packed = _repacked(backup.unpacked, source, changed)
        return BackupCopy({out: packed}, (out,))
    top = backup.unpacked or source
    if not top.is_dir():
        files = {out / path.relative_to(backup.root): data for path, data in changed.items()}
        return BackupCopy({**_beside(backup, out), **files}, tuple(files))
    _check_apart(top, out)
    known = {Path(os.path.abspath(path)): data for path, data in changed.items()}
    made: dict[Path, bytes] = {}
    others: list[Path] = []
    for path in _files_below(top):
        place = out / path.relative_to(top)
        data = known.get(Path(os.path.abspath(path)))
        made[place] = read_bytes(path, _LARGEST) if data is None else data
        others += [] if data is None else [place]
    return BackupCopy(made, tuple(others))


def _beside(backup: Backup, out: Path) -> dict[Path, bytes]:
    """The files that a single one is read with; those from above its folder beside it."""
    places = {}
    for name in (file for task in backup.tasks for file in task.files):
        path = backup.root / name
        place = PurePosixPath(name)
        if path.is_file():
            places[out / (place.name if ".." in place.parts else place)] = path
    return {place: read_bytes(path, _LARGEST) for place, path in places.items()}


def _files_below(top: Path) -> Iterator[Path]:
    """All files; links are passed over."""
    for folder, _, names in os.walk(top):
        for name in sorted(names):
            path = Path(folder) / name
            if not path.is_symlink():
                yield path


def _check_apart(source: Path, out: Path) -> None:
    """Refuse a copy in the original.

    Raises:
        InputError: it would be one.
    """
    real, other = (Path(os.path.realpath(path)) for path in (source, out))
    if other == real or other.is_relative_to(real):
        raise InputError(f"{out}: lies in the backup {source} itself; name another folder")


def _repacked(top: Path, source: Path, changed: Mapping[Path, bytes]) -> bytes:
    """An archive with other contents of some files; order, dates and packing stay."""
    others = {path.relative_to(top).as_posix(): data for path, data in changed.items()}
    data = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(read_bytes(source, _LARGEST))) as before,
        zipfile.ZipFile(data, "w") as after,
    ):
        after.comment = before.comment
        for info in before.infolist():
            name = info.filename.replace("\\", "/")
            content = others.get(name)
            after.writestr(info, before.read(info) if content is None else content)
    return data.getvalue()
