"""Whether data are as they were: a loop that leaves them so does not come nearer to its end."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from .scope import Variable
from .values import Pending, Unknown, Value, copied

Held = Value | Pending | None


class Snapshot:
    """Data as they are now.

    Args:
        cells: those that there are.
        absent: names of those that nothing declares: they are there once they are written.
        find: a datum by its name.
    """

    def __init__(
        self,
        cells: Iterable[Variable],
        absent: Collection[str] = (),
        find: Callable[[str], Variable | None] = lambda name: None,
    ) -> None:
        self._held = [(cell, _kept(cell.value)) for cell in cells]
        self._absent = absent
        self._find = find

    def changed(self) -> bool:
        """Whether some datum has another value now."""
        if any(self._find(name) is not None for name in self._absent):
            return True
        return any(not _same(old, cell.value) for cell, old in self._held)


def _kept(value: Held) -> Held:
    return value if value is None or isinstance(value, Pending) else copied(value)


def _same(old: Held, new: Held) -> bool:
    if isinstance(old, Unknown) and isinstance(new, Unknown):
        return True
    return old == new
