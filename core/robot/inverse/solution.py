"""What inverse kinematics find: configurations and their branches, or why there is none."""

from __future__ import annotations

from dataclasses import dataclass

from ...arrays import FloatArray
from ...errors import FaultCause, MotionError


class UnreachableError(MotionError):
    """A pose that the arm cannot take.

    Args:
        message: by how much it is missed, and what to do.
        distance: m by which the wrist is out of reach; 0 if only limits are in the way.
        tilted: whether a joint that has no motor would have to turn.
    """

    def __init__(self, message: str, distance: float = 0.0, tilted: bool = False) -> None:
        limited = distance == 0.0 and not tilted
        super().__init__(message, cause=FaultCause.LIMIT if limited else FaultCause.REACH)
        self.distance = distance


@dataclass(frozen=True, slots=True)
class Branch:
    """Which of the up to eight solutions of a six-axis arm.

    Args:
        shoulder: whether the wrist's centre lies behind axis 1, that is, on the side of -x when
            axis 2 points along y and axis 1 along z.
        elbow: whether the forearm (from axis 3 to the wrist's centre, or to axis 4 if that is
            parallel) turns against axis 2 from the upper arm's direction.
        wrist: whether axis 6 is turned against axis 5 from axis 4 (axis 2 if axes 2, 3 and 4
            are parallel), the shorter way.
    """

    shoulder: bool
    elbow: bool
    wrist: bool


@dataclass(frozen=True, slots=True, eq=False)
class InverseSolution:
    """A configuration of the arm.

    Args:
        q: (n,) rad or m, within the limits; of equivalent turns the one nearest to zero.
        branch: None if it was found numerically.
        singular: which of ``"shoulder"``, ``"elbow"``, ``"wrist"`` are singular. There other
            solutions lie infinitely near; q is one of them.
    """

    q: FloatArray
    branch: Branch | None
    singular: frozenset[str]


@dataclass(frozen=True, slots=True)
class Candidate:
    """A solution before limits are looked at; a ``doubtful`` one may equal another."""

    q: FloatArray
    branch: Branch | None
    singular: frozenset[str]
    doubtful: bool
