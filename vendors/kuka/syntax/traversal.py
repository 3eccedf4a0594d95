"""What stands in an expression."""

from __future__ import annotations

from collections.abc import Iterator

from .expression_tree import Ambiguous, Call, Expression, Name, Operation, Unary


def operands(expression: Expression) -> tuple[Expression, ...]:
    """The expressions that one is made of; of an ambiguous one, of KUKA's reading."""
    if isinstance(expression, Operation):
        return (expression.first, *(operand for _, operand in expression.rest))
    if isinstance(expression, Unary):
        return (expression.operand,)
    if isinstance(expression, Ambiguous):
        return (expression.manual,)
    if isinstance(expression, Call):
        return tuple(argument for argument in expression.arguments if argument is not None)
    return ()


def data_in(expression: Expression) -> Iterator[Name]:
    """The data that an expression reads, those in their indices left out."""
    if isinstance(expression, Name):
        yield expression
    for operand in operands(expression):
        yield from data_in(operand)


def calls_in(expression: Expression) -> Iterator[Call]:
    """The functions that an expression calls, those in indices left out."""
    if isinstance(expression, Call):
        yield expression
    for operand in operands(expression):
        yield from calls_in(operand)


def indices_in(datum: Name) -> Iterator[Expression]:
    """The indices in the path of a datum."""
    for step in datum.path:
        if not isinstance(step, str):
            yield from (index for index in step if index is not None)
