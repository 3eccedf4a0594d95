"""What can be said of statements without running them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from .syntax import (
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
from .terms import Call

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
