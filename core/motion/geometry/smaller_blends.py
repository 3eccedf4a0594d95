"""Blends that are made smaller: the speed of their arcs is not that which legs arrive with.

Legs that are driven superposed (`superposed_legs`) drive a zone of radius r at V = min(v², 2 A r),
v the programmed speed. On the tangent arc, of radius r / tan δ/2 for a deflection δ, the
centripetal acceleration may be k A at most. A leg of the length L, planned from rest, is at the
zone's edge at W = min(V, 2 A (L − r)). From there it goes straight on into the zone, changing its
speed by k A, until that is the speed of an arc of a smaller radius r', which begins there:

- braking, where W is too fast for the arc: W − 2 k A (r − r') = k A r' / tan δ/2;
- accelerating, where W < V: W + 2 k A (r − r') = V, or k A r' / tan δ/2 if that is less.

Fitted: a corner of 151° of a UR10e, r = 100 mm, k = 1.2, has r' = 19.085 mm; the rule says 19.09.
Of another run it predicts 25.53 mm in a corner of 110°, and 56.78 mm in one at the end of a first
leg of 148.1 mm; the logged path is there within 0.005 mm.
"""

from __future__ import annotations

import math

import numpy as np

from .reach import Part, Reach, least
from .segments import LINE_SEGMENT, Segments

_STRAIGHT = 1e-6
"""1 − |cos δ| below which two legs do not deflect, or turn back."""


SHARP = "its corner is too sharp for the speed"
SHORT = "the leg before it is too short to come to the corner's speed"


def share_kept(
    segments: Segments, i: int, reach: Reach, assumed: float | None, centripetal: float
) -> tuple[Reach, str] | None:
    """What share of its radius the blend between segments i and i + 1 keeps, and why.

    Args:
        segments: of the path.
        i: the corner.
        reach: share of segment i that the blend takes.
        assumed: A in m/s² where the program states none; None for no limit.
        centripetal: k.

    Returns:
        None where it keeps all of it.
    """
    ends = segments.ends
    if centripetal <= 1.0 or (ends.kind[i : i + 2] != LINE_SEGMENT).any():
        return None
    size = reach * Reach(float(segments.length[i]), (("length", i, 1.0),))
    cosine = _cosine(segments, i)
    used = _used(segments, i, size, assumed)
    if used is None or 1.0 - abs(cosine.value) < _STRAIGHT:
        return None
    risen = _risen(segments, i, reach, assumed)
    short = risen.value < used.value
    arriving = least(used, risen)
    flat = math.sqrt((1.0 + cosine.value) / (1.0 - cosine.value))  # 1 / tan δ/2
    slope = 0.5 / (flat * (1.0 - cosine.value) ** 2)
    share = 1.0 / centripetal
    if 2.0 * arriving.value > centripetal * flat:
        straight = arriving.mapped(1.0 - share * arriving.value, -share)
        return straight * cosine.mapped(1.0 - 0.5 * flat, -slope).inverse(), SHARP
    if not short:
        return None
    kept = Reach(1.0) + (used + risen * Reach(-1.0)) * Reach(-share)
    if 2.0 * used.value > centripetal * flat * kept.value:
        straight = risen.mapped(1.0 + share * risen.value, share)
        kept = straight * cosine.mapped(1.0 + 0.5 * flat, slope).inverse()
    return kept, SHORT


def _cosine(segments: Segments, i: int) -> Reach:
    """cos δ between the lines i and i + 1."""
    ends = segments.ends
    steps = ends.position[i : i + 2, 1] - ends.position[i : i + 2, 0]
    lengths = np.linalg.norm(steps, axis=1)
    if not lengths.all():
        return Reach(1.0)
    first, second = steps / lengths[:, None]
    cosine = float(first @ second)
    turned = np.stack([second - cosine * first, first - cosine * second]) / lengths[:, None]
    parts: list[Part] = []
    for k in range(2):
        parts += [("position1", i + k, turned[k]), ("position0", i + k, -turned[k])]
    return Reach(cosine, tuple(parts))


def _used(segments: Segments, i: int, size: Reach, assumed: float | None) -> Reach | None:
    """V / (2 A r), at most one; None where nothing bounds the acceleration."""
    ends = segments.ends
    slower = i + int(np.argmin(ends.speed[i : i + 2]))
    A = least(*(acceleration_along(segments, k, assumed) for k in (i, i + 1)))
    if math.isinf(A.value):
        return None
    v = float(ends.speed[slower])
    if v**2 >= 2.0 * A.value * size.value:
        return Reach(1.0)
    square = Reach(0.5 * v**2, (("speed", slower, v),))
    return square * (A * size).inverse()


def _risen(segments: Segments, i: int, reach: Reach, assumed: float | None) -> Reach:
    """The square of the speed that leg i comes to from rest at the zone's edge, over 2 A r."""
    own, next_one = (acceleration_along(segments, k, assumed) for k in (i, i + 1))
    before = reach.inverse() + Reach(-1.0)
    return before if own.value <= next_one.value else before * own * next_one.inverse()


def acceleration_along(segments: Segments, k: int, assumed: float | None) -> Reach:
    """m/s² along segment k; inf where nothing bounds it."""
    own = float(segments.ends.acceleration[k])
    if math.isinf(own):
        return Reach(math.inf if assumed is None else assumed * float(segments.ends.override[k]))
    return Reach(own, (("acceleration", k, 1.0),))
