"""Where distances are linearised for the next outer iteration.

The distance of a point to a convex body is a convex function of its place: a tangent taken
anywhere cuts off only what is too near. About the motion itself tangents hold every node where it
is beside a corner, though sliding along either way would let it pass nearer; such motions are
stationary, but no optima. So tangents are also taken

- *ahead*: where nodes will be if they go on as they came;
- *beside*: where the motion is a little earlier or later.

What comes of it counts only if it is better and proven, wherever the tangents were taken.
"""

from __future__ import annotations

import numpy as np

from .....core.arrays import FloatArray
from ..motion.first_guess import Guess
from ..motion.motion import Motion
from ..task.task import MotionTask
from .surroundings import Instants

_FASTER, _FARTHEST = 1.5, 4.0
"""How far ahead, in steps of the last size."""
_PATTERNS = ((1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0))
_LITTLE = 10
"""Gains in a row that are too little, after which the search ends."""
_SIZES = (4.0, 2.0, 1.0, 0.35)
"""Intervals by which tangents are taken earlier or later at the motion's beginning and end."""

MOST_TRIALS = len(_PATTERNS) * len(_SIZES)
"""Ways to look beside a motion."""


class TangentChoice:
    """The choice of one search; it learns from what comes of it.

    Args:
        trials: ways to look beside the motion.

    Attributes:
        exhausted: whether tangents about the motion itself give nothing any more.
    """

    def __init__(self, trials: int) -> None:
        self._trials = trials
        self._begin()

    def settle(self) -> None:
        """From now on, about the motion itself alone: what can be had beside it is known."""
        self._trials = 0
        self._begin()

    def _begin(self) -> None:
        self._ahead = 0.0
        self._before: FloatArray | None = None
        self._beside = 0
        self._small = 0
        self.exhausted = False

    @property
    def at_base(self) -> bool:
        """Whether distances are linearised about the motion itself."""
        return self._ahead == 0.0 and self._beside == 0

    def gained(self, previous: FloatArray, little: bool) -> bool:
        """A better motion was found; whether too little is gained to go on.

        Args:
            previous: variables before.
            little: whether it is hardly better.
        """
        self._before, self.exhausted = previous, False
        self._small = self._small + 1 if little else 0
        if self._small >= _LITTLE:
            return True
        if little:
            self._ahead = 0.0
            return self._next_beside()
        if self._beside == 0:
            self._ahead = min(_FARTHEST, max(1.0, _FASTER * self._ahead))
        return False

    def missed(self) -> bool:
        """Nothing came of it; whether nothing is left to try."""
        if self._ahead > 0.0:
            self._ahead = 0.25 * self._ahead if self._ahead > 1.0 else 0.0
            return False
        return self._next_beside()

    def _next_beside(self) -> bool:
        """Look elsewhere beside the motion; whether nothing is left."""
        self._beside += 1
        return self._beside > self._trials

    def exhaust(self, touching: bool) -> None:
        """About the motion itself there is nothing to be had: look beside.

        Args:
            touching: whether any distance holds the motion back; else there is nothing to look for.
        """
        self.exhausted = True
        self._beside = 0 if touching else self._trials

    def configurations(self, task: MotionTask, base: Guess, places: Instants) -> FloatArray:
        """(M, N), where the distances at places are to be linearised."""
        motion = base.motion
        if self._ahead > 0.0 and self._before is not None:
            kept = 1 + base.layout.stretches
            x = base.x + self._ahead * (base.x - self._before)
            x[:kept] = base.x[:kept]
            return places.of(task, Motion.of(base.layout, base.scale, x))
        if self._beside == 0:
            return places.of(task, motion)
        size, pattern = divmod(self._beside - 1, len(_PATTERNS))
        first, last = _SIZES[size % len(_SIZES)] * np.array(_PATTERNS[pattern])
        share = places.time(motion) / motion.duration
        shift = (first + (last - first) * share) * motion.duration / len(motion)
        t = np.clip(places.time(motion) + shift, 0.0, motion.duration)
        return task.whole(motion.at(t))
