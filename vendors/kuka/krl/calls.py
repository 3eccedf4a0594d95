"""Calls of routines and functions: of the program, of KUKA's own files, and of others."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from ....core.errors import SourceError
from ....core.source.arguments import wrong_count
from .flow import Jump, Left, Returned
from .functions import COMPUTED
from .instructions import Kept, kept, refused
from .library import Module
from .names import Path
from .scope import Cell, Scope, unknown_name
from .syntax import Block, Invoke, Routine
from .terms import Call, Name
from .types import KrlTypeError, convert
from .values import Array, Pending, Struct, Unknown, Value, copied

if TYPE_CHECKING:
    from .interpreter import Interpreter

NATIVE = frozenset({"bas"})


class Calls:
    """Carries calls out.

    Args:
        run: the program run.
    """

    def __init__(self, run: Interpreter) -> None:
        self.run = run

    def invoke(self, statement: Invoke, scope: Scope) -> None:
        call = statement.call
        own = self.run.library.main.routines.get(call.name) or scope.module.routines.get(call.name)
        if own is None:
            if call.name in NATIVE:
                self.run.basis.invoke(call, scope)
                return
            if self.run.course.skips(call.text):
                self.run.data.outputs.forget()
                self.run.keep(statement.span, call.text, Kept("as the answers say"))
                return
            table = self._from_table(call)
            if table is not None:
                self._keep_call(statement, table, scope)
                return
        found = self.run.library.routine(call.name, scope.module)
        if found is None:
            raise self._refusal(call, scope)
        self.run_routine(*found, call, scope)

    def _from_table(self, call: Call) -> Kept | None:
        reason = refused(call.name)
        if reason is not None:
            raise SourceError(f"{call.text} is refused: {reason}", call.span)
        return kept(call.name)

    def _keep_call(self, statement: Invoke, why: Kept, scope: Scope) -> None:
        if why.writes:
            self._forget(statement.call, scope)
        if why.outputs:
            self.run.output_writes.pulsed(statement.call, scope)
        self.run.keep(statement.span, statement.call.text, why)

    def _forget(self, call: Call, scope: Scope) -> None:
        """Data that a kept call may have written have no known value any more."""
        for argument in call.arguments:
            if not isinstance(argument, Name):
                continue
            cell = self.run.data.find(argument.name, scope)
            if cell is None or cell.constant or cell.signal is not None:
                continue
            if any(isinstance(step, str) for step in argument.path):
                continue
            unknown = Unknown(f"what {call.text} gave {argument.text}", call.span)
            if not isinstance(cell.value, Array | Struct):
                self.run.data.journal.note(cell)
                cell.value = unknown
            elif argument.path:
                with suppress(SourceError):
                    self.run.evaluator.assign(argument, unknown, scope, call.span)

    def _refusal(self, call: Call, scope: Scope) -> SourceError:
        known = self.run.library.routine_names(scope.module)
        offer = (
            "it might move the robot, so it is not stepped over: put its .src beside the program, "
            f'name it with the other files, or answer [calls] {call.text} = "skip"'
        )
        return SourceError(unknown_name("routine", call.text, known, offer), call.span)

    def call_function(self, call: Call, scope: Scope) -> Value | None:
        """The value of a function of the program or of KUKA's own files."""
        own = self.run.library.main.routines.get(call.name) or scope.module.routines.get(call.name)
        if own is None:
            value = self.run.inline.value(call, scope)
            if value is not None:
                return value
        found = self.run.library.routine(call.name, scope.module)
        if found is None:
            if call.name not in COMPUTED:
                self._forget(call, scope)
            return None
        routine, module = found
        reader, self.run.evaluator.reader = self.run.evaluator.reader, -1
        value = self.run_routine(routine, module, call, scope)
        self.run.evaluator.reader = reader
        if value is None:
            raise SourceError(f"{routine.text} ends without RETURN and a value", call.span)
        return value

    def run_routine(
        self, routine: Routine, module: Module, call: Call, caller: Scope
    ) -> Value | None:
        self.run.data.declare_module(module)
        self.run.meter.call(routine.text, call.span)
        kind = "DEF" if routine.returns is None else "DEFFCT"
        scope = Scope(f"{kind} {routine.text}", module, returns=routine.returns)
        back = self._hand_over(routine, call, caller, scope)
        self.run.where.append(module)
        skipped = self.run.flow.skipped_exit
        value: Value | None = None
        try:
            self.run.run_block(routine.body, scope)
        except Returned as returned:
            value = returned.value
        except Jump as jump:
            raise SourceError(
                f"no label '{jump.goto.name}' can be reached from here", jump.goto.span
            ) from None
        except Left:
            raise SourceError("EXIT stands outside a loop", routine.span) from None
        finally:
            self.run.where.pop()
            self.run.data.journal.forget(scope.cells.values())
            self.run.flow.skipped_exit = skipped
            self.run.meter.back()
        self._hand_back(back, call, caller)
        return self._returned(routine, value, call)

    def _returned(self, routine: Routine, value: Value | None, call: Call) -> Value | None:
        if value is None or routine.returns is None:
            return value
        try:
            return convert(value, routine.returns, self.run.data.types)
        except KrlTypeError as error:
            raise SourceError(f"the value of {routine.text}: {error}", call.span) from None

    def _hand_over(
        self, routine: Routine, call: Call, caller: Scope, scope: Scope
    ) -> list[tuple[Cell, Name, Path]]:
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
        back: list[tuple[Cell, Name, Path]] = []
        for index, parameter in enumerate(routine.parameters):
            argument = call.arguments[index] if index < len(call.arguments) else None
            cell = Cell(parameter.name)
            if argument is not None:
                cell.value = copied(self.run.evaluator.evaluate(argument, caller))
            scope.cells[parameter.name] = cell
            if parameter.by_reference and isinstance(argument, Name):
                back.append((cell, argument, self.run.evaluator.names.path(argument, caller)))
        return back

    def _hand_back(self, back: list[tuple[Cell, Name, Path]], call: Call, caller: Scope) -> None:
        """What a parameter by reference was given goes into the caller's datum."""
        for cell, datum, path in back:
            value = cell.value
            if cell.assigned and value is not None and not isinstance(value, Pending):
                self.run.evaluator.assign(datum, value, caller, call.span, path)

    def body_of(self, call: Call) -> Block | None:
        """The statements that a call runs, as far as it is known without running."""
        if call.name in NATIVE or kept(call.name) is not None:
            return None
        found = self.run.library.routine(call.name, self.run.where[-1])
        return None if found is None else found[0].body
