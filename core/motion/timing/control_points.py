"""Bounds of how fast joints and tool move anywhere between two samples, by control points.

A polynomial lies within the hull of its control points (Bernstein): the slope of the quintic that
joints are on has five, the cubic that the TCP's twist is on four. A square is at most what the
squares of the control points make. So a look at a few numbers tells of most intervals that no limit
is passed in them, and only the others need to be looked at place by place.
"""

from __future__ import annotations

from ...robot.kinematics.lean import inlined
from ..path.tcp_samples import States

Points = tuple[float, float, float, float, float]


@inlined
def slope_points(states: States, s: int, j: int, way: float, h: float) -> Points:
    """Control points of q' of joint j between samples s and s + 1, ``h`` apart, on the quintic that
    goes ``way``."""
    c0, c4 = states.dq[s, j], states.dq[s + 1, j]
    c1, c3 = c0 + 0.25 * h * states.ddq[s, j], c4 - 0.25 * h * states.ddq[s + 1, j]
    return c0, c1, 5.0 * way / h - (c0 + c1 + c3 + c4), c3, c4


@inlined
def most_speed(c: Points, x0: float, x1: float) -> float:
    """Bound of q̇² = q'² x, x linear between two values."""
    s0, s1, s2, s3, s4 = c[0] * c[0], c[1] * c[1], c[2] * c[2], c[3] * c[3], c[4] * c[4]
    inner = max(0.8 * s1 * x0 + 0.2 * s0 * x1, 0.6 * s2 * x0 + 0.4 * s1 * x1)
    inner = max(inner, 0.4 * s3 * x0 + 0.6 * s2 * x1, 0.2 * s4 * x0 + 0.8 * s3 * x1)
    return max(inner, s0 * x0, s4 * x1)


@inlined
def most_acceleration(c: Points, x0: float, x1: float, h: float) -> float:
    """Bound of |q̈| = |q' u + q'' x|, x linear between two values."""
    u, by = 0.5 * (x1 - x0) / h, 4.0 / h
    b0, b1, b2, b3 = by * (c[1] - c[0]), by * (c[2] - c[1]), by * (c[3] - c[2]), by * (c[4] - c[3])
    ends = max(abs(u * c[0] + b0 * x0), abs(u * c[4] + b3 * x1))
    first = abs(u * c[1] + 0.75 * b1 * x0 + 0.25 * b0 * x1)
    middle = abs(u * c[2] + 0.5 * (b2 * x0 + b1 * x1))
    return max(ends, first, middle, abs(u * c[3] + 0.25 * b3 * x0 + 0.75 * b2 * x1))


@inlined
def most_tool_speed(states: States, s: int, part: int, h: float, x0: float, x1: float) -> float:
    """Bound of the square of the TCP's speed (part 0), or of the tool's rate of turn (1)."""
    s0 = s1 = s2 = s3 = 0.0
    for i in range(3 * part, 3 * part + 3):
        c0, c3 = states.v[s, i], states.v[s + 1, i]
        c1, c2 = c0 + h / 3.0 * states.a[s, i], c3 - h / 3.0 * states.a[s + 1, i]
        s0, s1, s2, s3 = s0 + c0 * c0, s1 + c1 * c1, s2 + c2 * c2, s3 + c3 * c3
    inner = max(0.75 * s1 * x0 + 0.25 * s0 * x1, 0.5 * (s2 * x0 + s1 * x1))
    return max(inner, 0.25 * s3 * x0 + 0.75 * s2 * x1, s0 * x0, s3 * x1)
