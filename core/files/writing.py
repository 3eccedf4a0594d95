"""Files that are written: all of a set or none, whatever ends the program in between.

A set is staged in hidden folders beside its files (`PREFIX`), each locked for as long as its
writer lives. When all of it is on the disk a journal says so, and only then do files change: those
that are replaced are moved away first, then the new ones come, so that old and new never stand side
by side. A set that was interrupted after its journal was written is finished, or taken back, by the
next run that reads or writes in one of its folders; before that, what was staged is thrown away.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import json
import os
import secrets
import shutil
import stat
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ..errors import InputError, Note
from .disk import WriteError, blaming, digest, open_folder, sync, there, write_new
from .journal import JOURNAL, OWNER, PREFIX, StagedFile, journal_of, put_in_place, take_back
from .recovery import recover


def write_file(path: Path, data: bytes) -> tuple[Note, ...]:
    """`write_files` of one file."""
    return write_files({path: data})


def write_files(files: Mapping[Path, bytes], made: Path | None = None) -> tuple[Note, ...]:
    """Write files so that all of them are there, whole, or none is.

    Links stay links to the files that are written; files keep their permissions.

    Args:
        files: contents by path.
        made: a folder that is made, with those in it, if it is missing; it goes again with files
            that cannot be written.

    Returns:
        What the user should know: files that have further names (hard links), which keep the old
        content.

    Raises:
        WriteError: one of them cannot be written; nothing has changed then.
        InputError: two of them are one, or an interrupted write stands in the way.
    """
    wanted: dict[Path, bytes] = {}
    for path, data in files.items():
        real = _real(path)
        if real in wanted:
            raise InputError(f"{path}: is to be written twice, under another name as well")
        wanted[real] = data
    for folder in dict.fromkeys(path.parent for path in wanted):
        recover(folder)
    notes = tuple(note for path in wanted for note in _checked(path))
    begun: list[Path] = []
    root = None if made is None else _real(made)
    try:
        with _Staged() as staged:
            entries = _stage(wanted, staged, root, begun)
            if len(entries) == 1:
                with blaming(entries[0].target):
                    os.replace(entries[0].new, entries[0].target)
                with contextlib.suppress(OSError):  # it has come to pass
                    sync(entries[0].target.parent)
            elif entries:
                _commit(entries)
    except BaseException:
        for folder in reversed(begun):
            with contextlib.suppress(OSError):
                os.rmdir(folder)
        raise
    return notes


class _Staged:
    """Staging folders, by the folder beside whose files they stand; gone at the end of a block.

    Those of a set whose journal is left stay for the next run.
    """

    def __init__(self) -> None:
        self.folders: dict[Path, Path] = {}
        self._locks: list[int] = []

    def beside(self, folder: Path) -> Path:
        """The staging folder, made and locked."""
        if folder not in self.folders:
            staging = folder / (PREFIX + secrets.token_hex(8))
            os.mkdir(staging, 0o700)
            self.folders[folder] = staging
            self._locks.append(open_folder(staging))
            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(self._locks[-1], fcntl.LOCK_EX | fcntl.LOCK_NB)
        return self.folders[folder]

    def __enter__(self) -> _Staged:
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):  # what is not known to be waste stays
            if not any(there(staging / JOURNAL) for staging in self.folders.values()):
                for staging in self.folders.values():
                    shutil.rmtree(staging, ignore_errors=True)
        for lock in self._locks:
            os.close(lock)


def _real(path: Path) -> Path:
    try:
        return Path(os.path.realpath(path))
    except (OSError, ValueError) as error:
        raise WriteError(path, str(error)) from None


def _checked(path: Path) -> Iterator[Note]:
    """Notes on a file that is to be replaced, if it can be."""
    try:
        state = os.stat(path)
    except FileNotFoundError:
        return
    except OSError as error:
        raise WriteError(path, error.strerror or str(error)) from None
    if not stat.S_ISREG(state.st_mode):
        raise WriteError(path, "it is no regular file")
    if state.st_nlink > 1:
        others = state.st_nlink - 1
        yield Note(
            f"{path}: the file has {others} other name{'s' if others > 1 else ''} (hard links), "
            "which keep the old content"
        )


def _stage(
    wanted: Mapping[Path, bytes], staged: _Staged, root: Path | None, begun: list[Path]
) -> list[StagedFile]:
    """All of a set on the disk, in staging folders."""
    entries = []
    for number, (path, data) in enumerate(wanted.items()):
        with blaming(path):
            if root is not None and path.is_relative_to(root):
                _make_folder(path.parent, begun)
            staging = staged.beside(path.parent)
            before = digest(path)
            entry = StagedFile(staging, number, path.name, hashlib.sha256(data).hexdigest(), before)
            write_new(entry.new, data)
            if before is not None:
                _take_permissions(path, entry.new)
            entries.append(entry)
    return entries


def _make_folder(folder: Path, begun: list[Path]) -> None:
    missing = []
    while not folder.is_dir():
        missing.append(folder)
        folder = folder.parent
    for one in reversed(missing):
        os.mkdir(one)
        begun.append(one)
        sync(one.parent)


def _take_permissions(before: Path, draft: Path) -> None:
    state = os.stat(before)
    with contextlib.suppress(PermissionError):  # only root gives files to others
        os.chown(draft, state.st_uid, state.st_gid)
    os.chmod(draft, stat.S_IMODE(state.st_mode))


def _commit(entries: Sequence[StagedFile]) -> None:
    """Put staged files in their places, with a journal for as long as not all are there."""
    primary = entries[0].staging
    stagings = dict.fromkeys(entry.staging for entry in entries)
    try:
        with blaming(entries[0].target):
            for staging in stagings:
                if staging != primary:
                    owner = {"owner": os.path.relpath(primary, staging.parent)}
                    write_new(staging / OWNER, json.dumps(owner).encode())
                sync(staging)
                sync(staging.parent)
            draft = primary / "journal.new"
            write_new(draft, journal_of(primary, entries))
            os.replace(draft, primary / JOURNAL)
            sync(primary)
        put_in_place(entries)
    except BaseException:
        take_back(entries)
        raise
    with contextlib.suppress(OSError):  # all is there; the next run cleans up
        os.unlink(primary / JOURNAL)
        sync(primary)
