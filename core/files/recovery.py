"""What an interrupted write has left: finished, or taken back."""

from __future__ import annotations

import contextlib
import fcntl
import logging
import os
import shutil
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from ..errors import InputError
from .disk import digest, open_folder, sync, there
from .journal import (
    JOURNAL,
    PREFIX,
    StagedFile,
    entries_of,
    primary_of,
    put_in_place,
    stands,
    take_back,
    unfinished,
)

_log = logging.getLogger("flyby")

_CLEAN: dict[tuple[int, int], tuple[int, int]] = {}
"""Folders without what a write has left, and when they were changed: a folder of hundreds of files
is not looked through for each of them."""
_MOST_CLEAN = 10_000
_STEADY = 3 * 10**9
"""ns after which a folder that is changed again has another time, on any disk."""


def recover(folder: Path) -> None:
    """Finish or take back what an interrupted write has left in a folder, and clean up after it.

    Raises:
        InputError: neither can be done; the message says which files are concerned.
    """
    try:
        state = os.stat(folder)
        place, changed = (state.st_dev, state.st_ino), (state.st_mtime_ns, state.st_ctime_ns)
        if _CLEAN.get(place) == changed:
            return
        with os.scandir(folder) as found:
            names = sorted(entry.name for entry in found if entry.name.startswith(PREFIX))
    except (OSError, ValueError):
        return
    if not names and time.time_ns() - max(changed) > _STEADY:
        if len(_CLEAN) == _MOST_CLEAN:
            _CLEAN.clear()
        _CLEAN[place] = changed
    for name in names:
        try:
            _recover(folder / name)
        except OSError as error:
            reason = error.strerror or error
            raise InputError(
                f"{folder / name}: here a write of files was interrupted, and what is left of it "
                f"cannot be looked at: {reason}"
            ) from None


def _recover(staging: Path) -> None:
    """See `recover`, of one staging folder."""
    if staging.is_symlink() or not staging.is_dir():
        return
    with _held(staging) as free:
        if not free:
            return
        primary = primary_of(staging)
        if primary == staging:
            _recover_set(staging)
            return
    if primary is not None and primary.is_dir() and not primary.is_symlink():
        with _held(primary) as free:
            if not free:
                return
            if there(primary / JOURNAL):
                _recover_set(primary)
                return
    shutil.rmtree(staging, ignore_errors=True)


def _recover_set(primary: Path) -> None:
    """Finish or take back the set of a journal; without a journal, clean up."""
    if there(primary / JOURNAL):
        if os.stat(primary).st_uid != os.geteuid():
            raise InputError(
                f"{primary}: another user's write of files was interrupted here; let that user "
                "run flyby again, or delete the folder if its files are of no use"
            )
        entries = entries_of(primary)
        names = ", ".join(str(entry.target) for entry in entries)
        try:
            how = _resolve(entries)
        except OSError as error:
            raise unfinished(entries, error.strerror or str(error)) from None
        if how:
            _log.warning("a write of %s was interrupted, and has been %s", names, how)
        for entry in entries:
            if entry.staging != primary:
                shutil.rmtree(entry.staging, ignore_errors=True)
    shutil.rmtree(primary, ignore_errors=True)


def _resolve(entries: Sequence[StagedFile]) -> str:
    """Bring a set to an end; returns how, nothing if all of it had come to pass."""
    pending = [entry for entry in entries if there(entry.new)]
    for entry in pending:
        now = digest(entry.target)
        if now is not None and (now != entry.before or there(entry.old)):
            raise unfinished(entries, f"{entry.target} has been changed since")
    primary = entries[0].staging
    how = ""
    if all(digest(entry.new) == entry.digest for entry in pending):
        if pending:
            put_in_place(entries)
            how = "finished: the new files are there"
    elif all(entry.before is None or stands(entry) for entry in entries):
        take_back(entries)
        how = "taken back: the files are as they were"
    else:
        raise unfinished(entries, "neither the new nor the old files are whole")
    with contextlib.suppress(FileNotFoundError):
        os.unlink(primary / JOURNAL)
    sync(primary)
    return how


@contextlib.contextmanager
def _held(staging: Path) -> Iterator[bool]:
    """Whether a staging folder's writer is gone; it is ours for as long as the block lasts."""
    try:
        lock = open_folder(staging)
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
