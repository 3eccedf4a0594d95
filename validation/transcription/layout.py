"""Where each quantity of the transcription stands in the vector of variables.

M legs join M + 1 points: start, V = M − 1 via points, end. The motion is cut into 2 M − 1 segments,
lines and blends in turn; segment 2k is the line on leg k, segment 2k + 1 the blend at point k + 1.
Each segment of duration t has nodes at fixed shares τ of t.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.errors import InputError


@dataclass(frozen=True)
class Grid:
    """Intervals of time on each segment.

    Args:
        line: on each line.
        blend: on each blend.
    """

    line: int = 6
    blend: int = 12

    def __post_init__(self) -> None:
        for name in ("line", "blend"):
            if getattr(self, name) < 2:
                raise InputError(
                    f"a transcription needs 2 intervals or more on every {name}, "
                    f"not {getattr(self, name)}"
                )


class Layout:
    """Indices of the variables.

    Args:
        legs: M ≥ 2.
        joints: n, the number of joints that move.
        grid: of every segment.

    Attributes:
        time: (2 M − 1,) durations t of the segments.
        points: (M + 1, n) joint values q of start, via points and end.
        length: (M,) ℓ of each leg.
        cut: (M, 2) what zones cut off a leg: r_B of the zone behind, r_A of the one ahead.
        radius: (V,) r of the TCP's sphere at each via point.
        tcp: (M + 1, 3) TCP at the points.
        edge: (V, 2, 3) TCP at a zone's entry and exit.
        tau: per segment, (intervals + 1,) times of the nodes from 0 to 1.
        s, rate, push: per segment, (intervals + 1,) path parameter, w = ṡ t and z = s̈ t.
        size: of the vector.
    """

    def __init__(self, legs: int, joints: int, grid: Grid) -> None:
        self.legs, self.joints, self.grid = legs, joints, grid
        self.vias = legs - 1
        self.segments = 2 * legs - 1
        self.size = 0
        self.time = self._take(self.segments)
        self.points = self._take(legs + 1, joints)
        self.length = self._take(legs)
        self.cut = self._take(legs, 2)
        self.radius = self._take(self.vias)
        self.tcp = self._take(legs + 1, 3)
        self.edge = self._take(self.vias, 2, 3)
        self.tau = [_times(grid, k) for k in range(self.segments)]
        counts = [self.intervals(k) for k in range(self.segments)]
        self.s = [self._take(count + 1) for count in counts]
        self.rate = [self._take(count + 1) for count in counts]
        self.push = [self._take(count + 1) for count in counts]

    def intervals(self, segment: int) -> int:
        """Intervals of time on a segment."""
        return self.grid.blend if segment % 2 else self.grid.line

    def _take(self, *shape: int) -> IntArray:
        first = self.size
        self.size += int(np.prod(shape))
        return np.arange(first, self.size).reshape(shape)


def _times(grid: Grid, segment: int) -> FloatArray:
    """Even on lines. On blends denser towards both ends, where q″ rises and falls within a short
    time: half even, half as the cosine has it."""
    if segment % 2 == 0:
        return np.linspace(0.0, 1.0, grid.line + 1)
    even = np.linspace(0.0, 1.0, grid.blend + 1)
    return np.asarray(0.5 * even + 0.25 * (1.0 - np.cos(np.pi * even)))
