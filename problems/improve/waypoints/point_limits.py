"""How far a via point may be moved from where the program has it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ....core.errors import InputError
from ....core.spatial.pose import Vector3


@dataclass(frozen=True, slots=True)
class Fixed:
    """It stays; its zone may change.

    Args:
        why: for messages.
    """

    why: str = "it is to stay"


@dataclass(frozen=True, slots=True)
class Free:
    """It may go anywhere within the joints' limits; how far the tool may turn, the task says."""


@dataclass(frozen=True, slots=True)
class PointBox:
    """Each quantity that is given stays within its range; None leaves it free.

    Args:
        position: m, half the edges of a box round the TCP, along the work object's axes.
        turn: rad, largest turn of the tool from its programmed orientation; None for the task's.
        joints: rad or m, largest change of each of the arm's joints.

    Raises:
        InputError: a range is not finite or below zero.
    """

    position: Vector3 | None = None
    turn: float | None = None
    joints: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        turn = () if self.turn is None else (self.turn,)
        _check("PointBox", *(self.position or ()), *turn, *(self.joints or ()))


@dataclass(frozen=True, slots=True)
class PointCone:
    """The tool's axis stays near its programmed direction; turns about the axis are free.

    Args:
        angle: rad, half the cone's opening, below π.
        axis: which axis of the tool, in its own frame.
        position: m, as in `PointBox`; None leaves the position free.

    Raises:
        InputError: a range is not finite or below zero, or the axis has no direction.
    """

    angle: float
    axis: Vector3 = (0.0, 0.0, 1.0)
    position: Vector3 | None = None

    def __post_init__(self) -> None:
        _check("PointCone", self.angle, *(self.position or ()))
        if not self.angle < math.pi:
            raise InputError(f"PointCone.angle is below π, not {self.angle}")
        if not (math.isfinite(math.hypot(*self.axis)) and math.hypot(*self.axis) > 0):
            raise InputError(f"PointCone.axis needs a direction, not {self.axis}")


PointLimit = Fixed | Free | PointBox | PointCone
FREE = Free()


def _check(owner: str, *ranges: float) -> None:
    for value in ranges:
        if not (math.isfinite(value) and value >= 0):
            raise InputError(f"a range of a {owner} is finite and zero or more, not {value}")
