"""Zones, and stretches of zones, that take a controller at least a while.

A controller that works a path out once a period puts at least one point on each stretch between
the edges of a zone: none is passed in less than that time T. A zone of the TCP is such a stretch.
Where the tool begins to turn before it, and goes on behind it, what is left of that wider zone on
either side is one too, unless the tool turns on evenly there, so that nothing is blended.

A stretch of the length L on ℓ is passed at ℓ̇ ≤ L / T, so that it takes T or longer, whatever the
speed does in it. That is a ceiling on ℓ̇².

Short legs with small zones show it: an IRB 6640 in RobotStudio passes zones of 1 mm on a straight
line at 0.5 m/s whatever speed is programmed, and zones of 10 mm at 2 m/s, or, where the tool turns
otherwise from there on, at 1.25 m/s, as the turn begins 5 mm before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ..geometry.corners import POSITION, STOP, TURNING
from ..geometry.layout import Layout
from ..geometry.pieces import Pieces
from ..path.tcp_samples import States

LEAST_TIME = -4
"""What stands for a row in `limits.PathLimits.binding` where a stretch's time is the ceiling."""
_EVENLY = 0.1
"""Share of the greater rate of turn by which those of both legs may differ where the tool turns on
evenly (assumed: logs have 0 and 0.5)."""
_STEADY = 1e-3
"""rad per unit of ℓ by which they may in any case: rounding of programmed orientations."""


class ZoneStretches(NamedTuple):
    """Stretches that take at least a while.

    Args:
        first, last: (Z,), knots at their ends; they overlap at these at most.
        least: s.
    """

    first: IntArray
    last: IntArray
    least: float = 0.0

    @classmethod
    def of(cls, layout: Layout, pieces: Pieces, states: States, least: float) -> ZoneStretches:
        """Those of a path.

        Args:
            layout, pieces: of the path.
            states: (S,) samples.
            least: s that each takes; zero for none.
        """
        if least <= 0.0:
            return cls(np.zeros(0, np.int64), np.zeros(0, np.int64))
        own = layout.extent[:, POSITION]
        corners = np.flatnonzero((layout.corners.kind != STOP) & (own > 0.0).all(axis=1))
        if not len(corners):
            return cls(np.zeros(0, np.int64), np.zeros(0, np.int64))
        at, knots = layout.waypoint[corners + 1], pieces.first_interval
        first, _, last = pieces.around(at, own[corners]).T
        begin, _, end = pieces.around(at, layout.extent[corners, TURNING]).T
        begin, end = np.minimum(begin, first), np.maximum(end, last)
        bent = _bent(states, pieces.first_sample[begin], pieces.first_sample[end + 1] - 1)
        before, behind = bent & (begin < first), bent & (end > last)
        return cls(
            knots[np.concatenate([first, begin[before], last[behind] + 1])],
            knots[np.concatenate([last + 1, first[before], end[behind] + 1])],
            least,
        )

    def lower(self, spacing: FloatArray, ceiling: FloatArray, binding: IntArray) -> None:
        """Lower ceilings (K + 1,) where stretches would take less, noting where that binds.

        Args:
            spacing: (K,) of the intervals.
            ceiling: lowered.
            binding: (K + 1, 3), becomes (`LEAST_TIME`, `LEAST_TIME`, index of the stretch).
        """
        if not len(self.first):
            return
        most = (self._lengths(spacing) / self.least) ** 2
        count = self.last - self.first
        stretch = np.repeat(np.arange(len(count)), count)
        inside = np.arange(len(stretch)) + np.repeat(self.first - np.cumsum(count) + count, count)
        # Of two stretches that meet at a knot, one begins there and the other ends.
        for knot, owner in ((inside, stretch), (self.last, np.arange(len(count)))):
            lower = most[owner] < ceiling[knot]
            knot, owner = knot[lower], owner[lower]
            ceiling[knot] = most[owner]
            binding[knot, :2], binding[knot, 2] = LEAST_TIME, owner

    def pull(
        self,
        spacing: FloatArray,
        binding: IntArray,
        ceiling_bar: FloatArray,
        spacing_bar: FloatArray,
    ) -> None:
        """Reverse of `lower`: adds to the last, (K,)."""
        if not len(self.first):
            return
        bound = binding[:, 1] == LEAST_TIME
        asked = np.zeros(len(self.first))
        np.add.at(asked, binding[bound, 2], ceiling_bar[bound])
        asked *= 2.0 * self._lengths(spacing) / self.least**2
        steps = np.zeros(len(spacing) + 1)
        np.add.at(steps, self.first, asked)
        np.subtract.at(steps, self.last, asked)
        spacing_bar += np.cumsum(steps)[:-1]

    def _lengths(self, spacing: FloatArray) -> FloatArray:
        """(Z,), ℓ of each."""
        covered = np.concatenate([[0.0], np.cumsum(spacing)])
        return np.asarray(covered[self.last] - covered[self.first])


def _bent(states: States, entry: IntArray, leave: IntArray) -> BoolArray:
    """(Z,), whether the tool turns otherwise behind zones with these samples than before them."""
    before, behind = states.v[entry, 3:], states.v[leave, 3:]
    rate = np.maximum(np.linalg.norm(before, axis=1), np.linalg.norm(behind, axis=1))
    return np.asarray(np.linalg.norm(behind - before, axis=1) > np.maximum(_EVENLY * rate, _STEADY))
