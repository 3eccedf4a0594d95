"""What can be said of statements without running them.

It is asked only where a run meets a condition that is not known, or a loop that may have no end;
the answers are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from ..syntax.traversal import (
    calls_in,
    expressions_of,
    inner_blocks,
    labels_of,
    names_in,
    statements_of,
)
from ..syntax.tree import (
    Argument,
    Assign,
    Block,
    Expression,
    Goto,
    If,
    Invoke,
    Keyword,
    Label,
    LateInvoke,
    Name,
    Return,
    Routine,
    Statement,
    Test,
    While,
)
from ..values.outputs import READING, WRITING
from ..values.scope import Home
from .instructions import KEPT, MOVING

if TYPE_CHECKING:
    from ..values.data import Globals

_ENDING = frozenset({"stop", "exitcycle", "systemstopaction"})
_STEPPING = frozenset({"incr", "decr", "add", "clear"})


class Flow:
    """Asks statements, and the routines that they call, what they do.

    Args:
        data: the program's routines.
    """

    def __init__(self, data: Globals) -> None:
        self._data = data
        self._known: dict[tuple[str, int], bool] = {}
        self._written: dict[int, frozenset[str]] = {}

    def comes_back(self, block: Block, home: Home, labels: dict[str, int], main: bool) -> bool:
        """Whether a branch moves the robot and the program goes on behind it.

        Args:
            home: the module of the text.
            labels: offsets of the labels of its routine: who jumps back does not go on.
            main: whether the routine is the one that the program starts in.
        """
        return self.moves(block, home) and not self.ends(block, home, labels, main)

    def moves(self, block: Block, home: Home) -> bool:
        """Whether a move stands in a block or in a routine that it calls."""
        return self._once("moves", block, lambda: any(self._move_in(block, home)))

    def routine_moves(self, routine: Routine) -> bool:
        """Whether a routine moves the robot."""
        return self.moves(routine.body, self._data.scope_of(routine).home)

    def call_moves(self, expression: Expression, home: Home) -> bool:
        """Whether a function in an expression moves the robot."""
        return any(self._calls_mover(call.name, home) for call in calls_in(expression))

    def may_leave(self, block: Block, body: Block) -> bool:
        """Whether a block in a loop's body (or all of it) holds a statement that can end the loop.

        Args:
            block: in the body, or all of it.
            body: of the loop.
        """
        return self._once(f"leaves {id(body)}", block, lambda: _may_leave(block, body))

    def unchanging(self, loop: While, home: Home) -> bool:
        """Whether nothing in a loop's body writes the data that its condition reads."""
        if any(call.name not in READING for call in calls_in(loop.condition)):
            return False
        return not (names_in(loop.condition) & self._writes(loop.body, home))

    def decided_by(self, loop: While, skipped: Sequence[Block], home: Home) -> bool:
        """Whether the data and outputs that a loop's condition reads are written in blocks of its
        body that were not taken, and nowhere else in it."""
        read = names_in(loop.condition)
        if not any(
            read & (self._writes(block, home) | self.signals_written(block, home))
            for block in skipped
        ):
            return False
        left_out = frozenset(map(id, skipped))
        written = {*self._names_written(loop.body, home, left_out)}
        return not read & (written | self.signals_written(loop.body, home, left_out))

    # ---------------------------------------------------------------------- moves

    def _once(self, kind: str, block: Block, find: Callable[[], bool]) -> bool:
        key = (kind, id(block))
        if key not in self._known:
            self._known[key] = False  # for routines that call each other
            self._known[key] = find()
        return self._known[key]

    def _move_in(self, block: Block, home: Home) -> Iterator[bool]:
        for statement in block.statements:
            if isinstance(statement, Invoke):
                own = self._data.routine(statement.name, home)
                yield statement.name in MOVING if own is None else self.routine_moves(own)
            yield isinstance(statement, LateInvoke)
            for expression in expressions_of(statement):
                yield self.call_moves(expression, home)
            for inner in inner_blocks(statement):
                yield self.moves(inner, home)

    def _calls_mover(self, name: str, home: Home) -> bool:
        routine = self._data.routine(name, home)
        return routine is not None and self.routine_moves(routine)

    # ----------------------------------------------------------------------- ends

    def ends(self, block: Block, home: Home, labels: dict[str, int], main: bool) -> bool:
        """Whether the program does not go on behind a block."""
        return any(self._statement_ends(s, home, labels, main) for s in block.statements)

    def _statement_ends(
        self, statement: Statement, home: Home, labels: dict[str, int], main: bool
    ) -> bool:
        if isinstance(statement, Return):
            return main
        if isinstance(statement, Keyword):
            return statement.word in ("exit", "raise")
        if isinstance(statement, Goto):
            return labels.get(statement.name, -1) < statement.span.start
        if isinstance(statement, Invoke):
            own = self._data.routine(statement.name, home)
            return statement.name in _ENDING if own is None else self._routine_ends(own)
        if isinstance(statement, If | Test) and statement.otherwise is not None:
            return all(self.ends(b, home, labels, main) for b in inner_blocks(statement))
        return False

    def _routine_ends(self, routine: Routine) -> bool:
        home = self._data.scope_of(routine).home
        return self._once(
            "ends", routine.body, lambda: self.ends(routine.body, home, labels_of(routine), False)
        )

    # --------------------------------------------------------------------- writes

    def _writes(self, block: Block, home: Home) -> frozenset[str]:
        """Lower-case names of the data that a block, and what it calls, may write."""
        if id(block) not in self._written:
            self._written[id(block)] = frozenset()
            self._written[id(block)] = frozenset(self._names_written(block, home))
        return self._written[id(block)]

    def signals_written(
        self, block: Block, home: Home, left_out: frozenset[int] = frozenset()
    ) -> set[str]:
        """Lower-case names of the outputs that a block, and what it calls, may write.

        What is handed to a routine that writes outputs is among them.

        Args:
            left_out: ids of blocks in it that do not count.
        """
        found: set[str] = set()
        reached, todo = {id(block)}, [(block, home)]
        while todo:
            one, home = todo.pop()
            for statement in one.statements:
                todo += [(b, home) for b in inner_blocks(statement) if id(b) not in left_out]
                if not isinstance(statement, Invoke):
                    continue
                called = self._data.routine(statement.name, home)
                if called is not None or statement.name in WRITING:
                    found |= set(_names_given(statement.arguments))
                if called is not None and id(called.body) not in reached:
                    reached.add(id(called.body))
                    todo.append((called.body, self._data.scope_of(called).home))
        return found

    def _names_written(
        self, block: Block, home: Home, left_out: frozenset[int] = frozenset()
    ) -> Iterator[str]:
        if id(block) in left_out:
            return
        for statement in block.statements:
            if isinstance(statement, Assign):
                yield statement.target.name
            elif isinstance(statement, Invoke | LateInvoke):
                yield from self._written_by_call(statement, home)
            for expression in expressions_of(statement):
                for call in calls_in(expression):
                    yield from self._written_by_routine(call.name, home)
                    yield from _names_given(call.arguments)
            for inner in inner_blocks(statement):
                if left_out:
                    yield from self._names_written(inner, home, left_out)
                else:
                    yield from self._writes(inner, home)

    def _written_by_call(self, statement: Invoke | LateInvoke, home: Home) -> Iterator[str]:
        if isinstance(statement, Invoke):
            kept = KEPT.get(statement.name)
            own = self._data.routine(statement.name, home)
            writes = statement.name in _STEPPING or (kept is not None and kept.writes)
            if own is None and not writes:
                return
            yield from self._written_by_routine(statement.name, home)
        yield from _names_given(statement.arguments)

    def _written_by_routine(self, name: str, home: Home) -> Iterable[str]:
        routine = self._data.routine(name, home)
        if routine is None:
            return ()
        return self._writes(routine.body, self._data.scope_of(routine).home)


def _may_leave(block: Block, body: Block) -> bool:
    inside = {s.name for s in statements_of(body) if isinstance(s, Label)}
    return any(_leaves(statement, inside) for statement in statements_of(block))


def _leaves(statement: Statement, labels: set[str]) -> bool:
    if isinstance(statement, Goto):
        return statement.name not in labels
    if isinstance(statement, Keyword):
        return statement.word in ("exit", "raise")
    if isinstance(statement, Invoke):
        return statement.name == "exitcycle"
    return isinstance(statement, Return)


def _names_given(arguments: Iterable[Argument]) -> Iterator[str]:
    for argument in arguments:
        value = argument.value
        if isinstance(value, Name):
            yield value.name
