"""Behind a jump or a RETURN that nobody decides: what is set there is set on one of two ways.

As long as the program is on that way it is known, as there is no other; where the two come together
it is not.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol


class Supposable(Protocol):
    """A datum.

    Attributes:
        supposed: what its value depends on, if a way that was chosen by rule has set it.
    """

    supposed: str


@dataclass(slots=True)
class Guard:
    """A jump or RETURN that was not taken.

    Args:
        reason: what it depends on.
        routine: in which it stands, by its number.
        label: where the ways come together; None for the routine's end.
        place: where the robot stood.

    Attributes:
        written: data that were set since.
    """

    reason: str
    routine: int
    label: str | None
    place: object
    written: list[Supposable] = field(default_factory=list)

    def close(self) -> None:
        """The ways have come together."""
        for datum in self.written:
            datum.supposed = datum.supposed or self.reason
