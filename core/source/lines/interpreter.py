"""Runs a program of lines: statements → the moves, waits and kept statements that the robot does.

What the text leaves open (inputs, registers that nobody sets) travels as `Unknown`; where a jump
depends on one, `core.source.execution.control_flow` decides, and where a move does, it is refused.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import NoReturn
from weakref import proxy

from ...errors import FlybyError, InputError, PluginFault, SourceError, Span, StopError
from ...program import move
from ...program.entry_point import ALL, EntryPoint, listed
from ...program.program import Program
from ..execution.control_flow.analysis import Analysis
from ..execution.control_flow.flow import Flow
from ..execution.control_flow.loops import Loop
from ..execution.control_flow.steps import NOTHING, PLACE
from ..execution.course import Course
from ..execution.limits import Meter
from ..execution.outputs import Outputs
from ..execution.provenance import MovePart, Reads, Source
from ..execution.scopes import unknown_name
from ..execution.transcript import MoveParts, Transcript
from ..reading import ReadOptions
from ..text.nodes import jumps_nowhere, no_label
from .analysis import Statements, expressions_of
from .data import Data
from .expressions import Datum, Expression, Number
from .program import Grammar, LineProgram, routine_key
from .statements import (
    Assign,
    AssignAll,
    Body,
    Call,
    Drive,
    End,
    If,
    Jump,
    Kept,
    Label,
    Numbers,
    Operand,
    Pause,
    Return,
    Set,
    Statement,
)
from .values import Snapshot, Unknown, Values


class _Jumped(Exception):
    def __init__(self, jump: Jump) -> None:
        self.jump = jump


class _Returned(Exception):
    pass


class _Finished(Exception):
    pass


@dataclass(slots=True)
class _SaidLine:
    """A line that is carried out: its statements so far, whether one drives, whether it is kept."""

    span: Span | None = None
    statements: set[int] = field(default_factory=set)
    drives: bool = False
    kept: bool = False


def run_lines(program: LineProgram, grammar: Grammar, options: ReadOptions) -> Program:
    """The program that a routine drives.

    Args:
        program: the routines.
        grammar: of the language.
        options: entry, answers and limits; without an entry the lines before the first routine are
            run if they drive, else the routine ``main``, else the first of the file that drives and
            that no other calls. Of the entry ``all`` the routines are listed.

    Raises:
        SourceError: what it does cannot be followed; file, line and cause are named.
    """
    run = _Interpreter(program, grammar, options)
    asked = options.entry
    if asked == ALL and ALL not in program.routines:
        return Program((), PurePath(program.file).stem, entries=run.entry_points(None))
    name = run.first() if asked is None else routine_key(asked)
    body = program.routines.get(name)
    if body is None or (asked is not None and not name):
        known = listed(run.entry_points(None))
        raise SourceError(
            f"there is no routine '{asked}': choose as the entry one of {known}; all drives each "
            "of them",
            Span(program.file, 1, 1, 0, 0),
        )
    return run.run(body, asked or body.name or "main")


class _Interpreter:
    """One run of a program; it is the host of the rules for branches and loops."""

    position_asked = 0

    def __init__(self, program: LineProgram, grammar: Grammar, options: ReadOptions) -> None:
        self._program = program
        self._grammar = grammar
        self._start = options.start
        self.course = Course(options.answers)
        self.meter = Meter(options.limits, options.executed)
        self.outputs = Outputs()
        self.place: object = None
        self._stands_by = ""  # what it depends on where it stands, see `leave_supposed`
        self._standing: tuple[Source | None, ...] = ()
        self._counted_on = False
        self._out = Transcript(program.text_of, self.course)
        self._tree = Statements(program, grammar)
        self._analysis = Analysis(self._tree)
        self._flow: Flow[Body] = Flow(self._analysis, proxy(self))
        self._values = Values(program.text_of, grammar, self.course, self.outputs)
        self._data = Data(program, grammar, self._values)
        self._computed: set[str] = set()
        self._driven: Span | None = None
        self._line = _SaidLine()
        self._reads = Reads()
        self._loops: dict[int, Body] = {}

    # ---------------------------------------------------------------------- the run

    def first(self) -> str:
        """The routine that is run where nobody says which."""
        own, routines = self._program.own, self._program.routines
        drive = [key for key in own if self._analysis.moves(routines[key])]
        before = routines[""]
        if not own or self._analysis.moves(before) or (before.statements and not drive):
            return ""
        if len(own) == 1 or "main" in own:
            return "main" if "main" in own else own[0]
        within = {key: self._analysis.blocks_in(routines[key]) for key in own}
        calling = (
            key
            for key in drive
            if not any(id(routines[key]) in within[one] for one in own if one != key)
        )
        first = next(calling, (drive or own)[0])
        if len(drive) > 1:
            message = (
                f"it begins with {routines[first].name}, the first of {len(drive)} routines that "
                "move the robot: name another as the entry, or all of them (all)"
            )
            self._out.notes.once("entry", message, Span(self._program.file, 1, 1, 0, 0))
        return first

    def entry_points(self, begun: Body | None) -> tuple[EntryPoint, ...]:
        """The routines of the first file; ``begun`` is the one that was run."""
        bodies = (self._program.routines[key] for key in self._program.own)
        return tuple(
            EntryPoint(body.name, (), self._analysis.move_count(body), body is begun)
            for body in bodies
        )

    def run(self, body: Body, name: str) -> Program:
        """Carry a routine out to its end."""
        for one in self._program.routines.values():
            for jump in jumps_nowhere(one):
                message = f"{no_label(jump).message}: a controller stops here"
                self._out.notes.once(f"jump {jump.span}", message, jump.span)
        try:
            with suppress(_Finished):
                self._routine(body, "", Span(self._program.file, 1, 1, 0, 0))
        except StopError as error:
            if not self._out.stops(error):
                raise
        return Program(
            self._out.statements(self._reads),
            name,
            notes=(*self._out.notes.notes(), *self.course.notes()),
            questions=self.course.questions(),
            entries=() if self._out.move_index else self.entry_points(body),
            calls=tuple(self._out.calls),
            cycle=self.course.cycle,
            sections=self.course.sections.found(self.course.cycle),
        )

    def snapshot(self, names: frozenset[str] | None, written: frozenset[str]) -> Snapshot:
        """See `core.source.execution.host.Host`."""
        return Snapshot(self._values, names)

    def leave_to_others(self, names: frozenset[str], span: Span) -> list[str]:
        """None: what registers hold that others write is not known anyhow."""
        return []

    def leave_supposed(
        self,
        names: frozenset[str],
        settings: frozenset[str],
        reason: str,
        called: frozenset[str] = NOTHING,
    ) -> None:
        """See `core.source.execution.host.Host`."""
        if PLACE in names:
            self._stands_by = reason
        self._values.leave_supposed(names | called, reason)

    def open_move(self, error: SourceError, span: Span) -> bool:
        """See `core.source.execution.host.Host`."""
        if not self._out.leaves_open(error, span):
            return False
        self.meter.move(span)
        self.place = object()
        return True

    def pause(self, text: str, span: Span) -> None:
        """See `core.source.execution.host.Host`."""
        self._out.pause(text, span)

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """See `core.source.execution.host.Host`."""
        self._out.notes.once(kind, message, span)

    def finish(self, message: str, span: Span) -> NoReturn:
        """See `core.source.execution.host.Host`."""
        self._out.notes.once("end", message, span)
        raise _Finished

    # -------------------------------------------------------------------- statements

    def _routine(self, body: Body, name: str, span: Span) -> None:
        with self._flow.routine(name, span), suppress(_Returned):
            try:
                self._body(body)
            except _Jumped as found:
                raise no_label(found.jump) from None

    def _body(self, body: Body) -> None:
        index = 0
        while index < len(body.statements):
            try:
                self._carry_out(body.statements[index])
                index += 1
            except _Jumped as found:
                index = self._after(body, index, found.jump)

    def _after(self, body: Body, index: int, jump: Jump) -> int:
        """Index of the statement behind a jump out of one of them.

        Raises:
            _Jumped: the label stands in no statement of the block.
        """
        target = body.labels.get(jump.name)
        if target is None:
            raise _Jumped(jump)
        if target > index:
            return target
        statement = body.statements[index]
        label, key = id(body.statements[target]), id(statement)
        between = self._loops.setdefault(key, Body(body.statements[target : index + 1]))
        unconditional = isinstance(statement, Jump)
        loop = Loop(
            between,
            jump.span,
            self._program.text_of(jump.span).strip(),
            NOTHING if unconditional else self._tree.reads(expressions_of(statement)),
            endless=unconditional,
        )
        try:
            stays = self._flow.jump(loop, label, key, self._run)
            return target + 1 if stays else index + 1
        except _Jumped as found:
            return self._after(body, index, found.jump)

    def _run(self, block: Body) -> bool:
        self._body(block)
        return True

    def _carry_out(self, statement: Statement) -> None:
        self.meter.statement(statement.span)
        self.course.supposed = ""
        self._begin(statement)
        if isinstance(statement, Drive):
            try:
                self._drive(statement)
            except SourceError as error:
                if not self.open_move(error, statement.span):
                    raise
        elif isinstance(statement, Assign):
            self._assign(statement)
        elif isinstance(statement, AssignAll):
            self._data.assign_all(statement)
        elif isinstance(statement, Set):
            self._data.set(statement)
        elif isinstance(statement, If):
            self._if(statement)
        elif isinstance(statement, Label):
            self._flow.label(id(statement), statement.name)
        elif isinstance(statement, Jump):
            raise _Jumped(statement)
        elif isinstance(statement, Call):
            self._call(statement)
        elif isinstance(statement, Return):
            raise _Returned
        elif isinstance(statement, End):
            raise _Finished
        elif isinstance(statement, Pause):
            self._pause(statement)
        elif isinstance(statement, Kept):
            self._keep(statement, statement.name, statement.why, statement.stops)

    def _keep(
        self, statement: Assign | Pause | Kept, name: str, why: str, stops: bool = False
    ) -> None:
        """Keep a statement; the line of several that do not say what each is alone, once."""
        line, span = self._line, statement.span
        if statement.said is None and line.drives:
            raise SourceError(
                "this line drives and says something else beside, which would be kept as the whole "
                "line: the language has to give that a place of its own, or its text (said)",
                span,
            )
        if statement.said is None and line.kept:
            if stops:
                self._out.stop()
            return
        self._out.keep(span, name, why, stops, said=statement.said)
        line.kept = line.kept or statement.said is None

    def _begin(self, statement: Statement) -> None:
        """Know which statements are of the line that is carried out."""
        line = self._line
        if line.span != statement.span or id(statement) in line.statements:
            line = self._line = _SaidLine(statement.span)
        line.statements.add(id(statement))
        line.drives = line.drives or isinstance(statement, Drive)

    def _if(self, statement: If) -> None:
        value = self._values.value(statement.condition)
        if isinstance(value, Unknown):
            span = statement.condition.span
            choice = self._flow.choose(span, value.reason, [statement.then], statement.otherwise)
            block, supposed = choice.block, choice.supposed
        else:
            block = statement.then if value else statement.otherwise
            supposed = self.course.supposed
        with self._flow.supposing((statement.then, statement.otherwise), supposed):
            if block is not None:
                self._body(block)

    def _call(self, statement: Call) -> None:
        name = statement.routine
        body = self._program.routines.get(routine_key(name))
        if body is None:
            if self.course.skips(name, statement.span):
                self.outputs.forget()
                told = name.casefold() in self.course.answers.skipped
                why = "it is skipped, as the answers say" if told else ""
                self._out.keep(statement.span, name, why, device=True)
                return
            known = [key for key in self._program.routines if key]
            offer = (
                "it might move the robot, so it is not stepped over: put it into the file, or "
                f'answer [calls] {name} = "skip"'
            )
            raise SourceError(unknown_name("routine", name, known, offer), statement.span)
        for k, argument in enumerate(statement.arguments):
            with self.course.apart():
                value = self._values.value(argument)
                self._values.put(f"{self._grammar.argument}[{k + 1}]", value)
        self.meter.call(name, statement.span)
        self._out.called(statement.span)
        try:
            self._routine(body, name, statement.span)
        finally:
            self.meter.back()

    def _pause(self, statement: Pause) -> None:
        if statement.time is not None:
            value = self._values.value(statement.time)
            if not isinstance(value, Unknown):
                self._out.wait(float(value), "a wait", "there is no such time", statement.span)
                return
            why = f"its time depends on {value.reason} and is taken as zero"
        else:
            assert statement.condition is not None
            mark = self.outputs.mark()
            if self._values.value(statement.condition) is False:
                self.outputs.forget(self.outputs.asked_since(mark))
            why = "taken as satisfied at once: waiting takes no time here"
        self._keep(statement, "a wait", why, stops=True)

    def _assign(self, statement: Assign) -> None:
        value = self._values.value(statement.value)
        name = self._values.name(statement.target)
        registers = self._values.registers
        if self._grammar.holds(statement.target.word):
            if name is None:  # it may be any of them
                unknown = Unknown("a register whose number is not known")
                registers.update(dict.fromkeys(registers, unknown))
            else:
                self._data.hold(name, statement.value)
            return
        if name is None:
            self.outputs.forget()
        else:
            self.outputs.write(name, None if isinstance(value, Unknown) else value)
        word = statement.target.word
        self._keep(statement, word, "outputs do not move the robot")

    # ------------------------------------------------------------------------- moves

    @property
    def before(self) -> move.Move | None:
        """See `Situation`."""
        self._counted_on = True
        if not isinstance(self.place, move.Move):
            return None
        self.course.suppose(self.place.supposed or self._stands_by)
        return self.place

    def number(self, datum: Expression) -> float:
        """See `Situation`."""
        return self._values.number(datum)

    def setting(self, word: str, default: float) -> float:
        """See `Situation`."""
        value = self._values.registers.get(word, default)
        self._values.suppose(word)
        if isinstance(value, Unknown):
            raise InputError(f"a move depends on {word}, and that on {value.reason}")
        return float(value)

    def vector(self, word: str, number: int | None) -> Numbers:
        """See `Situation`."""
        assert self._driven is not None
        index = None if number is None else Number(self._driven, float(number))
        return self._values.all_of(Datum(self._driven, word, index))

    def note(self, message: str) -> None:
        """See `Situation`."""
        assert self._driven is not None
        self.note_once("drive", message, self._driven)

    def computed(self, *parts: str) -> None:
        """See `Situation`."""
        self._computed.update(parts)

    def _operand(self, one: Operand | None) -> tuple[Numbers, MovePart] | None:
        return None if one is None else self._data.operand(one)

    def _drive(self, statement: Drive) -> None:
        with self.course.apart():  # the path does not depend on it
            pace = self._operand(statement.speed)
        others = (statement.target, statement.zone, statement.via)
        goal, *shape = map(self._operand, others)
        found = (goal, pace, *shape)
        numbers = [Numbers() if one is None else one[0] for one in found]
        self._computed.clear()
        self._counted_on = False
        self._driven = statement.span
        if not all(math.isfinite(number) for one in numbers for number in one):
            raise SourceError("a number is larger than controllers hold", statement.span)
        try:
            move = statement.build(numbers[0], numbers[1], numbers[2], numbers[3], self)
        except InputError as error:
            raise SourceError(str(error), statement.span) from None
        except FlybyError:
            raise
        except Exception as error:
            text = self._program.text_of(statement.span)
            name = getattr(statement.build, "__qualname__", "build").replace(".<locals>", "")
            raise PluginFault.of(f"{text!r}: {name}", error, statement.span) from error
        parts = [one and one[1] for one in found]
        computed: list[Source | None] = []
        for k, name in enumerate(("target", "speed", "zone", "via")):
            if name in self._computed and (one := parts[k]):
                computed += one.sources
                parts[k] = replace(one, sources=())
        target, speed, zone, via = parts
        assert target is not None and speed is not None and zone is not None
        self.meter.move(statement.span)
        for part in filter(None, (target, speed, zone, via)):
            for source in filter(None, part.sources):
                self._reads.by_move(source, self._out.move_index)
                self._reads.by_expression(source, self._out.move_index)
        for source in filter(None, (*computed, *(self._standing if self._counted_on else ()))):
            self._reads.by_expression(source, self._out.move_index)
        own = found[0][1].sources if found[0] else ()
        self._standing = (*own, *(self._standing if self._counted_on else ()))
        if self.course.supposed:
            move = replace(move, supposed=f"where it goes depends on {self.course.supposed}")
        self._out.emit_move(move, MoveParts(statement.span, target, speed, zone, via))
        self.place, self._stands_by = move, ""
        self._data.moved()
