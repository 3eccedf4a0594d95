"""Values with the places that they were read from."""

from __future__ import annotations

from ....core.source.text.quick import quick
from .provenance import Literal
from .scope import Variable
from .types import Type, Value, find_unknown


@quick(frozen=True, slots=True)
class Located:
    """A value together with the place of the text that it was read from.

    Args:
        cell: the datum, None if the expression is no plain datum.
        predefined: name of the controller's own datum that the value is.
        type: of the value, None if it is not known.
    """

    value: Value
    source: Literal | None
    cell: Variable | None
    predefined: str | None = None
    type: Type | None = None

    @property
    def open(self) -> bool:
        """Whether a part of it is not known; literals and the controller's own data are."""
        return (
            self.source is None and self.predefined is None and find_unknown(self.value) is not None
        )
