"""What stands in an expression, what stands in indices left out."""

from __future__ import annotations

from collections.abc import Iterator

from .tree import Call, Expression, Name


def data_in(expression: Expression) -> Iterator[Name]:
    """The data that an expression reads."""
    return (part for part in expression.walk() if isinstance(part, Name))


def calls_in(expression: Expression) -> Iterator[Call]:
    """The functions that an expression calls."""
    return (part for part in expression.walk() if isinstance(part, Call))


def indices_in(datum: Name) -> Iterator[Expression]:
    """The indices in the path of a datum."""
    for step in datum.path:
        if not isinstance(step, str):
            yield from (index for index in step if index is not None)
