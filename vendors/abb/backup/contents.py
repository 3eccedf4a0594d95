"""The files of a backup, found whatever the case of their names, and what is noted of them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from ....core.errors import FlybyError, Note, Span
from ....core.files.reading import read_bytes
from ....core.source.text.files import LARGEST_FILE, SourceFile, source_of

MOST_FILES = 50_000
"""That are looked at; the largest backups seen have some 600."""
_NAMED = 6
"""Files that a note names at most."""
_CODED = (b"\xfc", b"\xfe")
"""First bytes of modules that a controller has encoded."""


class Notes:
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


class EncodedError(FlybyError):
    """A module is encoded: only the controller can read it."""


class Contents:
    """The files below a backup's root.

    Args:
        root: the folder on disk.
        notes: where it is said what cannot be read.
    """

    def __init__(self, root: Path, notes: Notes) -> None:
        self.root = root
        self.notes = notes
        self.names = _names(root, notes)
        self._folded = {name.casefold(): name for name in reversed(self.names)}

    def find(self, name: str) -> str | None:
        """A file by its name in a list, with ``/`` or ``\\``, in whatever case; None if absent."""
        return self._folded.get(name.replace("\\", "/").strip("/").casefold())

    def below(self, folder: str) -> list[str]:
        """All files below a folder, whatever the case of its name."""
        head = folder.casefold() + "/"
        return [name for name in self.names if name.casefold().startswith(head)]

    def source(self, name: str) -> SourceFile:
        """A file as text, called as it is below the root.

        Raises:
            EncodedError: it is encoded.
            FlybyError: it cannot be read, or is no text.
        """
        data = read_bytes(self.root / name, LARGEST_FILE)
        if data.startswith(_CODED):
            raise EncodedError(f"{name}: is encoded")
        return source_of(data, name)

    def text(self, name: str) -> str | None:
        """The text of a file if there is one; what keeps it from being read is noted."""
        found = self.find(name)
        if found is None:
            return None
        try:
            return self.source(found).text
        except FlybyError as error:
            self.notes.add(f"passed over: {error}".replace(f"{self.root}{os.sep}", ""))
            return None


def _names(root: Path, notes: Notes) -> list[str]:
    """Names below the root, with ``/`` between folders, sorted; hidden folders are passed over."""
    found: list[str] = []
    for folder, inner, files in os.walk(root):
        inner[:] = sorted(name for name in inner if not name.startswith("."))
        here = Path(folder).relative_to(root)
        found += [(here / name).as_posix() for name in files]
        if len(found) > MOST_FILES:
            notes.add(f"only the first {MOST_FILES:,} files are looked at")
            break
    return sorted(found[:MOST_FILES])


def listed(names: Iterable[str]) -> str:
    """Names for a note: ``a.mod, b.mod and 3 more``."""
    given = list(names)
    more = f" and {len(given) - _NAMED} more" if len(given) > _NAMED else ""
    return ", ".join(given[:_NAMED]) + more
