"""A program's statements, one after the other, as lines of its language."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from ...errors import InputError, MotionError
from ...program.move import Move, Opaque, Statement, Wait
from ...program.places import Destination
from ...program.program import Program
from .structure import Structure

Line = TypeVar("Line")


def lines_of_statements(
    program: Program,
    wait: Callable[[Wait], Iterable[Line]],
    opaque: Callable[[Opaque], Iterable[Line]],
    move: Callable[[Move, int, tuple[Destination, ...]], Iterable[Line]],
    structure: Structure[Line] | None = None,
) -> list[Line]:
    """The lines of all statements.

    Args:
        wait, opaque: the lines of statements that are no moves.
        move: those of a move with its index and its places, where loops and routines move it on,
            and of what must be said before it; what the language cannot say it refuses
            (`InputError`).
        structure: writes loops and routines; None for all statements one after the other.

    Raises:
        MotionError: the language cannot say a move; it is named by number.
    """

    def said(
        statement: Statement, index: int, places: tuple[Destination, ...] = ()
    ) -> Iterable[Line]:
        if isinstance(statement, Wait):
            return () if statement.device else wait(statement)
        if isinstance(statement, Opaque):
            return opaque(statement)
        try:
            return list(move(statement, index, places))
        except MotionError:
            raise
        except InputError as error:
            raise MotionError(str(error), index, statement.statement) from None

    if structure is not None:
        return structure.lines(program, said)
    lines: list[Line] = []
    index = 0
    for statement in program.statements:
        lines += said(statement, index)
        index += not isinstance(statement, Wait | Opaque)
    return lines
