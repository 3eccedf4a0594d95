"""Operators by their priorities, read by one loop over a table of levels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

from .cursor import TokenCursor
from .nodes import Expression, Operation

Cursor = TypeVar("Cursor", bound=TokenCursor[Any])
Operand = TypeVar("Operand")
COMPARING = frozenset({"=", "==", "<>", "!=", "<", ">", "<=", ">="})
"""Operators that compare, in whichever language."""


class Operators(Generic[Cursor, Operand]):
    """Reads operands with operators between them.

    Args:
        levels: the kinds of operators of one priority, the loosest first.
        operand: reads an operand; called with the loosest level that may follow in its place.
        join: makes one of operators of the same level: of the offset where they start, the first
            operand, and each operator with the operand behind it.
    """

    def __init__(
        self,
        levels: Sequence[frozenset[str]],
        operand: Callable[[Cursor, int], Operand],
        join: Callable[[Cursor, int, Operand, tuple[tuple[str, Operand], ...]], Operand],
    ) -> None:
        self._levels = levels
        self._level_of = {kind: level for level, kinds in enumerate(levels) for kind in kinds}
        self._operand = operand
        self._join = join

    def read(self, cursor: Cursor, level: int = 0) -> Operand:
        """Operands with the operators of a level, and all tighter ones, between them."""
        start = cursor.starts[cursor.index]
        first = self._operand(cursor, level)
        while (here := self._level_of.get(cursor.kinds[cursor.index], -1)) >= level:
            operators = self._levels[here]
            rest = []
            while (operator := cursor.kinds[cursor.index]) in operators:
                cursor.index += 1
                rest.append((operator, self.read(cursor, here + 1)))
            first = self._join(cursor, start, first, tuple(rest))
        return first


def operation(
    cursor: TokenCursor[Any],
    start: int,
    first: Expression,
    rest: tuple[tuple[str, Expression], ...],
) -> Expression:
    """The operation that ends where the cursor is, of nodes with a span."""
    return Operation(cursor.span_from(start), first, rest)
