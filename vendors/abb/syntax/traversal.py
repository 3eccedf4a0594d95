"""What stands in a syntax tree: calls and names in expressions, expressions in statements."""

from __future__ import annotations

from collections.abc import Iterator

from ....core.source.text.nodes import Composed
from . import tree
from .tree import Call, Expression, Statement


def calls_in(expression: Expression) -> Iterator[Call]:
    """The functions that an expression calls, in order."""
    pending: list[Composed] = [expression]  # a tree of generators takes several times as long
    while pending:
        part = pending.pop()
        if isinstance(part, Call):
            yield part
        if inner := part.parts:
            pending += reversed(inner)


def names_in(expression: Expression) -> set[str]:
    """Lower-case names of the data that an expression reads."""
    return {part.name for part in expression.walk() if isinstance(part, tree.Name)}


def expressions_of(statement: Statement) -> list[Expression]:
    """The expressions that a statement evaluates itself."""
    if isinstance(statement, tree.Assign):
        return [statement.value]
    if isinstance(statement, tree.Invoke | tree.LateInvoke):
        return [a.value for a in statement.arguments if a.value is not None]
    if isinstance(statement, tree.If):
        return [b.condition for b in statement.branches]
    if isinstance(statement, tree.While):
        return [statement.condition]
    if isinstance(statement, tree.Return) and statement.value is not None:
        return [statement.value]
    return []
