"""Walks through statements and expressions: what stands in them, whatever runs."""

from __future__ import annotations

from collections.abc import Iterator

from . import tree
from .tree import Block, Call, Expression, MethodCall, Statement


def assigned(block: Block) -> Iterator[str]:
    """Names of the variables that a block itself assigns."""
    for statement in run_in(block):
        if isinstance(statement, tree.Assign) and isinstance(statement.target, tree.Name):
            yield statement.target.text


def returns(block: Block) -> bool:
    """Whether a ``return`` stands in a block."""
    return any(isinstance(statement, tree.Return) for statement in run_in(block))


def names_in(expression: Expression) -> Iterator[str]:
    """Names of the variables that an expression reads."""
    return (part.text for part in expression.walk() if isinstance(part, tree.Name))


def calls_in(expression: Expression) -> Iterator[str]:
    """Names of the functions and threads that an expression calls or starts."""
    for part in expression.walk():
        if isinstance(part, Call):
            yield part.name
        elif isinstance(part, MethodCall):
            yield f".{part.name}"


def run_in(block: Block) -> Iterator[Statement]:
    """The statements of a block, and those inside them that run when they run."""
    for statement in block:
        yield statement
        for inner in statement.blocks:
            yield from run_in(inner)


def all_statements(block: Block) -> Iterator[Statement]:
    """All statements of a block, those of functions in it included."""
    for statement in run_in(block):
        yield statement
        if isinstance(statement, tree.Define):
            yield from all_statements(statement.body)


def calls_of(block: Block) -> set[str]:
    """What a block calls itself; functions defined in it run only when they are called."""
    return {name for s in run_in(block) for e in expressions_of(s) for name in calls_in(e)}


def calls_written(expression: Expression) -> Iterator[Call]:
    """The calls in an expression, with their arguments."""
    return (part for part in expression.walk() if isinstance(part, Call))


def methods_in(expression: Expression) -> Iterator[MethodCall]:
    """The calls of methods in an expression."""
    return (part for part in expression.walk() if isinstance(part, MethodCall))


def all_calls(block: Block) -> set[str]:
    """What a block and the functions defined in it call."""
    inside = [s.body for s in all_statements(block) if isinstance(s, tree.Define)]
    return calls_of(block).union(*map(calls_of, inside))


def expressions_of(statement: Statement) -> list[Expression]:
    """The expressions that a statement evaluates itself."""
    if isinstance(statement, tree.Assign):
        whole = isinstance(statement.target, tree.Name)
        return [statement.value] if whole else [statement.value, statement.target]
    if isinstance(statement, tree.Evaluate):
        return [statement.expression]
    if isinstance(statement, tree.If):
        return [b.condition for b in statement.branches]
    if isinstance(statement, tree.While):
        return [statement.condition]
    if isinstance(statement, tree.ThreadEnd):
        return [statement.handle]
    if isinstance(statement, tree.Return) and statement.value is not None:
        return [statement.value]
    return []


def base_name(expression: Expression) -> str:
    """Name of the variable that a target is, or is a part of."""
    while isinstance(expression, tree.Index | tree.Member):
        expression = expression.base
    return expression.text if isinstance(expression, tree.Name) else ""
