"""Runs a program: statements → the moves, waits and kept statements that the robot goes through.

What the text leaves open travels as `Unknown` through assignments. Where a branch or a loop
depends on it, `core.source.execution.answers.Course` decides; a move that depends on it is refused
by name.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any, NoReturn
from weakref import proxy

from ....core.errors import Note, SourceError, Span
from ....core.program.move import Move
from ....core.program.move import Statement as ProgramStatement
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.control_flow.flow import Flow
from ....core.source.execution.control_flow.steps import NOTHING as NO_NAMES
from ....core.source.execution.control_flow.steps import PLACE
from ....core.source.execution.course import Course
from ....core.source.execution.limits import Meter
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.streams import Streaming
from ....core.source.execution.transcript import MoveParts, Transcript
from ....core.source.reading import ReadOptions
from ..motion.jogs import Jog
from ..motion.kinematics import joints_of
from ..motion.position import Position
from ..motion.settings import Settings, spoiled
from ..syntax.texts import Texts
from ..syntax.tree import (
    Assign,
    Block,
    Call,
    Define,
    Evaluate,
    If,
    Keyword,
    MethodCall,
    Return,
    StartThread,
    Statement,
    ThreadEnd,
    Unread,
    While,
)
from ..values.answers import answer
from ..values.assignments import store
from ..values.changes import Snapshot
from ..values.evaluator import evaluate, locate
from ..values.instructions import Kept
from ..values.located import NOTHING, Located
from ..values.provenance import SourceReads
from ..values.scope import Function, Scope
from ..values.values import PendingInverse, Unknown, Value
from . import calls, flow, threads
from .analysis import ScriptTree
from .exits import Break, Continue, Finished, Frame, Returned

_ELEMENTS_PER_STATEMENT = 100
"""Elements of a list that are copied in the time of a statement."""


class Interpreter:
    """One run of a program: what holds at a time, and what was executed so far.

    What carries out statements and calls are functions beside it, which take it through protocols
    of their own; nothing here refers back to it.

    Args:
        texts: source texts.
        tree: its statements.
        options: robot, answers and limits.

    Attributes:
        settings: TCP and payload in force.
        statement: that is executed.
        decisions: how often something was decided that is not known.
        frames: the functions that run.
        entered: names of the functions that have run.
        threads: that were started.
        inside: names of the threads that are being carried out.
        jogged: the last motion by `speedj` or `speedl` that was carried out.
        guided: functions by which something else than the program moves the robot, and where.
    """

    def __init__(self, texts: Texts, tree: ScriptTree, options: ReadOptions) -> None:
        self.texts = texts
        self.tree = tree
        self.analysis = Analysis(tree)
        self.course = Course(options.answers)
        self.meter = Meter(options.limits, options.executed)
        self.literals = SourceReads(texts)
        self.outputs = Outputs()
        self.position = Position(options.robot, options.start)
        self.settings = Settings()
        self.root = Scope("the program")
        self.statement: Statement | None = None
        self.flow: Flow[Block] = Flow(self.analysis, proxy(self))
        self.decisions = 0
        self.frames: list[Frame] = []
        self.entered: set[str] = set()
        self.threads: list[threads.Started] = []
        self.inside: list[str] = []
        self.guided: list[tuple[str, Span]] = []
        self.jogged: Jog | None = None
        self.out = Transcript(texts.text, self.course)
        self.out.streaming = Streaming(options.robot, self.position.moved, self.position.left_out)
        self._carried = 0

    # --------------------------------------------------------------------- the run

    def run_top(self, block: Block) -> None:
        """Execute statements that stand in no function, up to the end of the program.

        Raises:
            Finished: it has ended.
        """
        with suppress(Returned):
            self.run_block(block, self.root)

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""
        for statement in block:
            self.meter.statement(self.texts.span_of(statement))
            self.statement = statement
            self.course.supposed = ""
            _STATEMENTS[type(statement)](self, statement, scope)

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note.

        Raises:
            Finished: always.
        """
        self.note_once("end", message, span)
        raise Finished

    # --------------------------------------------------------- what branches and loops ask

    @property
    def position_asked(self) -> int:
        """How often the program has asked where the robot stands."""
        return self.position.asked

    @property
    def place(self) -> object:
        """Where the robot stands: another object after every move to another place."""
        return self.position.place

    def snapshot(self, names: frozenset[str] | None, written: frozenset[str]) -> Snapshot:
        """Variables as they are now; see `core.source.execution.host.Host`."""
        watched = written if names is None else names
        return Snapshot(watched, self.frames[-1].scope if self.frames else self.root)

    def leave_to_others(self, names: frozenset[str], span: Span) -> list[str]:
        """See `core.source.execution.host.Host`: a script's data are written by nobody else."""
        return []

    def leave_supposed(
        self,
        names: frozenset[str],
        settings: frozenset[str],
        reason: str,
        called: frozenset[str] = NO_NAMES,
    ) -> None:
        """See `core.source.execution.host.Host`."""
        if PLACE in names:
            self.position.suppose(reason)
        scope = self.frames[-1].scope if self.frames else self.root
        own = map(scope.find, sorted(names))
        for cell in filter(None, (*own, *map(self.root.find, sorted(called)))):
            cell.supposed = cell.supposed or reason
        if "set_tcp" in settings and not self.settings.supposed:
            self.settings = replace(self.settings, supposed=reason)

    def pause(self, text: str, span: Span) -> None:
        """The robot stands at a loop that waits."""
        self.out.pause(text, span)

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of this kind was taken before."""
        self.out.notes.once(kind, message, span)

    # ------------------------------------------------------------- what was executed

    def emit_move(self, move: Move, parts: MoveParts) -> None:
        """Put a move at the end of the program.

        Raises:
            SourceError: there are too many, or a thread moves the robot already.
        """
        self.meter.move(parts.statement)
        threads.check_free(self.threads, parts.statement)
        for part in filter(None, (parts.target, parts.via, parts.speed, parts.zone)):
            for source in filter(None, part.sources):
                self.literals.reads.by_move(source, self.out.move_index)
        self.out.emit_move(move, parts)
        self.position.moved(move, parts.statement)

    def keep(self, call: Call | MethodCall | StartThread, entry: Kept, name: str) -> Value:
        """Keep a call, with all of its statement if that is nothing but the call.

        Returns:
            What the call returns: the user's answer, or unknown.
        """
        node: Call | MethodCall | StartThread | Assign = call
        statement = self.statement
        if isinstance(statement, Assign) and statement.value is call:
            node = statement
        span = self.texts.span_of(node)
        driven = self.out.keep(span, name, "", entry.stops, entry.device)
        if entry.kind and not driven:
            self.out.notes.group(entry.kind, name, span)
        if isinstance(call, StartThread):
            return Unknown(f"what {name} returns", span)
        unused = isinstance(statement, Evaluate) and statement.expression is call
        return answer(self, call, name, listed=not unused)

    def open_move(self, error: SourceError, span: Span) -> bool:
        """Whether the program goes on behind what cannot be carried out, as an open move."""
        if not self.out.leaves_open(error, span):
            return False
        self.meter.move(span)
        self.position.left_out(span)
        return True

    def stopped_somewhere(self, error: SourceError, span: Span) -> None:
        """The robot is where nobody knows; see `ThreadsRun`."""
        if not self.open_move(error, span):
            raise error

    def statements(self) -> tuple[ProgramStatement, ...]:
        """What was executed, each move with the origin of its numbers."""
        return self.out.statements(self.literals.reads)

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about the run."""
        damage = self.texts.damage
        torn = () if damage is None else damage.notes()
        return (*self.texts.notes, *torn, *self.course.notes(), *self.out.notes.notes())

    # ------------------------------------------------------------- what expressions do

    def call(self, call: Call, scope: Scope) -> Located:
        """The value of a function."""
        return calls.call(self, call, scope)

    def enter(self, function: Function, call: Call, caller: Scope) -> Located:
        """Run one of the program's own functions; what it returns."""
        return calls.enter(self, function, call, caller)

    def method(self, call: MethodCall, scope: Scope) -> Value:
        """The value of a method."""
        return calls.method(self, call, scope)

    def start_thread(self, run: StartThread, scope: Scope) -> Value:
        """Start a thread; its handle."""
        return threads.start(self, run, scope)

    def joints(self, solution: PendingInverse) -> Value:
        """The numbers of an inverse-kinematics solution."""
        return joints_of(self.position, solution)

    def work(self, amount: int, span: Span) -> None:
        """Count what copying a list of so many elements costs."""
        self._carried += amount
        while self._carried >= _ELEMENTS_PER_STATEMENT:
            self._carried -= _ELEMENTS_PER_STATEMENT
            self.meter.statement(span)


