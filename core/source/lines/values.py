"""What registers, signals and expressions of lines are at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...errors import SourceError, Span
from ...program.question import Answer
from ..execution.answers import About, AnswerError, Course
from ..execution.outputs import Outputs
from .expressions import COMPUTE, Datum, Expression, Number, Operation, Truth, Value
from .program import Grammar


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that only the running controller has.

    Args:
        reason: what it depends on.
    """

    reason: str


class Snapshot:
    """Registers as they are now; see `core.source.execution.flow.Snapshot`."""

    def __init__(self, values: dict[str, Value | Unknown], names: frozenset[str] | None) -> None:
        self._values = values
        self._names = sorted(values if names is None else names)
        self._before = self._now()

    def _now(self) -> list[Value | Unknown | None]:
        return [self._values.get(name) for name in self._names]

    def changed(self) -> bool:
        """Whether one has another value now."""
        return self._now() != self._before


class Values:
    """The values of one run.

    Args:
        text: of the file.
        grammar: of the language.
        course: the user's answers.
        outputs: what the program has set its outputs to.

    Attributes:
        registers: by name, ``R[1]``.
    """

    def __init__(self, text: str, grammar: Grammar, course: Course, outputs: Outputs) -> None:
        self._text = text
        self._grammar = grammar
        self._course = course
        self.outputs = outputs
        self.registers: dict[str, Value | Unknown] = {}

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
        text = self._text[datum.span.start : datum.span.end]
        if name is None:
            return Unknown(f"{text}, whose number is not known")
        if datum.word in self._grammar.registers and name in self.registers:
            return self.registers[name]
        if datum.word in self._grammar.outputs and not self._course.changing(name):
            held = self.outputs.value(name)
            if held is not None:
                return held
        answer = self._course.value(name, About(datum.span))
        if answer is None:
            return Unknown(name)
        return _answered(answer, name, datum.span)

    def name(self, datum: Datum) -> str | None:
        """Of a datum, ``R[1]``; None if its number is not known."""
        index = self.value(datum.index)
        if isinstance(index, Unknown):
            return None
        if isinstance(index, bool) or index != int(index):
            raise SourceError(f"{datum.word} has whole numbers", datum.span)
        return f"{datum.word}[{int(index)}]"


def _answered(answer: Answer, name: str, span: Span) -> Value:
    if isinstance(answer, bool | float):
        return answer
    raise AnswerError(f"the answer to {name} is a number or a truth, not {answer!r}", span)
