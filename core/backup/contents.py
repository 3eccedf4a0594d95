"""What openers of backups have in common: names of files, and notes on what is missing."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from ..errors import Note, Span

MOST_FILES = 50_000
"""That are looked at; the largest backups seen have some 2000."""
_NAMED = 6
"""Names that a note has at most."""


class BackupNotes:
    """What is left out of a backup, missing in it, or doubtful."""

    def __init__(self) -> None:
        self._notes: dict[Note, None] = {}

    def add(self, message: str, file: str | None = None, line: int = 1) -> None:
        """A note, once.

        Args:
            message: one sentence; it names the files that it is about, unless one line is.
            file: below the backup's root, with the line that the note is about.
            line: from 1.
        """
        span = None if file is None else Span(file, line, 1, 0, 0)
        self._notes.setdefault(Note(message, span=span))

    def all(self) -> tuple[Note, ...]:
        """In the order in which they were made."""
        return tuple(self._notes)


def listed(names: Iterable[str]) -> str:
    """Names for a note: ``a.mod, b.mod and 3 more``."""
    given = list(names)
    more = f" and {len(given) - _NAMED} more" if len(given) > _NAMED else ""
    return ", ".join(given[:_NAMED]) + more


def names_below(root: Path, notes: BackupNotes) -> list[str]:
    """Names of the files below a folder, with ``/`` between folders, sorted.

    Hidden folders and links are passed over; that there are too many is noted.
    """
    found: list[str] = []
    for folder, inner, files in os.walk(root):
        inner[:] = sorted(name for name in inner if not name.startswith("."))
        here = Path(folder)
        inside = here.relative_to(root)
        found += [(inside / name).as_posix() for name in files if not (here / name).is_symlink()]
        if len(found) > MOST_FILES:
            notes.add(f"only the first {MOST_FILES:,} files are looked at")
            break
    return sorted(found[:MOST_FILES])
