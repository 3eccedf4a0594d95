"""What links and motors are commanded to do along a stamped path.

All is done a stretch of time at a time. Averages look back over their window alone, splines of
leads forget values `_ASIDE` away, and what friction remembers is carried on. So a stretch needs no
more of the stamped motion than itself and a little to both sides, and a program of any length no
more memory than its samples and one stretch.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...robot.model import Robot
from ..model.elasticity import RIGID
from ..model.motion_model import MotionModel
from ..timing.timing import Timing
from .elasticity import lead_states_at, lead_step, links_of
from .ramp import ramped
from .servo import FrictionMemory, drag_at, drag_reach
from .smoothing import STEP, JointMotion, Smoothing, States, even_times, knot_step
from .trajectory import Leads, no_leads, sample_times

_STRETCH = 30.0
"""s that are looked at together."""
_ASIDE = 20
"""Steps: of a cubic spline's values, those n steps away count (2 − √3)ⁿ, here 4e-12."""


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
    robot: Robot, model: MotionModel, smoothing: Smoothing, timing: Timing, t: FloatArray
) -> CommandedMotion:
    """What is driven at increasing times t (T,) in s."""
    shape = len(t), timing.path.q.shape[1]
    q, dq, ddq, sigma = (*(np.empty(shape) for _ in range(3)), np.empty(len(t)))
    elasticity = model.elasticity
    lead = None if elasticity == RIGID else no_leads(shape)
    servo = model.servo
    friction = FrictionMemory(servo, smoothing, shape[1]) if any(servo.friction) else None
    needs_jerk = any(elasticity.lag)
    step = lead_step(smoothing.window + timing.ramp)
    last = max(timing.duration, float(t[-1]))
    for part in stretches(t):
        sigma[part] = timing.place_at(np.clip(t[part] - timing.lag, 0.0, timing.duration))
        if smoothing.window == 0.0 and timing.ramp == 0.0 and lead is None and servo.still:
            timing.driven_at(t[part], (q[part], dq[part], ddq[part]))
            continue
        begin, end = t[part][0] - _ASIDE * step, t[part][-1] + _ASIDE * step
        first = min(begin, t[part][0] - drag_reach(servo))
        if friction is not None:
            first = min(first, friction.known_to)
        # What `lead_states_at` averages may begin two steps before.
        stamped = stamped_motion(timing, first - smoothing.window - 2 * step, end)
        smooth = (q[part], dq[part], ddq[part])
        if needs_jerk:
            smooth = np.empty_like(q[part]), np.empty_like(q[part]), np.empty_like(q[part])
        left = 0
        if lead is not None or needs_jerk:
            even = even_times(max(begin, 0.0), min(end, last), step)
            known = smoothing.command(stamped, even)
            left = _taken_over(even, known, t[part], smooth)
        if left < len(smooth[0]):
            rest = (smooth[0][left:], smooth[1][left:], smooth[2][left:])
            smoothing.command(stamped, t[part][left:], rest)
        offs = [] if friction is None else [friction.over(stamped, t[part], smooth)]
        if any(servo.drag):
            offs.append(drag_at(servo, smoothing, stamped, t[part]))
        if needs_jerk:
            jerk = JointMotion.through(even, known[2]).at(t[part])[1]
            q[part], dq[part], ddq[part] = links_of(elasticity, smooth, jerk)
        if lead is not None:
            led = lead_states_at(elasticity, robot, smoothing, stamped, even, known, t[part])
            for made, of in zip(lead, led, strict=True):
                made[part] = of
        for off in offs:
            for links, by in zip((q, dq, ddq), off, strict=True):
                links[part] += by
    return CommandedMotion((q, dq, ddq), lead, sigma)


def _taken_over(even: FloatArray, known: States, t: FloatArray, out: States) -> int:
    """Take what is known at even times for the first of the times t that are the same: how many."""
    first = int(np.searchsorted(even, t[0]))
    beside = even[first : first + len(t)]
    others = np.flatnonzero(beside != t[: len(beside)])
    count = int(others[0]) if len(others) else len(beside)
    for target, source in zip(out, known, strict=True):
        target[:count] = source[first : first + count]
    return count


def stamped_motion(timing: Timing, begin: float = -np.inf, end: float = np.inf) -> JointMotion:
    """The stamped motion, ramped where the model says so.

    Knots are fine enough that cubics in time between them stand for it.

    Args:
        timing: of the path.
        begin, end: s, what is wanted of it.
    """
    if timing.ramp > 0.0:
        step = knot_step(timing.ramp)
        t = even_times(max(begin, 0.0), min(end, timing.duration), step)
        made = ramped(timing.intervals, timing.along.states, timing.start, timing.ramp, t)
        return JointMotion(t, *made, step)
    even = sample_times(0.0, timing.duration, STEP, (begin, end))
    first, last = np.searchsorted(timing.begin, timing.start.stamped(even[[0, -1]])[0], "right")
    near = slice(max(int(first) - 2, 0), int(last) + 1)
    edges = timing.start.driven(np.concatenate([timing.begin[near], timing.end[near]]))
    edges = edges[(even[0] <= edges) & (edges <= even[-1])]
    t = np.unique(np.concatenate([even, edges]))
    q, dq, _ = timing.driven_at(t)
    return JointMotion(t, q, dq)
