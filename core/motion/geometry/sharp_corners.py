"""Corners too sharp for the speed that legs arrive at: their blends are made smaller.

Legs that are driven superposed (`superposed_legs`) enter a zone of radius r at V = min(v², 2 A r),
v the programmed speed. On the tangent arc, of radius r / tan δ/2 for a deflection δ, the
centripetal acceleration may be k A at most. Where it would be more, the leg goes straight on into
the zone, braking by k A, until an arc of a smaller radius r' takes it at the speed that is left:

    V − 2 k A (r − r') = k A r' / tan δ/2,     r'/r = (1 − V / (2 A r k)) / (1 − 1 / (2 tan δ/2)).

Fitted: a corner of 151° of a UR10e, r = 100 mm, k = 1.2, has r' = 19.085 mm; the rule says 19.09.
"""

from __future__ import annotations

import math

import numpy as np

from .reach import Part, Reach
from .segments import LINE_SEGMENT, Segments

_STRAIGHT = 1e-6
"""1 − |cos δ| below which two legs do not deflect, or turn back."""


def share_kept(
    segments: Segments, i: int, reach: Reach, assumed: float | None, centripetal: float
) -> Reach | None:
    """What share of its radius the blend between segments i and i + 1 keeps; None for all of it.

    Args:
        segments: of the path.
        i: the corner.
        reach: share of segment i that the blend takes.
        assumed: A in m/s² where the program states none; None for no limit.
        centripetal: k.
    """
    ends = segments.ends
    if centripetal <= 1.0 or (ends.kind[i : i + 2] != LINE_SEGMENT).any():
        return None
    size = reach * Reach(float(segments.length[i]), (("length", i, 1.0),))
    cosine = _cosine(segments, i)
    used = _used(segments, i, size, assumed)
    if used is None or 1.0 - abs(cosine.value) < _STRAIGHT:
        return None
    flat = math.sqrt((1.0 + cosine.value) / (1.0 - cosine.value))  # 1 / tan δ/2
    if 2.0 * used.value <= centripetal * flat:
        return None
    slope = -0.5 / (flat * (1.0 - cosine.value) ** 2)
    bottom = cosine.mapped(1.0 - 0.5 * flat, slope)
    return used.mapped(1.0 - used.value / centripetal, -1.0 / centripetal) * bottom.inverse()


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
    own = ends.acceleration[i : i + 2]
    given = np.where(np.isinf(own), math.inf if assumed is None else assumed, own)
    weaker = int(np.argmin(given))
    if math.isinf(given[weaker]):
        return None
    named: tuple[Part, ...] = (("acceleration", i + weaker, 1.0),)
    A = Reach(float(given[weaker]), () if math.isinf(own[weaker]) else named)
    v = float(ends.speed[slower])
    if v**2 >= 2.0 * A.value * size.value:
        return Reach(1.0)
    square = Reach(0.5 * v**2, (("speed", slower, v),))
    return square * (A * size).inverse()
