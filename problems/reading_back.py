"""A changed program as it is read from its own text, as far as that has a place for the changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..core.errors import FlybyError, Note
from ..core.program.program import Program
from .changes import Change, changes_of, with_changes

ReadBack = Callable[[Program], Program]
"""Writes a program and reads what was written.

Raises:
    FlybyError: a change has no place in the text.
"""


@dataclass(frozen=True)
class Written:
    """A program as read.

    Args:
        program: from its text.
        refused: what stays as it was, as the text has no place for another value: (index of the
            move, "target", "speed" or "zone") → why.
    """

    program: Program
    refused: dict[tuple[int, str], str]

    @property
    def notes(self) -> tuple[Note, ...]:
        """One on each move that keeps something."""
        moves = self.program.moves
        return tuple(
            Note(f"its {part} stays as it is: {why}", i, moves[i].statement)
            for (i, part), why in sorted(self.refused.items())
        )


def read_as_written(given: Program, wanted: Program, read_back: ReadBack) -> Written:
    """A program as its text can say it: what has no place there stays as it was.

    Args:
        given: as its files say it now.
        wanted: the same moves with other targets, speeds or zones.
        read_back: see `ReadBack`; its last call is of the program that is returned.

    Raises:
        FlybyError: nothing of it can be written, or the moves are others.
    """
    try:
        return Written(read_back(wanted), {})
    except FlybyError:
        if [m.origin for m in given.moves] != [m.origin for m in wanted.moves]:
            raise
    search = _Search(given, wanted, read_back)
    kept = search.added([], changes_of(given, wanted))
    return Written(read_back(search.program(kept)), search.refused)


class _Search:
    """Which changes the text takes, by halving."""

    def __init__(self, given: Program, wanted: Program, read_back: ReadBack) -> None:
        self._given, self._wanted, self._read_back = given, wanted, read_back
        self.refused: dict[tuple[int, str], str] = {}

    def added(self, kept: list[Change], more: Sequence[Change]) -> list[Change]:
        """The changes kept, with those of some more that the text takes beside them."""
        if not more:
            return kept
        try:
            self._read_back(self.program([*kept, *more]))
        except FlybyError as error:
            if len(more) == 1:
                for i, part in more[0]:
                    why = getattr(error, "message", str(error)).removeprefix(f"{part}: ")
                    self.refused[i, part] = why
                return kept
        else:
            return [*kept, *more]
        half = len(more) // 2
        return self.added(self.added(kept, more[:half]), more[half:])

    def program(self, changes: Sequence[Change]) -> Program:
        return with_changes(self._given, self._wanted, changes)
