"""What could not be carried over, collected with its move and line during a translation."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import Note, Span
from ..program.program import Program


class Losses:
    """Notes on the source program.

    Args:
        program: the source, whose moves and lines are named.
    """

    def __init__(self, program: Program) -> None:
        self._program = program
        self._told: dict[tuple[object, ...], tuple[Note, float]] = {}
        self._unmapped: dict[str, str] = {}

    def at(self, move: int, message: str, kind: str | None = None, size: float = 0.0) -> None:
        """Something that move ``move`` of the source loses.

        Args:
            kind: of losses that a line in a loop has every time, in another size: the largest is
                told. None for the message itself.
        """
        span = self._program.moves[move].statement
        key = (kind or message, span or move)
        self._add(key, Note(message, move, span), size)

    def statement(self, span: Span | None, message: str) -> None:
        """Something that a statement that is no move loses."""
        self._add((message, span), Note(message, None, span), 0.0)

    def unmapped(self, name: str, example: str) -> None:
        """A signal of which nobody says what it is called on the new robot.

        Args:
            example: what it may be called there.
        """
        self._unmapped.setdefault(name, example)

    def signals_to_map(self) -> dict[str, str]:
        """All such signals, with examples, in the order of the program."""
        return dict(self._unmapped)

    def sorted(self) -> tuple[Note, ...]:
        """In the order of the program's text; what a line loses every time is listed once."""
        return tuple(sorted((note for note, _ in self._told.values()), key=_place))

    def _add(self, key: tuple[object, ...], note: Note, size: float) -> None:
        if key not in self._told or size > self._told[key][1]:
            self._told[key] = note, size

    def through(self, moves: Sequence[int]) -> LossesOfPart:
        """The same losses for a program that keeps only some of the moves.

        Args:
            moves: the source's index of each move that is kept.
        """
        return LossesOfPart(self, moves)


class LossesOfPart:
    """Losses of a program whose moves are some of the source's."""

    def __init__(self, losses: Losses, moves: Sequence[int]) -> None:
        self._losses = losses
        self._moves = moves

    def at(self, move: int, message: str, kind: str | None = None, size: float = 0.0) -> None:
        """Something that move ``move`` of the part loses; see `Losses.at`."""
        self._losses.at(self._moves[move], message, kind, size)


def _place(note: Note) -> tuple[str, int, int]:
    span, move = note.span, -1 if note.move is None else note.move
    return ("", 0, move) if span is None else (span.file, span.start, move)
