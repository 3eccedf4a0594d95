"""One difference, as a value."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from ..errors import Span


class Differing(StrEnum):
    """What differs, in the order in which differences are listed."""

    ROBOT = "robot"
    RANGE = "range"
    BASE = "base"
    TOOL = "tool"
    FRAME = "frame"
    LOAD = "load"
    POINT = "point"
    SIGNAL = "signal"
    ENTRY = "entry"
    MOVE = "move"
    TARGET = "target"
    ZONE = "zone"
    SPEED = "speed"
    MOVE_TOOL = "tool of a move"
    MOVE_FRAME = "frame of a move"
    MOVE_LOAD = "load of a move"
    WAIT = "wait"


@dataclass(frozen=True, slots=True)
class Difference:
    """Something that two states have otherwise.

    Args:
        subject: what it is.
        name: of the datum, the signal, or the move in its routine.
        before, after: as the shop floor writes them; empty where there is none.
        distance: m between two places; None where there are none to compare.
        angle: rad between two orientations, or the greatest of joint values.
        span: where it stands after the change, else before.
    """

    subject: Differing
    name: str
    before: str
    after: str
    distance: float | None = None
    angle: float | None = None
    span: Span | None = None

    @property
    def kind(self) -> str:
        """``added``, ``removed`` or ``changed``."""
        if not self.before:
            return "added"
        return "changed" if self.after else "removed"
