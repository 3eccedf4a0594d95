"""Which literal a value was read from, and who else reads it.

A *source* is a literal of the program text that stands for a value unchanged: the initial value
of a datum (or a component or element of it), or a literal at the move itself. Reading a datum
through another one (``CONST robtarget p20:=p10;``) or through a value parameter keeps the source;
computing with it, or assigning at run time, loses it.

Ownership of a move's part follows from all reads of the run:

- *owned*: a literal that this one executed move reads and nothing else;
- *shared*: a literal that several executed moves, or an expression elsewhere, read as well; and
  every predefined datum (``v100``, ``z10``), which has no numbers in the text;
- *derived*: no source.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

from ....core.errors import Span
from ....core.program.origin import Origin, Ownership
from .syntax import Aggregate, Expression, Number, Text, Truth

ELSEWHERE = -1
"""The reader that is no move."""


@dataclass(frozen=True, slots=True)
class Source:
    """Where a value stands in the text.

    Args:
        literal: the expression; all its leaves are literals.
        root: span of the literal that it is part of, or is.
        datum: name of the datum it belongs to, None for a literal at the place of use.
    """

    literal: Expression
    root: Span
    datum: str | None

    def part(self, index: int, name: str) -> Source | None:
        """The source of an item of an aggregate."""
        if not isinstance(self.literal, Aggregate) or index >= len(self.literal.items):
            return None
        return Source(self.literal.items[index], self.root, f"{self.datum or ''}{name}")


def source_of_literal(expression: Expression, datum: str | None) -> Source | None:
    """The source that an expression is, None if it computes anything."""
    return Source(expression, expression.span, datum) if _is_literal(expression) else None


def _is_literal(expression: Expression) -> bool:
    if isinstance(expression, Aggregate):
        return all(_is_literal(item) for item in expression.items)
    return isinstance(expression, Number | Text | Truth)


def numbers_of(expression: Expression) -> tuple[Span, ...]:
    """Spans of the numbers of a literal, left to right."""
    if isinstance(expression, Number):
        return (expression.span,)
    if isinstance(expression, Aggregate):
        return tuple(span for item in expression.items for span in numbers_of(item))
    return ()


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a move before all reads are known.

    Args:
        span: of the expression at the move.
        source: None if it is derived or predefined.
        predefined: name of the controller's own datum.
    """

    span: Span
    source: Source | None = None
    predefined: str | None = None


@dataclass
class Reads:
    """Every read of a literal during a run."""

    _whole: defaultdict[Span, set[int]] = field(default_factory=lambda: defaultdict(set))
    _inside: defaultdict[Span, set[tuple[int, int, int]]] = field(
        default_factory=lambda: defaultdict(set)
    )

    def by_move(self, source: Source, move: int) -> None:
        """A move takes its target, speed or zone from the literal as it stands."""
        self._whole[source.literal.span].add(move)

    def by_expression(self, source: Source, reader: int) -> None:
        """An expression, of a move or `ELSEWHERE`, computes with the literal."""
        span = source.literal.span
        self._inside[source.root].add((span.start, span.end, reader))

    def origin(self, part: Part, move: int) -> Origin:
        """The origin of a part of a move, when all reads are known."""
        source = part.source
        if part.predefined is not None:
            return Origin(Ownership.SHARED, part.span, part.predefined)
        if source is None:
            return Origin(Ownership.DERIVED, part.span)
        alone = self._whole[source.literal.span] == {move} and not self._read_inside(source, move)
        ownership = Ownership.OWNED if alone else Ownership.SHARED
        return Origin(ownership, part.span, source.datum, numbers_of(source.literal))

    def _read_inside(self, source: Source, move: int) -> bool:
        reads = self._inside.get(source.root)
        if not reads:
            return False
        span = source.literal.span
        return any(
            reader != move and start < span.end and span.start < end for start, end, reader in reads
        )
