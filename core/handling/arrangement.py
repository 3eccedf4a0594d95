"""Where parts are: on the flange, or where they lie."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..cell.workpiece import Workpiece
from ..spatial.pose import Pose, Vector3


@dataclass(frozen=True, slots=True)
class PlacedPart:
    """One part at its place.

    Args:
        name: unique among all parts.
        part: its kind.
        pose: of its shape, in the flange's frame where it is held, else in that of ``carrier``.
        held: whether the flange carries it.
        carrier: external axis on which it lies; None for the world.
        gone: whether it has left the cell.
    """

    name: str
    part: Workpiece
    pose: Pose
    held: bool = False
    carrier: str | None = None
    gone: bool = False


Arrangement = tuple[PlacedPart, ...]
"""All parts, always in the same order."""


def at_first(parts: tuple[Workpiece, ...]) -> Arrangement:
    """Where parts lie before the program runs."""
    return tuple(
        PlacedPart(name, part, pose, carrier=part.carried_by)
        for part in parts
        for name, pose in part.pieces()
    )


def distance_to_box(point: Vector3, place: Pose, box: tuple[Vector3, Vector3]) -> float:
    """m from a point to a box, 0 inside.

    Args:
        point: in the frame of ``place``.
        place: of the box's frame.
        box: its lowest and highest corner.
    """
    at = (place.inverse() @ Pose(point)).position
    return math.hypot(*(max(low - x, 0.0, x - high) for x, low, high in zip(at, *box, strict=True)))
