"""What ``$POS_ACT`` and ``$AXIS_ACT`` hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from ....core.errors import Span
from ..values.values import Unknown, Value
from .frames import Placements
from .position import Position


@dataclass(slots=True)
class OwnPosition:
    """Answers the program when it asks where the robot stands.

    Args:
        move_index: index of the move that comes next.
        suppose: called with what it depends on where the robot stands; see `Course.suppose`.
        asked: how often the program has asked.
    """

    position: Position
    placements: Placements
    move_index: Callable[[], int]
    suppose: Callable[[str], None]
    asked: int = 0

    def __call__(self, kind: str, span: Span) -> Value:
        """Where it stands: ``pose`` or ``axes``."""
        self.asked += 1
        placement = None if kind == "axes" else self.placements.current(span)
        if placement is None:
            value: Value = self.position.axes(span)
        else:
            value = self.position.pose(placement, span)
        self.suppose(self.position.supposed or (placement.supposed if placement else ""))
        here = self.move_index(), placement
        return replace(value, here=here) if isinstance(value, Unknown) else value
