"""Calls of routines and functions: of the program, of KUKA's own files, and of others."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace

from ....core.errors import SourceError
from ....core.source.execution.course import About, Course
from ....core.source.execution.provenance import ELSEWHERE
from ....core.source.execution.scopes import unknown_name
from ..motion.bas import Basis
from ..motion.inline_forms import Function
from ..syntax.tree import Call, Invoke, Name
from ..values.answers import answered
from ..values.data import Data
from ..values.evaluator import Evaluator, brought_by
from ..values.expected import EXPECTED
from ..values.functions import COMPUTED
from ..values.scope import Scope
from ..values.values import Array, Struct, Unknown, Value, supposed
from .analysis import NATIVE
from .instructions import Kept, kept
from .keeping import Keeping
from .output_writes import OutputWrites
from .routines import Routines


class Calls:
    """Carries calls out.

    Args:
        data: of the program.
        evaluator: for arguments.
        course: says which routines are stepped over.
        routines: runs those whose text is at hand.
        basis: carries out ``BAS``.
        functions: of KUKA's own files, by lower-case name.
        writes: outputs at uncertain moments.
        keeping: takes what is kept.
    """

    def __init__(
        self,
        data: Data,
        evaluator: Evaluator,
        course: Course,
        routines: Routines,
        basis: Basis,
        functions: Mapping[str, Function],
        writes: OutputWrites,
        keeping: Keeping,
    ) -> None:
        self._data = data
        self._library = data.library
        self._evaluator = evaluator
        self._course = course
        self._routines = routines
        self._basis = basis
        self._functions = functions
        self._writes = writes
        self._keeping = keeping

    def invoke(self, statement: Invoke, scope: Scope) -> None:
        """A call as a statement.

        Raises:
            SourceError: it is refused, or the routine is not at hand.
        """
        call = statement.call
        own = self._library.main.routines.get(call.name) or scope.module.routines.get(call.name)
        if own is None:
            if call.name in NATIVE:
                self._basis.invoke(call, scope)
                return
            if call.name in self._course.answers.skipped:
                self._course.skips(call.text, call.span)
                self._skip(statement, "as the answers say")
                return
            table = kept(call.name)
            if table is not None:
                self._keep_call(statement, table, scope)
                return
        found = self._library.routine(call.name, scope.module)
        if found is None:
            self._step_over(statement, scope)
            return
        self._routines.run(*found, call, scope)

    def _skip(self, statement: Invoke, why: str) -> None:
        """Step over a routine, as if it moved nothing."""
        call = statement.call
        self._data.outputs.forget()
        self._keeping.keep(statement.span, call.text, why, device=True)

    def _keep_call(self, statement: Invoke, why: Kept, scope: Scope) -> None:
        call = statement.call
        if why.writes:
            self._forget(call, scope)
        for name in why.brings:
            self._forget_datum(Name(call.span, name, name.upper()), call, scope)
        if why.outputs:
            self._writes.pulsed(statement.call, scope)
        if why.sent:
            self._course.sent(call.text, statement.span)
        self._keeping.keep(statement.span, call.text, why.why, why.stops)

    def _forget(self, call: Call, scope: Scope) -> None:
        """Data that a kept call may have written have no known value any more."""
        for argument in call.arguments:
            if isinstance(argument, Name):
                self._forget_datum(argument, call, scope)

    def _forget_datum(self, datum: Name, call: Call, scope: Scope) -> None:
        """One of them."""
        cell = self._data.find(datum.name, scope)
        if cell is None or cell.constant or cell.signal is not None:
            return
        part = datum.path and cell.type != "char"
        expected = () if part else EXPECTED.get(cell.type, ("",))
        about = About(datum.span, brought_by(call.name), *expected)
        text = self._data.text(datum.span) if datum.path else datum.text
        answer = self._course.value(text, about)
        if answer is not None:
            value = answered(answer)
            self._evaluator.assign(datum, value, scope, call.span)
            return
        unknown = Unknown(f"what {call.text} gave {text}", call.span, key=text)
        before: Value | None = None
        with suppress(SourceError):
            whole = self._evaluator.names.settled(cell)
            before = self._evaluator.evaluate(datum, scope) if datum.path else whole
        if before is not None and not isinstance(before, Unknown):
            unknown = replace(unknown, held=supposed(before))
        unset = isinstance(cell.value, Struct) and not cell.value.fields
        if unset and not datum.path:
            cell.value = replace(unknown, held=None)
        elif not isinstance(cell.value, Array | Struct):
            cell.value = unknown
        elif datum.path:
            with suppress(SourceError):
                self._evaluator.assign(datum, unknown, scope, call.span)

    def _step_over(self, statement: Invoke, scope: Scope) -> None:
        """A routine whose text is not at hand: taken as one that moves nothing."""
        call = statement.call
        self._data.outputs.forget()
        self._forget(call, scope)
        known = self._library.routine_names(scope.module)
        offer = (
            "it is stepped over as if it moved nothing: put its .src beside the program, name it "
            f'with the other files, or say that it is so by [calls] {call.text} = "skip"'
        )
        message = unknown_name("routine", call.text, known, offer)
        self._course.stepped_over(call.text, statement.span, message)
        self._keeping.keep(statement.span, call.text, "", device=True)

    def call_function(self, call: Call, scope: Scope) -> Value | None:
        """The value of a function of the program or of KUKA's own files."""
        own = self._library.main.routines.get(call.name) or scope.module.routines.get(call.name)
        if own is None:
            function = self._functions.get(call.name)
            if function is not None:
                evaluate = self._evaluator.evaluate
                arguments = [None if a is None else evaluate(a, scope) for a in call.arguments]
                return function(call, arguments, scope)
        found = self._library.routine(call.name, scope.module)
        if found is None:
            if call.name not in COMPUTED:
                self._forget(call, scope)
            return None
        routine, module = found
        reader, self._evaluator.reader = self._evaluator.reader, ELSEWHERE
        value = self._routines.run(routine, module, call, scope)
        self._evaluator.reader = reader
        if value is None and not self._course.guessed:
            raise SourceError(f"{routine.text} ends without RETURN and a value", call.span)
        # On its true way, which nobody knows, it may well return.
        return self._evaluator.unknown_function(call, scope) if value is None else value
