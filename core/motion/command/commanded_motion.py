"""What links and motors are commanded to do along a stamped path.

**Ramps.** Where a controller limits how fast accelerations change, they rise and fall over about
the same time T wherever limits are reached. That is a moving average of length T over the way λ
that has been covered along the path: λ̈ is then what it was on average over the last T seconds, at
most as great as before. It leaves the path alone, unlike a moving average over the joints
(`smoothing`). λ is the TCP's way, with a turn of the tool counted as `_TURNING` and one of the
joints as `_SWAYING`, so that it grows wherever anything moves. (An average of σ would pass limits
of speed where σ runs unevenly.)

**Stretches.** All is done a stretch of time at a time. Averages look back over their window alone,
and splines of leads forget values `_ASIDE` away. So a stretch needs no more of the stamped motion
than itself and a little to both sides, and a program of any length no more memory than its samples
and one stretch.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...robot.model import Robot
from ..model.elasticity import RIGID, Elasticity
from ..timing.timing import Timing
from .elasticity import LEAD_STEP, derivatives_of, leads, links_of
from .smoothing import JointMotion, Smoothing, States
from .trajectory import Leads, no_leads, sample_times

_STAMPED_STEP = 0.002
_FINE = 2.5e-4
"""s between places from which averages are made."""
_STEP = 1e-3
"""s between the knots of a ramped motion."""
_TURNING, _SWAYING = 0.1, 0.01
"""m that a turn of the tool, and one of the joints, by one rad counts."""
_STRETCH = 20.0
"""s that are looked at together."""
_ASIDE = 0.05
"""s: of a cubic spline's values, those n steps away count (2 − √3)ⁿ, here 3e-29."""


class CommandedMotion(NamedTuple):
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


def commanded_motion(
    robot: Robot, elasticity: Elasticity, smoothing: Smoothing, timing: Timing, t: FloatArray
) -> CommandedMotion:
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
        ahead = derivatives_of(even, leads(elasticity, robot, *known), t[part])
        if any(elasticity.lag):
            jerk = derivatives_of(even, known[2], t[part])[1]
            q[part], dq[part], ddq[part] = links_of(elasticity, smooth, jerk)
        for k, links in enumerate((q, dq, ddq)):
            lead[k][part] = smooth[k] + ahead[k] - links[part]
    return CommandedMotion((q, dq, ddq), lead, sigma)


def stamped_motion(timing: Timing, begin: float = -np.inf, end: float = np.inf) -> JointMotion:
    """The stamped motion, ramped where the model says so.

    Knots are fine enough that cubics in time between them stand for it.

    Args:
        timing: of the path.
        begin, end: s, what is wanted of it.
    """
    if timing.ramp > 0.0:
        return ramped(timing, begin, end)
    even = sample_times(0.0, timing.duration, _STAMPED_STEP, (begin, end))
    edges = timing.start.driven(np.concatenate([timing.begin, timing.end]))
    edges = edges[(even[0] <= edges) & (edges <= even[-1])]
    t = np.unique(np.concatenate([even, edges]))
    q, dq, _, _ = timing.driven_at(t)
    return JointMotion(t, q, dq)


def ramped(timing: Timing, begin: float = -np.inf, end: float = np.inf) -> JointMotion:
    """The motion that is at time t where the stamped one is on average over the last T seconds."""
    # Velocities are differences: of knots at the ends, to one side.
    begin, end = begin - 2.0 * _STEP, end + 2.0 * _STEP
    t = sample_times(0.0, timing.duration, _STEP, (begin, end))
    fine = sample_times(0.0, timing.duration, _FINE, (t[0] - timing.ramp, t[-1]))
    place = _way(timing, np.maximum.accumulate(timing.driven_at(fine)[3]))
    average = _averaged(fine, place, timing.ramp, t)
    # Where the path rests, any time at that place will do.
    moving = np.concatenate([[True], np.diff(place) > 0.0])
    at = np.interp(average, place[moving], fine[moving])
    q = timing.driven_at(at)[0]
    dq = np.gradient(q, t, axis=0)
    dq[(t <= 0.0) | (t >= timing.duration)] = 0.0
    return JointMotion(t, q, dq)


def way_slopes(timing: Timing) -> FloatArray:
    """(S,), dλ/dσ at the samples of a path."""
    states = timing.along.states
    squares = np.sum(states.v[:, :3] ** 2, axis=1) + np.sum((_SWAYING * states.dq) ** 2, axis=1)
    squares += np.sum((_TURNING * states.v[:, 3:]) ** 2, axis=1)
    return np.asarray(np.sqrt(squares) * timing.along.rate)


def _way(timing: Timing, sigma: FloatArray) -> FloatArray:
    """λ (T,) at places σ (T,) on the path; its slope is linear between samples."""
    path, slope = timing.path, way_slopes(timing)
    left = path.pieces.interval_samples
    begin, step = path.sigma[left], path.sigma[left + 1] - path.sigma[left]
    first, last = slope[left], slope[left + 1]
    before = np.concatenate([[0.0], np.cumsum(0.5 * step * (first + last))[:-1]])
    k = np.clip(np.searchsorted(begin, sigma, side="right") - 1, 0, None)
    share = np.clip((sigma - begin[k]) / step[k], 0.0, 1.0)
    return np.asarray(before[k] + step[k] * share * (first[k] + 0.5 * share * (last - first)[k]))


def _averaged(fine: FloatArray, place: FloatArray, window: float, t: FloatArray) -> FloatArray:
    """Mean of a place over the last ``window`` s, at times t; it rests before and after."""
    steps = 0.5 * np.diff(fine) * (place[1:] + place[:-1])
    area = np.concatenate([[0.0], np.cumsum(steps)])
    before = place[0] * np.minimum(t - window - fine[0], 0.0)
    whole = np.interp(t, fine, area) - np.interp(t - window, fine, area) - before
    return np.asarray(np.clip(whole / window, place[0], place[-1]))
