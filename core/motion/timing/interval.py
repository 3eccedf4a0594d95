"""What is driven within one interval of a stamped path.

Between samples x = (dℓ/dt)² is linear in ℓ: ℓ̈ is constant, and ℓ a parabola in time.
"""

from __future__ import annotations

from typing import NamedTuple

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner


class Intervals(NamedTuple):
    """K intervals of a stamped path.

    Args:
        begin, end: (K,) s, when each is entered and left, waits included.
        sample: (K,), the sample at the left of each.
        spacing: (K,), ℓ of each.
        x: (K + 1,), (dℓ/dt)² at their ends.
    """

    begin: FloatArray
    end: FloatArray
    sample: IntArray
    spacing: FloatArray
    x: FloatArray

    def rows(self, first: int, last: int) -> Intervals:
        """A view of some of them."""
        own = slice(first, last)
        x = self.x[first : last + 1]
        return Intervals(self.begin[own], self.end[own], self.sample[own], self.spacing[own], x)


@inner
def progress(intervals: Intervals, k: int, t: float) -> tuple[float, float]:
    """The share of interval k that is behind at time t in s, 0 to 1, and dℓ/dt there.

    Before and after, what holds at the nearer end.
    """
    begin, end, spacing = intervals.begin[k], intervals.end[k], intervals.spacing[k]
    x0, x1 = intervals.x[k], intervals.x[k + 1]
    change = (x1 - x0) / (2 * spacing)
    tau = min(max(t - begin, 0.0), end - begin)
    # From the nearer end, so that arrival at a stop is exact.
    if 2 * tau <= end - begin:
        start = x0**0.5
        step = tau * (start + 0.5 * change * tau)
        return min(max(step / spacing, 0.0), 1.0), start + change * tau
    left = end - begin - tau
    arrival = x1**0.5
    step = spacing - left * (arrival - 0.5 * change * left)
    return min(max(step / spacing, 0.0), 1.0), x0**0.5 + change * tau


@inner
def sigma_at(sigma: FloatArray, rate: FloatArray, s: int, length: float, z: float) -> float:
    """σ at a share z behind sample s: the cubic with slopes dσ/dℓ = 1 / rate at both samples."""
    rise = sigma[s + 1] - sigma[s]
    lead, tail = length / rate[s] - rise, rise - length / rate[s + 1]
    place: float = sigma[s] + z * (rise + (1 - z) * ((1 - z) * lead + z * tail))
    return place
