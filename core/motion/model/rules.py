"""Rules of controllers that a motion model names: zones, turns, pace and durations."""

from __future__ import annotations

from enum import StrEnum

from ...program.arc_orientation import ArcOrientation


class Overlap(StrEnum):
    """What happens where the zones of neighbouring waypoints would overlap."""

    HALF = "half"
    """No zone reaches further than half way to a neighbour (ABB, KUKA)."""
    SHRINK = "shrink"
    """Both zones shrink in proportion until they touch (UR, motion version 2)."""
    SKIP = "skip"
    """The later waypoint is left out (UR, motion version 1)."""


class OrientationZone(StrEnum):
    """Where the tool begins to turn towards the next target."""

    OWN = "own"
    """In a zone of its own, not smaller than the TCP's (ABB ``pzone_ori``)."""
    TCP = "tcp"
    """In the TCP's zone."""


class Space(StrEnum):
    """The space a corner between a joint move and a TCP move is blended in."""

    JOINT = "joint"
    TCP = "tcp"


class LineTurn(StrEnum):
    """How the tool turns along lines, and what limits of turning hold for there."""

    AXIS = "axis"
    """About one axis; for the whole turn."""
    SWIVEL = "swivel"
    """By the swivel of its x axis and the rotation about that; for each of both (KUKA)."""


class ArcTurn(StrEnum):
    """How the tool turns along arcs, whatever their programs say."""

    PROGRAMMED = "programmed"
    """As the program says."""
    AXIS = "axis"
    """About one axis, from the orientation at the start to that at the end."""
    PATH = "path"
    """With the arc, and evenly by the rest of its turn."""

    def follows(self, programmed: ArcOrientation) -> bool:
        """Whether the tool turns with an arc for which a program says how."""
        if self is ArcTurn.PROGRAMMED:
            return programmed is ArcOrientation.FOLLOWS_ARC
        return self is ArcTurn.PATH


class Pace(StrEnum):
    """How fast zones are driven."""

    LIMITS = "limits"
    """As fast as the limits along the path allow."""
    SUPERPOSED = "superposed"
    """As fast as legs from rest to rest that overlap in time; see `superposed_legs` (KUKA, UR)."""


class DurationRule(StrEnum):
    """How a move is driven that is programmed to take a time."""

    SCALED = "scaled"
    """As without, all its speeds slowed in common."""
    THIRDS = "thirds"
    """Accelerating over the first third of the time, braking over the last (UR, CB3)."""
    HALVES = "halves"
    """Accelerating over the first half of the time, braking over the second (UR, e-Series)."""

    @property
    def ramp(self) -> float | None:
        """The share of the time over which it accelerates, and again brakes."""
        return {DurationRule.THIRDS: 1 / 3, DurationRule.HALVES: 0.5}.get(self)
