"""Walks through statements and expressions: what stands in them, whatever runs."""

from __future__ import annotations

from collections.abc import Iterator

from .tree import (
    Aggregate,
    Assign,
    Block,
    Call,
    Define,
    Evaluate,
    Expression,
    If,
    Index,
    Member,
    MethodCall,
    Name,
    Operation,
    Return,
    StartThread,
    Statement,
    ThreadEnd,
    Unary,
    While,
)


def assigned(block: Block) -> Iterator[str]:
    """Names of the variables that a block itself assigns."""
    for statement in block:
        if isinstance(statement, Assign) and isinstance(statement.target, Name):
            yield statement.target.text
        for inner in inner_blocks(statement):
            yield from assigned(inner)


def returns(block: Block) -> bool:
    """Whether a ``return`` stands in a block."""
    return any(
        isinstance(s, Return) or any(returns(inner) for inner in inner_blocks(s)) for s in block
    )


def names_in(expression: Expression) -> Iterator[str]:
    """Names of the variables that an expression reads."""
    if isinstance(expression, Name):
        yield expression.text
    for part in _parts(expression):
        yield from names_in(part)


def calls_in(expression: Expression) -> Iterator[str]:
    """Names of the functions and threads that an expression calls or starts."""
    if isinstance(expression, Call):
        yield expression.name
    if isinstance(expression, MethodCall):
        yield f".{expression.name}"
    for part in _parts(expression):
        yield from calls_in(part)


def inner_blocks(statement: Statement) -> list[Block]:
    """The blocks inside a statement that run when it runs."""
    if isinstance(statement, If):
        blocks = [b.body for b in statement.branches]
        return blocks if statement.otherwise is None else [*blocks, statement.otherwise]
    return [statement.body] if isinstance(statement, While) else []


def all_statements(block: Block) -> Iterator[Statement]:
    """All statements of a block, those of functions in it included."""
    for statement in block:
        yield statement
        inner = [statement.body] if isinstance(statement, Define) else inner_blocks(statement)
        for body in inner:
            yield from all_statements(body)


def calls_of(block: Block) -> set[str]:
    """What a block calls itself; functions defined in it run only when they are called."""
    names: set[str] = set()
    for statement in block:
        for expression in expressions_of(statement):
            names.update(calls_in(expression))
        for inner in inner_blocks(statement):
            names |= calls_of(inner)
    return names


def calls_written(expression: Expression) -> Iterator[Call]:
    """The calls in an expression, with their arguments."""
    if isinstance(expression, Call):
        yield expression
    for part in _parts(expression):
        yield from calls_written(part)


def methods_in(expression: Expression) -> Iterator[MethodCall]:
    """The calls of methods in an expression."""
    if isinstance(expression, MethodCall):
        yield expression
    for part in _parts(expression):
        yield from methods_in(part)


def all_calls(block: Block) -> set[str]:
    """What a block and the functions defined in it call."""
    inside = [s.body for s in all_statements(block) if isinstance(s, Define)]
    return calls_of(block).union(*map(calls_of, inside))


def expressions_of(statement: Statement) -> list[Expression]:
    """The expressions that a statement evaluates itself."""
    if isinstance(statement, Assign):
        return [statement.value, statement.target]
    if isinstance(statement, Evaluate):
        return [statement.expression]
    if isinstance(statement, If):
        return [b.condition for b in statement.branches]
    if isinstance(statement, While):
        return [statement.condition]
    if isinstance(statement, ThreadEnd):
        return [statement.handle]
    if isinstance(statement, Return) and statement.value is not None:
        return [statement.value]
    return []


def _parts(expression: Expression) -> list[Expression]:
    if isinstance(expression, Aggregate):
        return list(expression.items)
    if isinstance(expression, Index):
        return [expression.base, *expression.indices]
    if isinstance(expression, Member):
        return [expression.base]
    if isinstance(expression, Call):
        return [a.value for a in expression.arguments]
    if isinstance(expression, MethodCall):
        return [expression.base, *(a.value for a in expression.arguments)]
    if isinstance(expression, StartThread):
        return [expression.call]
    if isinstance(expression, Unary):
        return [expression.operand]
    if isinstance(expression, Operation):
        return [expression.first, *(operand for _, operand in expression.rest)]
    return []


def base_name(expression: Expression) -> str:
    """Name of the variable that a target is, or is a part of."""
    while isinstance(expression, Index | Member):
        expression = expression.base
    return expression.text if isinstance(expression, Name) else ""
