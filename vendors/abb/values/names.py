"""Data by their names, with components and indices: read, written, asked for."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Protocol

from ....core.door import spelt
from ....core.errors import SourceError, Span
from ....core.program.question import QuestionKind
from ....core.source.execution.course import Course
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.provenance import ELSEWHERE, Reads
from ....core.source.execution.suppose import is_open
from ..syntax import tree
from .answers import TypedAnswers, kind_brought_by
from .data import Globals
from .defaults import default_of, nominal, unset
from .elements import (
    array_mismatch,
    check_index,
    check_size,
    element,
    filled,
    gathered,
    located_part,
    replaced,
    written_by_others,
)
from .errors import NOT_PRESENT, NUMBERS, ProgramError
from .located import Located
from .provenance import Literal
from .scope import Scope, Variable
from .types import (
    NUM,
    Foreign,
    RecordType,
    Type,
    Unknown,
    Value,
    check_known,
    check_type,
    find_unknown,
    interpreted,
)


class Host(Protocol):
    """Runs what expressions call."""

    def call_function(self, routine: tree.Routine, call: tree.Call, scope: Scope) -> Value:
        """The value of one of the program's own functions."""

    def note_undeclared(self, name: tree.Name) -> None:
        """A name is assigned and declared nowhere at hand."""


