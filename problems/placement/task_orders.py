"""The order in which a program carries out tasks: calls of routines that may change places."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations

from ...core.errors import InputError, UnknownNameError
from ...core.program.program import Program
from ...core.program.section import Section

Order = tuple[int, ...]
"""Which task comes first, second, …, by their places in the program."""
Seconds = Callable[[Program], float]
"""How long a program takes; infinite for one that cannot be driven."""

_ALL = 5
"""Tasks up to which all orders are driven; of more pairs are exchanged."""
_CLEARLY = 1e-3
"""s by which an order has to be faster."""


@dataclass(frozen=True)
class TaskOrders:
    """A program with tasks that may change places.

    Args:
        program: as given.
        tasks: calls of routines, one behind the other; what stands between them stays.
    """

    program: Program
    tasks: tuple[Section, ...]

    @classmethod
    def of(cls, program: Program, names: Sequence[str]) -> TaskOrders:
        """The tasks of these names.

        Raises:
            InputError: the program calls no such routine, or fewer than two of them.
        """
        calls = [section for section in program.sections if not section.passes]
        known = {section.name.casefold(): section.name for section in calls}
        for name in names:
            if name.casefold() not in known:
                raise UnknownNameError("routine that the program calls", name, known.values())
        wanted = {name.casefold() for name in names}
        found: list[Section] = []
        for section in sorted(calls, key=lambda section: (section.begin, -section.end)):
            inside = found and section.begin < found[-1].end
            if section.name.casefold() in wanted and not inside and section.end > section.begin:
                found.append(section)
        if len(found) < 2:
            raise InputError(
                f"of {', '.join(names)} the program carries out {len(found)}: an order takes two"
            )
        return cls(program, tuple(found))

    @property
    def given(self) -> Order:
        """As the program has them."""
        return tuple(range(len(self.tasks)))

    def program_in(self, order: Order) -> Program:
        """The program with its tasks in another order; what is known of its text goes."""
        if order == self.given:
            return self.program
        statements = self.program.statements
        made = list(statements[: self.tasks[0].begin])
        ends = [*(task.begin for task in self.tasks[1:]), len(statements)]
        for place, which in enumerate(order):
            task = self.tasks[which]
            made += statements[task.begin : task.end]
            made += statements[self.tasks[place].end : ends[place]]
        return replace(self.program, statements=tuple(made), sections=(), cycle=None, calls=())

    def named(self, order: Order) -> list[str]:
        """The tasks in an order, with the lines that call them."""
        return [f"{self.tasks[k].name} ({self.tasks[k].span})" for k in order]


def quickest_order(orders: TaskOrders, seconds: Seconds, begin: Order | None = None) -> Order:
    """The order in which a program is driven fastest.

    Args:
        orders: of its tasks.
        seconds: how long a program takes.
        begin: order that is kept if none is faster; the program's own if unset.
    """
    known: dict[Order, float] = {}

    def takes(order: Order) -> float:
        if order not in known:
            known[order] = seconds(orders.program_in(order))
        return known[order]

    best = begin or orders.given
    while True:
        found = min(_others(best), key=takes, default=best)
        if not takes(found) < takes(best) - _CLEARLY:
            return best
        best = found
        if len(best) <= _ALL:
            return best


def _others(order: Order) -> Iterator[Order]:
    """Orders beside one: all, or those that exchange two tasks or take one elsewhere."""
    if len(order) <= _ALL:
        yield from permutations(sorted(order))
        return
    for i, j in combinations(range(len(order)), 2):
        swapped = list(order)
        swapped[i], swapped[j] = swapped[j], swapped[i]
        yield tuple(swapped)
        for a, b in ((i, j), (j, i)):
            taken = list(order)
            taken.insert(b, taken.pop(a))
            yield tuple(taken)
