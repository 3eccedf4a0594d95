"""The source files of a page, and where in them things stand."""

from __future__ import annotations

import re
from pathlib import PurePath
from typing import TYPE_CHECKING

from ...core.errors import Span
from ...core.program.program import Program
from ...core.source.reading import Reading
from ...drawing.page.content import (
    PageSource,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

_ENDS = re.compile(r"\r\n?|\n")
_LARGEST = 400_000
"""Characters of a file above which a page has the lines round its moves alone."""


class SourceList:
    """Collects the files of one or several programs in the order in which they are needed."""

    def __init__(self) -> None:
        self._places: dict[tuple[int, str], int] = {}
        self._made: list[PageSource] = []

    @property
    def made(self) -> list[PageSource]:
        """The files."""
        return self._made

    def add(self, program: Program, track: int, moved: Iterable[Span | None]) -> None:
        """Add the files of a program in which something stands that the page shows.

        Args:
            program: that was read; one that was built in Python has none.
            track: that runs it.
            moved: where these things stand.
        """
        reading = program.reading
        if not isinstance(reading, Reading):
            return
        used = [span.file for span in moved if span is not None]
        order = dict.fromkeys([reading.main, *used])
        for name in order:
            file = reading.files.get(name)
            if file is None:
                file = next((f for f in reading.files.values() if f.name == name), None)
            if file is not None and (track, name) not in self._places:
                self._places[track, name] = len(self._made)
                text = _ENDS.sub("\n", file.text)
                self._made.append(PageSource(PurePath(name).name, text, track))

    def place(self, track: int, span: Span | None) -> tuple[int, int]:
        """Index of the file and line of a place; -1 and 0 where it has none."""
        if span is None:
            return -1, 0
        found = self._places.get((track, span.file), -1)
        return (found, span.line) if found >= 0 else (-1, 0)
