"""Where two robots are not proven to keep clear of each other, and why."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

OwnSpan = tuple[float, float]


class ConflictCause(StrEnum):
    """Why two robots are not proven to keep clear of each other."""

    NEAR = "too near"
    """They come too near."""
    DEVIATION = "off the path"
    """What smoothing in time and the residual may take uses up what there is."""
    UNVERIFIED = "near a singular posture"
    """No bounds of the configurations were found."""
    STALLED = "within rounding"
    """Within rounding of the clearance."""
    EXHAUSTED = "budget used up"
    """The budget was used up."""
    EARLY = "handed over early"
    """One robot may take a part before the other one stands with it."""
    DROPPED = "dropped"
    """One robot may let go of a part that lies on nothing before the other one has it."""
    TORN = "torn"
    """One robot may drive off with a part before the other one has let go of it."""
    CARRIED = "not proven on what the other turns"
    """A robot that works on what the other one turns, on moves that both make together."""
    OWN_CELL = "not proven in its own cell"
    """A robot's way to a part that is handed over, or back from it, is not proven."""


@dataclass(frozen=True, slots=True)
class Conflict:
    """Where two robots are not proven to keep clear.

    Args:
        cause: why.
        moves: indices of the moves of the one and of the other.
        pair: names of the bodies.
        distance: m between them; None where it was not measured.
        times: s, from when until when the one and the other are there, on their own clocks; without
            end where one has always stood, or stands for ever.
        rows: the intervals of the one and of the other.
        why: more about it.
    """

    cause: ConflictCause
    moves: tuple[int, int]
    pair: tuple[str, str]
    distance: float | None
    times: tuple[OwnSpan, OwnSpan]
    rows: tuple[int, int]
    why: str = ""

    def time(self, side: int) -> float:
        """s, an own time of the one (0) or of the other there: the middle, or the end known."""
        low, high = self.times[side]
        if math.isinf(low):
            return 0.0 if math.isinf(high) else high
        return low if math.isinf(high) else 0.5 * (low + high)


@dataclass
class PairVerdict:
    """What was found of two robots.

    Args:
        clearance: m that is proven where there is no conflict.
        conflicts: by moves of the one and of the other.
        looks: how many bounds were made.
    """

    clearance: float
    conflicts: dict[tuple[int, int], Conflict] = field(default_factory=dict)
    looks: int = 0

    @property
    def proven(self) -> bool:
        """Whether nothing is left."""
        return not self.conflicts
