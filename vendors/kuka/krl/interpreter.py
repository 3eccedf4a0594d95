"""Runs a program: statements → the moves, waits and kept statements that the robot goes through.

A program is executed where its course follows from its own text. Values that only the running
controller has (inputs, clocks) travel as `Unknown` through assignments; what depends on one is
answered by the user or decided by rule (`core.source.answers`), and refused where a move does.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from ....core.errors import Note, SourceError, Span
from ....core.program.event import Event
from ....core.program.move import Move, Opaque, Wait
from ....core.program.move import Statement as ProgramStatement
from ....core.program.origin import MoveOrigin
from ....core.source.answers import Course
from ....core.source.limits import Meter
from ....core.source.reading import ReadOptions
from .basis import Basis
from .calls import Calls
from .control import Moving
from .data import Data
from .evaluator import Evaluator
from .flow import Finished, Flow, Jump
from .inline import Inline
from .instructions import Kept
from .library import Library, Module
from .motion import MotionReader, Parts
from .outputs import OutputWrites
from .placement import Placements
from .position import Position
from .scope import Cell, Scope
from .settings import Settings
from .syntax import (
    Assign,
    Block,
    Continue,
    Declaration,
    EnumDefinition,
    Exit,
    For,
    Goto,
    Halt,
    If,
    Invoke,
    Keyword,
    Label,
    Loop,
    Motion,
    Repeat,
    Return,
    Routine,
    SignalDeclaration,
    SplineBlock,
    Statement,
    StrucDefinition,
    Switch,
    Trigger,
    WaitFor,
    WaitSec,
    While,
)
from .system import MOTION, SILENT, STOPS_WHEN_SET
from .targets import Targets
from .terms import Call, Expression, Name
from .types import KrlTypeError, convert
from .values import Array, Pending, Unknown, Value, copied
from .waits import Waits


class Interpreter:
    """One run of a program.

    Args:
        library: its files.
        options: robot, answers, limits.

    Attributes:
        asked: how often the program has asked where the robot stands.
    """

    def __init__(self, library: Library, options: ReadOptions) -> None:
        self.library = library
        self.robot = options.robot
        self.data = Data(library)
        self.calls = Calls(self)
        self.flow = Flow(self)
        self._waits = Waits(self)
        self.output_writes = OutputWrites(self)
        self.course = Course(options.answers)
        self.evaluator = Evaluator(self.data, self.course, self.calls.call_function, self._position)
        self.settings = Settings(self.data.system, self.config, self.note_once)
        self.placements = Placements(self.data.system, self.note_once)
        self.position = Position(options.robot, options.start)
        self.asked = 0
        self.targets = Targets(options.robot, self.position)
        self.basis = Basis(self)
        self.inline = Inline(self)
        self.parts: list[Parts] = []
        self._motions = MotionReader(self)
        self.meter = Meter(options.limits, options.executed)
        self.moving = Moving(self.calls.body_of)
        self._statements: list[ProgramStatement] = []
        self._notes: dict[str, Note] = {}
        self._kept: dict[str, tuple[Note, int]] = {}
        self.events: list[tuple[Event, Span]] = []
        self._advance = False
        self.where: list[Module] = [library.main]
        self._handlers: dict[type, Callable[..., None]] = {
            Assign: self._assign,
            Motion: self._motion,
            Invoke: self.calls.invoke,
            If: self.flow.if_,
            For: self.flow.for_,
            While: self.flow.while_,
            Repeat: self.flow.repeat_,
            Loop: self.flow.loop_,
            Switch: self.flow.switch_,
            Goto: self.flow.goto_,
            Return: self.flow.return_,
            Exit: self.flow.exit_,
            Halt: self._waits.halt,
            WaitSec: self._waits.wait_sec,
            WaitFor: self._waits.wait_for,
            Trigger: self._waits.trigger,
            Keyword: self._waits.keyword,
            SplineBlock: self._waits.spline,
            Declaration: self._declare,
            SignalDeclaration: self._define,
            StrucDefinition: self._define,
            EnumDefinition: self._define,
        }

    # ---------------------------------------------------------------------- the run

    def run(self, entry: Routine) -> None:
        """Execute a routine to its end; its parameters have no values."""
        call = Call(entry.span, entry.name, entry.text, ())
        scope = Scope("the entry", self.library.main)
        with suppress(Finished):
            self.calls.run_routine(entry, self.library.main, call, scope)
        for event, span in self.events:
            self.emit(Opaque(event.text, False, span))

    def statements(self) -> tuple[ProgramStatement, ...]:
        """What was executed, each move with the origin of its numbers."""
        parts = enumerate(self.parts)
        return tuple(
            statement
            if isinstance(statement, Wait | Opaque)
            else replace(statement, origin=self._origin(*next(parts)))
            for statement in self._statements
        )

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about the run."""
        notes = [*self.library.notes, *self.data.notes, *self._notes.values()]
        for note, count in self._kept.values():
            times = f" ({count} times, here first)" if count > 1 else ""
            notes.append(replace(note, message=note.message + times))
        return (*notes, *self.course.notes())

    def _origin(self, index: int, parts: Parts) -> MoveOrigin:
        reads = self.evaluator.reads
        return MoveOrigin(
            parts.statement,
            reads.origin(parts.target, index),
            reads.origin(parts.speed, index),
            reads.origin(parts.zone, index),
            None if parts.via is None else reads.origin(parts.via, index),
        )

    # ------------------------------------------------------- for the other modules

    @property
    def move_index(self) -> int:
        """Index of the move that is being read, or comes next."""
        return len(self.parts)

    def text(self, span: Span) -> str:
        """The text of a place."""
        return self.data.text(span)

    def config(self, name: str) -> Value:
        """A datum of ``$CONFIG.DAT``, or of the program where that has one of the same name."""
        node = Name(Span("", 1, 1, 0, 0), name.lower(), name)
        return self.evaluator.names.value(node, Scope("", self.where[-1]))

    def config_item(self, table: str, index: int, span: Span | None) -> Value | None:
        """An item of an array of ``$CONFIG.DAT``; None where nothing is set.

        Raises:
            SourceError: the index is outside the array.
        """
        cell = self.data.find(table, Scope("", self.where[-1]))
        holder = cell.value if cell is not None else None
        if not isinstance(holder, Array):
            return None
        size = holder.sizes[0]
        if size is not None and index > size:
            if span is None or (cell is not None and cell.shipped):
                return None
            raise SourceError(f"{table.upper()} has {size} items; there is no {index}", span)
        assert cell is not None
        return self.evaluator.names.item(holder, (index,), cell)

    def system_changed(self) -> None:
        """A system variable has another value now."""
        self.settings.changed()
        self.placements.changed()

    def emit(self, statement: Wait | Opaque) -> None:
        """Put a statement that is no move at the end of the program."""
        self._statements.append(statement)

    def emit_move(self, move: Move, parts: Parts) -> None:
        """Put a move at the end of the program.

        Raises:
            SourceError: there are more than the limits allow.
        """
        self.meter.move(parts.statement)
        self._statements.append(move)
        self.parts.append(parts)

    def take_events(self) -> tuple[Event, ...]:
        """What triggers have laid on the move that comes now."""
        self.output_writes.driven()
        events, self.events = self.events, []
        return tuple(event for event, _ in events)

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless this kind was noted before."""
        self._notes.setdefault(kind, Note(message, span=span))

    def keep(self, span: Span, name: str, why: Kept) -> None:
        """Keep a statement as it stands, with one note per kind, at the first of them.

        So is the ``CONTINUE`` that lets the robot pass it.
        """
        if why.stops and self._advance:
            self.emit(Opaque("CONTINUE", span=span))
        self.emit(Opaque(self.text(span), why.stops and not self._advance, span))
        if why.why:
            message = f"{name} is kept and not carried out: {why.why}"
            first, count = self._kept.get(message.lower(), (Note(message, span=span), 0))
            self._kept[message.lower()] = first, count + 1

    # ------------------------------------------------------------------- statements

    def run_block(self, block: Block, scope: Scope) -> None:
        statements = block.statements
        index = 0
        while index < len(statements):
            try:
                self._run_statement(statements[index], scope)
            except Jump as jump:
                target = block.labels.get(jump.goto.name)
                if target is None:
                    raise
                if target <= index:
                    self.flow.jump_back(
                        jump.goto, Block(statements[target:index]), statements[index], scope
                    )
                index = target
                continue
            index += 1

    def _run_statement(self, statement: Statement, scope: Scope) -> None:
        self.meter.statement(statement.span)
        if isinstance(statement, Continue):
            self._advance = True
            return
        handler = self._handlers.get(type(statement))
        if handler is not None:
            self.evaluator.stopped = False
            handler(statement, scope)
        if not isinstance(statement, Label):
            self._advance = False

    def evaluated(self, expression: Expression, scope: Scope, span: Span) -> Value:
        """A value; if reading it stops the advance run, the robot stops here."""
        self.evaluator.stopped = False
        value = self.evaluator.evaluate(expression, scope)
        self._stop_if_read(span)
        return value

    def _stop_if_read(self, span: Span) -> None:
        if self.evaluator.stopped and not self._advance:
            last = self._statements[-1] if self._statements else None
            stops = isinstance(last, Wait) or (isinstance(last, Opaque) and last.stops)
            if last is not None and not stops:
                self.emit(Wait(0.0, span))
        self.evaluator.stopped = False

    def _motion(self, statement: Motion, scope: Scope) -> None:
        if not statement.settings:
            self._motions.read(statement, scope)
            return
        system = self.data.system
        saved = {name: copied(_held(system[name])) for name in MOTION}
        try:
            for setting in statement.settings:
                value = self.evaluator.evaluate(setting.value, scope)
                self.evaluator.assign(setting.target, value, scope, setting.span)
            self.system_changed()
            self._motions.read(statement, scope)
        finally:
            for name, value in saved.items():
                system[name].value = value
            self.system_changed()

    def _assign(self, statement: Assign, scope: Scope) -> None:
        target = statement.target
        datum = None if target.name.startswith("$") else self.text(target.span)
        self.evaluator.stopped = False
        value = self.evaluator.evaluate(statement.value, scope, datum)
        self._stop_if_read(statement.span)
        cell = self.evaluator.assign(target, value, scope, statement.span)
        if target.name in MOTION:
            self.system_changed()
        elif cell.signal is not None:
            self._write_signal(statement, cell)
        elif self.data.is_system(target.name) and target.name not in SILENT:
            stops = target.name in STOPS_WHEN_SET
            why = "outputs do not move the robot" if stops else "it is not emulated"
            self.keep(statement.span, target.text.upper(), Kept(why, stops))

    def _write_signal(self, statement: Assign, cell: Cell) -> None:
        assert cell.signal is not None
        stops = cell.signal[0].name in STOPS_WHEN_SET
        name = cell.signal[0].text.upper()
        self.keep(statement.span, name, Kept("outputs do not move the robot", stops))

    def _declare(self, statement: Declaration, scope: Scope) -> None:
        known = scope.cells.get(statement.name)
        fresh = self.data.cell(statement, scope.module)
        if known is not None:
            known.type = fresh.type
            if isinstance(known.value, Unknown | Array | None):
                return
            assert not isinstance(known.value, Pending)
            try:
                known.value = convert(known.value, fresh.type, self.data.types)
            except KrlTypeError as error:
                raise SourceError(f"{fresh.name}: {error}", statement.span) from None
            return
        if statement.value is not None:
            value = self.evaluator.evaluate(statement.value, scope, statement.text)
            name = Name(statement.span, statement.name, statement.text)
            scope.cells[statement.name] = fresh
            constant, fresh.constant = fresh.constant, False
            self.evaluator.assign(name, value, scope, statement.span)
            fresh.constant = constant
            return
        scope.cells[statement.name] = fresh

    def _define(self, statement: Statement, scope: Scope) -> None:
        self.data.define(statement, scope.cells)

    def _position(self, kind: str, span: Span) -> Value:
        """What ``$POS_ACT`` and ``$AXIS_ACT`` hold."""
        self.asked += 1
        placement = None if kind == "axes" else self.placements.current(span)
        if placement is None:
            value: Value = self.position.axes(span)
        else:
            value = self.position.pose(placement, span)
        here = self.move_index, placement
        return replace(value, here=here) if isinstance(value, Unknown) else value


def _held(cell: Cell) -> Value:
    value = cell.value
    assert value is not None and not isinstance(value, Pending)
    return value
