"""Compiled distances of segments to segments and to boxes: cores of spheres and capsules.

A sphere is a segment of no length. All kernels give the signed distance of the cores with the
normal from the second to the first; growing the cores by radii only subtracts them.
"""

from __future__ import annotations

import math

from numba import njit

from ...robot.kinematics.vectors import Vector, add, cross, dot, scale, subtract

TINY = 1e-14
"""m² (or 1) below which a length or a sine is zero."""
CLEAR = 1e-9
"""Share of the box's size by which a segment is moved off the box to find where they touch."""


@njit(cache=True, error_model="numpy")
def _clip(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))


@njit(cache=True, error_model="numpy")
def _any_normal(u: Vector) -> Vector:
    """A unit vector square to a unit vector (or any, if ``u`` is zero)."""
    x, y, z = abs(u[0]), abs(u[1]), abs(u[2])
    if x <= y and x <= z:
        across = (0.0, -u[2], u[1])
    elif y <= z:
        across = (u[2], 0.0, -u[0])
    else:
        across = (-u[1], u[0], 0.0)
    length = math.sqrt(dot(across, across))
    return scale(1.0 / length, across) if length > 0.0 else (0.0, 0.0, 1.0)


@njit(cache=True, error_model="numpy")
def segment_segment(
    a: Vector, u: Vector, la: float, b: Vector, v: Vector, lb: float
) -> tuple[float, Vector, Vector, Vector]:
    """Two segments with centres a, b, unit directions u, v and half lengths la, lb in m.

    After C. Ericson, Real-Time Collision Detection, 2005, 5.1.9. Crossing segments are at
    distance 0, with the normal of the plane that they lie in.

    Returns:
        distance, nearest point on the first, on the second, unit normal towards the first.
    """
    step = subtract(a, b)
    c, d, e = dot(u, v), dot(u, step), dot(v, step)
    square = 1.0 - c * c
    s = 0.0
    if square > TINY:
        s = _clip((c * e - d) / square, la)
    t = c * s + e
    if abs(t) > lb:
        t = _clip(t, lb)
        s = _clip(c * t - d, la)
    else:
        s = _clip(s, la)
    on_a, on_b = add(a, scale(s, u)), add(b, scale(t, v))
    apart = subtract(on_a, on_b)
    distance = math.sqrt(dot(apart, apart))
    if distance > TINY:
        return distance, on_a, on_b, scale(1.0 / distance, apart)
    normal = cross(u, v)
    length = math.sqrt(dot(normal, normal))
    if la * lb > 0.0 and length > TINY:
        return 0.0, on_a, on_b, scale(1.0 / length, normal)
    return 0.0, on_a, on_b, _any_normal(u if la > 0.0 else v)


@njit(cache=True, error_model="numpy")
def _excess(value: float, half: float) -> float:
    """How far a coordinate is outside [-half, half], with its sign."""
    over: float = value - _clip(value, half)
    return over


@njit(cache=True, error_model="numpy")
def _slope(c: Vector, u: Vector, h: Vector, t: float) -> float:
    """Half the derivative of the squared distance from c + t u to the box."""
    slope: float = (
        u[0] * _excess(c[0] + t * u[0], h[0])
        + u[1] * _excess(c[1] + t * u[1], h[1])
        + u[2] * _excess(c[2] + t * u[2], h[2])
    )
    return slope


@njit(cache=True, error_model="numpy")
def nearest_parameter(c: Vector, u: Vector, length: float, h: Vector) -> float:
    """Where a segment comes nearest to a box, as t in c + t u, |t| <= length.

    The squared distance is convex in t and quadratic between the planes of the box's faces: the
    root of its slope is bracketed by those planes and then found in one step.
    """
    low, high = -length, length
    at_low, at_high = _slope(c, u, h, low), _slope(c, u, h, high)
    if at_low >= 0.0:
        return low
    if at_high <= 0.0:
        return high
    for i in range(3):
        if u[i] == 0.0:
            continue
        for side in (-1.0, 1.0):
            t = (side * h[i] - c[i]) / u[i]
            if low < t < high:
                slope = _slope(c, u, h, t)
                if slope < 0.0:
                    low, at_low = t, slope
                elif slope > 0.0:
                    high, at_high = t, slope
                else:
                    return t
    root: float = low + (high - low) * at_low / (at_low - at_high)
    return root


@njit(cache=True, error_model="numpy")
def segment_box(
    c: Vector, u: Vector, length: float, h: Vector
) -> tuple[float, Vector, Vector, Vector]:
    """A segment against a box about the origin along the axes.

    Args:
        c: centre of the segment, m.
        u: its unit direction.
        length: half its length, m.
        h: half edges of the box, m.

    Returns:
        signed distance, point on the segment, point on the box, unit normal towards the segment;
        negative by the shortest way out if the segment enters the box.
    """
    t = nearest_parameter(c, u, length, h)
    on_a = add(c, scale(t, u))
    on_b = (_clip(on_a[0], h[0]), _clip(on_a[1], h[1]), _clip(on_a[2], h[2]))
    apart = subtract(on_a, on_b)
    distance = math.sqrt(dot(apart, apart))
    if distance > TINY:
        return distance, on_a, on_b, scale(1.0 / distance, apart)
    depth, normal = _way_out(c, u, length, h)
    moved = add(c, scale(depth + CLEAR * (h[0] + h[1] + h[2]), normal))
    on_a = add(c, scale(nearest_parameter(moved, u, length, h), u))
    return -depth, on_a, add(on_a, scale(depth, normal)), normal


@njit(cache=True, error_model="numpy")
def _way_out(c: Vector, u: Vector, length: float, h: Vector) -> tuple[float, Vector]:
    """Depth and direction of the shortest way of a segment out of a box.

    The difference of box and segment is a polytope whose faces are square to the box's axes or
    to an axis and the segment; the nearest of them is the way out.
    """
    depth, normal = math.inf, (0.0, 0.0, 1.0)
    for i in range(3):
        way = h[i] + length * abs(u[i]) - abs(c[i])
        if way < depth:
            sign = 1.0 if c[i] >= 0.0 else -1.0
            depth = way
            normal = (sign * (i == 0), sign * (i == 1), sign * (i == 2))
    for i in range(3):
        across = cross((1.0 * (i == 0), 1.0 * (i == 1), 1.0 * (i == 2)), u)
        size = math.sqrt(dot(across, across))
        if length == 0.0 or size < 1e-9:
            continue
        n = scale(1.0 / size, across)
        middle = dot(c, n)
        way = h[0] * abs(n[0]) + h[1] * abs(n[1]) + h[2] * abs(n[2]) - abs(middle)
        if way < depth:
            depth = way
            normal = n if middle >= 0.0 else scale(-1.0, n)
    return depth, normal
