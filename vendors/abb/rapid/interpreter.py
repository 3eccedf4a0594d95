"""Runs a program: statements → the moves, waits and kept statements that the robot goes through.

A program is executed where all that decides its course follows from its own text. Values that
only the running controller has (signals, clocks, the robot's position) travel as `Unknown` through
assignments and are refused as soon as a branch, a loop or a move depends on one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

from ....core.errors import Note, SourceError, Span
from ....core.program.move import Move, Opaque, Wait
from ....core.program.move import Statement as ProgramStatement
from ....core.program.origin import MoveOrigin
from .calls import pass_arguments, present
from .control import may_leave
from .convert import Converter
from .evaluator import Evaluator
from .globals import Globals
from .instructions import INTERPRETED, KEPT, REFUSED, known_names
from .motion import Sources
from .operators import OperandError, apply
from .scope import Cell, Scope, unknown_name
from .settings import Settings
from .syntax import (
    Argument,
    Assign,
    Block,
    Call,
    Expression,
    For,
    Goto,
    If,
    Invoke,
    Keyword,
    Label,
    LateInvoke,
    Name,
    Return,
    Routine,
    Statement,
    Test,
    Truth,
    While,
)
from .types import BOOL, NUM, STRING, Foreign, Unknown, Value, interpreted, mismatch

STATEMENT_LIMIT = 1_000_000
"""Statements executed; a program that needs more has no end that can be waited for."""
MOVE_LIMIT = 100_000
"""Moves executed."""
CALL_LIMIT = 40
"""Routines that have called each other."""


class _Returned(Exception):
    def __init__(self, value: Value | None) -> None:
        self.value = value


class _Jump(Exception):
    def __init__(self, goto: Goto) -> None:
        self.goto = goto


class _Finished(Exception):
    pass


class Interpreter:
    """One run of a program.

    Args:
        data: modules, routines and data of the program.
        texts: source texts by file, from which kept statements are cut.
        external_axes: see `Converter`.
    """

    def __init__(
        self, data: Globals, texts: Mapping[str, str], external_axes: Sequence[str] | None
    ) -> None:
        self.data = data
        self.settings = Settings()
        self.convert = Converter(self, external_axes)
        self.evaluator = Evaluator(data.types, data.functions, self._call_function)
        data.declare(self.evaluator)
        self._texts = texts
        self._statements: list[ProgramStatement] = []
        self._sources: list[Sources] = []
        self._notes: dict[tuple[str, str], Note] = {}
        self._kept: dict[str, tuple[Note, int]] = {}
        self._quaternions: dict[Span, float] = {}
        self._where = ""
        self._depth = 0
        self._executed = 0

    # --------------------------------------------------------------------- the run

    def run(self, entry: Routine) -> None:
        """Execute a procedure without parameters to its end."""
        with suppress(_Finished):
            self._call(entry, (), self.data.scope_of(entry), entry.span)

    def statements(self) -> tuple[ProgramStatement, ...]:
        """What was executed, each move with the origin of its numbers."""
        sources = enumerate(self._sources)
        return tuple(
            statement
            if isinstance(statement, Wait | Opaque)
            else replace(statement, origin=self._origin(*next(sources)))
            for statement in self._statements
        )

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about the run."""
        notes = list(self._notes.values())
        for note, count in self._kept.values():
            times = f" ({count} times, here first)" if count > 1 else ""
            notes.append(replace(note, message=note.message + times))
        if self._quaternions:
            worst = max(self._quaternions.values())
            first = next(iter(self._quaternions))
            count = len(self._quaternions)
            what = "a quaternion is" if count == 1 else f"{count} quaternions are"
            notes.append(
                Note(f"{what} not of unit length (by {worst:.1g} at most): normalised", span=first)
            )
        return tuple(notes)

    def _origin(self, index: int, sources: Sources) -> MoveOrigin:
        reads = self.evaluator.reads
        return MoveOrigin(
            sources.statement,
            reads.origin(sources.target, index),
            reads.origin(sources.speed, index),
            reads.origin(sources.zone, index),
            None if sources.via is None else reads.origin(sources.via, index),
        )

    # ------------------------------------------------------ for instruction handlers

    @property
    def move_index(self) -> int:
        """Index of the move that is being read, or comes next."""
        return len(self._sources)

    def number(self, expression: Expression, scope: Scope, use: str) -> float:
        """A known num; see `Evaluator.known`."""
        return self.evaluator.number(expression, scope, use)

    def emit(self, statement: Wait | Opaque) -> None:
        """Put a statement that is no move at the end of the program."""
        self._statements.append(statement)

    def emit_move(self, move: Move, sources: Sources) -> None:
        """Put a move at the end of the program.

        Raises:
            SourceError: there are more than `MOVE_LIMIT`.
        """
        if len(self._sources) >= MOVE_LIMIT:
            raise self._endless(f"{MOVE_LIMIT} moves", sources.statement)
        self._statements.append(move)
        self._sources.append(sources)

    def keep(self, statement: Invoke | Keyword, why: str, stops: bool = False) -> None:
        """Keep a statement as it stands, with one note per kind, at the first of them."""
        span = statement.span
        text = self._texts[span.file][span.start : span.end]
        self.emit(Opaque(text, stops, span))
        if why:
            name = statement.text if isinstance(statement, Invoke) else statement.word.upper()
            message = f"{name} is kept and not carried out: {why}"
            first, count = self._kept.get(message.lower(), (Note(message, span=span), 0))
            self._kept[message.lower()] = first, count + 1

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless this kind was noted in this routine before."""
        where = f" (in {self._where})" if self._where else ""
        self._notes.setdefault((self._where, kind), Note(message + where, span=span))

    def note_quaternion(self, error: float, span: Span) -> None:
        """A quaternion was scaled to unit length."""
        self._quaternions.setdefault(span, error)

    def change(
        self, target: Expression, add: Expression | None, amount: float | None, scope: Scope
    ) -> None:
        """Add to a num, or clear it if ``amount`` is None."""
        if not isinstance(target, Name):
            raise SourceError("a variable is wanted here", target.span)
        value: Value = 0.0
        if amount is not None:
            step = amount if add is None else self.evaluator.evaluate(add, scope)
            try:
                value = apply("+", self.evaluator.evaluate(target, scope), step)
            except OperandError as error:
                raise SourceError(str(error), target.span) from None
        self.evaluator.assign(target, value, scope)

    def finish(self, message: str, span: Span) -> None:
        """End the program here, with a note."""
        self.note_once("end", message, span)
        raise _Finished

    # -------------------------------------------------------------------- statements

    def _run_block(self, block: Block, scope: Scope) -> None:
        statements = block.statements
        index = 0
        while index < len(statements):
            try:
                self._run_statement(statements[index], scope)
            except _Jump as jump:
                if jump.goto.name not in block.labels:
                    raise
                index = block.labels[jump.goto.name]
                continue
            index += 1

    def _run_statement(self, statement: Statement, scope: Scope) -> None:
        self._executed += 1
        if self._executed > STATEMENT_LIMIT:
            raise self._endless(f"{STATEMENT_LIMIT} statements", statement.span)
        if isinstance(statement, Invoke):
            self._invoke(statement, scope)
        elif isinstance(statement, Assign):
            value = self.evaluator.evaluate(statement.value, scope)
            self.evaluator.assign(statement.target, value, scope)
        elif isinstance(statement, If):
            self._if(statement, scope)
        elif isinstance(statement, For):
            self._for(statement, scope)
        elif isinstance(statement, While):
            self._while(statement, scope)
        elif isinstance(statement, Test):
            self._test(statement, scope)
        elif isinstance(statement, Return):
            value_ = statement.value
            raise _Returned(None if value_ is None else self.evaluator.evaluate(value_, scope))
        elif isinstance(statement, Goto):
            raise _Jump(statement)
        elif isinstance(statement, LateInvoke):
            self._late(statement, scope)
        elif not isinstance(statement, Label):
            self._keyword(statement)

    def _if(self, statement: If, scope: Scope) -> None:
        for branch in statement.branches:
            if self.evaluator.known(branch.condition, scope, BOOL, "IF"):
                self._run_block(branch.body, scope)
                return
        if statement.otherwise is not None:
            self._run_block(statement.otherwise, scope)

    def _for(self, loop: For, scope: Scope) -> None:
        start = self.number(loop.start, scope, "FOR")
        stop = self.number(loop.stop, scope, "FOR")
        # Without STEP the controller counts down where it has to.
        step = 1.0 if start <= stop else -1.0
        if loop.step is not None:
            step = self.number(loop.step, scope, "FOR")
        if step == 0:
            raise SourceError("STEP is zero: the loop has no end", loop.span)
        counter = Cell(loop.name, NUM)
        inner = Scope(scope.where, {loop.name: counter}, scope)
        value = start
        while value <= stop if step > 0 else value >= stop:
            counter.value = value
            self._run_block(loop.body, inner)
            self._executed += 1
            if self._executed > STATEMENT_LIMIT:
                raise self._endless(f"{STATEMENT_LIMIT} statements", loop.span)
            value += step

    def _while(self, loop: While, scope: Scope) -> None:
        forever = isinstance(loop.condition, Truth) and loop.condition.value
        if forever and not may_leave(loop.body):
            self._run_block(loop.body, scope)
            self.finish("the program is an endless loop (WHILE TRUE): one pass is read", loop.span)
        while self.evaluator.known(loop.condition, scope, BOOL, "WHILE"):
            self._run_block(loop.body, scope)
            self._executed += 1
            if self._executed > STATEMENT_LIMIT:
                raise self._endless(f"{STATEMENT_LIMIT} statements", loop.span)

    def _test(self, test: Test, scope: Scope) -> None:
        subject = self._decided(test.subject, scope)
        for case in test.cases:
            for expression in case.values:
                try:
                    equal = apply("=", subject, self._decided(expression, scope))
                except OperandError as error:
                    raise SourceError(f"TEST: {error}", expression.span) from None
                if equal:
                    self._run_block(case.body, scope)
                    return
        if test.otherwise is not None:
            self._run_block(test.otherwise, scope)

    def _decided(self, expression: Expression, scope: Scope) -> Value:
        value = self.evaluator.evaluate(expression, scope)
        self.evaluator.check(value, Foreign("any"), "TEST", expression.span)
        return value

    def _keyword(self, statement: Keyword) -> None:
        if statement.word == "exit":
            raise _Finished
        if statement.word == "connect":
            self.keep(statement, KEPT["connect"].why)
            return
        what = {
            "placeholder": "this statement is not filled in: write it, or take it out",
            "raise": "RAISE hands an error to a handler, and error handlers are not run",
            "retry": "RETRY stands outside an error handler",
            "trynext": "TRYNEXT stands outside an error handler",
        }
        raise SourceError(what[statement.word], statement.span)

    def _endless(self, what: str, span: Span) -> SourceError:
        return SourceError(
            f"{what} are executed and the program has not ended: a loop without end? Give it an "
            "end, or choose a routine without it as the entry",
            span,
        )

    # ------------------------------------------------------------------------- calls

    def _invoke(self, statement: Invoke, scope: Scope) -> None:
        routine = self.data.procedures.get(statement.name)
        if routine is not None:
            self._call(routine, statement.arguments, scope, statement.span)
            return
        statement = self._with_present_arguments(statement, scope)
        handler = INTERPRETED.get(statement.name)
        if handler is not None:
            self.evaluator.reader = self.move_index if statement.name.startswith("move") else -1
            handler(self, statement, scope)
            self.evaluator.reader = -1
            return
        kept = KEPT.get(statement.name)
        if kept is not None:
            self._run_functions_in(statement.arguments, scope)
            if kept.writes:
                self._forget(statement, scope)
            self.keep(statement, kept.why, kept.stops)
            return
        raise self._refusal(statement)

    def _refusal(self, statement: Invoke) -> SourceError:
        reason = REFUSED.get(statement.name)
        if reason is not None:
            return SourceError(f"{statement.text} is refused: {reason}", statement.span)
        known = {r.text for r in self.data.procedures.values()} | known_names()
        return SourceError(
            f"{unknown_name('instruction or routine', statement.text, known)}; it might move the "
            "robot, so it is not stepped over: put its text into this module, or take the call out",
            statement.span,
        )

    def _with_present_arguments(self, statement: Invoke, scope: Scope) -> Invoke:
        """Without the arguments that are handed on from absent parameters."""
        if not any(a.conditional for a in statement.arguments):
            return statement
        return replace(statement, arguments=tuple(present(statement.arguments, scope)))

    def _run_functions_in(self, arguments: tuple[Argument, ...], scope: Scope) -> None:
        """Functions of the program itself may move the robot, even for a message's text."""
        for argument in arguments:
            value = argument.value
            if isinstance(value, Call) and value.name in self.data.functions:
                self.evaluator.evaluate(value, scope)

    def _forget(self, statement: Invoke, scope: Scope) -> None:
        """Data that a kept instruction may have written have no known value any more."""
        for argument in statement.arguments:
            if not isinstance(argument.value, Name):
                continue
            cell = scope.find(argument.value.name)
            if cell is not None and not cell.constant:
                self.evaluator.settle(cell)
                cell.value = Unknown(f"what {statement.text} gave {cell.name}", statement.span)
                cell.source = cell.predefined = None

    def _late(self, statement: LateInvoke, scope: Scope) -> None:
        name = self.evaluator.known(statement.routine, scope, STRING, "the routine to call")
        assert isinstance(name, str)
        routine = self.data.procedures.get(name.lower())
        if routine is None:
            known = [r.text for r in self.data.procedures.values()]
            raise SourceError(unknown_name("routine", name, known), statement.span)
        self._call(routine, statement.arguments, scope, statement.span)

    def _call_function(self, routine: Routine, call: Call, scope: Scope) -> Value:
        reader, self.evaluator.reader = self.evaluator.reader, -1
        value = self._call(routine, call.arguments, scope, call.span)
        self.evaluator.reader = reader
        if value is None:
            raise SourceError(f"{routine.text} ends without RETURN and a value", call.span)
        type_ = self.data.types.get(routine.returns or "", Foreign(routine.returns or ""))
        wrong = mismatch(value, type_)
        if wrong is not None:
            raise SourceError(f"the value of {routine.text}: {wrong}", call.span)
        return interpreted(value, type_, call.span)

    def _call(
        self, routine: Routine, arguments: tuple[Argument, ...], caller: Scope, span: Span
    ) -> Value | None:
        if self._depth >= CALL_LIMIT:
            raise SourceError(
                f"more than {CALL_LIMIT} routines have called each other: {routine.text} calls "
                "itself without end?",
                span,
            )
        where = self._where
        scope = Scope(f"{routine.kind.upper()} {routine.text}", {}, self.data.scope_of(routine))
        pass_arguments(
            self.evaluator, routine, tuple(present(arguments, caller)), caller, scope, span
        )
        for declaration in routine.declarations:
            self.evaluator.declare(declaration, scope)
        self._depth += 1
        self._where = scope.where
        if routine.handlers:
            kinds = ", ".join(h.upper() for h in routine.handlers)
            self.note_once("handlers", f"handlers are not run: {kinds}", routine.span)
        try:
            self._run_block(routine.body, scope)
        except _Returned as returned:
            return returned.value
        except _Jump as jump:
            raise SourceError(
                f"no label '{jump.goto.name}' can be reached from here", jump.goto.span
            ) from None
        finally:
            self._depth -= 1
            self._where = where
        return None
