"""The files of an archive, found whatever the case of their names, and what is noted of them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from ....core.errors import FlybyError, Note, Span
from ....core.source.text.files import SourceFile, read_source
from ..data_list import DataList
from .marks import Layout, layout_of

MOST_FILES = 50_000
"""That are looked at; the largest archives seen have some 2000."""
_NAMED = 6
"""Names that a note has at most."""


class Notes:
    """What is left out of an archive, missing in it, or doubtful."""

    def __init__(self) -> None:
        self._notes: dict[Note, None] = {}

    def add(self, message: str, file: str | None = None, line: int = 1) -> None:
        """A note, once.

        Args:
            message: one sentence; it names the files that it is about, unless one line is.
            file: below the archive's root, with the line that the note is about.
            line: from 1.
        """
        span = None if file is None else Span(file, line, 1, 0, 0)
        self._notes.setdefault(Note(message, span=span))

    def all(self) -> tuple[Note, ...]:
        """In the order in which they were made."""
        return tuple(self._notes)


class Contents:
    """The files below an archive's root.

    Args:
        root: the folder on disk.
        notes: where it is said what cannot be read.
    """

    def __init__(self, root: Path, notes: Notes) -> None:
        self.root = root
        self.notes = notes
        self.names = _names(root, notes)
        self._folded = {name.casefold(): name for name in reversed(self.names)}
        self._sources: dict[str, SourceFile | None] = {}

    @cached_property
    def layout(self) -> Layout:
        """Where the parts are."""
        return layout_of(self.names)

    def find(self, *places: str | None) -> str | None:
        """A file by its place in whatever case; None if a part is None, or there is none."""
        if None in places:
            return None
        return self._folded.get("/".join(one for one in places if one).casefold())

    def called(self, name: str) -> list[str]:
        """The files of a name in whatever folder, the outermost first."""
        found = [one for one in self.names if one.casefold().rpartition("/")[2] == name]
        return sorted(found, key=lambda one: (one.count("/"), one.casefold()))

    def source(self, name: str) -> SourceFile | None:
        """A file as text, called as it is below the root; None, with a note, if it is none."""
        if name not in self._sources:
            try:
                self._sources[name] = replace(read_source(self.root / name), name=name)
            except FlybyError as error:
                self._sources[name] = None
                told = str(error).replace(f"{self.root}{os.sep}", "")
                self.notes.add(f"left out: {told}")
        return self._sources[name]

    def same(self, one: str, other: str) -> bool:
        """Whether two files have the same text."""
        texts = [
            None if (found := self.source(name)) is None else found.text for name in (one, other)
        ]
        return texts[0] == texts[1]

    def data(self, name: str | None) -> DataList | None:
        """A data list; None if there is none, or with a note if it cannot be read."""
        source = None if name is None else self.source(name)
        return None if source is None else DataList.of(source)


def listed(names: Iterable[str]) -> str:
    """Names for a note: ``a.src, b.src and 3 more``."""
    given = list(names)
    more = f" and {len(given) - _NAMED} more" if len(given) > _NAMED else ""
    return ", ".join(given[:_NAMED]) + more


def _names(root: Path, notes: Notes) -> list[str]:
    """Names below the root, with ``/`` between folders, sorted; hidden folders are passed over."""
    found: list[str] = []
    for folder, inner, files in os.walk(root):
        inner[:] = sorted(name for name in inner if not name.startswith("."))
        here = Path(folder).relative_to(root)
        found += [
            (here / name).as_posix() for name in files if not (Path(folder) / name).is_symlink()
        ]
        if len(found) > MOST_FILES:
            notes.add(f"only the first {MOST_FILES:,} files are looked at")
            break
    return sorted(found[:MOST_FILES])
