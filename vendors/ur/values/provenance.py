"""Literals of URScript as the sources of values; see `flyby.core.source.execution.provenance`."""

from __future__ import annotations

from dataclasses import dataclass, field

from ....core.errors import Span
from ....core.source.execution.provenance import ELSEWHERE, Reads
from ....core.source.text.quick import quick
from ..syntax.texts import Texts
from ..syntax.tree import Constant, Expression, Number, Numbers, Text


@quick(frozen=True, slots=True)
class Literal:
    """Where a value stands in the text: a `Source`.

    Args:
        span: of the literal.
        root: of the literal that it is part of, or is.
        datum: name of the variable it belongs to, None for a literal at the place of use.
        numbers: spans of its numbers, signs included.
    """

    span: Span
    root: Span
    datum: str | None
    numbers: tuple[Span, ...]

    def part(self, index: int) -> Literal:
        """The source of an element of a list of numbers."""
        span = self.numbers[index]
        return Literal(span, self.root, f"{self.datum or ''}[{index}]", (span,))

    def named(self, datum: str) -> Literal:
        """The same, of a variable."""
        return Literal(self.span, self.root, datum, self.numbers)


Sources = tuple[Literal | None, ...]
"""Of a value: one literal that it stands in as a whole; or, for a list of which only elements
stand in literals, one or None for each element; empty if it is computed."""


@dataclass
class SourceReads:
    """Who reads which literals while a program runs.

    Attributes:
        reads: all of them.
        reader: index of the move whose arguments are evaluated, or `ELSEWHERE`.
    """

    texts: Texts
    reads: Reads = field(default_factory=Reads)
    reader: int = ELSEWHERE
    _literals: dict[int, Literal | None] = field(default_factory=dict)

    def consume(self, sources: Sources) -> None:
        """An expression computes with values that have sources."""
        for source in sources:
            if source is not None:
                self.reads.by_expression(source, self.reader)

    def literal(self, expression: Expression) -> Literal | None:
        """The source that an expression is, None if it computes anything."""
        key = expression.start
        if key not in self._literals:
            self._literals[key] = literal(expression, self.texts)
        return self._literals[key]


def elements(sources: Sources, count: int) -> Sources:
    """The source of each of ``count`` elements of a list, of which ``sources`` are the sources."""
    if len(sources) == 1 and sources[0] is not None and len(sources[0].numbers) == count:
        whole = sources[0]
        return tuple([whole.part(k) for k in range(count)]) if count > 1 else sources
    return sources if len(sources) == count else (None,) * count


def element_source(sources: Sources, count: int, index: int) -> Literal | None:
    """The source of one of ``count`` elements."""
    if len(sources) == 1 and count > 1:
        whole = sources[0]
        return whole.part(index) if whole is not None and len(whole.numbers) == count else None
    return sources[index] if len(sources) == count else None


def covering(sources: Sources, count: int) -> Sources:
    """Sources that stand for ``count`` numbers: those given if they do, else None for each."""
    if len(sources) == 1 and sources[0] is not None and len(sources[0].numbers) == count:
        return sources
    stated = sum(1 if source is None else len(source.numbers) for source in sources)
    return sources if stated == count else (None,) * count


def literal(expression: Expression, texts: Texts) -> Literal | None:
    """The source that an expression is, None if it computes anything."""
    if isinstance(expression, Numbers):
        places = ((expression.start, expression.end), *expression.places)
        span, *numbers = texts.spans(places)
        return Literal(span, span, None, tuple(numbers))
    if isinstance(expression, Number):
        span = texts.span(expression.start, expression.end)
        return Literal(span, span, None, (span,))
    if isinstance(expression, Text | Constant):
        span = texts.span(expression.start, expression.end)
        return Literal(span, span, None, ())
    return None
