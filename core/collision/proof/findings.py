"""What a subdivision finds, and how much it may do."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum, auto

from ...arrays import FloatArray


class FailureCause(Enum):
    """Why a stretch is not proven."""

    NEAR = auto()
    """A configuration on it is too near."""
    DEVIATION = auto()
    """Smoothing in time and the model's residual take up what there is."""
    UNVERIFIED = auto()
    """No enclosure of the configurations was found."""
    STALLED = auto()
    """Within rounding of the distance wanted."""
    EXHAUSTED = auto()
    """The budget was used up."""
    TORN = auto()
    """The path's joints jump there."""


@dataclass(frozen=True)
class UnprovenStretch:
    """A stretch that is not proven.

    Args:
        cause: why.
        piece: index of the path's piece.
        begin, end: of the stretch, σ.
        sigma: σ of the configuration.
        q: (N,), a configuration on it.
        pair: row of the scene's pairs; None if no pair is to blame.
        distance: m between the pair there; None if it was not measured.
        conditioning: of the Jacobian there.
    """

    cause: FailureCause
    piece: int
    begin: float
    end: float
    sigma: float
    q: FloatArray
    pair: int | None
    distance: float | None
    conditioning: float


@dataclass
class NearestPair:
    """Where the least was met so far, and which pair.

    Args:
        kept: m, the distance less what smoothing in time and the residual may take of it.
        distance: m.
        sigma, piece, q: where.
        pair: row of the scene's pairs.
    """

    kept: float = math.inf
    distance: float = math.inf
    sigma: float = math.nan
    piece: int = -1
    pair: int = -1
    q: FloatArray | None = None


@dataclass
class Budget:
    """How many distances may still be measured, and enclosures made."""

    left: int
    used: int = 0

    def take(self, count: int) -> None:
        """Use some of it."""
        self.left -= count
        self.used += count
