"""What ``$POS_ACT`` and ``$AXIS_ACT`` hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ....core.errors import Span
from ..values.values import Unknown, Value
from .frames import Placements
from .position import Position


class OwnPosition:
    """Answers the program when it asks where the robot stands.

    Args:
        position: follows the robot.
        placements: tool and base in force.
        move_index: index of the move that comes next.

    Attributes:
        asked: how often the program has asked.
    """

    def __init__(
        self, position: Position, placements: Placements, move_index: Callable[[], int]
    ) -> None:
        self.asked = 0
        self._position = position
        self._placements = placements
        self._move_index = move_index

    def __call__(self, kind: str, span: Span) -> Value:
        """Where it stands: ``pose`` or ``axes``."""
        self.asked += 1
        placement = None if kind == "axes" else self._placements.current(span)
        if placement is None:
            value: Value = self._position.axes(span)
        else:
            value = self._position.pose(placement, span)
        here = self._move_index(), placement
        return replace(value, here=here) if isinstance(value, Unknown) else value
