"""Loops and routines of a written program, whatever its language."""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Generic, TypeVar

from ...program.folding import Called, Node, Repeat, folded
from ...program.move import Move, MoveC, MoveJ, MoveL, Statement
from ...program.program import Program
from ..text.names import Names

Line = TypeVar("Line")
COUNTER = "flyby_{}"
"""What counters are called."""


class Structure(ABC, Generic[Line]):
    """Writes each loop once, and each routine beside the program.

    What holds until it is set again is not known where a loop or a routine begins, and is what it
    has left where it ends.

    Args:
        names: gives routines and counters theirs.

    Attributes:
        held: what is known to hold, an object that is copied, and changed by what is written.
        routines: the lines of each by its name, in the order of their first call.
        counters: of the loops in each routine, by its name; the program's own is called "".
    """

    fallback = "Routine"
    """What a routine is called of whose name nothing can be kept."""

    def __init__(self, names: Names, held: Any) -> None:
        self.names = names
        self.held = held
        self.routines: dict[str, list[Line]] = {}
        self.counters: dict[str, list[str]] = {"": []}
        self._inside = ""
        self._known: dict[tuple[str, int], tuple[str, Any]] = {}

    @abstractmethod
    def nothing_known(self) -> Any:
        """What `held` is where nothing is known."""

    @abstractmethod
    def counted(self, body: list[Line], count: int, counter: str) -> list[Line]:
        """A loop that runs ``count`` times, and counts them by a name of its routine's own."""

    @abstractmethod
    def endless(self, body: list[Line]) -> list[Line]:
        """A loop without an end."""

    @abstractmethod
    def call(self, name: str) -> Line:
        """A call of a routine without arguments."""

    @property
    def taken(self) -> list[str]:
        """The names that it has given, which data may not have."""
        return [*self.routines, *(name for names in self.counters.values() for name in names)]

    def passed(self, move: Move, index: int) -> None:
        """A move that is not written again is driven."""

    def lines(
        self, program: Program, said: Callable[[Statement, int], Iterable[Line]]
    ) -> list[Line]:
        """The lines of the program itself.

        Args:
            said: the lines of a statement and the index that it has, or would have, as a move.
        """
        self._statements: Sequence[Statement] = program.statements
        self._moves = [0]
        for statement in program.statements:
            self._moves.append(self._moves[-1] + isinstance(statement, MoveJ | MoveL | MoveC))
        self._said = said
        return list(self._of(folded(program)))

    def _of(self, nodes: Sequence[Node]) -> Iterator[Line]:
        for node in nodes:
            if isinstance(node, Repeat):
                yield from self._repeat(node)
            elif isinstance(node, Called):
                yield self._called(node)
            else:
                yield from self._said(self._statements[node], self._moves[node])

    def _repeat(self, node: Repeat) -> list[Line]:
        self.held = self.nothing_known()
        body = list(self._of(node.body))
        self._pass(node.rest)
        if node.count is None:
            return self.endless(body)
        counters = self.counters[self._inside]
        while len(counters) <= node.level:
            counters.append(COUNTER.format(len(counters) + 1))
        return self.counted(body, node.count, counters[node.level])

    def _called(self, node: Called) -> Line:
        key = node.name.casefold(), node.number
        if key in self._known:
            self._pass(node.whole)
            name, held = self._known[key]
            self.held = copy.deepcopy(held)
            return self.call(name)
        name = self.names.claim(node.name, self.fallback)
        self.routines[name], self.counters[name] = [], []  # its place is that of its first call
        outer, self._inside = self._inside, name
        self.held = self.nothing_known()
        self.routines[name] += self._of(node.body)
        self._inside = outer
        self._known[key] = name, copy.deepcopy(self.held)
        return self.call(name)

    def _pass(self, indices: range) -> None:
        for index in indices:
            statement = self._statements[index]
            if isinstance(statement, MoveJ | MoveL | MoveC):
                self.passed(statement, self._moves[index])
