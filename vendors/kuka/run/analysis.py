"""What can be said of statements without running them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ..syntax.expression_tree import Ambiguous, Call, Expression, Name, Operation, Unary
from ..syntax.tree import (
    Assign,
    Block,
    Exit,
    For,
    Goto,
    If,
    Invoke,
    Loop,
    Motion,
    Repeat,
    Return,
    SplineBlock,
    Statement,
    Switch,
    While,
)

Routines = Callable[[Call], Block | None]
_LOOPS = (For, While, Repeat, Loop)


def inner_blocks(statement: Statement) -> Iterator[Block]:
    """The blocks that a statement holds."""
    if isinstance(statement, If):
        yield statement.body
        yield statement.otherwise
    elif isinstance(statement, Switch):
        yield from (case.body for case in statement.cases)
        if statement.otherwise is not None:
            yield statement.otherwise
    elif isinstance(statement, _LOOPS):
        yield statement.body


def names_in(expression: Expression | None) -> set[str]:
    """Lower-case names of the data that an expression reads."""
    if isinstance(expression, Name):
        indices = [i for step in expression.path if not isinstance(step, str) for i in step]
        return {expression.name}.union(*map(names_in, indices))
    if isinstance(expression, Operation):
        parts = [expression.first, *(operand for _, operand in expression.rest)]
    elif isinstance(expression, Unary):
        parts = [expression.operand]
    elif isinstance(expression, Ambiguous):
        parts = [expression.manual]
    elif isinstance(expression, Call):
        return set().union(*map(names_in, expression.arguments))
    else:
        return set()
    return set().union(*map(names_in, parts))


def names_written(
    block: Block, routine: Routines, left_out: frozenset[int] = frozenset()
) -> set[str]:
    """Lower-case names of the data that a block, and what it calls, may write.

    Args:
        routine: the body of the routine that a call means; None if it is not at hand.
        left_out: ids of blocks in it that do not count.
    """
    found: set[str] = set()
    reached, todo = {*left_out}, [block]
    while todo:
        one = todo.pop()
        if id(one) in reached:
            continue
        reached.add(id(one))
        for statement in one.statements:
            todo += inner_blocks(statement)
            if isinstance(statement, Assign):
                found.add(statement.target.name)
            elif isinstance(statement, For):
                found.add(statement.counter.name)
            elif isinstance(statement, Invoke):
                found.update(a.name for a in statement.call.arguments if isinstance(a, Name))
                body = routine(statement.call)
                todo += [] if body is None else [body]
    return found


def guard_names(block: Block, left_out: frozenset[int] = frozenset()) -> set[str]:
    """Lower-case names of the data that decide whether a block is left from within.

    Args:
        left_out: ids of blocks in it that do not count.
    """
    found: set[str] = set()
    for statement in block.statements:
        inner = [b for b in inner_blocks(statement) if id(b) not in left_out]
        if any(map(leaves, inner)):
            if isinstance(statement, If):
                found |= names_in(statement.condition)
            elif isinstance(statement, Switch):
                found |= names_in(statement.subject)
            found = found.union(*(guard_names(b, left_out) for b in inner))
    return found


def leaves(block: Block, in_loop: bool = False) -> bool:
    """Whether a block holds a statement that goes elsewhere: GOTO, RETURN, or EXIT of a loop
    round the block."""
    for statement in block.statements:
        if isinstance(statement, Goto | Return):
            return True
        if isinstance(statement, Exit) and not in_loop:
            return True
        inside = in_loop or isinstance(statement, _LOOPS)
        if any(leaves(inner, inside) for inner in inner_blocks(statement)):
            return True
    return False


class Moving:
    """Whether blocks move the robot.

    Args:
        routine: the body of the routine that a call means; None if it is not at hand.
    """

    def __init__(self, routine: Routines) -> None:
        self._routine = routine
        self._known: dict[int, bool] = {}

    def __call__(self, block: Block) -> bool:
        """Whether a block holds a motion, or calls a routine that does."""
        known = self._known.get(id(block))
        if known is None:
            self._known[id(block)] = False  # a routine that calls itself
            known = self._known[id(block)] = any(map(self._moves, block.statements))
        return known

    def _moves(self, statement: Statement) -> bool:
        if isinstance(statement, Motion | SplineBlock):
            return True
        if isinstance(statement, Invoke):
            body = self._routine(statement.call)
            return body is not None and self(body)
        return any(map(self, inner_blocks(statement)))
