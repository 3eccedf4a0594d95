"""What handlers of instructions need of a run."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn, Protocol

from ....core.errors import Span
from ....core.source.execution.transcript import Transcript
from ..syntax.tree import Argument, Invoke
from ..values.evaluator import Evaluator
from ..values.scope import Scope
from ..values.types import Unknown


class Keeping(Protocol):
    """Evaluates arguments and keeps instructions as they stand."""

    evaluator: Evaluator

    def keep(self, statement: Invoke, scope: Scope) -> None:
        """Step over an instruction that does not move the robot; it stays as it stands."""


class Running(Protocol):
    """Evaluates arguments, notes, calls routines and ends the program."""

    evaluator: Evaluator
    out: Transcript

    def call_named(
        self,
        name: str,
        arguments: tuple[Argument, ...],
        scope: Scope,
        span: Span,
        unknown: Unknown | None = None,
    ) -> None:
        """Call the procedure that a string names."""

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""

    def book_error(self) -> float:
        """A number for an error of the program's own."""


KeepingHandler = Callable[[Keeping, Invoke, Scope], None]
RunningHandler = Callable[[Running, Invoke, Scope], None]
