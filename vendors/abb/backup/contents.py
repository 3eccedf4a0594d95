"""The files of a backup, found whatever the case of their names, and what is noted of them."""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path

from ....core.backup.contents import BackupNotes, names_below
from ....core.errors import FlybyError
from ....core.files.reading import read_bytes
from ....core.source.text.files import LARGEST_FILE, SourceFile, source_of

_CODED = (b"\xfc", b"\xfe")
"""First bytes of modules that a controller has encoded."""


class EncodedError(FlybyError):
    """A module is encoded: only the controller can read it."""


class Contents:
    """The files below a backup's root.

    Args:
        root: the folder on disk.
        notes: where it is said what cannot be read.
    """

    def __init__(self, root: Path, notes: BackupNotes) -> None:
        self.root = root
        self.notes = notes
        self.names = names_below(root, notes)
        self._folded = {name.casefold(): name for name in reversed(self.names)}

    def find(self, name: str) -> str | None:
        """A file by its name in a list, with ``/`` or ``\\``, in whatever case; None if absent."""
        return self._folded.get(name.replace("\\", "/").strip("/").casefold())

    def task(self, folder: str) -> str:
        """Where a task's folder is: below ``RAPID``, or where that was not copied, the root, which
        the folder of a task without a name is as well."""
        return folder if self._without_rapid or not folder else f"RAPID/{folder}"

    @cached_property
    def _without_rapid(self) -> bool:
        return not any(name.startswith("rapid/") for name in self._folded)

    def below(self, folder: str) -> list[str]:
        """All files below a folder, whatever the case of its name; ``""`` for the root."""
        head = f"{folder.casefold()}/" if folder else ""
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
