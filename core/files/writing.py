"""Files that are written: all of a set or none, whatever ends the program in between.

A set is staged in hidden folders beside its files (`PREFIX`), each locked for as long as its
writer lives. When all of it is on the disk a journal says so, and only then do files change: those
that are replaced are moved away first, then the new ones come, so that old and new never stand side
by side. A set that was interrupted after its journal was written is finished, or taken back, by the
next run that reads or writes in one of its folders; before that, what was staged is thrown away.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import hashlib
import json
import logging
import os
import secrets
import shutil
import stat
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import InputError, Note

PREFIX = ".flyby-write-"
"""Begins the names of staging folders."""
_JOURNAL, _OWNER = "journal.json", "owner.json"
_MOST_BYTES = 10_000_000
"""Of a journal; a larger one is none of ours."""
_log = logging.getLogger("flyby")


class WriteError(InputError):
    """A file cannot be written; then none of its set is.

    Args:
        path: the file.
        reason: why not.
    """

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: cannot be written: {reason}")


@dataclass(frozen=True)
class _Entry:
    """One file of a set: staged under a number in the staging folder beside it.

    Args:
        staging: that folder.
        number: of the file in it.
        name: of the file.
        digest: of what it is to hold.
        before: of what it held; None if it was not there.
    """

    staging: Path
    number: int
    name: str
    digest: str
    before: str | None

    @property
    def target(self) -> Path:
        return self.staging.parent / self.name

    @property
    def new(self) -> Path:
        return self.staging / f"{self.number}.new"

    @property
    def old(self) -> Path:
        return self.staging / f"{self.number}.old"


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
                with _blaming(entries[0].target):
                    os.replace(entries[0].new, entries[0].target)
                with contextlib.suppress(OSError):  # it has come to pass
                    _sync(entries[0].target.parent)
            elif entries:
                _commit(entries)
    except BaseException:
        for folder in reversed(begun):
            with contextlib.suppress(OSError):
                os.rmdir(folder)
        raise
    return notes


def recover(folder: Path) -> None:
    """Finish or take back what an interrupted write has left in a folder, and clean up after it.

    Raises:
        InputError: neither can be done; the message says which files are concerned.
    """
    try:
        with os.scandir(folder) as found:
            names = sorted(entry.name for entry in found if entry.name.startswith(PREFIX))
    except (OSError, ValueError):
        return
    for name in names:
        try:
            _recover(folder / name)
        except OSError as error:
            reason = error.strerror or error
            raise InputError(
                f"{folder / name}: here a write of files was interrupted, and what is left of it "
                f"cannot be looked at: {reason}"
            ) from None


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
            self._locks.append(_open_folder(staging))
            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(self._locks[-1], fcntl.LOCK_EX | fcntl.LOCK_NB)
        return self.folders[folder]

    def __enter__(self) -> _Staged:
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):  # what is not known to be waste stays
            if not any(_there(staging / _JOURNAL) for staging in self.folders.values()):
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
) -> list[_Entry]:
    """All of a set on the disk, in staging folders."""
    entries = []
    for number, (path, data) in enumerate(wanted.items()):
        with _blaming(path):
            if root is not None and path.is_relative_to(root):
                _make_folder(path.parent, begun)
            staging = staged.beside(path.parent)
            before = _digest(path)
            entry = _Entry(staging, number, path.name, hashlib.sha256(data).hexdigest(), before)
            _write_new(entry.new, data)
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
        _sync(one.parent)


def _take_permissions(before: Path, draft: Path) -> None:
    state = os.stat(before)
    with contextlib.suppress(PermissionError):  # only root gives files to others
        os.chown(draft, state.st_uid, state.st_gid)
    os.chmod(draft, stat.S_IMODE(state.st_mode))


def _commit(entries: Sequence[_Entry]) -> None:
    """Put staged files in their places, with a journal for as long as not all are there."""
    primary = entries[0].staging
    stagings = dict.fromkeys(entry.staging for entry in entries)
    try:
        with _blaming(entries[0].target):
            for staging in stagings:
                if staging != primary:
                    owner = {"owner": os.path.relpath(primary, staging.parent)}
                    _write_new(staging / _OWNER, json.dumps(owner).encode())
                _sync(staging)
                _sync(staging.parent)
            draft = primary / "journal.new"
            _write_new(draft, _journal(primary, entries))
            os.replace(draft, primary / _JOURNAL)
            _sync(primary)
        _put_in_place(entries)
    except BaseException:
        _take_back(entries)
        raise
    with contextlib.suppress(OSError):  # all is there; the next run cleans up
        os.unlink(primary / _JOURNAL)
        _sync(primary)


def _journal(primary: Path, entries: Sequence[_Entry]) -> bytes:
    told = [
        {
            "staging": os.path.relpath(entry.staging, primary.parent),
            "number": entry.number,
            "name": entry.name,
            "digest": entry.digest,
            "before": entry.before,
        }
        for entry in entries
    ]
    return json.dumps(told, indent=1).encode()


def _put_in_place(entries: Sequence[_Entry]) -> None:
    """Old files go, then new ones come; those that have come already stay."""
    with _blaming(entries[0].target):
        pending = [entry for entry in entries if _there(entry.new)]
    for entry in pending:
        with _blaming(entry.target):
            if _there(entry.target):
                os.rename(entry.target, entry.old)
    for entry in pending:
        with _blaming(entry.target):
            os.rename(entry.new, entry.target)
    for folder in dict.fromkeys(entry.target.parent for entry in entries):
        with _blaming(folder):
            _sync(folder)


def _take_back(entries: Sequence[_Entry]) -> None:
    """New files go, then the old ones come back, and with them the journal goes.

    Raises:
        InputError: the disk does not let it; the next run will try again.
    """
    try:
        for entry in entries:
            if not _there(entry.new) and _there(entry.target):
                os.rename(entry.target, entry.new)
        for entry in entries:
            if _there(entry.old):
                os.rename(entry.old, entry.target)
        for folder in dict.fromkeys(entry.target.parent for entry in entries):
            _sync(folder)
        primary = entries[0].staging
        if _there(primary / _JOURNAL):
            os.unlink(primary / _JOURNAL)
            _sync(primary)
    except OSError as error:
        raise _unfinished(entries, error.strerror or str(error)) from None


def _recover(staging: Path) -> None:
    """See `recover`, of one staging folder."""
    if staging.is_symlink() or not staging.is_dir():
        return
    with _held(staging) as free:
        if not free:
            return
        primary = _primary(staging)
        if primary == staging:
            _recover_set(staging)
            return
    if primary is not None and primary.is_dir() and not primary.is_symlink():
        with _held(primary) as free:
            if not free:
                return
            if _there(primary / _JOURNAL):
                _recover_set(primary)
                return
    shutil.rmtree(staging, ignore_errors=True)


def _recover_set(primary: Path) -> None:
    """Finish or take back the set of a journal; without a journal, clean up."""
    if _there(primary / _JOURNAL):
        if os.stat(primary).st_uid != os.geteuid():
            raise InputError(
                f"{primary}: another user's write of files was interrupted here; let that user "
                "run flyby again, or delete the folder if its files are of no use"
            )
        entries = _entries(primary)
        names = ", ".join(str(entry.target) for entry in entries)
        try:
            how = _resolve(entries)
        except OSError as error:
            raise _unfinished(entries, error.strerror or str(error)) from None
        if how:
            _log.warning("a write of %s was interrupted, and has been %s", names, how)
        for entry in entries:
            if entry.staging != primary:
                shutil.rmtree(entry.staging, ignore_errors=True)
    shutil.rmtree(primary, ignore_errors=True)


def _resolve(entries: Sequence[_Entry]) -> str:
    """Bring a set to an end; returns how, nothing if all of it had come to pass."""
    pending = [entry for entry in entries if _there(entry.new)]
    for entry in pending:
        now = _digest(entry.target)
        if now is not None and (now != entry.before or _there(entry.old)):
            raise _unfinished(entries, f"{entry.target} has been changed since")
    primary = entries[0].staging
    how = ""
    if all(_digest(entry.new) == entry.digest for entry in pending):
        if pending:
            _put_in_place(entries)
            how = "finished: the new files are there"
    elif all(entry.before is None or _stands(entry) for entry in entries):
        _take_back(entries)
        how = "taken back: the files are as they were"
    else:
        raise _unfinished(entries, "neither the new nor the old files are whole")
    with contextlib.suppress(FileNotFoundError):
        os.unlink(primary / _JOURNAL)
    _sync(primary)
    return how


def _stands(entry: _Entry) -> bool:
    """Whether what a file held is there to be put back."""
    return entry.before in (_digest(entry.old), _digest(entry.target))


def _unfinished(entries: Sequence[_Entry], reason: str) -> InputError:
    names = ", ".join(str(entry.target) for entry in entries)
    where = ", ".join(str(staging) for staging in dict.fromkeys(e.staging for e in entries))
    return InputError(
        f"a write of {names} was interrupted and can be neither finished nor taken back: {reason}. "
        f"The new files are *.new, the earlier ones *.old in {where} (journal.json there says "
        "which): put in place what is right, delete these folders and run again"
    )


def _entries(primary: Path) -> list[_Entry]:
    """The files of a journal; each must be beside a staging folder of this very set.

    A folder may come from anywhere (a stick), and so may a journal: it never reaches files of
    other folders.
    """
    misshapen = InputError(
        f"{primary}: what an interrupted write has left here is not to be understood; see which "
        "files beside it are right, then delete this folder"
    )
    rows = _json(primary / _JOURNAL)
    if not isinstance(rows, list) or not rows:
        raise misshapen
    known = {"staging": str, "number": int, "name": str, "digest": str}
    entries = []
    for row in rows:
        if not isinstance(row, dict) or any(not isinstance(row.get(k), known[k]) for k in known):
            raise misshapen
        staging = Path(os.path.normpath(primary.parent / row["staging"]))
        before, name = row.get("before"), row["name"]
        if not (
            staging.name.startswith(PREFIX)
            and not staging.is_symlink()
            and (staging == primary or _primary(staging) == primary)
            and name == os.path.basename(name)
            and name not in ("", ".", "..")
            and "\0" not in name
            and (before is None or isinstance(before, str))
        ):
            raise misshapen
        entries.append(_Entry(staging, row["number"], name, row["digest"], before))
    return entries


def _primary(staging: Path) -> Path | None:
    """The staging folder with the journal of the set that a staging folder belongs to."""
    if not _there(staging / _OWNER):
        return staging
    told = _json(staging / _OWNER)
    owner = told.get("owner") if isinstance(told, dict) else None
    if not isinstance(owner, str) or "\0" in owner:
        return None
    found = Path(os.path.normpath(staging.parent / owner))
    return found if found.name.startswith(PREFIX) else None


def _json(file: Path) -> Any:
    """What a small file of ours holds; None if it does not."""
    try:
        if not stat.S_ISREG(os.lstat(file).st_mode) or os.stat(file).st_size > _MOST_BYTES:
            return None
        with open(file, "rb") as stream:
            return json.loads(stream.read())
    except (OSError, ValueError, RecursionError):
        return None


@contextlib.contextmanager
def _held(staging: Path) -> Iterator[bool]:
    """Whether a staging folder's writer is gone; it is ours for as long as the block lasts."""
    try:
        lock = _open_folder(staging)
    except OSError:
        yield False
        return
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
        except OSError:
            yield True
        else:
            yield True
    finally:
        os.close(lock)


@contextlib.contextmanager
def _blaming(path: Path) -> Iterator[None]:
    """Say which file it is that cannot be written."""
    try:
        yield
    except OSError as error:
        raise WriteError(path, error.strerror or str(error)) from None


def _there(path: Path) -> bool:
    """Whether a name stands for anything; where the disk cannot tell, neither can this."""
    try:
        os.lstat(path)
    except (FileNotFoundError, NotADirectoryError):
        return False
    return True


def _digest(path: Path) -> str | None:
    """Of a file's content; None if there is none, nothing if it is no file."""
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):
            return ""
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except FileNotFoundError:
        return None


def _write_new(path: Path, data: bytes) -> None:
    with open(path, "xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def _open_folder(folder: Path) -> int:
    return os.open(folder, os.O_RDONLY | os.O_DIRECTORY)


def _sync(folder: Path) -> None:
    """Have what happened in a folder on the disk, where the file system can say so of folders."""
    try:
        descriptor = _open_folder(folder)
    except PermissionError:  # a folder to write in, not to be listed
        return
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):
            raise
    finally:
        os.close(descriptor)
