"""Calls: the program's own functions, the controller's, and those that nobody declares."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from ....core.errors import SourceError, Span
from ....core.source.execution.control_flow.flow import Flow
from ....core.source.execution.limits import Meter
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.provenance import ELSEWHERE
from ..motion.jogs import PARAMETERS, JogsRun, jog
from ..motion.kinematics import KINEMATICS
from ..motion.moves import move
from ..motion.settings import CALLS, SettingsRun, change
from ..syntax.tree import Block, Call, MethodCall, Statement
from ..values.answers import answer, answered, used_as
from ..values.arguments import bind
from ..values.evaluator import evaluate, locate, plain
from ..values.function_calls import compute, list_method, struct
from ..values.functions import COMPUTED
from ..values.instructions import ADD_ONS, MOVES, STREAMS, Kept, asks, kept, known_names, streamed
from ..values.lists import METHODS
from ..values.located import NOTHING, Located
from ..values.outputs import READING, WRITING, held, write
from ..values.scope import Function, Scope, Variable, did_you_mean
from ..values.values import Struct, Unknown, Value, describe, is_number
from .exits import Frame, Returned
from .threads import Started

_CALL = 200
"""Elements of a list that are copied in the time in which a function is entered and left."""
SKIPPED = Kept("an answer says to skip", device=True)
_MISSING = Kept("", device=True)
REMOTE = Kept("call remote procedures and add-ons", device=True)
_UNKNOWN_TIME = Kept("wait for a time that is not known", stops=True)


class CallsRun(JogsRun, SettingsRun, Protocol):
    """What calls ask of a run.

    Attributes:
        statement: that is executed.
    """

    statement: Statement | None

    @property
    def meter(self) -> Meter:
        """Counts what is executed."""

    @property
    def outputs(self) -> Outputs:
        """What the program has set."""

    @property
    def flow(self) -> Flow[Block]:
        """Decides about branches and loops."""

    @property
    def entered(self) -> set[str]:
        """Names of the functions that have run."""

    @property
    def frames(self) -> list[Frame]:
        """The functions that run."""

    @property
    def threads(self) -> list[Started]:
        """The threads that were started."""

    @property
    def guided(self) -> list[tuple[str, Span]]:
        """See `ThreadsRun`."""

    def keep(self, call: Call | MethodCall, entry: Kept, name: str) -> Value:
        """Keep a call as it stands; what it returns."""

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""

    def stopped_somewhere(self, error: SourceError, span: Span) -> None:
        """See `ThreadsRun`."""


def call(run: CallsRun, node: Call, scope: Scope) -> Located:
    """The value of a call, and what it does.

    Raises:
        SourceError: nobody knows the function, or it cannot be read further.
    """
    own = scope.function(node.name)
    if own is not None:
        return enter(run, own, node, scope)
    handler = _HANDLERS.get(node.name)
    if handler is not None:
        return handler(run, node, scope)
    if node.name in COMPUTED:
        return Located(compute(run, node, scope))
    return Located(_other(run, node, scope))


def method(run: CallsRun, node: MethodCall, scope: Scope) -> Value:
    """A method of a list; what other things do is kept.

    Raises:
        SourceError: the value has no such method.
    """
    base = plain(run, node.base, scope)
    arguments = [plain(run, a.value, scope) for a in node.arguments]
    if node.name in METHODS and isinstance(base, tuple):
        return list_method(run, node, base, arguments, scope)
    if not isinstance(base, Unknown | Struct):
        raise run.texts.error_at(f"{describe(base)} has no method '{node.name}'", node)
    return run.keep(node, REMOTE, f"{node.name}()")


# --------------------------------------------------------------------- own functions


def enter(run: CallsRun, function: Function, node: Call, caller: Scope) -> Located:
    """Run one of the program's own functions; what it returns."""
    define = function.definition
    span = run.texts.span_of(node)
    scope = Scope(define.name, outer=function.scope)
    _pass_arguments(run, function, node, caller, scope)
    run.entered.add(define.name)
    run.meter.call(define.name, span)
    run.out.called(span)
    run.work(_CALL, span)
    statement, reader = run.statement, run.literals.reader
    run.literals.reader = ELSEWHERE
    frame = Frame(scope)
    run.frames.append(frame)
    found = NOTHING
    supposed = run.course.supposed
    try:
        scope.define(define.body)
        with run.flow.routine(define.name, span):
            run.run_block(define.body, scope)
    except Returned as returned:
        found = returned.found
    finally:
        run.frames.pop()
        run.meter.back()
        run.statement, run.literals.reader = statement, reader
    run.course.supposed = supposed or run.course.supposed
    return found if frame.open is None else Located(frame.open)


