"""Whether data are as they were: a loop that leaves them so does not come nearer to its end."""

from __future__ import annotations

from collections.abc import Iterable

from .scope import Variable


class Snapshot:
    """Data as they are now.

    Args:
        cells: which; those whose values have not been evaluated yet do not count.
    """

    def __init__(self, cells: Iterable[Variable]) -> None:
        self._held = [
            (cell, cell.value, dict(cell.elements)) for cell in cells if cell.value is not None
        ]

    def changed(self) -> bool:
        """Whether some datum has another value now."""
        return any(
            cell.elements != elements or (cell.value is not value and cell.value != value)
            for cell, value, elements in self._held
        )
