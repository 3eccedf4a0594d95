"""Threads: those that leave the robot alone are kept, one that moves it takes the program's place.

Only one thread can move the robot at a time, so that a program that starts a moving thread waits
for it, by ``join``, by a flag or in a loop that does nothing: the thread is carried out where it is
started. A program that ends such a thread on the way (``kill``) is refused, as nobody knows where
the robot is by then.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ....core.errors import SourceError, Span
from ....core.program.move import Opaque
from ..syntax.tree import Run, ThreadEnd
from ..values.instructions import Kept
from ..values.scope import Cell, Function, Scope
from ..values.values import ThreadHandle, Unknown, Value
from .exits import Finished

if TYPE_CHECKING:
    from .interpreter import Interpreter

_STARTED = Kept("start threads that leave the robot alone")


@dataclass
class _Started:
    """A thread that was started.

    Args:
        moving: whether it moves the robot and was carried out.
        endless: whether it would go on moving.
        waited: whether time has passed since, or something was decided that is not known.
        written: the variables that it may write.
        outputs: the outputs that it may write.
    """

    name: str
    moving: bool
    endless: bool = False
    waited: bool = False
    decided: int = 0
    written: tuple[Cell, ...] = ()
    outputs: frozenset[str] = frozenset()


class Threads:
    """The threads of one run."""

    def __init__(self, run: Interpreter) -> None:
        self._run = run
        self._started: list[_Started] = []
        self._inside: list[str] = []

    def check_free(self, span: Span) -> None:
        """Raises:
        SourceError: a thread without an end moves the robot already.
        """
        for thread in self._started:
            if thread.endless:
                raise SourceError(
                    f"the program moves the robot while thread {thread.name} moves it in a loop "
                    "without end: choose one of them as the entry",
                    span,
                )

    def waited(self) -> None:
        """The program lets time pass."""
        for thread in self._started:
            thread.waited = True

    def start(self, run: Run, scope: Scope) -> Value:
        """``run name()``"""
        interpreter = self._run
        call = run.call
        span = interpreter.texts.span(run.start, run.end)
        function = scope.function(call.name)
        if function is None:
            raise SourceError(f"there is no thread '{call.name}' to run", span)
        moving = interpreter.flow.function_moves(call.name)
        thread = _Started(call.name, moving)
        if moving:
            self._carry_out(function, run, scope, thread, span)
        else:
            interpreter.calls.keep_call(run, _STARTED, call.name)
            thread.written = self._mark(function)
            thread.outputs = frozenset(interpreter.flow.function_outputs(call.name))
            interpreter.outputs.share(thread.outputs)
        thread.decided = interpreter.decisions
        self._started.append(thread)
        return ThreadHandle(call.name, len(self._started))

    def end(self, statement: ThreadEnd, scope: Scope) -> None:
        """``join handle``, ``kill handle``"""
        interpreter = self._run
        span = interpreter.texts.span(statement.start, statement.end)
        handle = interpreter.evaluator.evaluate(statement.handle, scope)
        thread = None
        if isinstance(handle, ThreadHandle) and handle.number:
            thread = self._started[handle.number - 1]
        if thread is None or not thread.moving:
            self._keep(statement, span, statement.word == "join")
            self._release(thread, span)
        elif statement.word == "kill":
            self._kill(thread, span)
        elif thread.endless:
            interpreter.finish(f"thread {thread.name}, which is waited for, never ends", span)

    def _kill(self, thread: _Started, span: Span) -> None:
        decided = self._run.decisions
        if thread.endless or thread.waited or decided != thread.decided:
            raise SourceError(
                f"thread {thread.name} moves the robot and is stopped on the way: where the robot "
                "is by then is only known at run time",
                span,
            )

    def _carry_out(
        self, function: Function, run: Run, scope: Scope, thread: _Started, span: Span
    ) -> None:
        interpreter = self._run
        name = thread.name
        if name in self._inside:
            raise SourceError(f"thread {name} starts itself", span)
        interpreter.notebook.once(
            f"thread {name}",
            f"thread {name} moves the robot: it is carried out where it is started, as if the "
            "program waited for its end",
            span,
        )
        self._inside.append(name)
        try:
            interpreter.calls.enter(function, run.call, scope)
        except Finished:
            thread.endless = True
        finally:
            self._inside.pop()

    def _mark(self, function: Function) -> tuple[Cell, ...]:
        """What a running thread writes has no known value."""
        name, flow = function.definition.name, self._run.flow
        for variable in flow.thread_makes(name):
            function.scope.root().own(variable)
        found = map(function.scope.find, flow.thread_writes(name))
        cells = tuple(cell for cell in found if cell is not None)
        for cell in cells:
            cell.writer = name
        return cells

    def _release(self, thread: _Started | None, span: Span) -> None:
        if thread is None:
            return
        self._run.outputs.release(thread.outputs)
        for cell in thread.written:
            cell.writer = None
            cell.value = Unknown(f"what thread {thread.name} has written", span)
            cell.sources = ()

    def _keep(self, statement: ThreadEnd, span: Span, stops: bool) -> None:
        texts = self._run.texts
        self._run.emit(Opaque(texts.cut(statement.start, statement.end), stops, span))
