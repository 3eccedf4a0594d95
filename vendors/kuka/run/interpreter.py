"""Runs a program: statements → the moves, waits and kept statements that the robot goes through.

A program is executed where its course follows from its own text. Values that only the running
controller has (inputs, clocks) travel as `Unknown` through assignments; what depends on one is
answered by the user or decided by rule (`core.source.answers`), and refused where a move does.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress

from ....core.errors import LeftOpenError, Note, SourceError, Span, StopError
from ....core.program.call import Call as ProgramCall
from ....core.program.entry_point import EntryPoint
from ....core.program.move import Statement as ProgramStatement
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.control_flow.flow import Flow as Rules
from ....core.source.execution.course import Course
from ....core.source.execution.limits import Meter
from ....core.source.execution.streams import Streaming
from ....core.source.execution.transcript import Transcript
from ....core.source.reading import ReadOptions
from ..motion.bas import Basis
from ..motion.frames import Placements
from ..motion.inline_forms import InlineForms
from ..motion.kinematics import Kinematics
from ..motion.moves import MotionReader
from ..motion.own_position import OwnPosition
from ..motion.position import Position
from ..motion.settings import Settings
from ..motion.tables import Tables
from ..motion.target_expressions import TargetExpressions
from ..motion.targets import Targets
from ..motion.triggers import Triggers
from ..syntax.tree import (
    Assign,
    Block,
    Call,
    Continue,
    Declaration,
    EnumDefinition,
    Exit,
    Expression,
    For,
    Goto,
    Halt,
    If,
    Invoke,
    Keyword,
    Label,
    Loop,
    MotionInstruction,
    Name,
    Repeat,
    Return,
    Routine,
    SignalDeclaration,
    SplineBlock,
    Statement,
    StrucDefinition,
    Switch,
    Trigger,
    Unread,
    WaitFor,
    WaitSec,
    While,
)
from ..values.advance_run import AdvanceRun
from ..values.config_data import ConfigData
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.expected import EXPECTED
from ..values.library import Library
from ..values.predefined import MOTION, SILENT, STOPS_WHEN_SET
from ..values.scope import Scope
from ..values.types import KrlTypeError, convert
from ..values.values import Array, Pending, Unknown, Value
from .analysis import KrlTree
from .calls import Calls
from .exits import Finished, Jump
from .flow import Flow
from .host import KrlHost
from .keeping import Keeping
from .output_writes import OutputWrites
from .routines import Routines
from .waiting import Waited
from .waits import Waits


class Interpreter:
    """One run of a program.

    Args:
        library: its files.
        options: robot, answers, limits.
    """

    def __init__(self, library: Library, options: ReadOptions) -> None:
        robot, scopes = options.robot, [Scope("the entry", library.main)]
        self._library = library
        self._data = data = Data(library)
        self._course = course = Course(options.answers)
        self._meter = meter = Meter(options.limits, options.executed)
        self._transcript = transcript = Transcript(data.text, course)
        notes = transcript.notes
        self._advance = AdvanceRun()
        self._keeping = keeping = Keeping(transcript, self._advance)
        position = Position(robot, options.start)
        self._placements = placements = Placements(data.system, course, notes.once)
        transcript.streaming = Streaming(robot, position.streamed, position.left_out)
        own_position = OwnPosition(
            position, placements, lambda: transcript.move_index, course.suppose
        )
        self._evaluator = evaluator = Evaluator(
            data, course, self._function, own_position, self._advance
        )
        config = ConfigData(data, evaluator.names, scopes)
        self._settings = Settings(data.system, config.value, notes.once)
        targets = Targets(robot, position, notes.once)
        tables = Tables(robot, notes)
        self._basis = basis = Basis(data, evaluator, config, tables, notes, self._system_changed)
        self._tree = tree = KrlTree(data, evaluator.names, scopes)
        self._analysis = analysis = Analysis(tree)
        writes = OutputWrites(data, evaluator.names, tree, analysis, notes)
        self._triggers = Triggers(evaluator, transcript, writes)
        self._motions = MotionReader(
            data,
            evaluator,
            placements,
            self._settings,
            TargetExpressions(data, evaluator, targets, position, transcript),
            position,
            self._triggers,
            meter,
            transcript,
            self._system_changed,
        )
        self._host = host = KrlHost(
            course,
            meter,
            data,
            evaluator.names,
            scopes,
            position,
            own_position,
            transcript,
            self._system_changed,
        )
        rules = Rules(analysis, host)
        waited = Waited(data, evaluator, course)
        self._flow = flow = Flow(
            self.run_block, self._evaluated, evaluator, data, tree, rules, waited, notes, course
        )
        functions = {
            **InlineForms(basis, data).functions(),
            **Kinematics(robot, evaluator, placements, targets, position, tables).functions(),
        }
        self._position = position
        self._routines = Routines(data, evaluator, meter, transcript, scopes, flow.run_body)
        self._calls = Calls(
            data, evaluator, course, self._routines, basis, functions, writes, keeping
        )
        waits = Waits(evaluator, waited, writes, transcript, keeping)
        self._handlers: dict[type, Callable[..., None]] = {
            Assign: self._assign,
            MotionInstruction: self._motion,
            Invoke: self._calls.invoke,
            If: flow.if_,
            For: flow.for_,
            While: flow.while_,
            Repeat: flow.repeat_,
            Loop: flow.loop_,
            Switch: flow.switch_,
            Goto: flow.goto_,
            Return: flow.return_,
            Exit: flow.exit_,
            Halt: waits.halt,
            WaitSec: waits.wait_sec,
            WaitFor: waits.wait_for,
            Trigger: self._triggers.trigger,
            Keyword: waits.keyword,
            Unread: self._unread,
            SplineBlock: self._spline,
            Declaration: self._declare,
            SignalDeclaration: self._define,
            StrucDefinition: self._define,
            EnumDefinition: self._define,
        }

    # ---------------------------------------------------------------------- the run

    @property
    def driven(self) -> bool:
        """Whether the robot was moved."""
        return self._transcript.move_index > 0

    def entry_points(
        self, routines: Sequence[Routine], begun: Routine | None = None
    ) -> tuple[EntryPoint, ...]:
        """Those of the routines that return nothing; ``begun`` is the one that was run."""
        return tuple(
            EntryPoint(
                r.text,
                tuple(p.text for p in r.parameters),
                self._analysis.move_count(r.body),
                r is begun,
            )
            for r in routines
            if r.returns is None
        )

    def roots(self, routines: Sequence[Routine]) -> list[Routine]:
        """Of the routines those that move the robot, and that none of the others calls."""
        moving = [r for r in routines if self._analysis.moves(r.body)]
        return [
            r
            for r in moving
            if not any(id(r.body) in self._analysis.blocks_in(o.body) for o in moving if o is not r)
        ]

    def run(self, entry: Routine, arguments: tuple[Expression | None, ...] = ()) -> None:
        """Execute a routine to its end; parameters that are not given have no values."""
        call = Call(entry.span, entry.name, entry.text, arguments)
        scope = Scope("the entry", self._library.main)
        try:
            with suppress(Finished):
                self._routines.run(entry, self._library.main, call, scope)
        except StopError as error:
            if not self._transcript.stops(error):
                raise
        self._triggers.end()
        self._transcript.check_driven()

    def forget(self) -> None:
        """Let go of all that was read. The parts of a run refer to one another: what they hold
        would wait for a search for garbage, which takes as long as half the reading."""
        for part in [*vars(self).values()]:
            if hasattr(part, "__dict__"):
                vars(part).clear()
        vars(self).clear()

    def statements(self) -> tuple[ProgramStatement, ...]:
        """What was executed, each move with the origin of its numbers."""
        return self._transcript.statements(self._evaluator.reads)

    def calls(self) -> tuple[ProgramCall, ...]:
        """Routines that were entered, but for the first."""
        return tuple(self._transcript.calls)

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about the run."""
        data = (*self._library.notes, *self._data.notes)
        return (*data, *self._transcript.notes.notes(), *self._course.notes())

    @property
    def course(self) -> Course:
        """What was decided, and asked."""
        return self._course

    def _function(self, call: Call, scope: Scope) -> Value | None:
        return self._calls.call_function(call, scope)

    def _system_changed(self) -> None:
        """A system variable has another value now."""
        self._settings.changed()
        self._placements.changed()

    # ------------------------------------------------------------------- statements

    def run_block(self, block: Block, scope: Scope) -> None:
        statements = block.statements
        index = 0
        while index < len(statements):
            try:
                self._run_statement(statements[index], scope)
            except Jump as jump:
                index = self._flow.after_jump(block, index, jump.goto, scope)
                continue
            index += 1

    def _run_statement(self, statement: Statement, scope: Scope) -> None:
        self._meter.statement(statement.span)
        self._course.supposed = ""
        if isinstance(statement, Continue):
            self._advance.passed = True
            return
        handler = self._handlers.get(type(statement))
        if handler is not None:
            self._advance.stopped = False
            handler(statement, scope)
        if isinstance(statement, Label):
            self._flow.label(statement)
        else:
            self._advance.passed = False

    def _evaluated(
        self, expression: Expression, scope: Scope, span: Span, datum: str | None = None
    ) -> Value:
        """A value; if reading it stops the advance run, the robot stops here."""
        self._advance.stopped = False
        value = self._evaluator.evaluate(expression, scope, datum)
        if self._advance.stopped:
            self._keeping.stop(span)
            self._advance.stopped = False
        return value

    def _motion(self, statement: MotionInstruction, scope: Scope) -> None:
        try:
            self._motions.read(statement, scope)
        except SourceError as error:
            if not self._host.open_move(error, statement.span):
                raise

    def _unread(self, statement: Unread, scope: Scope) -> None:
        # Nobody knows what it does to what it names.
        known_no_more = self._analysis.lost(self._tree.unread(statement, scope.module))
        target = statement.target
        would = f"damaged line {statement.span.line} would have set"
        if isinstance(target, Name):
            unknown = Unknown(f"{target.text}, which {would}", statement.span, damaged=True)
            with suppress(SourceError):  # a constant stays one
                self._evaluator.assign(target, unknown, scope, statement.span)
        lost = Unknown(f"what {would}", statement.span, damaged=True)
        self._basis.spoil(known_no_more.settings, lost)
        for name in known_no_more.data - {target.name if isinstance(target, Name) else ""}:
            cell = None if name.startswith("$") else self._data.find(name, scope)
            if cell is not None and cell.signal is None and not cell.constant:
                cell.value = lost
        self._system_changed()
        if not known_no_more.moves:
            self._transcript.keep(statement.span, "", "")
        else:
            self._host.open_move(statement.error, statement.span)

    def _assign(self, statement: Assign, scope: Scope) -> None:
        target = statement.target
        datum = None if target.name.startswith("$") else self._data.text(target.span)
        value = self._evaluated(statement.value, scope, statement.span, datum)
        try:
            cell = self._evaluator.assign(target, value, scope, statement.span)
        except LeftOpenError as error:
            self._assign_somewhere(target, scope, error)
            return
        whole = cell.type if not target.path else ""
        number = isinstance(cell.value, Array) or cell.type in ("cp", "apo")
        kind = "real" if target.path and number and self._data.is_system(target.name) else whole
        if kind in EXPECTED:
            self._evaluator.used_as(value, kind)
        if target.name in MOTION:
            self._system_changed()
            return
        written = target if cell.signal is None else cell.signal[0]
        stops = written.name in STOPS_WHEN_SET
        why = "outputs do not move the robot"
        if cell.signal is None:
            if not self._data.is_system(target.name) or target.name in SILENT:
                return
            why = why if stops else "it is not emulated"
        self._keeping.keep(statement.span, written.text.upper(), why, stops)

    def _assign_somewhere(self, target: Name, scope: Scope, error: LeftOpenError) -> None:
        """An item of an array gets a value, and nobody knows which: all of it is not known."""
        cell = self._data.find(target.name, scope)
        if cell is None or cell.signal is not None:
            self._data.outputs.forget()
        else:
            what = f"the value of {target.text}, of which an item was changed"
            cell.value = Unknown(what, target.span)
        self._transcript.notes.count(f"the assignment is left out: {error.message}", target.span)

    def _spline(self, block: SplineBlock, scope: Scope) -> None:
        """The segments of a block one after the other, with what follows its ``WITH``."""
        self._transcript.notes.once(
            block.word,
            f"{block.word.upper()} blocks are driven segment by segment, each point passed in as "
            "wide a zone as there is room for: the controller's own curve goes through the points "
            "and is smoother, and its time another one",
            block.span,
        )
        with self._motions.settings_of(block.settings, scope):
            for statement in block.body:
                self._run_statement(statement, scope)

    def _declare(self, statement: Declaration, scope: Scope) -> None:
        known = scope.cells.get(statement.name)
        if known is not None:  # a parameter, or one that a loop comes by again
            known.type = statement.type
            if isinstance(known.value, Unknown | Array | None):
                return
            assert not isinstance(known.value, Pending)
            try:
                known.value = convert(known.value, statement.type, self._data.types)
            except KrlTypeError as error:
                raise SourceError(f"{statement.text}: {error}", statement.span) from None
            return
        fresh = self._data.cell(statement, scope.module)
        if statement.value is not None:
            value = self._evaluator.evaluate(statement.value, scope, statement.text)
            name = Name(statement.span, statement.name, statement.text)
            scope.cells[statement.name] = fresh
            constant, fresh.constant = fresh.constant, False
            self._evaluator.assign(name, value, scope, statement.span)
            fresh.constant = constant
            return
        scope.cells[statement.name] = fresh

    def _define(self, statement: Statement, scope: Scope) -> None:
        self._data.define(statement, scope.cells)
