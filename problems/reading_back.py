"""A changed program as it is read from its own text, as far as that has a place for the changes."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace

from ..core.errors import FlybyError, Note
from ..core.program.move import Move
from ..core.program.origin import Origin
from ..core.program.program import Program

ReadBack = Callable[[Program], Program]
"""Writes a program and reads what was written.

Raises:
    FlybyError: a change has no place in the text.
"""
_PARTS = ("target", "speed", "zone")


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
    kept = search.added([], search.changes())
    return Written(read_back(search.program(kept)), search.refused)


_Change = tuple[tuple[int, str], ...]
"""Parts of moves that are one datum: (index of the move, name of the part)."""


class _Search:
    """Which changes the text takes, by halving."""

    def __init__(self, given: Program, wanted: Program, read_back: ReadBack) -> None:
        self._given, self._wanted, self._read_back = given, wanted, read_back
        self.refused: dict[tuple[int, str], str] = {}

    def changes(self) -> list[_Change]:
        """All of them, those together that stand in one place."""
        found: dict[Hashable, list[tuple[int, str]]] = {}
        pairs = zip(self._given.moves, self._wanted.moves, strict=True)
        for i, (old, new) in enumerate(pairs):
            for part in _PARTS:
                if getattr(old, part) != getattr(new, part):
                    found.setdefault((part, _place(old, i, part)), []).append((i, part))
        return [tuple(change) for change in found.values()]

    def added(self, kept: list[_Change], more: Sequence[_Change]) -> list[_Change]:
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

    def program(self, changes: Sequence[_Change]) -> Program:
        """The program as it was with these changes."""
        moves = list(self._given.moves)
        for change in changes:
            for i, part in change:
                values = {part: getattr(self._wanted.moves[i], part)}
                moves[i] = replace(moves[i], **values)
        return self._given.with_moves(tuple(moves))


def _place(move: Move, index: int, part: str) -> Hashable:
    if move.origin is None:
        return index
    origin: Origin = getattr(move.origin, part)
    return origin.numbers or (origin.span, move.origin.statement)
