"""What can be said of statements without running them.

It is asked only where a run meets a condition that is not known, a thread, or a loop that may have
no end; the answers are kept.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Container, Iterable, Iterator

from ..syntax.traversal import (
    all_statements,
    assigned,
    base_name,
    calls_in,
    calls_of,
    calls_written_in,
    inner_blocks,
    names_in,
    way_out,
)
from ..syntax.tree import (
    Assign,
    Block,
    Call,
    Define,
    Evaluate,
    Expression,
    If,
    Keyword,
    Return,
    Statement,
    While,
)
from ..values.instructions import MOVES, REFUSED
from ..values.outputs import written_by


class Analysis:
    """Asks statements, and the functions that they call, what they do.

    A name stands for all functions of that name, wherever they are defined.

    Args:
        blocks: the statements of all files.
        skipped: names of refused functions that an answer tells to skip.
    """

    def __init__(self, blocks: Iterable[Block], skipped: frozenset[str] = frozenset()) -> None:
        self._refused = REFUSED.keys() - skipped
        self._functions: defaultdict[str, list[Define]] = defaultdict(list)
        for block in blocks:
            for statement in all_statements(block):
                if isinstance(statement, Define):
                    self._functions[statement.name].append(statement)
        self._known: dict[tuple[str, str], bool] = {}
        self._written: dict[str, frozenset[str]] = {}
        self._decisive: dict[int, frozenset[str] | None] = {}

    def moves(self, block: Block) -> bool:
        """Whether what moves the robot stands in a block or in what it calls."""
        return self.drives(block) or self._reaches("refused", self._refused, block)

    def drives(self, block: Block) -> bool:
        """The same of moves that are carried out."""
        return self._reaches("moves", MOVES, block)

    def can_be_taken(self, block: Block) -> bool:
        """Whether a block moves the robot, and only by moves that are carried out."""
        return self.drives(block) and not self._reaches("refused", self._refused, block)

    def function_moves(self, name: str) -> bool:
        """Whether a function moves the robot."""
        moves = self._calls("moves", MOVES, name)
        return moves or self._calls("refused", self._refused, name)

    def _reaches(self, kind: str, names: Container[str], block: Block) -> bool:
        return any(self._calls(kind, names, name) for name in calls_of(block))

    def _calls(self, kind: str, names: Container[str], name: str) -> bool:
        own = self._functions.get(name)
        if own is None:
            return name in names
        return self._once(kind, name, lambda: any(self._reaches(kind, names, d.body) for d in own))

    def outputs_written(self, block: Block) -> set[str]:
        """Names of the outputs that a block, and what it calls, may write."""
        return written_by(calls_written_in(block)) | self._outputs_of(calls_of(block))

    def function_outputs(self, name: str) -> set[str]:
        """Names of the outputs that a function, and what it calls, may write."""
        return self._outputs_of([name])

    def _outputs_of(self, names: Iterable[str]) -> set[str]:
        bodies = (d.body for one in self._reached(names) for d in self._functions.get(one, ()))
        return written_by(call for body in bodies for call in calls_written_in(body))

    def ends(self, block: Block, main: bool) -> bool:
        """Whether the program does not go on behind a block.

        Args:
            main: whether it stands in the function that the program starts with.
        """
        return any(self._statement_ends(s, main) for s in block)

    def writes(self, block: Block) -> frozenset[str]:
        """Names of the variables that a block, and what it calls, may write."""
        names = {s.target for s in all_statements(block) if isinstance(s, Assign)}
        written = {base_name(target) for target in names}
        for name in calls_of(block):
            written |= self._function_writes(name)
        return frozenset(written)

    def assigns(self, block: Block) -> frozenset[str]:
        """Names of the variables that a block itself assigns."""
        return frozenset(assigned(block))

    def decisive_names(self, loop: While) -> frozenset[str] | None:
        """Names of the variables that decide when a loop ends.

        Those that its condition reads, and the conditions of the branches by which it is left; and
        those from which these get their values. None if a function of the program has a part in
        it: it may read and write anything.
        """
        if loop.start not in self._decisive:
            self._decisive[loop.start] = self._deciding(loop)
        return self._decisive[loop.start]

    def _deciding(self, loop: While) -> frozenset[str] | None:
        names: frozenset[str] = frozenset()
        found = [loop.condition, *_guards(loop.body)]
        while True:
            if any(self._may_read_anything(expression) for expression in found):
                return None
            known, names = names, names.union(*map(names_in, found))
            if names == known:
                return names
            if any(self._function_writes(f) & names for f in calls_of(loop.body)):
                return None
            found = list(_deciders(loop.body, names))

    def _may_read_anything(self, expression: Expression) -> bool:
        return any(name in self._functions or name.startswith(".") for name in calls_in(expression))

    def thread_writes(self, name: str) -> frozenset[str]:
        """Names of the variables outside that a thread may write, if there are such."""
        storages = {"", "global"}
        return frozenset(
            base_name(s.target) for s in self._assignments(name) if s.storage in storages
        )

    def thread_makes(self, name: str) -> frozenset[str]:
        """Names of the variables that a thread makes for the whole program."""
        return frozenset(
            base_name(s.target) for s in self._assignments(name) if s.storage == "global"
        )

    def _assignments(self, name: str) -> Iterator[Assign]:
        """Those in a function and in all that it calls."""
        for called in self._reached([name]):
            for define in self._functions.get(called, ()):
                yield from (s for s in all_statements(define.body) if isinstance(s, Assign))

    def _reached(self, names: Iterable[str]) -> set[str]:
        """Functions, with all that they call."""
        todo = list(names)
        reached = set(todo)
        while todo:
            for define in self._functions.get(todo.pop(), ()):
                called = calls_of(define.body) - reached
                reached |= called
                todo += called
        return reached

    def _function_writes(self, name: str) -> frozenset[str]:
        if name not in self._written:
            self._written[name] = frozenset()  # for functions that call each other
            own = self._functions.get(name, ())
            self._written[name] = frozenset().union(*(self.writes(d.body) for d in own))
        return self._written[name]

    def _statement_ends(self, statement: Statement, main: bool) -> bool:
        if isinstance(statement, Return):
            return main
        if isinstance(statement, Keyword):
            return statement.word == "halt"
        if isinstance(statement, Evaluate) and isinstance(statement.expression, Call):
            name = statement.expression.name
            own = self._functions.get(name)
            if own is None:
                return False
            return self._once("ends", name, lambda: all(self.ends(d.body, False) for d in own))
        if isinstance(statement, If) and statement.otherwise is not None:
            return all(self.ends(b, main) for b in inner_blocks(statement))
        return False

    def _once(self, kind: str, name: str, find: Callable[[], bool]) -> bool:
        key = kind, name
        if key not in self._known:
            self._known[key] = False  # for functions that call each other
            self._known[key] = find()
        return self._known[key]


def _guards(block: Block) -> Iterator[Expression]:
    """The conditions on which a loop with this body is left."""
    for statement in block:
        if isinstance(statement, If) and any(way_out(b) for b in inner_blocks(statement)):
            yield from (branch.condition for branch in statement.branches)
        for inner in inner_blocks(statement):
            if way_out(inner):
                yield from _guards(inner)
        if isinstance(statement, While) and way_out(statement.body):
            yield statement.condition


def _deciders(
    block: Block, names: frozenset[str], around: tuple[Expression, ...] = ()
) -> Iterator[Expression]:
    """The expressions that decide what variables become in a block.

    Args:
        names: of the variables.
        around: conditions on which the block runs.
    """
    for statement in block:
        if isinstance(statement, Assign) and base_name(statement.target) in names:
            yield from (statement.value, statement.target, *around)
        conditions: tuple[Expression, ...] = ()
        if isinstance(statement, If):
            conditions = tuple(branch.condition for branch in statement.branches)
        elif isinstance(statement, While):
            conditions = (statement.condition,)
        for inner in inner_blocks(statement):
            yield from _deciders(inner, names, (*around, *conditions))
