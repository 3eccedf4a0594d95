"""ERROR handlers: what a routine does about an error that the program makes while it runs.

Only errors that follow from the text are made here: RAISE, a division by zero, an index outside an
array, an argument that was not given, a routine that nobody declares. Those of the world (a part
that is not there, a time that is over) do not come, as waits are satisfied at once.

"RAPID Reference Manual", basic elements, error recovery: RETRY runs the statement again, TRYNEXT
goes on behind it, RETURN and the end of the handler leave the routine, RAISE hands the error to the
caller's handler. What nobody handles stops the program.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NoReturn, Protocol

from ....core.source.execution.transcript import Transcript
from ..syntax.tree import Block, Keyword, Routine, Statement
from ..values.errors import LONG_JUMP, NUMBERS, TOO_MANY_RETRIES, ProgramError
from ..values.evaluator import Evaluator
from ..values.scope import Scope

RETRIES = 4
"""How often a statement is tried again: the controller's default (system parameter NoOfRetry)."""


class Retry(Exception):
    """RETRY"""


class TryNext(Exception):
    """TRYNEXT"""


@dataclass(eq=False, slots=True)
class Frame:
    """A routine that is run.

    Attributes:
        error: that its handler is run for.
        tried: how often statements were tried again, by their ids.
    """

    routine: Routine
    scope: Scope
    error: ProgramError | None = None
    tried: dict[int, int] = field(default_factory=dict)


class Recovering(Protocol):
    """What handlers need of a run."""

    evaluator: Evaluator
    out: Transcript

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""

    def set_error(self, number: float) -> None:
        """What ``ERRNO`` holds."""

    def leave(self) -> NoReturn:
        """RETURN without a value."""


def recover(run: Recovering, frame: Frame, statement: Statement, error: ProgramError) -> bool:
    """Run the handler of the routine in which a statement made an error.

    Returns:
        Whether the statement is to be run again; else the next one is.

    Raises:
        ProgramError: the routine has no handler for it, or hands it on.
    """
    handler = frame.routine.handler
    if error.passed is frame or frame.error is not None or handler is None:
        raise error
    if handler.numbers and not _takes(run, frame, error):
        error.passed = frame
        raise error
    frame.error = error
    run.set_error(error.number)
    try:
        run.run_block(handler.body, frame.scope)
    except Retry:
        tried = frame.tried[id(statement)] = frame.tried.get(id(statement), 0) + 1
        if tried <= RETRIES:
            return True
        message = f"tried again {RETRIES} times in vain: {_bare(error)}"
        again = ProgramError(message, statement.span, NUMBERS[TOO_MANY_RETRIES])
        again.passed = frame
        raise again from None
    except TryNext:
        return False
    finally:
        frame.error = None
        run.set_error(0.0)
    run.out.notes.count(
        f"{_bare(error)}: the ERROR handler of {frame.routine.text} ends without RETRY or TRYNEXT, "
        "and the routine is left here",
        statement.span,
    )
    run.leave()


def raised(run: Recovering, frame: Frame | None, statement: Keyword, scope: Scope) -> ProgramError:
    """The error of a RAISE, to be raised."""
    handled = frame.error if frame is not None else None
    if statement.value is None and handled is None:
        return ProgramError("RAISE without a number stands outside a handler", statement.span, 0.0)
    if statement.value is None:
        assert handled is not None
        handled.passed = frame
        return handled
    number = run.evaluator.number(statement.value, scope, "RAISE")
    message = f"RAISE: no ERROR handler takes the error {number:g}, and the program stops"
    error = ProgramError(message, statement.span, number)
    if handled is not None:
        error.passed = frame
    return error


def _takes(run: Recovering, frame: Frame, error: ProgramError) -> bool:
    handler = frame.routine.handler
    assert handler is not None
    values = [run.evaluator.evaluate(number, frame.scope) for number in handler.numbers]
    return error.number in values or NUMBERS[LONG_JUMP] in values


def _bare(error: ProgramError) -> str:
    """The message without its place."""
    return str(error).removeprefix(f"{error.span}: ")
