"""Loops and routines of a written program, whatever its language."""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Generic, TypeVar

from ...program.folding import Called, Node, Repeat, folded
from ...program.move import Move, MoveC, MoveJ, MoveL, Statement
from ...program.places import Argument, Destination
from ...program.program import Program
from ...program.target import JointTarget, Target
from ...program.tool import WorkObject
from ..text.names import Names

Line = TypeVar("Line")
COUNTER = "flyby_{}"
"""What counters are called."""
ARGUMENT = "flyby_p{}"
"""What targets are called that a routine is given."""


def argument(number: int) -> str:
    """The name of an argument, by its number from 0."""
    return ARGUMENT.format(number + 1)


def summed(terms: Iterable[tuple[float, str]], number: Callable[[float], str]) -> str:
    """Stretches as a sum, see `Structure.stretches`.

    Args:
        number: writes one.
    """
    parts = (number(by) + (f"*{passes}" if passes else "") for by, passes in terms)
    return "+".join(parts).replace("+-", "-") or "0"


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
        arguments: of each routine, whether they are joint values.
    """

    fallback = "Routine"
    """What a routine is called of whose name nothing can be kept."""

    def __init__(self, names: Names, held: Any) -> None:
        self.names = names
        self.held = held
        self.routines: dict[str, list[Line]] = {}
        self.counters: dict[str, list[str]] = {"": []}
        self.arguments: dict[str, list[bool]] = {}
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
    def call(
        self, name: str, arguments: Sequence[Destination], frames: Sequence[WorkObject]
    ) -> list[Line]:
        """A call of a routine.

        Args:
            arguments: where it is sent.
            frames: the work object in which each is seen.
        """

    def stretches(self, place: Destination, first: int) -> list[list[tuple[float, str]]]:
        """How far a place is from its base, along x, y and z: stretches in m, each with what it is
        multiplied by, empty for nothing.

        Args:
            first: the number of a loop's first pass.
        """
        counters = self.counters[self._inside]
        found: list[list[tuple[float, str]]] = [[], [], []]
        for axis, terms in enumerate(found):
            if place.offset[axis]:
                terms.append((place.offset[axis], ""))
            for level, by in place.steps:
                counter = counters[level]
                passes = counter if first == 0 else f"({counter}-{first})"
                if by[axis]:
                    terms.append((by[axis], passes))
        return found

    @property
    def taken(self) -> list[str]:
        """The names that it has given, which data may not have."""
        counters = (name for names in self.counters.values() for name in names)
        most = max(map(len, self.arguments.values()), default=0)
        return [*self.routines, *counters, *map(argument, range(most))]

    def passed(self, move: Move, index: int) -> None:
        """A move that is not written again is driven."""

    def lines(
        self,
        program: Program,
        said: Callable[[Statement, int, tuple[Destination, ...]], Iterable[Line]],
    ) -> list[Line]:
        """The lines of the program itself.

        Args:
            said: the lines of a statement, of the index that it has, or would have, as a move, and
                of where it goes to and through.
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
                yield from self._called(node)
            else:
                index = node.index
                yield from self._said(self._statements[index], self._moves[index], node.places)

    def _repeat(self, node: Repeat) -> list[Line]:
        self.held = self.nothing_known()
        counters = self.counters[self._inside]
        while node.count is not None and len(counters) <= node.level:
            counters.append(COUNTER.format(len(counters) + 1))
        body = list(self._of(node.body))
        self._pass(node.rest)
        if node.count is None:
            return self.endless(body)
        return self.counted(body, node.count, counters[node.level])

    def _called(self, node: Called) -> list[Line]:
        key = node.name.casefold(), node.number
        if key in self._known:
            self._pass(node.whole)
            name, held = self._known[key]
            self.held = copy.deepcopy(held)
            return self.call(name, node.arguments, node.frames)
        name = self.names.claim(node.name, self.fallback)
        self.routines[name], self.counters[name] = [], []  # its place is that of its first call
        self.arguments[name] = [_joints(place.base) for place in node.arguments]
        outer, self._inside = self._inside, name
        self.held = self.nothing_known()
        self.routines[name] += self._of(node.body)
        self._inside = outer
        self._known[key] = name, copy.deepcopy(self.held)
        return self.call(name, node.arguments, node.frames)

    def _pass(self, indices: range) -> None:
        for index in indices:
            statement = self._statements[index]
            if isinstance(statement, MoveJ | MoveL | MoveC):
                self.passed(statement, self._moves[index])


def _joints(base: Target | Argument) -> bool:
    return base.joints if isinstance(base, Argument) else isinstance(base, JointTarget)
