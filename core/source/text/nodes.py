"""Nodes that the syntax trees of several languages have; a language's own tree adds the others.

None is changed once it is made (`quick`). Nothing in a tree is evaluated or checked beyond its
form; names are looked up as the language folds them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cached_property
from itertools import zip_longest
from typing import Protocol

from ...errors import SourceError, Span, StopError
from .quick import quick


class Composed:
    """What may be made of expressions."""

    __slots__ = ()

    @property
    def parts(self) -> Sequence[Composed]:
        """The expressions that it is made of, in order."""
        return ()

    def walk(self) -> Iterator[Composed]:
        """It, and all that it is made of, however deep."""
        yield self
        for part in self.parts:
            yield from part.walk()


def same_form(first: Composed | None, second: Composed | None) -> bool:
    """Whether two expressions say the same, wherever and with whatever blanks they are written."""
    if first is None or second is None:
        return first is second
    pairs = zip_longest(first.walk(), second.walk())
    return all(type(a) is type(b) and _said(a) == _said(b) for a, b in pairs)


def _said(node: Composed | None) -> list[object]:
    """What a node says besides its parts."""
    names: list[str] = [f.name for f in fields(node)] if is_dataclass(node) else []
    return [_plain(getattr(node, name)) for name in names if name not in ("span", "text")]


def _plain(value: object) -> object:
    if isinstance(value, tuple):
        return tuple(map(_plain, value))
    return None if isinstance(value, (Node, Composed)) else value


class Expression(Composed):
    """What has a value."""

    __slots__ = ()

    @property
    def span(self) -> Span:
        """Where it stands."""
        raise NotImplementedError


@quick(frozen=True, slots=True)
class Node:
    """What stands at a place of the text."""

    span: Span


@quick(frozen=True, slots=True)
class Term(Node, Expression):
    """An expression that keeps its place."""


@quick(frozen=True, slots=True)
class Text(Term):
    """A string."""

    value: str


@quick(frozen=True, slots=True)
class Unreadable(Term):
    """A value that cannot be read, in a text that is read all the same.

    Args:
        message: why.
    """

    message: str


@quick(frozen=True, slots=True)
class Truth(Term):
    """``TRUE`` or ``FALSE``."""

    value: bool


@quick(frozen=True, slots=True)
class Unary(Term):
    """A sign or a word like ``not`` before an operand."""

    operator: str
    operand: Expression

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.operand,)


@quick(frozen=True, slots=True)
class Operation(Term):
    """Operators of one priority, evaluated from left to right: ``a + b - c``.

    A flat list and no nest of pairs, so that a sum of a thousand terms is no deep tree.
    """

    first: Expression
    rest: tuple[tuple[str, Expression], ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.first, *(operand for _, operand in self.rest))


@quick(frozen=True, slots=True)
class Statement(Node):
    """What is carried out."""

    @property
    def blocks(self) -> Sequence[Block]:
        """The blocks inside it."""
        return ()


@quick(frozen=True)
class Block:
    """Statements in order."""

    statements: tuple[Statement, ...] = ()

    @cached_property
    def labels(self) -> dict[str, int]:
        """Index of the statement behind each label of this block."""
        return {s.name: i + 1 for i, s in enumerate(self.statements) if isinstance(s, Label)}

    def walk(self) -> Iterator[Statement]:
        """Its statements, and those of the blocks inside them."""
        for statement in self.statements:
            yield statement
            for inner in statement.blocks:
                yield from inner.walk()


@quick(frozen=True, slots=True)
class Looping(Statement):
    """A block that is run again and again."""

    body: Block

    @property
    def blocks(self) -> Sequence[Block]:
        return (self.body,)


@quick(frozen=True, slots=True)
class While(Looping):
    """A loop as long as a condition holds."""

    condition: Expression


@quick(frozen=True, slots=True)
class Case:
    """The values of a `Switch` for which a block is run."""

    values: tuple[Expression, ...]
    body: Block


@quick(frozen=True, slots=True)
class Switch(Statement):
    """One of several blocks, by the value of an expression: ``TEST``, ``SWITCH``."""

    subject: Expression
    cases: tuple[Case, ...]
    otherwise: Block | None

    @property
    def blocks(self) -> Sequence[Block]:
        bodies = [case.body for case in self.cases]
        return bodies if self.otherwise is None else [*bodies, self.otherwise]


@quick(frozen=True, slots=True)
class Label(Statement):
    """Where a ``GOTO`` leads."""

    name: str


@quick(frozen=True, slots=True)
class Goto(Statement):
    """A jump to a label."""

    name: str


class Labelled(Protocol):
    """Statements in order, some of which are labels."""

    @property
    def statements(self) -> Sequence[object]:
        """Those of it; `blocks` of one are inside it."""

    @property
    def labels(self) -> Mapping[str, int]:
        """Places of its labels by their names."""


def jumps_nowhere(block: Labelled, around: frozenset[str] = frozenset()) -> Iterator[Goto]:
    """The jumps in a block that have no label there, nor in the blocks around it.

    Args:
        around: names of the labels in those.
    """
    known = around.union(block.labels)
    for statement in block.statements:
        if isinstance(statement, Goto) and statement.name not in known:
            yield statement
        for inner in getattr(statement, "blocks", ()):
            yield from jumps_nowhere(inner, known)


def no_label(jump: Goto) -> StopError:
    """The error of a jump that leads nowhere, where it is carried out."""
    return StopError(f"there is no label {jump.name} in the blocks round this jump", jump.span)


@quick(frozen=True, slots=True)
class Return(Statement):
    """The end of a routine, with or without a value."""

    value: Expression | None


@quick(frozen=True, slots=True)
class Unread(Statement):
    """What is no statement of the language, in a text that is read all the same.

    Args:
        message: why.
        words: in it, lower case: of motions and routines, among others.
        target: the datum that it would set; None for none.
    """

    message: str
    words: frozenset[str]
    target: Expression | None = None

    @property
    def error(self) -> SourceError:
        """Why it cannot be carried out."""
        return SourceError(self.message, self.span)


@quick(frozen=True, slots=True)
class Keyword(Statement):
    """A statement of which only the first word is kept, lower case."""

    word: str
