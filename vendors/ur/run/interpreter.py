"""Runs a program: statements → the moves, waits and kept statements that the robot goes through.

What the text leaves open travels as `Unknown` through assignments. Where a branch or a loop
depends on it, `core.source.answers.Course` decides; a move that depends on it is refused by name.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any

from ....core.errors import Note, Span
from ....core.program.move import Move, Opaque, Wait
from ....core.program.move import Statement as ProgramStatement
from ....core.program.origin import MoveOrigin
from ....core.source.execution.answers import Course
from ....core.source.execution.limits import Meter
from ....core.source.execution.outputs import Outputs
from ....core.source.reading import ReadOptions
from ..motion.configuration import UrConfiguration
from ..motion.kinematics import joints_of, solution, to_near
from ..motion.moves import MoveParts
from ..motion.position import Position
from ..motion.settings import Settings
from ..syntax.texts import Texts
from ..syntax.traversal import returns
from ..syntax.tree import (
    Assign,
    Block,
    Call,
    Define,
    Evaluate,
    Expression,
    If,
    Keyword,
    MethodCall,
    Return,
    Run,
    Statement,
    ThreadEnd,
    While,
)
from ..values.assignments import Assignments
from ..values.evaluator import Evaluator
from ..values.located import NOTHING, Located
from ..values.scope import Function, Scope
from ..values.values import Solution, Unknown, Value
from .analysis import Flow
from .calls import Calls
from .exits import Break, Continue, Finished, Returned
from .flow import Loops
from .notes import Notebook
from .threads import Threads

_ELEMENTS_PER_STATEMENT = 100
"""Elements of a list that are copied in the time of a statement."""


class Interpreter:
    """One run of a program.

    Args:
        texts: source texts.
        flow: what can be said of its statements without running them.
        options: robot, answers and limits.
    """

    def __init__(self, texts: Texts, flow: Flow, options: ReadOptions) -> None:
        self.texts = texts
        self.flow = flow
        self.course = Course(options.answers)
        self.meter = Meter(options.limits, options.executed)
        self.settings = Settings()
        self.outputs = Outputs()
        self.position = Position(options.robot, options.start)
        self.notebook = Notebook()
        self.root = Scope("the program")
        self.threads = Threads(self)
        self.calls = Calls(self)
        self.loops = Loops(self)
        self.evaluator = Evaluator(texts, self.course, self)
        self.assignments = Assignments(self.evaluator, self)
        self.statement: Statement | None = None
        self.entered: set[str] = set()
        self._statements: list[ProgramStatement] = []
        self._parts: list[MoveParts] = []
        self.decisions = 0
        self._carried = 0
        self._spans: dict[tuple[int, int], Span] = {}
        self._by_type: dict[type, Callable[[Any, Scope], None]] = {
            Assign: self.assignments.carry_out,
            Evaluate: self._evaluate,
            If: self._if,
            While: self.loops.carry_out,
            Return: self._return,
            Keyword: self._keyword,
            ThreadEnd: self.threads.end,
            Define: self._define,
        }

    # --------------------------------------------------------------------- the run

    def run_top(self, block: Block) -> None:
        """Execute statements that stand in no function, up to the end of the program.

        Raises:
            Finished: it has ended.
        """
        with suppress(Returned):
            self.run_block(block, self.root)

    def statements(self) -> tuple[ProgramStatement, ...]:
        """What was executed, each move with the origin of its numbers."""
        parts = enumerate(self._parts)
        return tuple(
            statement
            if isinstance(statement, Wait | Opaque)
            else replace(statement, origin=self._origin(*next(parts)))
            for statement in self._statements
        )

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about the run."""
        return (*self.course.notes(), *self.notebook.notes())

    def _origin(self, index: int, parts: MoveParts) -> MoveOrigin:
        reads = self.evaluator.reads
        return MoveOrigin(
            parts.statement,
            reads.origin(parts.target, index),
            reads.origin(parts.speed, index),
            reads.origin(parts.zone, index),
            None if parts.via is None else reads.origin(parts.via, index),
        )

    # ------------------------------------------------------------- for its helpers

    @property
    def move_index(self) -> int:
        """Index of the move that is being read, or comes next."""
        return len(self._parts)

    def emit(self, statement: Wait | Opaque) -> None:
        """Put a statement that is no move at the end of the program."""
        self._statements.append(statement)

    def emit_move(self, move: Move, parts: MoveParts) -> None:
        """Put a move at the end of the program.

        Raises:
            SourceError: there are too many, or a thread moves the robot already.
        """
        self.meter.move(parts.statement)
        self.threads.check_free(parts.statement)
        reads = self.evaluator.reads
        for part in parts.all():
            for source in filter(None, part.sources):
                reads.by_move(source, self.move_index)
        self._statements.append(move)
        self._parts.append(parts)
        self.position.moved(move, parts.statement)

    def finish(self, message: str, span: Span) -> None:
        """End the program here, with a note.

        Raises:
            Finished: always.
        """
        self.notebook.once("end", message, span)
        raise Finished

    def state(self) -> list[Value]:
        """What, beside variables, decides how the program goes on."""
        return [self.position.asked, str(self.settings)]

    def work(self, amount: int, span: Span) -> None:
        """See `evaluator.Host`."""
        self._carried += amount
        while self._carried >= _ELEMENTS_PER_STATEMENT:
            self._carried -= _ELEMENTS_PER_STATEMENT
            self.meter.statement(span)

    def call(self, call: Call, scope: Scope) -> Located:
        """See `evaluator.Host`."""
        return self.calls.call(call, scope)

    def method(self, call: MethodCall, scope: Scope) -> Value:
        """See `evaluator.Host`."""
        return self.calls.method(call, scope)

    def start_thread(self, run: Run, scope: Scope) -> Value:
        """See `evaluator.Host`."""
        return self.threads.start(run, scope)

    def joints(self, solution: Solution) -> Value:
        """See `evaluator.Host`."""
        return joints_of(self, solution)

    def solution(self, call: Call, scope: Scope) -> Solution | Unknown:
        """What ``get_inverse_kin(…)`` returns."""
        return solution(self, call, scope)

    def near(self, value: Value, node: Expression) -> UrConfiguration:
        """A ``qnear``."""
        return to_near(self, value, node)

    # -------------------------------------------------------------------- statements

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""
        for statement in block:
            self.meter.statement(self.span_of(statement))
            self.statement = statement
            self._by_type[type(statement)](statement, scope)

    def span_of(self, node: Statement | Call) -> Span:
        """Where a statement, or the call that is one, stands."""
        place = node.start, node.end
        span = self._spans.get(place)
        if span is None:
            span = self._spans[place] = self.texts.span(*place)
        return span

    def hoist(self, block: Block, scope: Scope) -> None:
        """Make the functions known that a block defines."""
        for statement in block:
            if isinstance(statement, Define):
                self._define(statement, scope)

    def _define(self, define: Define, scope: Scope) -> None:
        scope.functions[define.name] = Function(define, scope)

    def _evaluate(self, statement: Evaluate, scope: Scope) -> None:
        self.evaluator.evaluate(statement.expression, scope)

    def _return(self, statement: Return, scope: Scope) -> None:
        if statement.value is None:
            raise Returned(NOTHING)
        raise Returned(self.evaluator.locate(statement.value, scope))

    def _keyword(self, statement: Keyword, scope: Scope) -> None:
        if statement.word == "break":
            raise Break
        if statement.word == "continue":
            raise Continue
        if statement.word == "halt":
            raise Finished

    # -------------------------------------------------------------------- branches

    def _if(self, statement: If, scope: Scope) -> None:
        for index, branch in enumerate(statement.branches):
            fulfilled = self.evaluator.condition(branch.condition, scope)
            if isinstance(fulfilled, Unknown):
                self._undecided(statement, index, fulfilled, scope)
                return
            if fulfilled:
                self.run_block(branch.body, scope)
                return
        if statement.otherwise is not None:
            self.run_block(statement.otherwise, scope)

    def _undecided(self, statement: If, first: int, reason: Unknown, scope: Scope) -> None:
        """The condition of branch ``first`` is not known."""
        bodies = [branch.body for branch in statement.branches]
        if statement.otherwise is not None:
            bodies.append(statement.otherwise)
        main = self.calls.in_entry
        possible = [
            k >= first and self.flow.can_be_taken(body) and not self.flow.ends(body, main)
            for k, body in enumerate(bodies)
        ]
        self.decisions += 1
        head = self.texts.span(statement.start, statement.start + len("if"))
        taken = self.course.branch(head, reason.reason, possible)
        otherwise = statement.otherwise
        if taken == 0 and otherwise is not None and not self.flow.ends(otherwise, main):
            taken = len(bodies)
        for k, body in enumerate(bodies[first:], first + 1):
            if returns(body):
                self.calls.return_depends(reason)
            if k != taken:
                self.loops.open_by(body, reason)
                self._leave_open(body, reason, scope)
        if taken:
            self.run_block(bodies[taken - 1], scope)

    def _leave_open(self, body: Block, reason: Unknown, scope: Scope) -> None:
        """Variables that only a branch makes that is not taken are there, but not known."""
        for name in self.flow.assigns(body):
            if scope.find(name) is None:
                scope.own(name).value = reason
