"""What registers, signals and expressions of lines are at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ...errors import SourceError, Span
from ...program.question import Answer
from ..execution.course import About, AnswerError, Course
from ..execution.outputs import Outputs
from .expressions import COMPUTE, Datum, Expression, Number, Operation, Truth, Value
from .program import Grammar
from .statements import Numbers

ONCE = " once"
"""Ends the names of settings that hold for the next move alone."""


@dataclass(frozen=True, slots=True)
class Literal:
    """Numbers that stand in the text (see `core.source.execution.provenance.Source`)."""

    span: Span
    datum: str | None
    numbers: Sequence[Span | None]
    whole: Span | None = None

    @property
    def root(self) -> Span:
        """Of the point that it is a number of, or its own."""
        return self.whole or self.span

    def each(self) -> tuple[Literal | None, ...]:
        """A literal for each of its numbers."""
        return tuple(
            None if span is None else Literal(span, self.datum, (span,), self.span)
            for span in self.numbers
        )


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that only the running controller has.

    Args:
        reason: what it depends on.
    """

    reason: str


@dataclass(slots=True)
class _Mark:
    """What a register depends on, if a way has set it that was chosen by rule."""

    supposed: str = ""


class Snapshot:
    """Registers as they are now; see `core.source.execution.host.Snapshot`."""

    def __init__(self, values: Values, names: frozenset[str] | None) -> None:
        self._values = values
        self._names = sorted(values.registers if names is None else names)
        self._before = self._now()

    def _now(self) -> list[tuple[Value | Unknown | None, Any]]:
        values = self._values
        return [(values.registers.get(name), values.kinds.get(name)) for name in self._names]

    def changed(self) -> bool:
        """Whether one has another value now."""
        return self._now() != self._before


