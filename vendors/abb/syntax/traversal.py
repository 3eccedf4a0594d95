"""What stands in a syntax tree: statements in blocks, calls and names in expressions."""

from __future__ import annotations

from collections.abc import Iterator

from .tree import (
    Aggregate,
    Assign,
    Block,
    Call,
    Expression,
    For,
    If,
    Invoke,
    Label,
    LateInvoke,
    Name,
    Operation,
    Return,
    Routine,
    Statement,
    Test,
    Unary,
    While,
)


def inner_blocks(statement: Statement) -> list[Block]:
    """The blocks inside a statement."""
    blocks: list[Block | None] = []
    if isinstance(statement, If):
        blocks = [*(b.body for b in statement.branches), statement.otherwise]
    elif isinstance(statement, Test):
        blocks = [*(c.body for c in statement.cases), statement.otherwise]
    elif isinstance(statement, For | While):
        blocks = [statement.body]
    return [b for b in blocks if b is not None]


def calls_in(expression: Expression) -> Iterator[Call]:
    """The functions that an expression calls."""
    if isinstance(expression, Call):
        yield expression
    for part in _parts(expression):
        yield from calls_in(part)


def names_in(expression: Expression) -> set[str]:
    """Lower-case names of the data that an expression reads."""
    own = {expression.name} if isinstance(expression, Name) else set()
    return own.union(*(names_in(part) for part in _parts(expression)))


def _parts(expression: Expression) -> list[Expression]:
    if isinstance(expression, Aggregate):
        return list(expression.items)
    if isinstance(expression, Unary):
        return [expression.operand]
    if isinstance(expression, Operation):
        return [expression.first, *(operand for _, operand in expression.rest)]
    if isinstance(expression, Name):
        return [e for step in expression.path if not isinstance(step, str) for e in step]
    if isinstance(expression, Call):
        return [a.value for a in expression.arguments if a.value is not None]
    return []


def expressions_of(statement: Statement) -> list[Expression]:
    """The expressions that a statement evaluates itself."""
    if isinstance(statement, Assign):
        return [statement.value]
    if isinstance(statement, Invoke | LateInvoke):
        return [a.value for a in statement.arguments if a.value is not None]
    if isinstance(statement, If):
        return [b.condition for b in statement.branches]
    if isinstance(statement, While):
        return [statement.condition]
    if isinstance(statement, Return) and statement.value is not None:
        return [statement.value]
    return []


def statements_of(block: Block) -> Iterator[Statement]:
    """The statements of a block and of the blocks inside it."""
    for statement in block.statements:
        yield statement
        for inner in inner_blocks(statement):
            yield from statements_of(inner)


def labels_of(routine: Routine) -> dict[str, int]:
    """Offsets of the labels of a routine."""
    return {s.name: s.span.start for s in statements_of(routine.body) if isinstance(s, Label)}
