"""Literals of RAPID as the sources of values; see `flyby.core.source.execution.provenance`."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from ....core.errors import Span
from ....core.program.origin import Spans
from ....core.source.text.quick import quick
from ..syntax.packed import number_spans, unpacked
from ..syntax.tree import Aggregate, Expression, Number, Packed, Text, Truth
from .types import Value


@quick(frozen=True, slots=True)
class Literal:
    """Where a value stands in the text: a `Source`.

    Args:
        expression: all its leaves are literals.
        root: span of the literal that it is part of, or is.
        datum: name of the datum it belongs to, None for a literal at the place of use.
    """

    expression: Expression
    root: Span
    datum: str | None

    @property
    def span(self) -> Span:
        """Of the literal."""
        return self.expression.span

    @property
    def numbers(self) -> Sequence[Span | None]:
        """Spans of its numbers, left to right."""
        literal = self.expression
        if isinstance(literal, Packed):
            return Spans(partial(number_spans, literal))
        return _numbers(literal)

    def part(self, index: int, name: str) -> Literal | None:
        """The source of an item of an aggregate."""
        literal = self.expression
        if isinstance(literal, Packed):
            literal = unpacked(literal)
        if not isinstance(literal, Aggregate) or index >= len(literal.items):
            return None
        return Literal(literal.items[index], self.root, f"{self.datum or ''}{name}")


def source_of_literal(expression: Expression, datum: str | None) -> Literal | None:
    """The source that an expression is, None if it computes anything."""
    return Literal(expression, expression.span, datum) if _is_literal(expression) else None


def constant(expression: Expression) -> Value:
    """The value of an expression that is a source."""
    if isinstance(expression, Aggregate):
        return tuple(constant(item) for item in expression.items)
    assert isinstance(expression, Number | Packed | Text | Truth)
    return expression.value


def _is_literal(expression: Expression) -> bool:
    if isinstance(expression, Packed):
        return True
    if isinstance(expression, Aggregate):
        return all(_is_literal(item) for item in expression.items)
    return isinstance(expression, Number | Text | Truth)


def _numbers(expression: Expression) -> tuple[Span, ...]:
    if isinstance(expression, Packed):
        return number_spans(expression)
    if isinstance(expression, Number):
        return (expression.span,)
    if isinstance(expression, Aggregate):
        return tuple(span for item in expression.items for span in _numbers(item))
    return ()