class Values:
    """The values of one run.

    Args:
        text_of: the text that stands at a place.
        grammar: of the language.
        course: the user's answers.
        outputs: what the program has set its outputs to.

    Attributes:
        registers: by name, ``R[1]``, ``PR[1,2]``.
        sources: the literals that registers have their values from, by name.
        kinds: what data of several numbers are beside them, and units of settings, by name.
    """

    def __init__(
        self,
        text_of: Callable[[Span], str],
        grammar: Grammar,
        course: Course,
        outputs: Outputs,
    ) -> None:
        self._text_of = text_of
        self._grammar = grammar
        self._course = course
        self.outputs = outputs
        self.registers: dict[str, Value | Unknown] = {}
        self.sources: dict[str, Literal | None] = {}
        self._marks: dict[str, _Mark] = {}
        self.kinds: dict[str, Any] = {}

    def all_of(self, datum: Datum) -> Numbers:
        """The numbers of a datum that has several.

        Raises:
            SourceError: they are not known.
        """
        count, numbers = self._grammar.vectors[datum.word], []
        for k in range(count):
            element = Datum(datum.span, datum.word, datum.index, Number(datum.span, k + 1.0))
            if k >= 6 and self.name(element) not in self.registers:
                break  # external axes
            numbers.append(self.number(element))
        return Numbers.of(numbers, self.kinds.get(self.name(datum) or ""))

    def source_of(self, expression: Expression) -> Literal | None:
        """The literal that an expression has its value from as it stands; None if none."""
        if isinstance(expression, Number):
            return Literal(expression.span, None, (expression.span,))
        name = self.name(expression) if isinstance(expression, Datum) else None
        return None if name is None else self.sources.get(name)

    def put(self, name: str, value: Value | Unknown, source: Literal | None = None) -> None:
        """Give a register a value; ``source``: the literal that states it."""
        self.registers[name] = value
        self.sources[name] = source
        self._course.sets(self._mark(name))

    def put_all(self, name: str, numbers: Numbers, sources: Sequence[Literal | None] = ()) -> None:
        """Give a datum all its numbers."""
        for k, value in enumerate(numbers):
            self.put(element(name, k), value, sources[k] if sources else None)
        self.kinds[name] = numbers.kind

    def number(self, expression: Expression) -> float:
        """A number that a move needs.

        Raises:
            SourceError: it is not known, or none.
        """
        value = self.value(expression)
        if isinstance(value, Unknown):
            raise SourceError(
                f"a move depends on {value.reason}: answer it in the table [values] of the answers",
                expression.span,
            )
        if isinstance(value, bool):
            raise SourceError("a number should stand here", expression.span)
        return value

    def value(self, expression: Expression) -> Value | Unknown:
        """What an expression is now.

        Raises:
            SourceError: it has no value.
        """
        if isinstance(expression, Number | Truth):
            return expression.value
        if isinstance(expression, Datum):
            return self._datum(expression)
        values = [self.value(one) for one in expression.operands]
        unknown = next((v for v in values if isinstance(v, Unknown)), None)
        if unknown is not None:
            return self._partly(expression, values) or unknown
        try:
            found = COMPUTE[expression.word](*values)
        except ZeroDivisionError:
            raise SourceError("a division by zero", expression.span) from None
        except (OverflowError, ValueError):
            raise SourceError("its value is no number that there is", expression.span) from None
        return found if isinstance(found, bool) else float(found)

    @staticmethod
    def _partly(expression: Operation, values: Sequence[Value | Unknown]) -> Value | None:
        """AND and OR may be known though one side is not; None if they are not."""
        if expression.word == "AND" and any(v is False for v in values):
            return False
        if expression.word == "OR" and any(v is True for v in values):
            return True
        return None

    def _datum(self, datum: Datum) -> Value | Unknown:
        name = self.name(datum)
        text = self._text_of(datum.span)
        if name is None:
            return Unknown(f"{text}, whose number is not known")
        if name in self.registers and self._grammar.holds(datum.word):
            self.suppose(name)
            return self.registers[name]
        if datum.word in self._grammar.outputs and not self._course.changing(name):
            held = self.outputs.value(name)
            if held is not None:
                return held
        answer = self._course.value(name, About(datum.span))
        if answer is None:
            return Unknown(name)
        return _answered(answer, name, datum.span)

    def suppose(self, name: str) -> None:
        """The statement under way reads a register."""
        mark = self._marks.get(name)
        if mark is not None:
            self._course.suppose(mark.supposed)

    def leave_supposed(self, names: frozenset[str], reason: str) -> None:
        """Registers have been set on a way that was chosen by rule."""
        for mark in (self._mark(name) for name in names & self.registers.keys()):
            mark.supposed = mark.supposed or reason

    def _mark(self, name: str) -> _Mark:
        return self._marks.setdefault(name, _Mark())

    def name(self, datum: Datum) -> str | None:
        """Of a datum, ``R[1]``, ``PR[1,2]``; None if its number is not known."""
        numbers: list[str] = []
        parts = [part for part in (datum.index, datum.element) if part is not None]
        for part in parts:
            index = self.value(part)
            if isinstance(index, Unknown):
                return None
            if isinstance(index, bool) or not float(index).is_integer():
                raise SourceError(f"{datum.word} has whole numbers", datum.span)
            numbers.append(str(int(index)))
        name = f"{datum.word}[{','.join(numbers)}]" if numbers else datum.word
        if datum.word in self._grammar.settings and f"{name}{ONCE}" in self.registers:
            return f"{name}{ONCE}"
        return name


def element(name: str, k: int) -> str:
    """The name of a number of a datum that has several, counted from 0."""
    return f"{name[:-1]},{k + 1}]" if name.endswith("]") else f"{name}[{k + 1}]"


def _answered(answer: Answer, name: str, span: Span) -> Value:
    if isinstance(answer, bool | float):
        return answer
    raise AnswerError(f"the answer to {name} is a number or a truth, not {answer!r}", span)
