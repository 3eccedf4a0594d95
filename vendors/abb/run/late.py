"""Procedures that are called by their names: ``%"routine"%``, ``CallByVar``."""

from __future__ import annotations

from typing import Protocol

from ....core.errors import Span
from ....core.source.execution.course import Course
from ....core.source.execution.transcript import Transcript
from ..syntax import tree
from ..values.data import Globals
from ..values.defaults import nominal
from ..values.errors import NO_ROUTINE, NUMBERS, ProgramError
from ..values.evaluator import Evaluator
from ..values.scope import Scope, unknown_name
from ..values.types import STRING, Unknown, Value, answerable


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
    if isinstance(value, Unknown):
        taken = nominal(value, STRING)
        alike = _of_those_alike(run, str(taken), value, statement.span)
        if alike is not None:
            call_named(run, alike, statement.arguments, scope, statement.span)
            return
    if isinstance(value, Unknown) and run.course.skips(
        run.text_of(statement.routine), statement.span
    ):
        run.evaluator.outputs.forget()
        run.out.keep(statement.span, "a call by name", "", device=True)
        return
    name = run.evaluator.known(statement.routine, scope, STRING, "the routine to call")
    assert isinstance(name, str)
    call_named(run, name, statement.arguments, scope, statement.span)


def _of_those_alike(run: LateRun, taken: str, unknown: Unknown, span: Span) -> str | None:
    """The procedure that is called where the number in its name is not known: the first of those
    that are called so but for the number, if there are any and programs go on behind what nobody
    knows.

    Args:
        taken: the name, with the number that is taken.
        unknown: what it depends on.
    """
    names = run.data.routine_names("proc")
    stem = taken.rstrip("0123456789")
    alike = [n for n in names if n.lower().startswith(stem.lower()) and n[len(stem) :].isdigit()]
    if stem == taken or not alike or not run.course.answers.goes_on:
        return None
    first = min(alike, key=lambda name: int(name[len(stem) :]))
    several = "the only one" if len(alike) == 1 else f"the first of {len(alike)}"
    message = f"which routine is called depends on {unknown.reason}: {first}, {several} of its name"
    run.course.decided(span, f"{message}, is called{answerable(unknown)}")
    return first


def call_named(
    run: LateRun,
    name: str,
    arguments: tuple[tree.Argument, ...],
    scope: Scope,
    span: Span,
    unknown: Unknown | None = None,
) -> None:
    """Call the procedure that a string names, by itself or as ``module:procedure``.

    Args:
        unknown: what the number in the name depends on, if it is not known.

    Raises:
        SourceError: there is none.
    """
    if unknown is not None:
        name = _of_those_alike(run, name, unknown, span) or name
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
