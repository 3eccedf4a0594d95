"""Routines carried out: arguments become their data, and what they are given goes back."""

from __future__ import annotations

from collections.abc import Callable

from ....core.errors import SourceError
from ....core.source.execution.limits import Meter
from ....core.source.execution.transcript import Transcript
from ....core.source.text.arguments import wrong_count
from ....core.source.text.nodes import no_label
from ..syntax.tree import Call, Name, Routine
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.scope import Module, Path, Scope, Variable
from ..values.types import KrlTypeError, convert
from ..values.values import Pending, Value, copied
from .exits import Jump, Left, Returned


class Routines:
    """Runs routines.

    Args:
        data: of the program.
        evaluator: for arguments.
        meter: counts calls.
        transcript: remembers them.
        scopes: of the routines under way, the innermost last.
        run_body: carries out the statements of a routine.
    """

    def __init__(
        self,
        data: Data,
        evaluator: Evaluator,
        meter: Meter,
        transcript: Transcript,
        scopes: list[Scope],
        run_body: Callable[[Routine, Call, Scope], None],
    ) -> None:
        self._data = data
        self._evaluator = evaluator
        self._meter = meter
        self._transcript = transcript
        self._scopes = scopes
        self._run_body = run_body

    def run(self, routine: Routine, module: Module, call: Call, caller: Scope) -> Value | None:
        """One call.

        Returns:
            What ``RETURN`` gave, as a value of the function's type; None if it gave none.

        Raises:
            SourceError: too many arguments, a value of another type, or calls nested too deeply.
        """
        self._data.declare_module(module)
        self._meter.call(routine.text, call.span)
        if len(self._scopes) > 1:
            self._transcript.called(call.span)
        kind = "DEF" if routine.returns is None else "DEFFCT"
        scope = Scope(f"{kind} {routine.text}", module, returns=routine.returns)
        back = self._hand_over(routine, call, caller, scope)
        self._scopes.append(scope)
        value: Value | None = None
        course = self._evaluator.course
        supposed = course.supposed
        try:
            self._run_body(routine, call, scope)
        except Returned as returned:
            value = returned.value
        except Jump as jump:
            raise no_label(jump.goto) from None
        except Left:
            raise SourceError("EXIT stands outside a loop", routine.span) from None
        finally:
            self._scopes.pop()
            self._meter.back()
        course.supposed = supposed or course.supposed
        self._hand_back(back, call, caller)
        return self._returned(routine, value, call)

    def _returned(self, routine: Routine, value: Value | None, call: Call) -> Value | None:
        if value is None or routine.returns is None:
            return value
        try:
            return convert(value, routine.returns, self._data.types)
        except KrlTypeError as error:
            raise SourceError(f"the value of {routine.text}: {error}", call.span) from None

    def _hand_over(
        self, routine: Routine, call: Call, caller: Scope, scope: Scope
    ) -> list[tuple[Variable, Name, Path]]:
        """Arguments become cells of the routine's scope.

        Returns:
            The parameters by reference with the caller's data that they stand for, and the paths
            of those as they are now: the routine may change what an index is made of.
        """
        if len(call.arguments) > len(routine.parameters):
            raise SourceError(
                f"{routine.text} {wrong_count(len(routine.parameters), len(call.arguments))}",
                call.span,
            )
        back: list[tuple[Variable, Name, Path]] = []
        for index, parameter in enumerate(routine.parameters):
            argument = call.arguments[index] if index < len(call.arguments) else None
            cell = Variable(parameter.text)
            if argument is not None:
                with self._evaluator.course.apart():
                    cell.value = copied(self._evaluator.evaluate(argument, caller))
                    cell.supposed = self._evaluator.course.supposed
            scope.cells[parameter.name] = cell
            if parameter.by_reference and isinstance(argument, Name):
                back.append((cell, argument, self._evaluator.names.path(argument, caller)))
        return back

    def _hand_back(
        self, back: list[tuple[Variable, Name, Path]], call: Call, caller: Scope
    ) -> None:
        """What a parameter by reference was given goes into the caller's datum."""
        for cell, datum, path in back:
            value = cell.value
            if cell.assigned and value is not None and not isinstance(value, Pending):
                with self._evaluator.course.apart():
                    self._evaluator.course.suppose(cell.supposed)
                    self._evaluator.assign(datum, value, caller, call.span, path)
            elif cell.supposed:  # on the other way it may have been written
                given = self._data.find(datum.name, caller)
                if given is not None:
                    given.supposed = given.supposed or cell.supposed
