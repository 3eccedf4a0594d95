"""What happens along a move without changing it: outputs set on the way."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

from ..errors import InputError, Span


class EventAnchor(StrEnum):
    """Where on the move an event's distance and time count from."""

    START = "start"
    """Forward from the move's beginning."""
    END = "end"
    """Back from the move's target; in a zone, from its middle."""


@dataclass(frozen=True, slots=True)
class Event:
    """An action at a place of the path (RAPID ``MoveLDO``, ``TriggL``; KRL ``TRIGGER``).

    Args:
        text: the action, as it stands in the source.
        anchor: see `EventAnchor`.
        distance: of the TCP along the path from the anchor, m.
        time: s before (positive) the place is passed.
        span: where in the source.

    Raises:
        InputError: a number is not finite, or the distance below zero.
    """

    text: str
    anchor: EventAnchor = EventAnchor.END
    distance: float = 0.0
    time: float = 0.0
    span: Span | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        if not (math.isfinite(self.distance) and math.isfinite(self.time) and self.distance >= 0):
            raise InputError(f"an event needs a distance of 0 or more and a finite time: {self}")
