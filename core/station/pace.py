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
    def slower(cls, spans: Sequence[tuple[FloatArray, FloatArray]]) -> ClockPace:
        """With spans that take longer.

        Args:
            spans: times (K,) s of its own, in their order, and s since the span began at which
                they pass.
        """
        own, clock = [np.zeros(1)], [np.zeros(1)]
        for times, passed in spans:
            own.append(times)
            clock.append(clock[-1][-1] + times[0] - own[-2][-1] + passed)
        return cls(np.concatenate(own), np.concatenate(clock))

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
