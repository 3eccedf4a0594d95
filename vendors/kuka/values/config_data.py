"""The data of ``$CONFIG.DAT``, as KUKA's own routines read them."""

from __future__ import annotations

from collections.abc import Sequence

from ....core.errors import Span
from ..syntax.tree import Name
from .data import Data
from .elements import Names
from .scope import Scope
from .values import Array, Value


class ConfigData:
    """Finds them, or the program's data of the same names.

    Args:
        scopes: of the routines under way, the innermost last.
    """

    def __init__(self, data: Data, names: Names, scopes: Sequence[Scope]) -> None:
        self._data = data
        self._names = names
        self._scopes = scopes

    def value(self, name: str) -> Value:
        """A datum."""
        node = Name(Span("", 1, 1, 0, 0), name.lower(), name)
        return self._names.value(node, Scope("", self._scopes[-1].module))

    def unset_frame(self, label: str) -> Value:
        """See `Names.unset_frame`."""
        return self._names.unset_frame(label)

    def item(self, table: str, index: int) -> Value | None:
        """An item of an array; None where nothing is set."""
        cell = self._data.find(table, Scope("", self._scopes[-1].module))
        holder = cell.value if cell is not None else None
        if not isinstance(holder, Array):
            return None
        size = holder.sizes[0]
        if size is not None and index > size:
            return None
        assert cell is not None
        return self._names.item(holder, (index,), cell)