# --------------------------------------------------------------------------- statements


def _assign(run: Interpreter, statement: Assign, scope: Scope) -> None:
    found = locate(run, statement.value, scope)
    store(run, statement.target, found, scope, statement.storage)


def _evaluate(run: Interpreter, statement: Evaluate, scope: Scope) -> None:
    evaluate(run, statement.expression, scope)


def _return(run: Interpreter, statement: Return, scope: Scope) -> None:
    if statement.value is None:
        raise Returned(NOTHING)
    raise Returned(locate(run, statement.value, scope))


def _keyword(run: Interpreter, statement: Keyword, scope: Scope) -> None:
    if statement.word == "break":
        raise Break
    if statement.word == "continue":
        raise Continue
    if statement.word == "halt":
        raise Finished


def _unread(run: Interpreter, statement: Unread, scope: Scope) -> None:
    span = run.texts.span_of(statement)
    known_no_more = run.analysis.lost(run.tree.unread(statement))
    would = f"damaged line {span.line} would have set"
    if statement.target is not None:
        lost = Unknown(f"'{statement.target.text}', which {would}", span, damaged=True)
        store(run, statement.target, Located(lost), scope)
    lost = Unknown(f"what {would}", span, damaged=True)
    run.settings = spoiled(run.settings, known_no_more.settings, lost)
    for name in known_no_more.data - {"" if statement.target is None else statement.target.text}:
        cell = run.root.find(name)
        if cell is not None:
            cell.value, cell.sources = lost, ()
    if known_no_more.moves:
        run.stopped_somewhere(SourceError(statement.message, span), span)
    else:
        run.out.keep(span, "", "")


def _define(run: Interpreter, statement: Define, scope: Scope) -> None:
    scope.define((statement,))


_STATEMENTS: dict[type, Callable[[Interpreter, Any, Scope], None]] = {
    Assign: _assign,
    Evaluate: _evaluate,
    If: flow.branch,
    While: flow.loop,
    Return: _return,
    Keyword: _keyword,
    ThreadEnd: threads.end,
    Define: _define,
    Unread: _unread,
}
