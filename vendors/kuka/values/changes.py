"""Whether a pass of a loop leaves the data as they were: then every other pass would, too."""

from __future__ import annotations

from collections.abc import Iterable

from .scope import Cell
from .values import Pending, Unknown, Value, copied

Held = Value | Pending | None


class Journal:
    """What data held before the passes of loops that are under way."""

    def __init__(self) -> None:
        self._passes: list[dict[int, tuple[Cell, Held]]] = []

    def begin(self) -> None:
        """A pass begins, perhaps inside another."""
        self._passes.append({})

    def end(self) -> bool:
        """The pass that began last ends.

        Returns:
            Whether some datum holds another value than before it.
        """
        before = self._passes.pop()
        return any(not _same(old, cell.value) for cell, old in before.values())

    def note(self, cell: Cell) -> None:
        """A datum is about to get a value."""
        for before in self._passes:
            if id(cell) not in before:
                before[id(cell)] = cell, _kept(cell.value)

    def forget(self, cells: Iterable[Cell]) -> None:
        """The data of a routine are gone when it is left."""
        if self._passes:
            gone = {id(cell) for cell in cells}
            for before in self._passes:
                for key in gone & before.keys():
                    del before[key]


def _kept(value: Held) -> Held:
    return value if value is None or isinstance(value, Pending) else copied(value)


def _same(old: Held, new: Held) -> bool:
    if isinstance(old, Unknown) and isinstance(new, Unknown):
        return True
    return old == new
