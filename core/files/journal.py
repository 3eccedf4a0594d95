"""The journal of a set of files: what is staged for which of them, and how they change places."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import InputError
from .disk import blaming, digest, sync, there

PREFIX = ".flyby-write-"
"""Begins the names of staging folders."""
JOURNAL, OWNER = "journal.json", "owner.json"
_MOST_BYTES = 10_000_000
"""Of a journal; a larger one is none of ours."""


@dataclass(frozen=True)
class StagedFile:
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
        """Where the file belongs."""
        return self.staging.parent / self.name

    @property
    def new(self) -> Path:
        """Where its new content is staged."""
        return self.staging / f"{self.number}.new"

    @property
    def old(self) -> Path:
        """Where its old content is kept meanwhile."""
        return self.staging / f"{self.number}.old"


def journal_of(primary: Path, entries: Sequence[StagedFile]) -> bytes:
    """What the journal in a staging folder says of a set."""
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


def entries_of(primary: Path) -> list[StagedFile]:
    """The files of a journal; each must be beside a staging folder of this very set.

    A folder may come from anywhere (a stick), and so may a journal: it never reaches files of
    other folders.
    """
    misshapen = InputError(
        f"{primary}: what an interrupted write has left here is not to be understood; see which "
        "files beside it are right, then delete this folder"
    )
    rows = _json(primary / JOURNAL)
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
            and (staging == primary or primary_of(staging) == primary)
            and name == os.path.basename(name)
            and name not in ("", ".", "..")
            and "\0" not in name
            and (before is None or isinstance(before, str))
        ):
            raise misshapen
        entries.append(StagedFile(staging, row["number"], name, row["digest"], before))
    return entries


def primary_of(staging: Path) -> Path | None:
    """The staging folder with the journal of the set that a staging folder belongs to."""
    if not there(staging / OWNER):
        return staging
    told = _json(staging / OWNER)
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


def put_in_place(entries: Sequence[StagedFile]) -> None:
    """Old files go, then new ones come; those that have come already stay."""
    with blaming(entries[0].target):
        pending = [entry for entry in entries if there(entry.new)]
    for entry in pending:
        with blaming(entry.target):
            if there(entry.target):
                os.rename(entry.target, entry.old)
    for entry in pending:
        with blaming(entry.target):
            os.rename(entry.new, entry.target)
    for folder in dict.fromkeys(entry.target.parent for entry in entries):
        with blaming(folder):
            sync(folder)


def take_back(entries: Sequence[StagedFile]) -> None:
    """New files go, then the old ones come back, and with them the journal goes.

    Raises:
        InputError: the disk does not let it; the next run will try again.
    """
    try:
        for entry in entries:
            if not there(entry.new) and there(entry.target):
                os.rename(entry.target, entry.new)
        for entry in entries:
            if there(entry.old):
                os.rename(entry.old, entry.target)
        for folder in dict.fromkeys(entry.target.parent for entry in entries):
            sync(folder)
        primary = entries[0].staging
        if there(primary / JOURNAL):
            os.unlink(primary / JOURNAL)
            sync(primary)
    except OSError as error:
        raise unfinished(entries, error.strerror or str(error)) from None


def stands(entry: StagedFile) -> bool:
    """Whether what a file held is there to be put back."""
    return entry.before in (digest(entry.old), digest(entry.target))


def unfinished(entries: Sequence[StagedFile], reason: str) -> InputError:
    """The error that a set can be neither finished nor taken back."""
    names = ", ".join(str(entry.target) for entry in entries)
    where = ", ".join(str(staging) for staging in dict.fromkeys(e.staging for e in entries))
    return InputError(
        f"a write of {names} was interrupted and can be neither finished nor taken back: {reason}. "
        f"The new files are *.new, the earlier ones *.old in {where} (journal.json there says "
        "which): put in place what is right, delete these folders and run again"
    )
