"""Procedures that are called by their names: ``%"routine"%``, ``CallByVar``."""

from __future__ import annotations

from typing import Protocol

from ....core.errors import Span
from ....core.source.execution.course import Course
from ....core.source.execution.transcript import Transcript
from ..syntax import tree
from ..values.data import Globals
from ..values.errors import NO_ROUTINE, NUMBERS, ProgramError
from ..values.evaluator import Evaluator
from ..values.scope import Scope, unknown_name
from ..values.types import STRING, Unknown, Value


class LateRun(Protocol):
    """What it takes to call a procedure by its name."""

    data: Globals
    course: Course
    out: Transcript
    evaluator: Evaluator

    def text_of(self, expression: tree.Expression) -> str:
        """An expression as it stands, on one line."""

    def call(
        self, routine: tree.Routine, arguments: tuple[tree.Argument, ...], caller: Scope, span: Span
    ) -> Value | None:
        """Run a routine."""


def call_late(run: LateRun, statement: tree.LateInvoke, scope: Scope) -> None:
    """Call the procedure that an expression names.

    Raises:
        SourceError: there is none.
    """
    value = run.evaluator.evaluate(statement.routine, scope)
    if isinstance(value, Unknown) and run.course.skips(
        run.text_of(statement.routine), statement.span
    ):
        run.evaluator.outputs.forget()
        run.out.keep(statement.span, "a call by name", "", device=True)
        return
    name = run.evaluator.known(statement.routine, scope, STRING, "the routine to call")
    assert isinstance(name, str)
    call_named(run, name, statement.arguments, scope, statement.span)


def call_named(
    run: LateRun, name: str, arguments: tuple[tree.Argument, ...], scope: Scope, span: Span
) -> None:
    """Call the procedure that a string names, by itself or as ``module:procedure``.

    Raises:
        SourceError: there is none.
    """
    module, _, own = (part.strip().lower() for part in name.rpartition(":"))
    if module:
        routine = run.data.routine_of(module, own, span)
    else:
        routine = run.data.fetched_routine(own, scope.home, span)
    if routine is None or routine.kind != "proc":
        if run.course.skips(name, span):
            run.evaluator.outputs.forget()
            run.out.keep(span, name, "", device=True)
            return
        known = run.data.routine_names("proc")
        raise ProgramError(unknown_name("routine", name, known), span, NUMBERS[NO_ROUTINE])
    run.call(routine, arguments, scope, span)
