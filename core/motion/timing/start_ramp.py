"""How a program's time comes up to speed when it starts.

A controller that scales speeds by letting time run slower (an override) lets it run up from
standstill: for T seconds from where the motion begins the rate of its time rises linearly from zero
to one. The path stays as it is, and so does all that comes later, T/2 later. Where q is stamped,

    q(s(t)),    s = t²/(2T) for t ≤ T, else t − T/2;    q̇ = ṡ q',    q̈ = ṡ² q'' + q'/T.

A joint whose stamped acceleration is at most a from rest on has q' ≤ a s and so accelerates by at
most a (t/T)² (1 + 1/2): not more than 3/2 a.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.lean import inner


@dataclass(frozen=True)
class StartRamp:
    """Time that comes up to speed.

    Args:
        length: T, s; zero where it runs at once.
        begin: s, when it begins to.
    """

    length: float = 0.0
    begin: float = 0.0

    @property
    def delay(self) -> float:
        """By how much later all is in the end, s."""
        return 0.5 * self.length

    def begun_at(self, begin: float) -> StartRamp:
        """The same, beginning at another time."""
        return self if self.length == 0.0 else replace(self, begin=begin)

    def stamped(self, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The stamped time (K,) at times t (K,), its rate and how fast (1/s) that grows."""
        since = np.maximum(t - self.begin, 0.0)
        if self.length == 0.0:
            return t, np.ones_like(t), np.zeros_like(t)
        rising = since < self.length
        risen = np.where(rising, since**2 / (2 * self.length), since - self.delay)
        rate = np.where(rising, since / self.length, 1.0)
        growth = np.where(rising & (since > 0.0), 1.0 / self.length, 0.0)
        return np.minimum(t, self.begin) + risen, rate, growth

    def driven(self, stamped: FloatArray) -> FloatArray:
        """When (K,) it is that stamped times (K,) are reached."""
        since = np.maximum(stamped - self.begin, 0.0)
        rising = np.sqrt(2 * self.length * since)
        risen = np.where(rising < self.length, rising, since + self.delay)
        return np.asarray(np.minimum(stamped, self.begin) + risen)


SUDDEN = StartRamp()


@inner
def stamped_time(t: float, begin: float, length: float) -> float:
    """The stamped time at a time, of a start of a length that begins at some time; all in s."""
    since = t - begin
    if since <= 0.0:
        return t
    return begin + (since * since / (2.0 * length) if since < length else since - 0.5 * length)
