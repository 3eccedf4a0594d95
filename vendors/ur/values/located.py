"""Values with the places that they were read from."""

from __future__ import annotations

from ....core.source.text.quick import quick
from .provenance import Sources
from .values import Value


@quick(frozen=True, slots=True)
class Located:
    """A value together with the places of the text that it was read from.

    Args:
        name: of the variable, if it holds what stands in the text.
    """

    value: Value
    sources: Sources = ()
    name: str | None = None


NOTHING = Located(None)
"""What a call returns that returns nothing."""
