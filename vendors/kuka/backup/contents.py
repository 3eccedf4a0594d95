"""The files of an archive, found whatever the case of their names, and what is noted of them."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from ....core.backup.contents import BackupNotes, names_below
from ....core.errors import FlybyError
from ....core.source.text.files import SourceFile, read_source
from ..data_list import DataList
from .marks import Layout, layout_of


class Contents:
    """The files below an archive's root.

    Args:
        root: the folder on disk.
        notes: where it is said what cannot be read.
    """

    def __init__(self, root: Path, notes: BackupNotes) -> None:
        self.root = root
        self.notes = notes
        self.names = names_below(root, notes)
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
