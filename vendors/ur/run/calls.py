"""Calls: the program's own functions, the controller's, and those that nobody declares."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ....core.errors import InputError, SourceError, Span
from ....core.program.move import Opaque, Wait
from ....core.source.execution.answers import Answer
from ..motion.kinematics import KINEMATICS
from ..motion.moves import move
from ..motion.settings_calls import SETTINGS
from ..syntax.tree import Argument, Assign, Call, Evaluate, MethodCall, Name, Run
from ..values.arguments import bind
from ..values.evaluator import answered
from ..values.functions import COMPUTED, SHAPES, Computed
from ..values.instructions import ADD_ONS, MOVES, REFUSED, Kept, asks, kept, known_names
from ..values.lists import METHODS
from ..values.located import NOTHING, Located
from ..values.outputs import READING, WRITING, held, write
from ..values.scope import Cell, Function, Scope, near_names
from ..values.values import Struct, Unknown, Value, ValueFault, describe, find_unknown, is_number
from .exits import Returned

if TYPE_CHECKING:
    from .interpreter import Interpreter

_CALL = 200
"""Elements of a list that are copied in the time in which a function is entered and left."""

Handler = Callable[["Interpreter", Call, Scope], Located]


@dataclass
class Frame:
    """A function that runs.

    Args:
        open: what decides which of its returns is taken, if that is not known.
    """

    open: Unknown | None = None


class Calls:
    """Carries out the calls of one run."""

    def __init__(self, run: Interpreter) -> None:
        self._run = run
        self._frames: list[Frame] = []
        self._handlers: dict[str, Handler] = {
            **dict.fromkeys(MOVES, move),
            **SETTINGS,
            **KINEMATICS,
            "sleep": _sleep,
            "struct": _struct,
        }

    @property
    def in_entry(self) -> bool:
        """Whether the function that runs is the one that the program starts with."""
        return len(self._frames) <= 1

    def return_depends(self, reason: Unknown) -> None:
        """What the function that runs returns depends on what is not known."""
        if self._frames and self._frames[-1].open is None:
            self._frames[-1].open = reason

    def call(self, call: Call, scope: Scope) -> Located:
        """The value of a call, and what it does.

        Raises:
            SourceError: nobody knows the function, or it cannot be read further.
        """
        own = scope.function(call.name)
        if own is not None:
            return self.enter(own, call, scope)
        handler = self._handlers.get(call.name)
        if handler is not None:
            return handler(self._run, call, scope)
        computed = COMPUTED.get(call.name)
        if computed is not None:
            return Located(self._computed(computed, call, scope))
        return Located(self._other(call, scope))

    # ------------------------------------------------------------- own functions

    def enter(self, function: Function, call: Call, caller: Scope) -> Located:
        """Run one of the program's own functions."""
        run = self._run
        define = function.definition
        span = run.texts.span(call.start, call.end)
        scope = Scope(define.name, function.scope)
        self._pass_arguments(function, call, caller, scope)
        run.entered.add(define.name)
        run.meter.call(define.name, span)
        run.work(_CALL, span)
        statement, reader = run.statement, run.evaluator.reader
        run.evaluator.reader = -1
        frame = Frame()
        self._frames.append(frame)
        outer, run.loops.exits = run.loops.exits, []
        found = NOTHING
        try:
            run.hoist(define.body, scope)
            run.run_block(define.body, scope)
        except Returned as returned:
            found = returned.found
        finally:
            self._frames.pop()
            run.meter.back()
            inner = run.loops.exits
            run.loops.exits = outer + [e for e in inner if e.word == "halt" or e.written]
            run.statement, run.evaluator.reader = statement, reader
        return found if frame.open is None else Located(frame.open)

    def _pass_arguments(self, function: Function, call: Call, caller: Scope, scope: Scope) -> None:
        define = function.definition
        names = [p.name for p in define.parameters]
        given = bind(call, names, 0, self._run.texts)
        for parameter in define.parameters:
            argument = given.get(parameter.name)
            if argument is not None:
                found = self._run.evaluator.locate(argument.value, caller)
            elif parameter.default is not None:
                found = self._run.evaluator.locate(parameter.default, function.scope)
            else:
                raise SourceError(
                    f"{call.name} needs the argument '{parameter.name}': "
                    f"{call.name}({', '.join(names)})",
                    self._run.texts.span(call.start, call.end),
                )
            scope.cells[parameter.name] = Cell(found.value, found.sources)

    # ------------------------------------------------------ functions of the language

    def _computed(self, computed: Computed, call: Call, scope: Scope) -> Value:
        run = self._run
        required = len(computed.parameters) - computed.optional
        given = bind(call, computed.parameters, required, run.texts)
        values: list[Value] = []
        for name in computed.parameters:
            if name not in given:
                break
            values.append(run.evaluator.plain(given[name].value, scope))
        whole = call.name in SHAPES
        run.work(computed.cost, run.span_of(call))
        for value in values:
            unknown = find_unknown(value) if not whole else value
            if isinstance(unknown, Unknown):
                return unknown
            if isinstance(value, tuple):
                run.work(len(value), run.texts.span(call.start, call.end))
        return self._applied(computed, values, call)

    def _applied(self, computed: Computed, values: list[Value], call: Call) -> Value:
        span = self._run.texts.span(call.start, call.end)
        try:
            return computed(*values)
        except ValueFault as fault:
            raise SourceError(f"{call.name}: {fault}", span) from None
        except InputError as error:
            raise SourceError(f"{call.name}: {error}", span) from None
        except (ValueError, ArithmeticError):
            shown = ", ".join(map(describe, values))
            raise SourceError(f"{call.name}({shown}) has no finite value", span) from None

    def method(self, call: MethodCall, scope: Scope) -> Value:
        """A method of a list; what other things do is kept."""
        run = self._run
        span = run.texts.span(call.start, call.end)
        base = run.evaluator.plain(call.base, scope)
        method = METHODS.get(call.name)
        arguments = [run.evaluator.plain(a.value, scope) for a in call.arguments]
        if method is None or not isinstance(base, tuple):
            if not isinstance(base, Unknown | Struct):
                raise SourceError(f"{describe(base)} has no method '{call.name}'", span)
            return self.keep_call(call, REMOTE, f"{call.name}()")
        run.work(len(base), span)
        try:
            changed, value = method(base, *arguments)
        except ValueFault as fault:
            raise SourceError(f"{call.name}: {fault}", span) from None
        except TypeError:
            raise SourceError(
                f"the method '{call.name}' does not take {len(arguments)} arguments", span
            ) from None
        if changed is not None and isinstance(call.base, Name):
            run.assignments.store(call.base, Located(changed), scope)
        return value

    # ------------------------------------------------------------------ the others

    def _other(self, call: Call, scope: Scope) -> Value:
        """A function that is not carried out: kept, asked for, or refused."""
        run = self._run
        if run.course.skips(call.name):
            run.outputs.forget()
            return self.keep_call(call, SKIPPED, call.name)
        refused = REFUSED.get(call.name)
        span = run.texts.span(call.start, call.end)
        if refused is not None:
            raise SourceError(
                f"{call.name} is refused: {refused}. To read the program as if it were not there, "
                f'answer [calls] "{call.name}" = "skip"',
                span,
            )
        values = [run.evaluator.evaluate(argument.value, scope) for argument in call.arguments]
        if call.name in READING and not run.course.changing(self._text(call)):
            known = held(run.outputs, call.name, values)
            if known is not None:
                return known
        if call.name in WRITING:
            write(run.outputs, call.name, values)
        if asks(call.name):
            return self.answer(call, f"{call.name}()")
        entry = kept(call.name)
        if entry is not None:
            if entry is ADD_ONS:
                run.outputs.forget()
            return self.keep_call(call, entry, call.name)
        answer = run.course.value(self._text(call))
        if answer is None:
            raise self._unknown(call, scope, span)
        run.outputs.forget()
        self.keep_call(call, SKIPPED, call.name)
        return answered(answer)

    def answer(self, call: Call | MethodCall, name: str) -> Value:
        """What a user says that a call returns, or that nobody knows it."""
        given = self.given(call)
        if given is not None:
            return answered(given)
        text = self._text(call)
        reason = text if len(text) <= 60 and "\n" not in text else name
        return Unknown(reason, self._run.texts.span(call.start, call.end))

    def given(self, call: Call | MethodCall) -> Answer | None:
        """What a user says that a call returns."""
        return self._run.course.value(self._text(call))

    def keep_call(self, call: Call | MethodCall | Run, entry: Kept, name: str) -> Value:
        """Keep a call, with all of its statement if that is nothing but the call."""
        run = self._run
        node: Call | MethodCall | Run | Assign | Evaluate = call
        statement = run.statement
        if isinstance(statement, Assign) and statement.value is call:
            node = statement
        span = run.texts.span(node.start, node.end)
        run.emit(Opaque(run.texts.cut(node.start, node.end), entry.stops, span))
        if entry.kind:
            run.notebook.kept(entry.kind, name, span)
        return (
            Unknown(f"what {name} returns", span)
            if isinstance(call, Run)
            else self.answer(call, name)
        )

    def _text(self, call: Call | MethodCall) -> str:
        return self._run.texts.cut(call.start, call.end)

    def _unknown(self, call: Call, scope: Scope, span: Span) -> SourceError:
        known = scope.function_names() | set(COMPUTED) | set(self._handlers) | known_names()
        return SourceError(
            f"nobody declares the function '{call.name}': {near_names(call.name, known)}it might "
            "move the robot, so it is not stepped over. Name the file that defines it, or, if it "
            f'leaves the robot alone, answer [calls] "{call.name}" = "skip"',
            span,
        )


