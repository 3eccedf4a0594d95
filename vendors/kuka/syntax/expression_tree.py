"""The syntax tree of KRL's expressions: frozen nodes, each with the place it stands at.

Names keep their spelling in ``text`` and are looked up by ``name``, which is lower case.
"""

from __future__ import annotations

from dataclasses import dataclass

from ....core.errors import Span
from ....core.source.text.files import SourceText


@dataclass(frozen=True, slots=True)
class Number:
    """A number, with its sign if one stands before it; an ``int`` if it is written as one."""

    source: SourceText
    start: int
    end: int
    value: int | float

    @property
    def span(self) -> Span:
        """Where it stands."""
        return self.source.span(self.start, self.end)


@dataclass(frozen=True, slots=True)
class Text:
    """A string."""

    span: Span
    value: str


@dataclass(frozen=True, slots=True)
class Truth:
    """``TRUE`` or ``FALSE``."""

    span: Span
    value: bool


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant of an enumeration, ``#BASE``; its name is lower case."""

    span: Span
    name: str


@dataclass(frozen=True, slots=True)
class Flat:
    """An aggregate whose items are literals, kept as text until it is asked for."""

    source: SourceText
    start: int
    end: int

    @property
    def span(self) -> Span:
        """Where it stands."""
        return self.source.span(self.start, self.end)


@dataclass(frozen=True, slots=True)
class Aggregate:
    """``{X 1,CM {X 0},POINT2[] " "}``: components by lower-case name, and perhaps a type."""

    source: SourceText
    start: int
    end: int
    type: str | None
    items: tuple[tuple[str, Expression], ...]

    @property
    def span(self) -> Span:
        """Where it stands."""
        return self.source.span(self.start, self.end)


@dataclass(frozen=True, slots=True)
class Name:
    """A datum or a part of it: ``P1``, ``P1.X``, ``P[3]``, ``S[]``, ``TOOL_NAME[1,]``.

    Args:
        name: of the datum, lower case.
        text: as it stands in the source.
        path: components (lower-case words) and tuples of indices, left to right; None in a tuple
            is an index left out.
    """

    span: Span
    name: str
    text: str
    path: tuple[str | tuple[Expression | None, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Call:
    """A function's value or the call of a routine; None is an argument left out."""

    span: Span
    name: str
    text: str
    arguments: tuple[Expression | None, ...]


@dataclass(frozen=True, slots=True)
class Unary:
    """``-``, ``+``, ``not`` or ``b_not`` before an operand."""

    span: Span
    operator: str
    operand: Expression


@dataclass(frozen=True, slots=True)
class Operation:
    """Operators of one priority, evaluated from left to right: ``a + b - c``.

    A flat list and no nest of pairs, so that a sum of a thousand terms is no deep tree.
    """

    span: Span
    first: Expression
    rest: tuple[tuple[str, Expression], ...]


@dataclass(frozen=True, slots=True)
class Ambiguous:
    """A condition that means two things: ``A == 1 AND B == 2``.

    Args:
        manual: comparisons last, as KUKA's table of priorities has it.
        usual: comparisons before AND and OR, for programs that mean that.
    """

    span: Span
    manual: Expression
    usual: Expression


Expression = (
    Number
    | Text
    | Truth
    | Constant
    | Flat
    | Aggregate
    | Name
    | Call
    | Unary
    | Operation
    | Ambiguous
)