def _pass_arguments(
    run: CallsRun, function: Function, node: Call, caller: Scope, scope: Scope
) -> None:
    define = function.definition
    names = [p.name for p in define.parameters]
    given = bind(node, names, 0, run.texts)
    for parameter in define.parameters:
        argument = given.get(parameter.name)
        with run.course.apart():
            if argument is not None:
                found = locate(run, argument.value, caller)
            elif parameter.default is not None:
                found = locate(run, parameter.default, function.scope)
            else:
                raise run.texts.error_at(
                    f"{node.name} needs the argument '{parameter.name}': "
                    f"{node.name}({', '.join(names)})",
                    node,
                )
            cell = Variable(found.value, found.sources, supposed=run.course.supposed)
        scope.cells[parameter.name] = cell


# ------------------------------------------------------------ functions of the controller


def _move(run: CallsRun, node: Call, scope: Scope) -> Located:
    """A move; if it cannot be read, the robot goes where nobody knows."""
    try:
        return move(run, node, scope)
    except SourceError as error:
        span = run.texts.span_of(node)
        run.stopped_somewhere(error, span)
        run.literals.reader = ELSEWHERE
        return NOTHING


def _sleep(run: CallsRun, node: Call, scope: Scope) -> Located:
    """``sleep(t)``: the robot waits, s."""
    given = bind(node, ("t",), 1, run.texts)
    value = plain(run, given["t"].value, scope)
    if isinstance(value, Unknown):
        used_as(run, given["t"].value, value, "number")
        run.keep(node, _UNKNOWN_TIME, "sleep")
        return NOTHING
    if not is_number(value):
        raise run.texts.error_at(f"sleep takes a time in s, not {describe(value)}", node)
    for thread in run.threads:
        thread.waited = True
    run.out.wait(float(value), "sleep", "there is no such time", run.texts.span_of(node))
    return NOTHING


_HANDLERS: dict[str, Callable[[CallsRun, Call, Scope], Located]] = {
    **dict.fromkeys(MOVES, _move),
    **dict.fromkeys(CALLS, change),
    **KINEMATICS,
    "sleep": _sleep,
    "struct": struct,
}
"""Function of the controller → what carries it out."""


def _other(run: CallsRun, node: Call, scope: Scope) -> Value:
    """A function that is not carried out: kept, asked for, or refused."""
    name, span = node.name, run.texts.span_of(node)
    if name.casefold() in run.course.answers.skipped:
        run.course.skips(name, span)
        run.outputs.forget()
        return run.keep(node, SKIPPED, name)
    values = [evaluate(run, argument.value, scope) for argument in node.arguments]
    text = run.texts.text_of(node)
    if name in READING and not run.course.changing(text):
        known = held(run.outputs, name, values)
        if known is not None:
            return known
    if name in WRITING:
        write(run.outputs, name, values)
    if asks(name):
        return answer(run, node, f"{name}()")
    entry = kept(name)
    if entry is not None:
        if entry is ADD_ONS:
            run.outputs.forget()
        if name in PARAMETERS and not run.course.answers.streams and jog(run, node, scope):
            return Unknown(f"what {name} returns", span)
        if entry is STREAMS:
            run.guided.append((name, span))
            run.out.left_out.append(streamed(name, span))
        return run.keep(node, entry, name)
    told = run.course.value(text)
    run.outputs.forget()
    if told is not None:
        run.keep(node, SKIPPED, name)
        return answered(told)
    names = scope.function_names() | COMPUTED.keys() | _HANDLERS.keys() | known_names()
    if name.casefold().startswith(tuple(MOVES)):
        raise run.texts.error_at(
            f"nobody declares the function '{name}': {did_you_mean(name, names)}names of moves are "
            "written in lower case and as they are",
            node,
        )
    run.course.stepped_over(
        name,
        span,
        f"nobody declares the function '{name}': {did_you_mean(name, names)}it is stepped over as "
        "if it moved nothing: name the file that defines it, or say that it is so by [calls] "
        f'"{name}" = "skip"',
    )
    for argument, value in zip(node.arguments, values, strict=True):
        if isinstance(value, Unknown) and value.key == run.texts.text_of(argument.value):
            run.course.needless(value.key)
    return run.keep(node, _MISSING, name)
