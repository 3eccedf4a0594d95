"""Data in expressions: names with components and indices → values.

What nothing sets is answered by the user, or is an `Unknown`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Protocol

from ....core.errors import LeftOpenError, SourceError, Span, StopError
from ....core.program.question import QuestionKind
from ....core.source.execution.course import Course
from ....core.source.execution.suppose import is_open
from ..syntax.tree import Expression, Name
from .advance_run import AdvanceRun
from .answers import DatumAnswers, answered
from .data import Data
from .expected import AXIS_NAMES, EXPECTED
from .frames import null_frame
from .predefined import NEVER_KNOWN, OUTPUTS, POSITION, STOPS_WHEN_READ
from .scope import Path, Scope, Variable, spelled
from .types import KrlTypeError, convert, no_component
from .values import (
    Array,
    Pending,
    Struct,
    Unknown,
    Value,
    copied,
    left_open,
    shown,
    supposed,
    unplaced,
)

Position = Callable[[str, Span], Value]
_LONGEST_ARRAY = 100_000
FRAMES = frozenset({"tool_data", "base_data", "$tool_data", "$base_data"})
"""Tables whose items are frames of zeros where nobody sets them."""
_WIDEST = 32
"""Bits of a ``SIGNAL``."""


class OpenIndexError(LeftOpenError):
    """Which item of an array is meant is not known.

    Args:
        unknown: what the index depends on.
    """

    def __init__(self, unknown: Unknown, span: Span) -> None:
        super().__init__(left_open("an index", unknown, span).message, span)
        self.unknown = unknown


class Expressions(Protocol):
    """Evaluates expressions in a scope."""

    def evaluate(self, expression: Expression, scope: Scope, datum: str | None = None) -> Value:
        """The value; ``datum`` is what a literal becomes the value of."""

    def number(self, expression: Expression, scope: Scope, use: str) -> float:
        """A known number; ``use`` says in messages what needs it."""


def _told(axes: Value) -> str:
    """The axis values of the arm, as KRL writes them."""
    fields = axes.fields if isinstance(axes, Struct) else {}
    names = [name for name in AXIS_NAMES if name.lower() in fields]
    return ", ".join(f"{name} {fields[name.lower()]:g}" for name in names)


@dataclass(frozen=True, slots=True)
class Names:
    """Reads data.

    Args:
        position: where the robot is: ``pose`` or ``axes``.
        guessed: what indices depend on that are taken for what they were last.
        advance: is stopped by reading some system variables.
    """

    expressions: Expressions
    data: Data
    course: Course
    position: Position
    advance: AdvanceRun
    answers: DatumAnswers = field(init=False)
    guessed: list[Unknown] = field(default_factory=list)

    def __post_init__(self) -> None:
        object.__setattr__(self, "answers", DatumAnswers(self.course, self.data))

    def value(self, node: Name, scope: Scope) -> Value:
        """The value of a datum or of a part of it; not known where an index is not.

        Raises:
            SourceError: it has no such part.
        """
        before = len(self.guessed)
        try:
            held, unknown = self._value(node, scope), None
        except OpenIndexError as error:
            held, unknown = None, error.unknown
        if len(self.guessed) > before:
            unknown = self.guessed[before]
            del self.guessed[before:]
        if unknown is None:
            assert held is not None
            return held
        reason = f"an item of {node.text}, whose index depends on {unknown.reason}"
        return Unknown(reason, node.span, held=held, key=unknown.key, damaged=unknown.damaged)

    def _value(self, node: Name, scope: Scope) -> Value:
        position = POSITION.get(node.name)
        if node.name in STOPS_WHEN_READ:
            self.advance.stopped = True
        if node.name in OUTPUTS:
            return self._output(node, scope)
        if node.name in NEVER_KNOWN:
            return self.answers.undeclared(node, self.path(node, scope))
        cell = self.data.find(node.name, scope)
        if cell is None and position is not None:
            return self._of_position(node, scope, position)
        if cell is None:
            return self.answers.undeclared(node, self.path(node, scope))
        if cell.signal is not None:
            return self._signal(node, cell, scope)
        if cell.supposed:
            self.course.suppose(cell.supposed)
        path = self.path(node, scope) if node.path else ()
        if self.course.answers.sequences and self.course.changing(spelled(node.text, path)):
            return self.answers.undeclared(node, path)
        value = self.settled(cell)
        for step in path:
            if isinstance(value, Unknown):
                self.answers.used_with(value, step)
                value = supposed_part(value, step)
            if value is None or isinstance(value, Unknown):
                break
            value = self.part(value, step, node, cell)
        if is_open(cell) and cell.found is not None and not path:
            value = self._found(node, cell.found) or value
        if is_open(cell):
            open_ = self.answers.undeclared(node, path, f", which {cell.writer} writes")
            return replace(open_, held=value) if isinstance(open_, Unknown) else open_
        if value is None or isinstance(value, Unknown):
            open_to_others = isinstance(value, Unknown) and value.others
            unset = (value is None or open_to_others) and position is None
            kind = QuestionKind.DATUM if unset else None
            answered = self.answers.answer(node, path, kind, self._type_of(cell, path))
            if answered is not None:
                return answered
            if isinstance(value, Unknown):
                return value
            if position is not None:
                return self._of_position(node, scope, position)
            return self._unset(node, path)
        if cell.shipped and cell.type == "e6axis" and not path:
            return self._home(node, cell, value)
        if isinstance(value, Struct) and not value.fields:
            return self.answers.answer(node, path) or value
        return value

    def _type_of(self, cell: Variable, path: Path) -> str:
        """The type of a datum, or of a component where what a value of it looks like is known."""
        type_ = cell.type
        for step in path:
            if isinstance(step, str):
                type_ = self.data.types.get(type_, {}).get(step, "")
        return type_ if not path or type_ in EXPECTED else ""

    def unset(self, node: Name, scope: Scope, type_: str) -> Value:
        """A structure of which nothing sets a component, as the user answers it."""
        path = self.path(node, scope)
        answer = self.answers.answer(node, path, QuestionKind.DATUM, type_)
        return self._unset(node, path) if answer is None else answer

    @staticmethod
    def _unset(node: Name, path: Path) -> Unknown:
        text = spelled(node.text, path)
        return Unknown(f"the value of {text}, which nothing sets", node.span, key=text)

    def _home(self, node: Name, cell: Variable, shipped: Value) -> Value:
        """A home that no file at hand says: the user's answer, or KUKA's own, with a note."""
        answer = self.answers.answer(node, (), QuestionKind.DATUM, cell.type)
        if answer is not None:
            return self.converted(answer, cell.type, cell.name, False, node.span)
        self.data.note(
            "assigned",
            f"{cell.name} is in no file at hand: KUKA's own is taken ({_told(shipped)})",
            node.span,
        )
        return shipped

    def _found(self, node: Name, kind: str) -> Value | None:
        """Where a search finds what it looks for: at its end, as the robot drives here."""
        value = self.position(kind, node.span)
        return None if isinstance(value, Unknown) else value

    def _of_position(self, node: Name, scope: Scope, kind: str) -> Value:
        path = self.path(node, scope)
        answer = self.answers.answer(node, path)
        if answer is not None:
            return answer
        value = self.position(kind, node.span)
        for step in path:
            if isinstance(value, Unknown):
                return value
            part = self.part(value, step, node, Variable(node.text))
            if part is None:
                text = spelled(node.text, path)
                return Unknown(f"the value of {text}", node.span, key=text)
            value = part
        return value

    def _output(self, node: Name, scope: Scope) -> Value:
        """What the program has set it to; a user's answers in turn come first."""
        path = self.path(node, scope)
        held = None
        if not self.course.changing(spelled(node.text, path)):
            held = self.data.outputs.value(spelled(OUTPUTS[node.name], path))
        return self.answers.undeclared(node, path) if held is None else held

    def _signal(self, node: Name, cell: Variable, scope: Scope) -> Value:
        """A ``SIGNAL``: an output that the program has set; answered by its own name, or by those
        of the inputs and outputs that it stands for."""
        assert cell.signal is not None
        first, last = cell.signal
        if first.name in STOPS_WHEN_READ:
            self.advance.stopped = True
        value: Value | None = None
        if first.name in OUTPUTS and not self.course.changing(node.text):
            value = self._whole(first, last, scope, self.data.outputs.value)
        if value is None:
            wide = last is not None
            value = self.answers.answer(node, (), QuestionKind.SIGNAL, "int" if wide else "bool")
        if value is None:
            value = self._whole(first, last, scope, self._bit(first))
        if value is None:
            return Unknown(f"the value of {node.text}", node.span, key=node.text)
        return value

    def _bit(self, first: Name) -> Callable[[str], Value | None]:
        """What the user answers to one of the inputs or outputs of a signal."""
        return lambda place: self.answers.answer(Name(first.span, first.name, place), ())

    def _whole(
        self, first: Name, last: Name | None, scope: Scope, bit: Callable[[str], Value | None]
    ) -> Value | None:
        """The value of a signal from those of its places: one, or bits with the lowest first."""
        values = [bit(place) for place in self.places(first, last, scope)]
        known = [value for value in values if value is not None]
        if last is None or len(known) < len(values):
            return known[0] if last is None and known else None
        return sum(1 << k for k, value in enumerate(known) if value is True or value == 1)

    def places(self, first: Name, last: Name | None, scope: Scope) -> list[str]:
        """The inputs or outputs that a signal stands for, as ``$OUT[3]``, the lowest bit first."""
        name = OUTPUTS.get(first.name, first.text)
        start = self.path(first, scope)
        if last is None:
            return [spelled(name, start)]
        (low,), (high,) = (self._plain_index(p, first) for p in (start, self.path(last, scope)))
        if not low <= high < low + _WIDEST:
            raise SourceError(f"a SIGNAL has 1 to {_WIDEST} bits, in order", first.span)
        return [f"{name}[{k}]" for k in range(low, high + 1)]

    @staticmethod
    def _plain_index(path: Path, node: Name) -> tuple[int, ...]:
        if len(path) != 1 or isinstance(path[0], str) or len(path[0]) != 1:
            raise SourceError("a SIGNAL stands for inputs or outputs with an index", node.span)
        return path[0]

    def outputs(self, node: Name, scope: Scope) -> list[str]:
        """The outputs that a name stands for; none if it is something else.

        Raises:
            SourceError: its index is not known.
        """
        if node.name in OUTPUTS:
            return [spelled(OUTPUTS[node.name], self.path(node, scope))]
        cell = self.data.find(node.name, scope)
        if cell is None or cell.signal is None or cell.signal[0].name not in OUTPUTS:
            return []
        return self.places(*cell.signal, scope)

    def part(
        self, value: Value, step: str | tuple[int, ...], node: Name, cell: Variable
    ) -> Value | None:
        """A component, an item, or a character; None if nothing is set there."""
        if isinstance(step, str):
            if not isinstance(value, Struct):
                raise SourceError(
                    f"{node.text} is {shown(value)} and has no component {step.upper()}", node.span
                )
            found = value.fields.get(step)
            fields = self.data.types.get(value.type)
            if found is None and fields is not None and step not in fields:
                raise SourceError(str(no_component(value.type, step, fields)), node.span)
            return found
        if not step:
            return value
        if isinstance(value, str) and len(step) == 1:
            index = step[0]
            return value[index - 1] if 1 <= index <= len(value) else None
        if not isinstance(value, Array):
            raise SourceError(f"{node.text} is {shown(value)} and no array", node.span)
        if node.name in FRAMES and value.sizes[0] is not None and step[0] > value.sizes[0]:
            return self.unset_frame(spelled(node.text, (step,)))
        self.check_index(value, step, node)
        return self.item(value, step, cell)

    def item(self, array: Array, index: tuple[int, ...], cell: Variable) -> Value | None:
        """An item of an array; None if nothing is set there."""
        item = array.items.get(index)
        if isinstance(item, Pending):
            label = f"{cell.name}[{','.join(map(str, index))}]"
            item = array.items[index] = self._initial(item, array.type, label, cell.shipped)
        elif item is None and cell.shipped and array.type == "frame":
            label = f"{cell.name}[{','.join(map(str, index))}]"
            item = array.items[index] = self.unset_frame(label)
        return item

    def unset_frame(self, label: str) -> Struct:
        """An item of ``TOOL_DATA`` or ``BASE_DATA`` that no file sets: the user's answer, or
        zeros."""
        told = self.course.value(label)
        answer = None if told is None else answered(told)
        if not isinstance(answer, Struct):
            return null_frame(label, shipped=True)
        return Struct("frame", {**null_frame().fields, **answer.fields}, label)

    def check_index(self, array: Array, index: tuple[int, ...], node: Name) -> None:
        for i, size in zip(index, array.sizes, strict=False):
            if i < 1 or (size is not None and i > size) or i > _LONGEST_ARRAY:
                raise StopError(
                    f"there is no {spelled(node.text, (index,))}: index {i} is outside 1 to "
                    f"{size or _LONGEST_ARRAY}",
                    node.span,
                )
        if len(index) > len(array.sizes):
            raise SourceError(
                f"{node.text} has {len(array.sizes)} dimensions, not {len(index)}", node.span
            )

    def path(self, node: Name, scope: Scope) -> Path:
        """The path with its indices evaluated; an unknown index is refused."""
        return tuple(
            step
            if isinstance(step, str)
            else tuple(self.index(i, scope) for i in step if i is not None)
            for step in node.path
        )

    def index(self, expression: Expression, scope: Scope) -> int:
        """A known whole number; of one that others may write, what it last was.

        Raises:
            SourceError: it is none.
        """
        value = self.expressions.evaluate(expression, scope)
        if isinstance(expression, Name) and isinstance(value, Unknown) and value.key:
            self.course.used_as(value.key, *EXPECTED["index"])
        last = supposed(value) if isinstance(value, Unknown) else None
        possible = isinstance(last, int) and last >= 1 and self.course.answers.goes_on
        if isinstance(value, Unknown) and isinstance(last, int) and possible:
            message = f"an index depends on {value.reason}: {last}, which it was last, is taken"
            self.course.decided(expression.span, message)
            self.guessed.append(value)
            return int(last)
        if isinstance(value, Unknown):
            raise OpenIndexError(value, expression.span)
        value = self.expressions.number(expression, scope, "an index")
        if value != int(value):
            raise SourceError(f"an index is a whole number, not {value:g}", expression.span)
        return int(value)

    def settled(self, cell: Variable) -> Value | None:
        if isinstance(cell.value, Pending):
            pending = cell.value
            cell.value = None
            cell.value = self._initial(pending, cell.type, cell.name, cell.shipped)
        return cell.value

    def _initial(self, pending: Pending, type_name: str, label: str, shipped: bool) -> Value:
        scope = Scope("a data list", self.data.library.home(pending.home))
        value = self.expressions.evaluate(pending.expression, scope, label)
        if shipped:
            value = unplaced(value)
        return self.converted(value, type_name, label, shipped, pending.expression.span)

    def converted(
        self, value: Value, type_name: str, label: str | None, shipped: bool, span: Span
    ) -> Value:
        try:
            made = convert(value, type_name, self.data.types)
        except KrlTypeError as error:
            raise SourceError(f"{label}: {error}" if label else str(error), span) from None
        if made is value:
            made = copied(value)
        if isinstance(made, Struct) and label is not None:
            made.label = label
            made.shipped = shipped
        return made


def supposed_part(value: Unknown, step: str | tuple[int, ...]) -> Unknown:
    """A component of what is not known."""
    held = supposed(value)
    part = held.fields.get(step) if isinstance(held, Struct) and isinstance(step, str) else None
    return replace(value, here=None, held=part)
