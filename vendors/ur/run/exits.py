"""How statements leave the block that they stand in."""

from __future__ import annotations

from ..values.located import Located


class Returned(Exception):
    """A function returns."""

    def __init__(self, found: Located) -> None:
        self.found = found


class Finished(Exception):
    """The program ends."""


class Break(Exception):
    """A loop ends."""


class Continue(Exception):
    """A pass of a loop ends."""
