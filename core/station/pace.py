"""How a robot's own time runs on the station's clock where others set its pace."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray


@dataclass(frozen=True)
class ClockPace:
    """Stretches of a robot's own time that take longer.

    Args:
        own: (K,) s, times of its own at which the pace changes, from 0 on, rising.
        clock: (K,) s, the same as they pass, waits left out.
    """

    own: FloatArray
    clock: FloatArray

    @classmethod
    def steady(cls) -> ClockPace:
        """As driven."""
        return cls(np.zeros(1), np.zeros(1))

    @classmethod
    def slower(cls, spans: Sequence[tuple[float, float, float]]) -> ClockPace:
        """With spans that take longer.

        Args:
            spans: begin and end, s of its own, in their order, and how long each takes.
        """
        own, clock = [0.0], [0.0]
        for begin, end, length in spans:
            own += [begin, end]
            clock += [clock[-1] + begin - own[-3]]
            clock += [clock[-1] + max(length, end - begin)]
        return cls(np.array(own), np.array(clock))

    def passed(self, own: FloatArray) -> FloatArray:
        """s on the clock at times of its own; beyond all changes it is as driven."""
        return _mapped(own, self.own, self.clock)

    def at(self, own: float) -> float:
        """The same of one time."""
        return float(self.passed(np.array([own]))[0])

    def own_at(self, clock: FloatArray) -> FloatArray:
        """s of its own at times on the clock."""
        return _mapped(clock, self.clock, self.own)


def _mapped(t: FloatArray, known: FloatArray, other: FloatArray) -> FloatArray:
    inside = np.interp(t, known, other)
    before, behind = np.minimum(t - known[0], 0.0), np.maximum(t - known[-1], 0.0)
    # What is infinite stays so.
    return np.asarray(inside + before + behind)
