"""Programs of one statement a line: what the statements are, and lines put together to routines.

A language says what a line is (`Grammar`); the statements here are what it can say. A condition
before a statement makes it an `If` of that one statement.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

from ...errors import InputError, SourceError, Span
from ...program.move import Move
from ..text.files import SourceText, unbroken
from .expressions import Datum, Expression

Numbers = Sequence[float]
_LINE = re.compile(r"[^\r\n]+")


@dataclass(frozen=True, slots=True)
class Line:
    """A line that is not blank.

    Args:
        source: the file.
        start, end: offsets of its first character that is no blank, and behind its last.
    """

    source: SourceText
    start: int
    end: int

    @property
    def text(self) -> str:
        """The line, without the blanks round it."""
        return self.source.text[self.start : self.end]

    @property
    def span(self) -> Span:
        """Where it stands."""
        return self.source.span(self.start, self.end)


@dataclass(frozen=True, slots=True)
class Operand:
    """A part of a move: a numbered point, or numbers at the move.

    Args:
        span: of it.
        numbers: one expression each; empty if it is a point.
        point: the point.
    """

    span: Span
    numbers: tuple[Expression, ...] = ()
    point: Datum | None = None


@dataclass(frozen=True, slots=True)
class Drive:
    """A move.

    Args:
        build: the move from the numbers of its target, speed, zone and auxiliary point; of what it
            raises (`InputError`, `ValueError`) the line is named.
        via: the auxiliary point of an arc.
    """

    span: Span
    target: Operand
    speed: Operand
    zone: Operand
    build: Callable[[Numbers, Numbers, Numbers, Numbers], Move]
    via: Operand | None = None


@dataclass(frozen=True, slots=True)
class Assign:
    """``R[1] = R[1] + 1``, ``DO[2] = ON``"""

    span: Span
    target: Datum
    value: Expression


@dataclass(frozen=True, slots=True)
class Label:
    """Where jumps lead."""

    span: Span
    name: str


@dataclass(frozen=True, slots=True)
class Jump:
    """A jump to a label of the same routine."""

    span: Span
    label: str


@dataclass(frozen=True, slots=True)
class If:
    """A statement that is carried out if a condition holds."""

    span: Span
    condition: Expression
    then: Body


@dataclass(frozen=True, slots=True)
class Call:
    """A call of a routine."""

    span: Span
    routine: str


@dataclass(frozen=True, slots=True)
class Return:
    """The routine ends."""

    span: Span


@dataclass(frozen=True, slots=True)
class End:
    """The program ends."""

    span: Span


@dataclass(frozen=True, slots=True)
class Pause:
    """The robot waits for a time, s, or until a condition holds."""

    span: Span
    time: Expression | None = None
    condition: Expression | None = None


@dataclass(frozen=True, slots=True)
class Kept:
    """What is kept as it stands and not carried out.

    Args:
        name: of the instruction, for the note.
        why: it is not carried out.
        stops: whether the robot stops at it.
    """

    span: Span
    name: str
    why: str
    stops: bool = False


@dataclass(frozen=True, slots=True)
class NumberedPoint:
    """A numbered point.

    Args:
        datum: its word and number.
        numbers: of it.
    """

    span: Span
    datum: Datum
    numbers: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Routine:
    """The lines from here on are another routine's."""

    span: Span
    name: str


Statement = (
    Drive
    | Assign
    | Label
    | Jump
    | If
    | Call
    | Return
    | End
    | Pause
    | Kept
    | NumberedPoint
    | Routine
)


@dataclass(frozen=True, eq=False)
class Body:
    """Statements in order."""

    statements: tuple[Statement, ...] = ()

    @cached_property
    def labels(self) -> Mapping[str, int]:
        """Index of each label."""
        return {s.name: i for i, s in enumerate(self.statements) if isinstance(s, Label)}


class Grammar(Protocol):
    """What a language takes a line for.

    Attributes:
        registers: words of data that the program itself sets and reads.
        outputs: words of outputs; all other words are asked of the answers.
    """

    registers: frozenset[str]
    outputs: frozenset[str]

    def statement(self, line: Line) -> Statement | None:
        """What a line says; None for nothing, a comment.

        Raises:
            InputError, ValueError: it says nothing that there is; the line is named by the caller.
        """
        ...


@dataclass(frozen=True)
class LineProgram:
    """The routines of a file.

    Args:
        file: its name.
        text: of the file.
        routines: by lower-case name; the lines before the first named one are called "".
        points: numbered points by `key`.
    """

    file: str
    text: str
    routines: Mapping[str, Body]
    points: Mapping[tuple[str, int], NumberedPoint] = field(default_factory=dict)


def read_lines(text: str, file: str, grammar: Grammar, name: str) -> LineProgram:
    """The routines of a text.

    Args:
        text: of the file.
        file: its name, for messages.
        grammar: of the language.
        name: of the language, for messages.

    Raises:
        SourceError: a line is no statement, or a routine, label or point is there twice.
    """
    source = SourceText(unbroken(text), file)
    routines: dict[str, list[Statement]] = {"": []}
    points: dict[tuple[str, int], NumberedPoint] = {}
    own, labels = routines[""], set[str]()
    for found in _LINE.finditer(source.text):
        words = found[0].strip()
        if not words:
            continue
        start = found.start() + len(found[0]) - len(found[0].lstrip())
        line = Line(source, start, start + len(words))
        statement = _statement(line, grammar, name)
        if isinstance(statement, Routine):
            if statement.name.lower() in routines:
                raise SourceError(f"there are two routines {statement.name}", line.span)
            own, labels = routines.setdefault(statement.name.lower(), []), set()
        elif isinstance(statement, NumberedPoint):
            key = point_key(statement.datum)
            if key in points:
                raise SourceError(f"there are two points {line.text.split()[0]}", line.span)
            points[key] = statement
        elif statement is not None:
            if isinstance(statement, Label) and statement.name in labels:
                raise SourceError(f"there are two labels {statement.name}", line.span)
            labels |= {statement.name} if isinstance(statement, Label) else set()
            own.append(statement)
    bodies = {key: Body(tuple(statements)) for key, statements in routines.items()}
    return LineProgram(file, text, bodies, points)


def point_key(datum: Datum) -> tuple[str, int]:
    """Under which a point with a written number is found.

    Raises:
        SourceError: its number is computed, or none.
    """
    value = getattr(datum.index, "value", None)
    if isinstance(value, bool) or not isinstance(value, float) or value != int(value):
        raise SourceError("a point that is defined has a whole number", datum.span)
    return datum.word, int(value)


def _statement(line: Line, grammar: Grammar, name: str) -> Statement | None:
    try:
        return grammar.statement(line)
    except (InputError, ValueError) as error:
        raise SourceError(f"{line.text!r} is no {name} statement: {error}", line.span) from None