SKIPPED = Kept("an answer tells to skip")
REMOTE = Kept("call remote procedures and add-ons")


def _sleep(run: Interpreter, call: Call, scope: Scope) -> Located:
    """``sleep(t)``: the robot waits, s."""
    given = bind(call, ("t",), 1, run.texts)
    value = run.evaluator.plain(given["t"].value, scope)
    span = run.texts.span(call.start, call.end)
    if isinstance(value, Unknown):
        run.calls.keep_call(call, Kept("wait for a time that is not known", stops=True), "sleep")
        return NOTHING
    if not is_number(value):
        raise SourceError(f"sleep takes a time in s, not {describe(value)}", span)
    run.threads.waited()
    try:
        run.emit(Wait(float(value), span))
    except InputError as error:
        raise SourceError(f"sleep: {error}", span) from None
    return NOTHING


def _struct(run: Interpreter, call: Call, scope: Scope) -> Located:
    """``struct(name=value, …)``"""
    names: list[str] = []
    values: list[Value] = []
    for argument in call.arguments:
        names.append(_part_name(run, argument, names))
        values.append(run.evaluator.evaluate(argument.value, scope))
    return Located(Struct(tuple(names), tuple(values)))


def _part_name(run: Interpreter, argument: Argument, before: list[str]) -> str:
    span = run.texts.span(argument.start, argument.end)
    if argument.name is None:
        raise SourceError("the parts of a struct have names: struct(name=value)", span)
    if argument.name in before:
        raise SourceError(f"the struct has '{argument.name}' twice", span)
    return argument.name
