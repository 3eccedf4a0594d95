"""What links and motors do along a stamped path, a stretch of time at a time.

Averages look back over their window alone, and splines of leads forget values `_ASIDE` away. So a
stretch needs no more of the stamped motion than itself and a little to both sides, and a program
of any length no more memory than its samples and one stretch.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...robot.model import Robot
from ..timing.timing import Timing
from .elasticity import LEAD_STEP, RIGID, Elasticity, derivatives_of
from .ramps import stamped_motion
from .smoothing import Smoothing, States
from .trajectory import Leads, no_leads, sample_times

_STRETCH = 20.0
"""s that are looked at together."""
_ASIDE = 0.05
"""s: of a cubic spline's values, those n steps away count (2 − √3)ⁿ, here 3e-29."""


class Driven(NamedTuple):
    """What is driven at T times.

    Args:
        links: (T, N) each, positions, velocities and accelerations.
        lead: (T, N) each, by how much motors are ahead of them; None where they never are.
        sigma: (T,), the place on the path in the middle of what is averaged.
    """

    links: States
    lead: Leads | None
    sigma: FloatArray


def stretches(t: FloatArray) -> Iterator[slice]:
    """Which of increasing times (T,) are looked at together."""
    first = 0
    while first < len(t):
        last = max(int(np.searchsorted(t, t[first] + _STRETCH)), first + 1)
        yield slice(first, last)
        first = last


def driven(
    robot: Robot, elasticity: Elasticity, smoothing: Smoothing, timing: Timing, t: FloatArray
) -> Driven:
    """What is driven at increasing times t (T,) in s."""
    shape = len(t), timing.path.q.shape[1]
    q, dq, ddq, sigma = (*(np.empty(shape) for _ in range(3)), np.empty(len(t)))
    lead = None if elasticity == RIGID else no_leads(shape)
    for part in stretches(t):
        if smoothing.window == 0.0 and timing.ramp == 0.0 and lead is None:
            q[part], dq[part], ddq[part], sigma[part] = timing.driven_at(t[part])
            continue
        sigma[part] = timing.driven_at(np.clip(t[part] - timing.lag, 0.0, timing.duration))[3]
        begin, end = t[part][0] - _ASIDE, t[part][-1] + _ASIDE
        stamped = stamped_motion(timing, begin - smoothing.window, end)
        smooth = smoothing.command(stamped, t[part])
        q[part], dq[part], ddq[part] = smooth
        if lead is None:
            continue
        even = sample_times(0.0, timing.duration, LEAD_STEP, (begin, end))
        known = smoothing.command(stamped, even)
        ahead = derivatives_of(even, elasticity.leads(robot, *known), t[part])
        if any(elasticity.lag):
            jerk = derivatives_of(even, known[2], t[part])[1]
            q[part], dq[part], ddq[part] = elasticity.links(smooth, jerk)
        for k, links in enumerate((q, dq, ddq)):
            lead[k][part] = smooth[k] + ahead[k] - links[part]
    return Driven((q, dq, ddq), lead, sigma)
