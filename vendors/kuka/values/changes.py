"""Whether data are as they were: a loop that leaves them so does not come nearer to its end."""

from __future__ import annotations

from collections.abc import Iterable

from .scope import Variable
from .values import Pending, Unknown, Value, copied

Held = Value | Pending | None


class Snapshot:
    """Data as they are now."""

    def __init__(self, cells: Iterable[Variable]) -> None:
        self._held = [(cell, _kept(cell.value)) for cell in cells]

    def changed(self) -> bool:
        """Whether some datum has another value now."""
        return any(not _same(old, cell.value) for cell, old in self._held)


def _kept(value: Held) -> Held:
    return value if value is None or isinstance(value, Pending) else copied(value)


def _same(old: Held, new: Held) -> bool:
    if isinstance(old, Unknown) and isinstance(new, Unknown):
        return True
    return old == new
