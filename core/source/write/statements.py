"""A program's statements, one after the other, as lines of its language."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from ...errors import InputError, MotionError
from ...program.move import Move, Opaque, Wait
from ...program.program import Program

Line = TypeVar("Line")


def lines_of_statements(
    program: Program,
    wait: Callable[[Wait], Iterable[Line]],
    opaque: Callable[[Opaque], Iterable[Line]],
    move: Callable[[Move, int], Iterable[Line]],
) -> list[Line]:
    """The lines of all statements.

    Args:
        wait, opaque: the lines of statements that are no moves.
        move: those of a move with its index, and of what must be said before it; what the language
            cannot say it refuses (`InputError`).

    Raises:
        MotionError: the language cannot say a move; it is named by number.
    """
    lines: list[Line] = []
    index = 0
    for statement in program.statements:
        if isinstance(statement, Wait):
            lines += [] if statement.device else wait(statement)
        elif isinstance(statement, Opaque):
            lines += opaque(statement)
        else:
            try:
                lines += move(statement, index)
            except MotionError:
                raise
            except InputError as error:
                span = None if statement.origin is None else statement.origin.statement
                raise MotionError(str(error), index, span) from None
            index += 1
    return lines
