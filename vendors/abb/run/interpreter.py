"""Runs a program: statements → the moves, waits and kept statements that the robot goes through.

Values that only the running controller has (signals, clocks, an operator's answers) travel as
`Unknown` through assignments; where a branch or a loop depends on one, `flow` decides, and
where a move does, it is refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import NoReturn
from weakref import proxy

from ....core.errors import Note, SourceError, Span, StopError
from ....core.program.move import Statement as ProgramStatement
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.control_flow.flow import Flow
from ....core.source.execution.control_flow.loops import Loop
from ....core.source.execution.provenance import ELSEWHERE
from ....core.source.reading import ReadOptions
from ....core.source.text.nodes import no_label
from ..motion.settings_instructions import SETS
from ..syntax import tree
from ..values.data import Globals
from ..values.defaults import default_of
from ..values.errors import ProgramError
from ..values.scope import Scope, Variable
from ..values.types import Unknown, Value, find_unknown, interpreted, mismatch
from .analysis import RapidTree
from .calls import leave_open, pass_arguments, present
from .entry import MAIN
from .flow import run_for, run_if, run_test, run_while
from .host import Finished, RapidHost
from .instructions import INTERPRETED, MOVING
from .kept import KEPT, REFUSED
from .late import call_late, call_named
from .passes import decisive, next_pass
from .recovery import Frame, Retry, TryNext, raised, recover
from .stepped_over import keep, step_over_missing, step_over_unread
from .traps import connect


class _Returned(Exception):
    def __init__(self, value: Value | None) -> None:
        self.value = value


class _Jump(Exception):
    def __init__(self, goto: tree.Goto) -> None:
        self.goto = goto


class Interpreter(RapidHost):
    """One run of a program.

    Args:
        data: modules, routines and data of the program.
        texts: source texts by file, from which kept statements are cut.
        options: answers, limits and the robot.
        external_axes: see `Converter`.

    Attributes:
        ran: ids of the routines that were called.
    """

    def __init__(
        self,
        data: Globals,
        texts: dict[str, str],
        options: ReadOptions,
        external_axes: Sequence[str] | None,
    ) -> None:
        super().__init__(data, texts, options, external_axes)
        host = proxy(self)
        self.tree = RapidTree(data, lambda: host.home)
        self.analysis = Analysis(self.tree)
        self.flow: Flow[tree.Block] = Flow(self.analysis, host)
        self.ran: set[int] = set()
        self._loops: dict[int, tree.Block] = {}  # bodies of loops that a GOTO closes, by its id

    # --------------------------------------------------------------------- the run

    def run(self, entry: tree.Routine, arguments: tuple[tree.Argument, ...] | None = None) -> None:
        """Execute a procedure to its end; ``main`` as often as the user says.

        Args:
            arguments: of it; None where nobody gives any.
        """
        scope = self.data.scope_of(entry)
        before = decisive(self.evaluator, entry.body, scope) if entry.name == MAIN else ()
        with suppress(Finished):
            for _ in range(self.course.answers.cycles if entry.name == MAIN else 1):
                try:
                    self.call(entry, arguments, scope, entry.span)
                except StopError as error:
                    if not self.out.stops(error):
                        raise
                    return
            body, once = self.tree.body(entry), self.course.answers.cycles == 1
            other = next_pass(self.evaluator, before, self.analysis, body) if once else None
            if other is not None:
                self.out.notes.once("pass", other[1], other[0].span)

    def statements(self) -> tuple[ProgramStatement, ...]:
        """What was executed, each move with the origin of its numbers."""
        return self.out.statements(self.evaluator.reads)

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about the run."""
        return (
            *self.data.notes,
            *self.out.notes.notes(),
            *self.convert.notes(),
            *self.course.notes(),
        )

    # -------------------------------------------------------------------- statements

    def run_block(self, block: tree.Block, scope: Scope) -> None:
        """Execute statements in order."""
        statements = block.statements
        index = 0
        while index < len(statements):
            try:
                self._run_statement(statements[index], scope)
                index += 1
            except _Jump as jump:
                index = self._after_jump(block, index, jump.goto, scope)
            except ProgramError as error:
                self.evaluator.reader, self.evaluator.setting = ELSEWHERE, False
                if not recover(self, self._frames[-1], statements[index], error):
                    index += 1

    def _after_jump(self, block: tree.Block, index: int, goto: tree.Goto, scope: Scope) -> int:
        """Index of the statement where a block goes on after a jump out of one of its statements.

        A jump back that stands in the block itself closes a loop.

        Raises:
            _Jump: the label is further out.
        """

        def carry_out(way: tree.Block) -> bool:
            self.run_block(way, scope)
            return True

        while goto.name in block.labels:
            target = block.labels[goto.name]
            if target > index:
                return target - 1  # the label itself
            always = goto is block.statements[index]
            body = self._loops.setdefault(
                id(goto), tree.Block(block.statements[target - 1 : index + 1])
            )
            loop = Loop(body, goto.span, f"GOTO {goto.name}", endless=always)
            label = id(block.statements[target - 1])
            try:
                if self.flow.jump(loop, label, id(goto), carry_out):
                    return target
                return index + 1
            except _Jump as jump:
                goto = jump.goto
        raise _Jump(goto)

    def _run_statement(self, statement: tree.Statement, scope: Scope) -> None:
        self.meter.statement(statement.span)
        self.course.supposed = ""
        if isinstance(statement, tree.Invoke):
            self._invoke(statement, scope)
        elif isinstance(statement, tree.Assign):
            value = self.evaluator.evaluate(statement.value, scope)
            if not statement.target.path and find_unknown(value) is not None:
                cell = scope.find(statement.target.name)
                if cell is not None and not cell.dimensions:
                    self.evaluator.answers.used_as(statement.value, value, cell.type)
            self.evaluator.assign(statement.target, value, scope)
        elif isinstance(statement, tree.If):
            run_if(self, statement, scope)
        elif isinstance(statement, tree.For):
            run_for(self, statement, scope)
        elif isinstance(statement, tree.While):
            run_while(self, statement, scope)
        elif isinstance(statement, tree.Test):
            run_test(self, statement, scope)
        elif isinstance(statement, tree.Return):
            value_ = statement.value
            raise _Returned(None if value_ is None else self.evaluator.evaluate(value_, scope))
        elif isinstance(statement, tree.Goto):
            raise _Jump(statement)
        elif isinstance(statement, tree.LateInvoke):
            call_late(self, statement, scope)
        elif isinstance(statement, tree.Label):
            self.flow.label(id(statement), statement.name)
        elif isinstance(statement, tree.Keyword):
            self._keyword(statement, scope)
        elif isinstance(statement, tree.Unread):
            step_over_unread(self, statement, scope)

    def _keyword(self, statement: tree.Keyword, scope: Scope) -> None:
        if statement.word == "exit":
            raise Finished
        if statement.word == "connect":
            trap = self.data.routine(statement.name, scope.home)
            if trap is not None:
                connect(self, trap, statement.span)
            self.out.keep(statement.span, "CONNECT", KEPT["connect"].why)
            return
        if statement.word == "placeholder":
            message = "statements that are not filled in (<SMT>) are stepped over"
            self.out.notes.count(message, statement.span)
            return
        frame = self._frames[-1]
        if statement.word == "raise":
            raise raised(self, frame, statement, scope)
        if frame.error is None:
            word = statement.word.upper()
            raise SourceError(f"{word} stands outside an error handler", statement.span)
        raise Retry if statement.word == "retry" else TryNext

    def leave(self) -> NoReturn:
        """RETURN without a value."""
        raise _Returned(None)

    # ------------------------------------------------------------------------- calls

    def _invoke(self, statement: tree.Invoke, scope: Scope) -> None:
        name = statement.name
        routine = self.data.routine(name, scope.home)
        if routine is not None and routine.kind == "proc":
            self.call(routine, statement.arguments, scope, statement.span)
            return
        statement = self._with_present_arguments(statement, scope)
        handler = INTERPRETED.get(name)
        if handler is not None:
            self.evaluator.reader = self.out.move_index if name in MOVING else ELSEWHERE
            self.evaluator.setting = name in SETS
            try:
                handler(self, statement, scope)
            except SourceError as error:
                if not self._gone_on(statement, error):
                    raise
            self.evaluator.reader, self.evaluator.setting = ELSEWHERE, False
            return
        if name in KEPT:
            self.keep(statement, scope)
            return
        routine = None if name in REFUSED else self.fetched(statement, scope)
        if routine is not None:
            self.call(routine, statement.arguments, scope, statement.span)
        else:
            step_over_missing(self, statement, scope)

    def _gone_on(self, statement: tree.Invoke, error: SourceError) -> bool:
        """Whether the program goes on behind an instruction that cannot be carried out: a move
        stays open, and of what a setting sets nobody knows the value."""
        handled = any(frame.routine.handler is not None for frame in self._frames)
        if isinstance(error, ProgramError) and handled:
            return False
        settings = SETS.get(statement.name)
        if settings is None:
            return statement.name in MOVING and self.open_move(error, statement.span)
        if not self.course.answers.mends or isinstance(error, ProgramError):
            return False
        message = str(error).removeprefix(f"{error.span}: ")
        said = f"{message}: what it sets is not known from here on"
        self.out.notes.count(said, statement.span, damage=True)
        self.settings.lose(settings, f"{statement.text} in line {statement.span.line}: {message}")
        self.out.keep(statement.span, statement.text, "")
        return True

    def fetched(self, statement: tree.Invoke, scope: Scope) -> tree.Routine | None:
        """A procedure of a module beside the program."""
        found = self.data.fetched_routine(statement.name, scope.home, statement.span)
        return found if found is not None and found.kind == "proc" else None

    def keep(self, statement: tree.Invoke, scope: Scope) -> None:
        """Step over an instruction that does not move the robot; it stays as it stands."""
        keep(self, statement, scope)

    def _with_present_arguments(self, statement: tree.Invoke, scope: Scope) -> tree.Invoke:
        """Without the arguments that are handed on from absent parameters."""
        if not any(a.conditional for a in statement.arguments):
            return statement
        return replace(statement, arguments=tuple(present(statement.arguments, scope)))

    def call_named(
        self,
        name: str,
        arguments: tuple[tree.Argument, ...],
        scope: Scope,
        span: Span,
        unknown: Unknown | None = None,
    ) -> None:
        """Call the procedure that a string names.

        Raises:
            SourceError: there is none.
        """
        call_named(self, name, arguments, scope, span, unknown)

    def call_function(self, routine: tree.Routine, call: tree.Call, scope: Scope) -> Value:
        reader, self.evaluator.reader = self.evaluator.reader, ELSEWHERE
        supposed = self.course.supposed
        value = self.call(routine, call.arguments, scope, call.span)
        self.course.supposed = supposed or self.course.supposed
        self.evaluator.reader = reader
        type_ = self.data.type(routine.returns or "", self.data.scope_of(routine).home, call.span)
        if value is None:
            if not self.course.guessed:
                raise SourceError(f"{routine.text} ends without RETURN and a value", call.span)
            # On its true way, which nobody knows, it may well return.
            reason = f"the value of {routine.text}(), which the way taken ends without RETURN"
            key = self.evaluator.answers.key(call.span)
            return Unknown(reason, call.span, key, default_of(type_))
        wrong = mismatch(value, type_)
        if wrong is not None:
            raise SourceError(f"the value of {routine.text}: {wrong}", call.span)
        return interpreted(value, type_, call.span)

    def call(
        self,
        routine: tree.Routine,
        arguments: tuple[tree.Argument, ...] | None,
        caller: Scope,
        span: Span,
    ) -> Value | None:
        """Run a routine; without arguments, these are not known."""
        outer = self.data.scope_of(routine)
        scope = outer.inner(f"{routine.kind.upper()} {routine.text}")
        back: list[tuple[Variable, tree.Name]] = []
        if arguments is None:
            leave_open(self.evaluator, routine, scope)
        else:
            given = tuple(present(arguments, caller))
            back = pass_arguments(self.evaluator, routine, given, caller, scope, span)
        for declaration in routine.declarations:
            self.data.declare(declaration, scope)
        self.meter.call(routine.text, span)
        self.ran.add(id(routine))
        if self._frames:
            self.out.called(span)
        where, self.out.notes.where = self.out.notes.where, scope.where
        self._frames.append(Frame(routine, scope))
        try:
            with self.flow.routine(routine.text, span):
                self.run_block(self.tree.body(routine), scope)
        except _Returned as returned:
            return returned.value
        except _Jump as jump:
            raise no_label(jump.goto) from None
        finally:
            self.meter.back()
            self.out.notes.where = where
            self._frames.pop()
            for cell, target in back:
                self._hand_back(cell, target, caller)
        return None

    def _hand_back(self, cell: Variable, target: tree.Name, caller: Scope) -> None:
        """What a routine made of an element or component that was passed by reference."""
        if cell.source is None and cell.value is not None:
            with self.course.apart():
                self.course.suppose(cell.supposed)
                self.evaluator.assign(target, cell.value, caller)
