"""The syntax tree of URScript: nodes, each with the offsets between which it stands.

Nothing here is evaluated or checked beyond its form. Offsets are those of `texts.Texts`.
"""

from __future__ import annotations

from collections.abc import Sequence

from ....core.source.text.nodes import Composed
from ....core.source.text.quick import quick


@quick(frozen=True, slots=True)
class Node:
    """What stands between two offsets."""

    start: int
    end: int


@quick(frozen=True, slots=True)
class Expression(Node, Composed):
    """What has a value, or is called."""


@quick(frozen=True, slots=True)
class Statement(Node):
    """What is carried out."""

    @property
    def blocks(self) -> Sequence[Block]:
        """The blocks inside it that run when it runs."""
        return ()


@quick(frozen=True, slots=True)
class Unread(Statement):
    """What is no statement, in a text that is read all the same.

    Args:
        message: why.
        words: in it: of motions and functions, among others.
        target: the variable that it would set; None for none.
    """

    message: str
    words: frozenset[str]
    target: Name | None = None


@quick(frozen=True, slots=True)
class Number(Expression):
    """A number, with its sign if one stands before it."""

    value: int | float


@quick(frozen=True, slots=True)
class Text(Expression):
    """A string."""

    value: str


@quick(frozen=True, slots=True)
class Constant(Expression):
    """``True``, ``False`` or ``None``."""

    value: bool | None


@quick(frozen=True, slots=True)
class Numbers(Expression):
    """``[1, -2.5]`` or ``p[…]`` of nothing but numbers.

    Args:
        values: their values.
        places: offsets of each, start and end.
        pose: written with ``p``.
    """

    values: tuple[int | float, ...]
    places: tuple[tuple[int, int], ...]
    pose: bool


@quick(frozen=True, slots=True)
class Aggregate(Expression):
    """``[a, b, …]`` or ``p[a, b, …]``."""

    items: tuple[Expression, ...]
    pose: bool

    @property
    def parts(self) -> Sequence[Expression]:
        return self.items


@quick(frozen=True, slots=True)
class Name(Expression):
    """A variable."""

    text: str


@quick(frozen=True, slots=True)
class Index(Expression):
    """``base[i]`` or ``base[i, j]``."""

    base: Expression
    indices: tuple[Expression, ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.base, *self.indices)


@quick(frozen=True, slots=True)
class Member(Expression):
    """``base.name``: a part of a struct."""

    base: Expression
    name: str

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.base,)


@quick(frozen=True, slots=True)
class Argument(Node):
    """An argument of a call; ``name`` is None unless it is given as ``name=value``."""

    name: str | None
    value: Expression


@quick(frozen=True, slots=True)
class Call(Expression):
    """``name(arguments)``; the closing bracket is the last character."""

    name: str
    arguments: tuple[Argument, ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return [a.value for a in self.arguments]


@quick(frozen=True, slots=True)
class MethodCall(Expression):
    """``base.name(arguments)``: of a list, or a remote procedure."""

    base: Expression
    name: str
    arguments: tuple[Argument, ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return [self.base, *(a.value for a in self.arguments)]


@quick(frozen=True, slots=True)
class StartThread(Expression):
    """``run name(arguments)``: starts a thread."""

    call: Call

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.call,)


@quick(frozen=True, slots=True)
class Unary(Expression):
    """``-``, ``+``, ``~`` or ``not`` before an operand."""

    operator: str
    operand: Expression

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.operand,)


@quick(frozen=True, slots=True)
class Operation(Expression):
    """Operators of one priority, evaluated from left to right: ``a + b - c``.

    A flat list and no nest of pairs, so that a sum of a thousand terms is no deep tree.
    """

    first: Expression
    rest: tuple[tuple[str, Expression], ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.first, *(operand for _, operand in self.rest))


Place = Name | Index | Member
"""What can be assigned."""


@quick(frozen=True, slots=True)
class Assign(Statement):
    """``target = value``; ``storage`` is ``global``, ``local`` or empty."""

    target: Place
    value: Expression
    storage: str


@quick(frozen=True, slots=True)
class Evaluate(Statement):
    """An expression as a statement: a call."""

    expression: Expression


@quick(frozen=True, slots=True)
class Branch:
    """Statements and the condition under which they run."""

    condition: Expression
    body: Block


@quick(frozen=True, slots=True)
class If(Statement):
    """``if … elif … else … end``"""

    branches: tuple[Branch, ...]
    otherwise: Block | None

    @property
    def blocks(self) -> Sequence[Block]:
        bodies = [branch.body for branch in self.branches]
        return bodies if self.otherwise is None else [*bodies, self.otherwise]


@quick(frozen=True, slots=True)
class While(Statement):
    """``while condition: … end``"""

    condition: Expression
    body: Block

    @property
    def blocks(self) -> Sequence[Block]:
        return (self.body,)


@quick(frozen=True, slots=True)
class Return(Statement):
    """``return`` with or without a value."""

    value: Expression | None


@quick(frozen=True, slots=True)
class Keyword(Statement):
    """``break``, ``continue``, ``halt``, ``pass``, ``enter_critical`` or ``exit_critical``."""

    word: str


@quick(frozen=True, slots=True)
class ThreadEnd(Statement):
    """``join handle`` or ``kill handle``."""

    word: str
    handle: Expression


@quick(frozen=True, slots=True)
class Parameter:
    """A parameter of a function; ``default`` is None if it must be given."""

    name: str
    default: Expression | None


@quick(frozen=True, slots=True)
class Define(Statement):
    """``def``, ``sec`` or ``thread``: ``kind name(parameters): … end``."""

    kind: str
    name: str
    parameters: tuple[Parameter, ...]
    body: Block

    @property
    def head(self) -> tuple[int, int]:
        """Where its first word stands."""
        return self.start, self.start + len(self.kind)


Block = tuple[Statement, ...]
