"""The zones at the inner waypoints of a path: where each is blended and how far it reaches."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...errors import Note
from .reach import Reach

STOP, TCP_CORNER, JOINT_CORNER = 0, 1, 2
POSITION, TURNING, PRESCRIBED = 0, 1, 2


@dataclass(frozen=True, slots=True)
class Room:
    """How much larger the zones at a place could be before the vendor's rules cut them.

    Args:
        left: in m, or as a share of a segment; below zero where a rule cuts.
        corner: index of the corner.
    """

    left: Reach
    corner: int


@dataclass(frozen=True)
class TimedBlend:
    """How a corner is blended in time; see `timed_blends`.

    Args:
        duration: T in s.
        rates: by how many times its extent in the zone each leg would go on in T, at its edge.
        bends: by how many times that rate changes in T.
    """

    duration: Reach
    rates: tuple[Reach, Reach]
    bends: tuple[Reach, Reach]

    @property
    def parts(self) -> tuple[Reach, ...]:
        """Rates, then bends."""
        return *self.rates, *self.bends


@dataclass
class Corners:
    """The zones at the M − 1 inner waypoints of M segments.

    Args:
        kind: (M − 1,) `STOP`, `TCP_CORNER` or `JOINT_CORNER`.
        reach: (M − 1, 3, 2) of position, turning and prescribed axes; into the segment before
            and the one after the waypoint.
        sources: the same with derivatives.
        kept: what share of its radius a blend that was made smaller keeps, by corner; see
            `smaller_blends`.
        overlapping: corners to be left out under `Overlap.SKIP`, because their zones overlap.
        notes: zones cut short and refused.
        timed: corners of joint moves that are blended in time, by corner.
    """

    kind: NDArray[np.int64]
    reach: FloatArray
    sources: list[tuple[tuple[Reach, Reach], ...]]
    kept: dict[int, Reach] = field(default_factory=dict)
    overlapping: tuple[int, ...] = ()
    notes: list[Note] = field(default_factory=list)
    timed: dict[int, TimedBlend] = field(default_factory=dict)


@dataclass
class ZoneGradient:
    """Gradient with respect to the radii and shares of the zones, by corner."""

    tcp: FloatArray
    reorientation: FloatArray
    external: FloatArray
    angle: FloatArray

    @classmethod
    def zeros(cls, count: int) -> ZoneGradient:
        """A gradient to add to."""
        return cls(*np.zeros((4, count)))
