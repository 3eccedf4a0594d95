"""How statements leave the block that they stand in."""

from __future__ import annotations

from dataclasses import dataclass

from ..values.located import Located
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


@dataclass(frozen=True, slots=True)
class OpenExit:
    """A branch that was not taken, since its condition is not known, and that may end a loop.

    Args:
        word: by what.
        written: variables that it writes; empty if it holds the ``word`` itself.
        reason: what the condition depends on.
        outputs: that it writes.
    """

    word: str
    written: frozenset[str]
    reason: Unknown
    outputs: frozenset[str] = frozenset()


@dataclass
class Frame:
    """A function that runs.

    Args:
        open: what decides which of its returns is taken, if that is not known.
    """

    open: Unknown | None = None
