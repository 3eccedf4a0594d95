"""How statements leave the block that they stand in."""

from __future__ import annotations

from dataclasses import dataclass

from ..values.located import Located
from ..values.scope import Scope
from ..values.values import Unknown


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


@dataclass
class Frame:
    """A function that runs.

    Args:
        scope: its names.
        open: what decides which of its returns is taken, if that is not known.
    """

    scope: Scope
    open: Unknown | None = None
