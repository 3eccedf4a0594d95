"""What can be said of statements without running them."""

from __future__ import annotations

from .syntax import Block, For, Goto, If, Invoke, Keyword, Return, Statement, Test, While


def may_leave(block: Block) -> bool:
    """Whether a loop's body holds a statement that can end the loop."""
    for statement in block.statements:
        if isinstance(statement, Goto | Return):
            return True
        if isinstance(statement, Keyword) and statement.word in ("exit", "raise"):
            return True
        if isinstance(statement, Invoke) and statement.name == "exitcycle":
            return True
        if any(may_leave(inner) for inner in _inner_blocks(statement)):
            return True
    return False


def _inner_blocks(statement: Statement) -> list[Block]:
    blocks: list[Block | None] = []
    if isinstance(statement, If):
        blocks = [*(b.body for b in statement.branches), statement.otherwise]
    elif isinstance(statement, Test):
        blocks = [*(c.body for c in statement.cases), statement.otherwise]
    elif isinstance(statement, For | While):
        blocks = [statement.body]
    return [b for b in blocks if b is not None]
