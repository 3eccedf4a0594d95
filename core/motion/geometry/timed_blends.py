"""Blends of two joint moves that are planned in time: quintics that meet both legs' motion.

Each leg is planned from rest to rest, by a trapezoid of its leading joint, the one that goes
furthest: at programmed speed v and acceleration A. Where it is at the zone's edge, x of the leading
joint from the waypoint, it has the speed min(v, √(2 A x)), or less where the leg is short. Between
the edges each joint is the quintic in time that meets position, speed and acceleration of both
legs. It takes the time T in which the slowest joint could come from the one to the other with
k A and v, by accelerating and braking alone:

    p² = k A d + (w₀² + w₁²) / 2,    T = (2 p − w₀ − w₁) / (k A)    or, where p > v,
    T = (2 v − w₀ − w₁) / (k A) + (d − (v² − (w₀² + w₁²) / 2) / (k A)) / v

for a joint that goes by d from the speed w₀ to w₁, counted in the direction that it has to
accelerate in first. Of two legs, A is the lower and v the higher one (assumed: those of the logs
were the same).

Of a UR10e in URSim, k = 1.2 gives 1.8143, 1.0226 and 1.0250 s in three corners, in which logs show
1.8142, 1.0227 and 1.0250 s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from .corners import TimedBlend
from .reach import Reach, least
from .segments import JOINT_SEGMENT, Segments

_NOTHING = 1e-9
"""rad of a zone, below which there is nothing to blend."""


_AT_REST = 0.05
"""Rate at a zone's edge below which the leg is as good as at rest there: it is all zone, and the
blend would begin or end with a stop (none of the logs has one)."""


@dataclass(frozen=True)
class _Leg:
    """A leg at its zone's edge: x and speed of its leading joint in rad and rad/s, its acceleration
    in rad/s², and (N,) what share of it each joint does."""

    segment: int
    lead: Reach
    way: Reach
    speed: Reach
    acceleration: Reach
    share: FloatArray


def timed_blend(
    segments: Segments, i: int, reaches: tuple[Reach, Reach], factor: float
) -> TimedBlend | None:
    """How the corner between segments i and i + 1 is blended in time.

    Args:
        segments: of the path.
        i: the corner.
        reaches: shares of both segments that the blend takes.
        factor: k.

    Returns:
        None where a leg is none of joints, or has no programmed speed or acceleration, or a
        programmed time (no log shows how these are blended), and where the zone takes nothing of
        one or all of it.
    """
    ends, both = segments.ends, slice(i, i + 2)
    stated = np.isfinite(ends.joint_speed[both]) & np.isfinite(ends.joint_acceleration[both])
    stated &= np.isinf(ends.duration[both])
    if (ends.kind[both] != JOINT_SEGMENT).any() or not stated.all():
        return None
    ways = [np.abs(segments.delta_q[i + k]).max() * reach.value for k, reach in enumerate(reaches)]
    if min(ways) <= _NOTHING:
        return None
    legs = _leg(segments, i, reaches[0], -1.0), _leg(segments, i + 1, reaches[1], 1.0)
    slower = min((i, i + 1), key=lambda k: float(ends.joint_acceleration[k]))
    faster = max((i, i + 1), key=lambda k: float(ends.joint_speed[k]))
    A = Reach(factor * ends.joint_acceleration[slower], (("joint_acceleration", slower, factor),))
    v = Reach(float(ends.joint_speed[faster]), (("joint_speed", faster, 1.0),))
    T = _duration(segments, legs, A, v)
    rates = tuple(T * leg.speed * leg.way.inverse() for leg in legs)
    if min(rate.value for rate in rates) < _AT_REST:
        return None
    bends = tuple(T * T * leg.acceleration * leg.way.inverse() for leg in legs)
    return TimedBlend(T, (rates[0], rates[1]), (bends[0], bends[1]))


def _leg(segments: Segments, k: int, reach: Reach, onwards: float) -> _Leg:
    """Segment k at its zone's edge; ``onwards`` +1 where it comes from its waypoint, −1 where it
    goes there."""
    ends, step = segments.ends, segments.delta_q[k]
    j = int(np.argmax(np.abs(step)))
    lead = _step(segments, k, j).scaled(math.copysign(1.0, step[j]))
    A = Reach(float(ends.joint_acceleration[k]), (("joint_acceleration", k, 1.0),))
    v = float(ends.joint_speed[k])
    cruising = Reach(v**2, (("joint_speed", k, 2.0 * v),))
    way = reach * lead
    near = A.scaled(2.0) * way
    far = A.scaled(2.0) * (lead + way.scaled(-1.0))
    square = least(cruising, near, far)
    acceleration = Reach(0.0)
    if square is not cruising:
        acceleration = A.scaled(onwards if square is near else -onwards)
    return _Leg(k, lead, way, square.root(), acceleration, step / lead.value)


def _step(segments: Segments, k: int, j: int) -> Reach:
    """How far joint j goes on segment k, rad."""
    axis = np.zeros(segments.delta_q.shape[1])
    axis[j] = 1.0
    return Reach(float(segments.delta_q[k, j]), (("q1", k, axis), ("q0", k, -axis)))


def _duration(segments: Segments, legs: tuple[_Leg, _Leg], A: Reach, v: Reach) -> Reach:
    """T, of the joint that needs it."""
    way = sum(leg.way.value * leg.share for leg in legs)
    w = np.stack([leg.speed.value * leg.share for leg in legs])
    sign = np.where(way >= 0.5 * w.sum(0) * np.abs(w[1] - w[0]) / A.value, 1.0, -1.0)
    forward, w = sign * way, sign * w
    half = 0.5 * (w**2).sum(0)
    peak = np.sqrt(np.maximum(A.value * forward + half, 0.0))
    time = (2 * np.minimum(peak, v.value) - w.sum(0)) / A.value
    time += np.where(peak > v.value, (forward - (v.value**2 - half) / A.value) / v.value, 0.0)
    j = int(np.argmax(time))
    before, after = (
        (leg.speed * _step(segments, leg.segment, j) * leg.lead.inverse()).scaled(sign[j])
        for leg in legs
    )
    gone = (
        legs[0].way * _step(segments, legs[0].segment, j) * legs[0].lead.inverse()
        + legs[1].way * _step(segments, legs[1].segment, j) * legs[1].lead.inverse()
    ).scaled(sign[j])
    squares = (before * before + after * after).scaled(0.5)
    speeds = (before + after).scaled(-1.0)
    inverse = A.inverse()
    if peak[j] <= v.value:
        return ((A * gone + squares).root().scaled(2.0) + speeds) * inverse
    accelerated = (v * v + squares.scaled(-1.0)) * inverse
    cruised = (gone + accelerated.scaled(-1.0)) * v.inverse()
    return (v.scaled(2.0) + speeds) * inverse + cruised
