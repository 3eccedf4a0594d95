"""Threads: those that leave the robot alone are kept, one that moves it takes the program's place.

Only one thread can move the robot at a time, so that a program that starts a moving thread waits
for it, by ``join``, by a flag or in a loop that does nothing: the thread is carried out where it is
started. A program that ends such a thread on the way (``kill``) is refused, as nobody knows where
the robot is by then; unless it only drives where a computer says, and a file says all of that.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NoReturn, Protocol

from ....core.door import spelt
from ....core.errors import SourceError, Span
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.transcript import Transcript
from ..syntax.traversal import calls_of
from ..syntax.tree import Block, Call, StartThread, ThreadEnd
from ..values.evaluator import Evaluation, evaluate
from ..values.instructions import MOVES, STREAMS, Kept, driven_by, kept, streamed
from ..values.scope import Function, Scope, Variable
from ..values.values import ThreadHandle, Unknown, Value
from .analysis import ScriptTree
from .exits import Finished

_STARTED = Kept("start threads that leave the robot alone")


@dataclass
class Started:
    """A thread that was started.

    Args:
        moving: whether it moves the robot and was carried out.
        endless: whether it would go on moving.
        sent: the functions by which a computer moves the robot in it; none if other moves do.
        waited: whether time has passed since, or something was decided that is not known.
        written: the variables that it may write.
        outputs: the outputs that it may write.
    """

    name: str
    moving: bool
    endless: bool = False
    sent: frozenset[str] = frozenset()
    waited: bool = False
    decided: int = 0
    written: tuple[Variable, ...] = ()
    outputs: frozenset[str] = frozenset()


class ThreadsRun(Evaluation, Protocol):
    """What threads ask of a run."""

    @property
    def tree(self) -> ScriptTree:
        """The statements of the program."""

    @property
    def analysis(self) -> Analysis[Block]:
        """What can be said of them without running them."""

    @property
    def outputs(self) -> Outputs:
        """What the program has set."""

    @property
    def out(self) -> Transcript:
        """What the run leaves."""

    @property
    def decisions(self) -> int:
        """How often something was decided that is not known."""

    @property
    def threads(self) -> list[Started]:
        """The threads that were started."""

    @property
    def guided(self) -> list[tuple[str, Span]]:
        """The functions by which something else than the program moves the robot, and where."""

    @property
    def inside(self) -> list[str]:
        """Names of the threads that are being carried out."""

    def enter(self, function: Function, call: Call, caller: Scope) -> object:
        """StartThread one of the program's own functions."""

    def keep(self, call: StartThread, entry: Kept, name: str) -> Value:
        """Keep the start of a thread as it stands."""

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""

    def stopped_somewhere(self, error: SourceError, span: Span) -> None:
        """The robot has been stopped where nobody knows.

        Raises:
            SourceError: ``error``, where programs do not go on behind such.
        """


def check_free(threads: Iterable[Started], span: Span) -> None:
    """Refuse a move while a thread without an end moves the robot.

    Raises:
        SourceError: there is one.
    """
    for thread in threads:
        if thread.endless:
            raise SourceError(
                f"the program moves the robot while thread {thread.name} moves it in a loop "
                "without end: choose one of them as the entry",
                span,
            )


def start(run: ThreadsRun, node: StartThread, scope: Scope) -> Value:
    """``run name()``

    Raises:
        SourceError: there is no such thread, or it starts itself.
    """
    name = node.call.name
    function = scope.function(name)
    if function is None and run.course.skips(name, run.texts.span_of(node)):
        return run.keep(node, _STARTED, name)
    if function is None:
        raise run.texts.error_at(f"there is no thread '{name}' to run", node)
    bodies = run.tree.bodies([name])
    thread = Started(name, any(map(run.analysis.moves, bodies)))
    if thread.moving:
        called = frozenset().union(*map(calls_of, run.tree.reached(name)))
        if not called & MOVES:
            thread.sent = called & STREAMS.names
        _carry_out(run, function, node, scope, thread)
    else:
        run.keep(node, _STARTED, name)
        names = (c for body in run.tree.reached(name) for c in sorted(calls_of(body)))
        stream = next((called for called in names if kept(called) is STREAMS), None)
        if stream is not None:
            run.guided.append((stream, run.texts.span_of(node)))
            run.out.left_out.append(streamed(stream, run.texts.span_of(node)))
        thread.written = _mark(run.tree, function)
        outputs = (run.analysis.outputs_written(body) or () for body in bodies)
        thread.outputs = frozenset().union(*outputs)
        run.outputs.share(thread.outputs)
    thread.decided = run.decisions
    run.threads.append(thread)
    return ThreadHandle(name, len(run.threads))


def _carry_out(
    run: ThreadsRun, function: Function, node: StartThread, scope: Scope, thread: Started
) -> None:
    name = thread.name
    if name in run.inside:
        raise run.texts.error_at(f"thread {name} starts itself", node)
    run.out.notes.once(
        f"thread {name}",
        f"thread {name} moves the robot: it is carried out where it is started, as if the "
        "program waited for its end",
        run.texts.span_of(node),
    )
    run.inside.append(name)
    try:
        run.enter(function, node.call, scope)
    except Finished:
        thread.endless = True
    finally:
        run.inside.pop()


def _mark(tree: ScriptTree, function: Function) -> tuple[Variable, ...]:
    """What a running thread writes has no known value."""
    name = function.definition.name
    for variable in tree.thread_makes(name):
        function.scope.root().own(variable)
    found = map(function.scope.find, tree.thread_writes(name))
    cells = tuple(cell for cell in found if cell is not None)
    for cell in cells:
        cell.writer = name
    return cells


def end(run: ThreadsRun, statement: ThreadEnd, scope: Scope) -> None:
    """``join handle``, ``kill handle``

    Raises:
        SourceError: a thread is killed that moves the robot.
        Finished: a thread is waited for that never ends.
    """
    span = run.texts.span_of(statement)
    handle = evaluate(run, statement.handle, scope)
    thread = None
    if isinstance(handle, ThreadHandle) and handle.number:
        thread = run.threads[handle.number - 1]
    if thread is None or not thread.moving:
        stops = statement.word == "join"
        run.out.keep(span, statement.word, "", stops)
        if thread is not None:
            _release(run.outputs, thread, span)
    elif statement.word == "kill":
        if thread.sent and thread.sent <= driven_by(run.course.answers.streams):
            thread.endless = False
        elif thread.endless or thread.waited or run.decisions != thread.decided:
            error = SourceError(
                f"thread {thread.name} moves the robot and is stopped on the way: where the robot "
                f"is by then is only known at run time{_says(thread)}",
                span,
            )
            thread.endless = False
            run.stopped_somewhere(error, span)
    elif thread.endless:
        run.finish(f"thread {thread.name}, which is waited for, never ends", span)


def _says(thread: Started) -> str:
    """Where it can be said where a thread drives."""
    if not thread.sent:
        return ""
    files = ", ".join(f'{name} = "joints.csv"' for name in sorted(thread.sent))
    return f"; say where it drives in files ({spelt('answers')}: [streams] {files})"


def _release(outputs: Outputs, thread: Started, span: Span) -> None:
    """A thread has ended: what it has written stays unknown, and is the program's again."""
    outputs.release(thread.outputs)
    for cell in thread.written:
        cell.writer = None
        cell.value = Unknown(f"what thread {thread.name} has written", span)
        cell.sources = ()