class Names(ABC):
    """Reads and writes data; what expressions in indices and initial values are, others know.

    Args:
        data: of all modules.
        course: has the user's answers.
        text_of: what stands at a place.
        host: hears of names that are declared nowhere at hand.
        signals: what signals are, by lower-case name, where a backup says so.

    Attributes:
        reader: of the literals that are read from here on.
    """

    def __init__(
        self,
        data: Globals,
        course: Course,
        text_of: Callable[[Span], str],
        host: Host,
        signals: Mapping[str, str],
    ) -> None:
        self.data = data
        self.reads = Reads()
        self.reader = ELSEWHERE
        self.outputs = Outputs()
        self.course = course
        self.answers = TypedAnswers(course, text_of)
        self._text_of = text_of
        self._host = host
        self._elsewhere: dict[str, Value] = {}
        self._shared_elsewhere: set[str] = set()
        self._signals = signals

    @abstractmethod
    def evaluate(self, expression: tree.Expression, scope: Scope) -> Value:
        """The value of an expression."""

    @abstractmethod
    def locate(self, expression: tree.Expression, scope: Scope, asking: bool = True) -> Located:
        """The same, with the place that it was read from."""

    def check(self, value: Value, type_: Type, use: str, span: Span) -> None:
        """Raises:
        SourceError: a value is not known, or not of a type.
        """
        check_known(value, use, span)
        check_type(value, type_, use, span)

    def text(self, span: Span) -> str:
        """What stands in the program."""
        return self._text_of(span)

    # ------------------------------------------------------------------- answers

    def fill(self, target: tree.Name, unknown: Unknown, scope: Scope, by: str) -> None:
        """An instruction writes a datum: the user's answer, or what is not known.

        Args:
            by: name of the instruction, lower case.
        """
        found = self.locate(target, scope, asking=False)
        sizes = found.cell.dimensions if found.cell is not None and not target.path else ()
        answer = self.answers.ask(target.span, found.type, sizes, kind_brought_by(by))
        if answer is None:
            one = default_of(found.type)
            answer = replace(unknown, nominal=None if one is None else filled(one, sizes))
        self.assign(target, answer, scope)

    def signal(self, expression: tree.Expression | None, scope: Scope) -> str | None:
        """The signal that an expression means, lower case; None if that is not known."""
        if not isinstance(expression, tree.Name) or expression.path:
            return None
        cell = self.cell(expression, scope)
        if cell is None:
            return None if expression.name in self._elsewhere else expression.name
        value = self.settle(cell) if isinstance(cell.type, Foreign) and cell.present else None
        return value.key.lower() or None if isinstance(value, Unknown) else None

    def output(self, signal: tree.Expression | None, asked: Span, scope: Scope) -> Value | None:
        """What the program has set an output to; None if that is not known.

        Args:
            asked: where it is read: a user's answers to it in turn come first.
        """
        name = self.signal(signal, scope)
        if name is None or self.answers.in_turn(asked):
            return None
        return self.outputs.value(name)

    # -------------------------------------------------------------------- data

    def settle(self, cell: Variable) -> Value:
        """The value of a cell, evaluated now if it was not yet."""
        value = self._settled(cell)
        if cell.elements:
            value = cell.value = gathered(value, cell.elements)
            cell.elements.clear()
        return value

    def _settled(self, cell: Variable) -> Value:
        """`settle`, leaving out the elements that were written of late."""
        declaration, scope = cell.pending, cell.scope
        if declaration is None:
            assert cell.value is not None
            return cell.value
        if scope is None:
            raise SourceError(f"the value of {cell.name} depends on itself", declaration.span)
        cell.scope = None  # while it is evaluated
        try:
            sizes = tuple(self._size(d, scope) for d in declaration.dimensions)
            check_size(cell.name, sizes, declaration.span)
            cell.dimensions = sizes
            cell.value, cell.source, cell.predefined = self._initial(
                declaration, cell.type, sizes, scope
            )
        except SourceError:
            cell.scope = scope
            raise
        cell.pending = None
        return cell.value

    def _size(self, expression: tree.Expression, scope: Scope) -> int:
        given = self.evaluate(expression, scope)
        if isinstance(given, Unknown):
            message = f"the size of an array depends on {given.reason}: one element is taken"
            self.answers.assumed(expression.span, message)
            return 1
        self.check(given, NUM, "the size of an array", expression.span)
        assert isinstance(given, float)
        size = given
        if size < 1 or size != int(size):
            raise SourceError(f"an array has one element or more, not {size:g}", expression.span)
        return int(size)

    def _initial(
        self, declaration: tree.Declaration, type_: Type, sizes: tuple[int, ...], scope: Scope
    ) -> tuple[Value, Literal | None, str | None]:
        if isinstance(type_, Foreign):
            reason = f"'{declaration.text}', a {type_.name}"
            return filled(Unknown(reason, declaration.span, declaration.text), sizes), None, None
        if declaration.value is None:
            shared = declaration.kind == "pers"
            value = unset(type_, declaration.text, declaration.span, shared=shared)
            return filled(value, sizes), None, None
        if declaration.kind == "pers":  # others may write it, whatever the text says
            told = self.answers.ask_by(declaration.text, declaration.span, type_, sizes)
            if told is not None:
                return told, None, None
        found = self.locate(declaration.value, scope)
        value = found.value
        wrong = array_mismatch(value, type_, sizes)
        if wrong is not None:
            raise SourceError(f"{declaration.text}: {wrong}", declaration.value.span)
        source = found.source
        if source is not None and source.datum is None:
            source = Literal(source.expression, source.root, declaration.text)
        return value, source, found.predefined

    def assign(self, target: tree.Name, value: Value, scope: Scope) -> None:
        """``target := value``

        Raises:
            SourceError: the target is constant, or of another type.
        """
        cell = self.cell(target, scope)
        if cell is None:
            self._assign_elsewhere(target, value)
            return
        if cell.constant:
            raise SourceError(f"{cell.name} is a constant and cannot be assigned", target.span)
        cell.awaited = False
        if not target.path:
            if cell.pending is not None:
                self.settle(cell)
            wrong = array_mismatch(value, cell.type, cell.dimensions)
            if wrong is not None:
                raise SourceError(f"{target.text}: {wrong}", target.span)
            cell.value = interpreted(value, cell.type, target.span)
            cell.source, cell.predefined = None, None
            cell.elements.clear()
            self.course.sets(cell)
            return
        self._assign_part(cell, target, value, scope)

    def _assign_part(self, cell: Variable, target: tree.Name, value: Value, scope: Scope) -> None:
        """An element or component is written."""
        old = self._settled(cell)
        path, unknown = self._path(target, cell, scope)
        cell.predefined = None
        self.course.sets(cell, whole=False)
        if unknown is not None:
            known = nominal(self.settle(cell))
            cell.value, cell.source = replace(unknown, key=cell.name, nominal=known), None
            return
        first = path[0]
        if isinstance(first, tuple):
            try:
                check_index(first, cell.dimensions, target)
            except ProgramError as error:
                self._tolerated(error)
                return
            cell.elements[first] = replaced(element(cell, first), cell, path, value, target)
            cell.overwritten.add(first)
        else:
            cell.value, cell.source = replaced(old, cell, path, value, target), None

    def _assign_elsewhere(self, target: tree.Name, value: Value) -> None:
        """A datum of a module that is not at hand moves nothing by being written.

        It keeps the value that it is given; of a part of it the type is not known.
        """
        self._host.note_undeclared(target)
        if target.path or target.name in self._shared_elsewhere:
            self._elsewhere.pop(target.name, None)
        else:
            self._elsewhere[target.name] = value

    def share(self, name: tree.Name, writer: str, scope: Scope) -> None:
        """From now on something beside the program's course may write a datum.

        Args:
            writer: for messages: ``TRAP stop``.
            scope: where the name is looked up.
        """
        cell = self.cell(name, scope)
        if cell is None:
            self._elsewhere.pop(name.name, None)
            self._shared_elsewhere.add(name.name)
        elif not cell.constant:
            cell.writer, cell.awaited = writer, False

    def leave_to_others(self, cell: Variable, span: Span) -> list[str]:
        """The numbers, flags and texts of a datum that were known and are so no more, as others may
        write them: by their names."""
        if cell.predefined is not None:
            return []
        value = self.settle(cell)
        cell.value, left = written_by_others(value, cell.type, cell.dimensions, cell.name, span)
        if left:
            cell.source = None
        return left

    def forget_elsewhere(self, name: str) -> bool:
        """Whether a datum of a module that is not at hand had a value, which it has no more."""
        return self._elsewhere.pop(name, None) is not None

    # ------------------------------------------------------------------- names

    def cell(self, name: tree.Name, scope: Scope) -> Variable | None:
        """The datum of a name, of a module beside the program if need be."""
        found = scope.find(name.name)
        return self.data.fetched_cell(name.name, name.span) if found is None else found

    def _read_name(self, name: tree.Name, scope: Scope) -> Value:
        found = self._locate_name(name, scope)
        if found.source is not None:
            self.reads.by_expression(found.source, self.reader)
        return found.value

    def _locate_name(self, name: tree.Name, scope: Scope, asking: bool = True) -> Located:
        found = self._find(name, scope)
        if asking and found.open:
            held = self.output(name, name.span, scope)
            if held is not None:
                return Located(held, None, None)
            sizes = found.cell.dimensions if found.cell is not None and not name.path else ()
            kind = QuestionKind.DATUM if found.cell is not None else QuestionKind.SIGNAL
            unknown = find_unknown(found.value)
            first = found.cell is None or (unknown is not None and unknown.key == name.text)
            answer = self.answers.ask(name.span, found.type, sizes, kind if first else None)
            if (
                answer is None
                and not name.path
                and isinstance(found.value, Unknown)
                and found.value.key != name.text
            ):
                answer = self.answers.ask_by(found.value.key, name.span, found.type, sizes)
            if answer is not None:
                return Located(answer, None, found.cell, type=found.type)
        return found

    def _foreign(self, name: str) -> str:
        """What a name is that no module at hand declares."""
        signal = self._signals.get(name)
        if signal is None:
            return "which is not declared in what is at hand (a signal?)"
        return f"{'an' if signal.startswith('a') else 'a'} {signal}"

    def _find(self, name: tree.Name, scope: Scope) -> Located:
        cell = self.cell(name, scope)
        if cell is None and not name.path and name.name in self._elsewhere:
            return Located(self._elsewhere[name.name], None, None)
        if cell is None:
            reason = f"'{name.text}', {self._foreign(name.name)}"
            return Located(Unknown(reason, name.span, self.answers.key(name.span)), None, None)
        if not cell.present:
            message = f"the optional argument {cell.name} was not given"
            raise ProgramError(message, name.span, NUMBERS[NOT_PRESENT])
        if cell.supposed:
            self.course.suppose(cell.supposed)
        if is_open(cell):
            reason = f"'{name.text}', which {cell.writer} writes"
            known = None if name.path else nominal(self.settle(cell), cell.type)
            unknown = Unknown(reason, name.span, self.answers.key(name.span), known)
            return Located(unknown, None, cell, type=None if name.path else cell.type)
        if not name.path:
            value = self.settle(cell)
            source = None if cell.overwritten else cell.source
            return Located(value, source, cell, cell.predefined, cell.type)
        value = self._settled(cell)
        path, missing = self._path(name, cell, scope)
        try:
            found = located_part(cell, value, path, name)
        except ProgramError as error:
            outside, type_ = self._tolerated(self._outside(error, name, scope)), cell.type
            for step in path:
                if isinstance(step, str) and isinstance(type_, RecordType):
                    type_ = type_.components[step]
            return Located(replace(outside, nominal=default_of(type_)), None, cell, type=type_)
        if missing is None:
            return found
        known = nominal(found.value, found.type)
        return Located(replace(missing, nominal=known), None, cell, type=found.type)

    def _outside(self, error: ProgramError, name: tree.Name, scope: Scope) -> ProgramError:
        """An index outside an array, with the datum that others may write into."""
        for index in (one for step in name.path if not isinstance(step, str) for one in step):
            cell = self.cell(index, scope) if isinstance(index, tree.Name) else None
            if cell is not None and cell.persistent:
                others = f"what others write into {cell.name} is said in a file"
                said = f"{error.message}; {others} ({spelt('answers')}): [values]"
                return ProgramError(said, name.span, error.number)
        return error

    def _tolerated(self, error: ProgramError) -> Unknown:
        """What stands outside an array, where nobody knows whether the program comes there.

        Raises:
            ProgramError: its course follows from the text itself.
        """
        if not self.answers.guessed or error.span is None:
            raise error
        message = str(error).removeprefix(f"{error.span}: ")
        reason = f"{message}, on the course that is taken without answers"
        self.answers.assumed(error.span, f"{reason}: it is left out")
        return Unknown(reason, error.span, self.answers.key(error.span))

    def _path(
        self, name: tree.Name, cell: Variable, scope: Scope
    ) -> tuple[list[str | tuple[int, ...]], Unknown | None]:
        """Components and indices of a part of a datum, and what is not known of its indices.

        For those, the defaults are given, within the array.
        """
        path: list[str | tuple[int, ...]] = []
        unknown: Unknown | None = None
        for step in name.path:
            if isinstance(step, str):
                path.append(step)
                continue
            indices = []
            for place, expression in enumerate(step):
                value = self.evaluate(expression, scope)
                if isinstance(value, Unknown):
                    unknown, known = value, nominal(value, NUM)
                    size = cell.dimensions[place] if place < len(cell.dimensions) else 1
                    value = max(1.0, min(float(size), known if type(known) is float else 1.0))
                    value = float(int(value))
                indices.append(self.as_index(value, expression.span))
            path.append(tuple(indices))
        return path, unknown

    def as_index(self, value: Value, span: Span) -> int:
        """A known value as an index.

        Raises:
            SourceError: it is no whole number.
        """
        self.check(value, NUM, "an index", span)
        assert isinstance(value, float)
        if value != int(value):
            raise SourceError(f"an index is a whole number, not {value:g}", span)
        return int(value)
