"""Stops that are closed in on, as a servo closes in on a place: ever more slowly.

Where a controller brakes by its limits until the very end, v² = 2 a r at the distance r. Logs show
that the last of it goes more slowly, v = r / τ, as a position controller has it that brakes by what
is left of the way: below a τ it is the way left that limits the speed. That alone would never
arrive; so

    ℓ̇² ≤ r (r + ρ) / τ²,

by which the last ρ are driven with an even ρ / 2 τ², nearly. It is a ceiling on ℓ̇².

RobotStudio's virtual controller shows it at stops of all speeds. From rest it accelerates by its
limits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray

APPROACH = -6
"""What stands for a row in `limits.PathLimits.binding` where the way left is the ceiling."""
NEAR = 1e-4
"""ρ: of ℓ, m on lines and arcs, rad on joint moves."""


class StopApproach(NamedTuple):
    """How the stops of a path are closed in on.

    Args:
        stop: (S,), their knots, rising; the last of the path is one.
        time: s, τ; zero for none.
    """

    stop: IntArray
    time: float = 0.0

    def lower(self, spacing: FloatArray, ceiling: FloatArray, binding: IntArray) -> None:
        """Lower ceilings (K + 1,) before stops, noting where that binds.

        Args:
            spacing: (K,) of the intervals.
            ceiling: lowered.
            binding: (K + 1, 3), becomes (`APPROACH`, `APPROACH`, knot of the stop).
        """
        if self.time <= 0.0:
            return
        left, stop = self._left(spacing)
        most = left * (left + NEAR) / self.time**2
        lower = np.flatnonzero((most < ceiling) & (left > 0.0))
        ceiling[lower] = most[lower]
        binding[lower, :2], binding[lower, 2] = APPROACH, stop[lower]

    def pull(
        self,
        spacing: FloatArray,
        binding: IntArray,
        ceiling_bar: FloatArray,
        spacing_bar: FloatArray,
    ) -> None:
        """Reverse of `lower`: adds to the last, (K,)."""
        if self.time <= 0.0:
            return
        bound = np.flatnonzero(binding[:, 1] == APPROACH)
        left, _ = self._left(spacing)
        asked = ceiling_bar[bound] * (2.0 * left[bound] + NEAR) / self.time**2
        steps = np.zeros(len(spacing) + 1)
        np.add.at(steps, bound, asked)
        np.subtract.at(steps, binding[bound, 2], asked)
        spacing_bar += np.cumsum(steps)[:-1]

    def _left(self, spacing: FloatArray) -> tuple[FloatArray, IntArray]:
        """(K + 1,) each, ℓ from each knot to the stop before which it is, and that one's knot."""
        covered = np.concatenate([[0.0], np.cumsum(spacing)])
        stop = self.stop[np.searchsorted(self.stop, np.arange(len(covered)))]
        return np.asarray(covered[stop] - covered), stop
