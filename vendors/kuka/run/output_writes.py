"""Writes of outputs whose moment is not certain: pulses, triggers, interrupts, routines without
their text."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ....core.errors import SourceError
from ....core.source.text.files import SourceText
from ..syntax.cursor import Cursor
from ..syntax.expression_tree import Call, Name
from ..syntax.lexer import tokenize
from ..syntax.statements import parse_statement
from ..syntax.tree import Assign, Block, Invoke, Statement
from ..values.data import Data
from ..values.elements import Names
from ..values.scope import Scope
from .analysis import inner_blocks

_HANDLER = re.compile(r"\bDO\s+(.+)", re.IGNORECASE | re.DOTALL)
_PRIORITY = re.compile(r"\bPRIO\s*=.*", re.IGNORECASE | re.DOTALL)

Written = set[str] | None
"""Names of outputs; None for any of them."""


class OutputWrites:
    """Follows such writes.

    Args:
        data: of the program, with what its outputs hold.
        names: finds the outputs that a name stands for.
    """

    def __init__(self, data: Data, names: Names) -> None:
        self._data = data
        self._names = names
        self._coming: list[Written] = []

    def pulsed(self, call: Call, scope: Scope) -> None:
        """``PULSE($OUT[1],TRUE,0.5)``, or another call that may write outputs."""
        self._data.outputs.forget(self._by_call(call, scope, set()))

    def triggered(self, action: str, scope: Scope) -> None:
        """A TRIGGER will carry an action out, on the way of the next motion."""
        self._coming.append(self._by_action(action, scope))

    def driven(self) -> None:
        """A motion has been read, with what was laid on its way."""
        coming, self._coming = self._coming, []
        for written in coming:
            self._data.outputs.forget(written)

    def interrupted(self, text: str, scope: Scope) -> None:
        """``INTERRUPT DECL 3 WHEN … DO routine()``: its routine may run at any time."""
        handler = _HANDLER.search(text)
        if handler is not None:
            self._data.outputs.share(self._by_action(handler[1], scope))

    def written(self, block: Block, scope: Scope) -> Written:
        """The outputs that a block, and what it calls, may write."""
        return self._by_block(block, scope, set())

    # -------------------------------------------------------------------- inside

    def _by_action(self, text: str, scope: Scope) -> Written:
        try:
            source = SourceText(_PRIORITY.sub("", text).strip(), "")
            statements = parse_statement(Cursor(tokenize(source)))
        except SourceError:
            return None
        return self._by_block(Block(statements), scope, set())

    def _by_block(self, block: Block, scope: Scope, reached: set[int]) -> Written:
        if id(block) in reached:
            return set()
        reached.add(id(block))
        found: set[str] = set()
        for part in self._parts(block, scope, reached):
            if part is None:
                return None
            found |= part
        return found

    def _parts(self, block: Block, scope: Scope, reached: set[int]) -> Iterator[Written]:
        for statement in block.statements:
            yield self._by_statement(statement, scope, reached)
            for inner in inner_blocks(statement):
                yield self._by_block(inner, scope, reached)

    def _by_statement(self, statement: Statement, scope: Scope, reached: set[int]) -> Written:
        if isinstance(statement, Assign):
            return self._named(statement.target, scope)
        if isinstance(statement, Invoke):
            return self._by_call(statement.call, scope, reached)
        return set()

    def _by_call(self, call: Call, scope: Scope, reached: set[int]) -> Written:
        if call.name == "pulse":
            first = call.arguments[0] if call.arguments else None
            return self._named(first, scope) if isinstance(first, Name) else None
        found = self._data.library.routine(call.name, scope.module)
        if found is None:
            return None
        routine, module = found
        self._data.declare_module(module)
        return self._by_block(routine.body, Scope(routine.text, module), reached)

    def _named(self, target: Name, scope: Scope) -> Written:
        try:
            return set(self._names.outputs(target, scope))
        except SourceError:  # an index that only the run knows
            return None
