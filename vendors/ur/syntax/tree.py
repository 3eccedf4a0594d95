"""The syntax tree of URScript: nodes, each with the offsets between which it stands.

Nothing here is evaluated or checked beyond its form. Offsets are those of `texts.Texts`.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Number:
    """A number, with its sign if one stands before it."""

    start: int
    end: int
    value: int | float


@dataclass(frozen=True, slots=True)
class Text:
    """A string."""

    start: int
    end: int
    value: str


@dataclass(frozen=True, slots=True)
class Constant:
    """``True``, ``False`` or ``None``."""

    start: int
    end: int
    value: bool | None


@dataclass(frozen=True, slots=True)
class Numbers:
    """``[1, -2.5]`` or ``p[…]`` of nothing but numbers.

    Args:
        values: their values.
        places: offsets of each, start and end.
        pose: written with ``p``.
    """

    start: int
    end: int
    values: tuple[int | float, ...]
    places: tuple[tuple[int, int], ...]
    pose: bool


@dataclass(frozen=True, slots=True)
class Aggregate:
    """``[a, b, …]`` or ``p[a, b, …]``."""

    start: int
    end: int
    items: tuple[Expression, ...]
    pose: bool


@dataclass(frozen=True, slots=True)
class Name:
    """A variable."""

    start: int
    end: int
    text: str


@dataclass(frozen=True, slots=True)
class Index:
    """``base[i]`` or ``base[i, j]``."""

    start: int
    end: int
    base: Expression
    indices: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Member:
    """``base.name``: a part of a struct."""

    start: int
    end: int
    base: Expression
    name: str


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a call; ``name`` is None unless it is given as ``name=value``."""

    start: int
    end: int
    name: str | None
    value: Expression


@dataclass(frozen=True, slots=True)
class Call:
    """``name(arguments)``; the closing bracket is the last character."""

    start: int
    end: int
    name: str
    arguments: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class MethodCall:
    """``base.name(arguments)``: of a list, or a remote procedure."""

    start: int
    end: int
    base: Expression
    name: str
    arguments: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class StartThread:
    """``run name(arguments)``: starts a thread."""

    start: int
    end: int
    call: Call


@dataclass(frozen=True, slots=True)
class Unary:
    """``-``, ``+``, ``~`` or ``not`` before an operand."""

    start: int
    end: int
    operator: str
    operand: Expression


@dataclass(frozen=True, slots=True)
class Operation:
    """Operators of one priority, evaluated from left to right: ``a + b - c``.

    A flat list and no nest of pairs, so that a sum of a thousand terms is no deep tree.
    """

    start: int
    end: int
    first: Expression
    rest: tuple[tuple[str, Expression], ...]


Expression = (
    Number
    | Text
    | Constant
    | Numbers
    | Aggregate
    | Name
    | Index
    | Member
    | Call
    | MethodCall
    | StartThread
    | Unary
    | Operation
)
Place = Name | Index | Member
"""What can be assigned."""


@dataclass(frozen=True, slots=True)
class Assign:
    """``target = value``; ``storage`` is ``global``, ``local`` or empty."""

    start: int
    end: int
    target: Place
    value: Expression
    storage: str


@dataclass(frozen=True, slots=True)
class Evaluate:
    """An expression as a statement: a call."""

    start: int
    end: int
    expression: Expression


@dataclass(frozen=True, slots=True)
class Branch:
    """Statements and the condition under which they run."""

    condition: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class If:
    """``if … elif … else … end``"""

    start: int
    end: int
    branches: tuple[Branch, ...]
    otherwise: Block | None


@dataclass(frozen=True, slots=True)
class While:
    """``while condition: … end``"""

    start: int
    end: int
    condition: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class Return:
    """``return`` with or without a value."""

    start: int
    end: int
    value: Expression | None


@dataclass(frozen=True, slots=True)
class Keyword:
    """``break``, ``continue``, ``halt``, ``pass``, ``enter_critical`` or ``exit_critical``."""

    start: int
    end: int
    word: str


@dataclass(frozen=True, slots=True)
class ThreadEnd:
    """``join handle`` or ``kill handle``."""

    start: int
    end: int
    word: str
    handle: Expression


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a function; ``default`` is None if it must be given."""

    name: str
    default: Expression | None


@dataclass(frozen=True, slots=True)
class Define:
    """``def``, ``sec`` or ``thread``: ``kind name(parameters): … end``."""

    start: int
    end: int
    kind: str
    name: str
    parameters: tuple[Parameter, ...]
    body: Block

    @property
    def head(self) -> tuple[int, int]:
        """Where its first word stands."""
        return self.start, self.start + len(self.kind)


Statement = Assign | Evaluate | If | While | Return | Keyword | ThreadEnd | Define
Block = tuple[Statement, ...]
