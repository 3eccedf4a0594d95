"""Whether variables are as they were: a loop that leaves them so comes no nearer to its end."""

from __future__ import annotations

from collections.abc import Iterable

from .scope import Scope
from .values import Value


class Snapshot:
    """Variables as they are now.

    Args:
        names: of the variables; those that are not there yet count, too.
    """

    def __init__(self, names: Iterable[str], scope: Scope) -> None:
        self._scope = scope
        self._held = {name: self._value(name) for name in names}

    def changed(self) -> bool:
        """Whether some variable has another value now."""
        return any(self._value(name) != value for name, value in self._held.items())

    def _value(self, name: str) -> Value:
        cell = self._scope.find(name)
        return None if cell is None else cell.value
