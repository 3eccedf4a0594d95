"""Compiled lower bounds of the distance of a body of one robot and one of another, the clocks of
both running freely on an interval each.

A distance at the middles, less what both bodies move, is a first bound. The second keeps a plane
between them: along its normal each body is bounded by itself over its own interval, so that
neither needs to know when the other is where. Near a grazing contact that is within the square of
the intervals' widths, where the first is within the widths.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from ...robot.kinematics.vectors import (
    Rotation,
    Vector,
    add,
    compose,
    cross,
    dot,
    load_rotation,
    load_row,
    scale,
    subtract,
    turn,
)
from ..distance.closed_form import BOX, Hulls
from ..distance.segments import segment_box, segment_segment
from ..scene.outline import Outlines, support
from .swept_intervals import SweptIntervals


class Side(NamedTuple):
    """One robot of a pair.

    Args:
        swept: its intervals.
        outlines: its bodies.
        hulls: the same, for closed forms.
        rotation, translation: (B, 3, 3), (B, 3) m, the solids in the frames that carry them.
    """

    swept: SweptIntervals
    outlines: Outlines
    hulls: Hulls
    rotation: FloatArray
    translation: FloatArray


class PairBounds(NamedTuple):
    """Answers for K items.

    Args:
        lower: (K,) m, the pair keeps at least this distance, whenever the two are where.
        distance: (K,) m, between the bodies at both middles, from below; −inf where not known.
        normal: (K, 3), from the second body to the first; zero where not known.
        engine: (K,) bool, whether a closed form lacks and an engine may tell more.
    """

    lower: FloatArray
    distance: FloatArray
    normal: FloatArray
    engine: NDArray[np.bool_]

    @staticmethod
    def unknown(count: int) -> PairBounds:
        """Nothing is known of any."""
        return PairBounds(
            np.full(count, -np.inf),
            np.full(count, -np.inf),
            np.zeros((count, 3)),
            np.zeros(count, dtype=np.bool_),
        )

    def chosen(self, which: NDArray[np.bool_]) -> PairBounds:
        """Some of them."""
        return PairBounds._make(a[which] for a in self)


@njit(cache=True, error_model="numpy")
def bound_pairs(
    one: Side, other: Side, items: IntArray, pairs: IntArray, wanted: float, found: PairBounds
) -> None:
    """Bound distances from boxes, then by closed forms, then with a plane.

    Args:
        one, other: the robots.
        items: (K, 3), as `near_pairs` has them.
        pairs: (P, 2), bodies.
        wanted: m; more is not asked for.
        found: written.
    """
    for k in range(items.shape[0]):
        i, j = items[k, 0], items[k, 1]
        a, b = pairs[items[k, 2], 0], pairs[items[k, 2], 1]
        motion = one.swept.motion[i, a] + other.swept.motion[j, b]
        gap = _box_gap(one, other, i, j, a, b)
        found.lower[k] = gap - motion
        if not found.lower[k] < wanted or motion == math.inf:
            continue
        kinds = one.hulls.kind[a] + other.hulls.kind[b]
        if kinds > 1:
            found.engine[k] = True
            continue
        distance, n = _measured(one, other, i, j, a, b)
        found.distance[k] = distance
        found.normal[k, 0], found.normal[k, 1], found.normal[k, 2] = n
        found.lower[k] = max(
            found.lower[k], distance - motion, _planar_gap(one, other, i, j, a, b, n)
        )


@njit(cache=True, error_model="numpy")
def bound_measured(
    one: Side, other: Side, items: IntArray, pairs: IntArray, found: PairBounds
) -> None:
    """The bounds of items whose distances and normals were measured by an engine."""
    for k in range(items.shape[0]):
        i, j = items[k, 0], items[k, 1]
        a, b = pairs[items[k, 2], 0], pairs[items[k, 2], 1]
        motion = one.swept.motion[i, a] + other.swept.motion[j, b]
        found.lower[k] = max(found.lower[k], found.distance[k] - motion)
        n = load_row(found.normal, k)
        if dot(n, n) > 0.0:
            found.lower[k] = max(found.lower[k], _planar_gap(one, other, i, j, a, b, n))


@njit(cache=True, error_model="numpy")
def place_solids(
    side: Side, intervals: IntArray, bodies: IntArray, R: FloatArray, p: FloatArray
) -> None:
    """Where the solids of bodies (K,) are at the middles of intervals (K,): written to (K, 3, 3)
    and (K, 3) m."""
    for k in range(intervals.size):
        turned, at = solid_place(side, intervals[k], bodies[k])
        for i in range(3):
            p[k, i] = at[i]
            for j in range(3):
                R[k, i, j] = turned[3 * i + j]


@lean
def solid_place(side: Side, i: int, b: int) -> tuple[Rotation, Vector]:
    """Where the solid of a body is at the middle of an interval."""
    f = side.outlines.frame[b]
    below = load_rotation(side.swept.R[i], f)
    at = add(load_row(side.swept.p[i], f), turn(below, load_row(side.translation, b)))
    return compose(below, load_rotation(side.rotation, b)), at


@lean
def _measured(one: Side, other: Side, i: int, j: int, a: int, b: int) -> tuple[float, Vector]:
    """Distance of two bodies at the middles, and the normal from the second to the first."""
    turned_a, at_a = solid_place(one, i, a)
    turned_b, at_b = solid_place(other, j, b)
    at_a = add(at_a, turn(turned_a, load_row(one.hulls.centre, a)))
    at_b = add(at_b, turn(turned_b, load_row(other.hulls.centre, b)))
    if one.hulls.kind[a] == BOX:
        distance, n = _to_box(
            turned_b, at_b, other.hulls.length[b], turned_a, at_a, load_row(one.hulls.half, a)
        )
        return distance - other.hulls.radius[b], scale(-1.0, n)
    if other.hulls.kind[b] == BOX:
        distance, n = _to_box(
            turned_a, at_a, one.hulls.length[a], turned_b, at_b, load_row(other.hulls.half, b)
        )
        return distance - one.hulls.radius[a], n
    distance, _, _, n = segment_segment(
        at_a,
        _third(turned_a),
        one.hulls.length[a],
        at_b,
        _third(turned_b),
        other.hulls.length[b],
    )
    return distance - one.hulls.radius[a] - other.hulls.radius[b], n


@lean
def _to_box(
    turned: Rotation, at: Vector, length: float, box: Rotation, middle: Vector, half: Vector
) -> tuple[float, Vector]:
    """A segment against a box: distance, and normal from the box."""
    distance, _, _, n = segment_box(
        _turn_back(box, subtract(at, middle)), _turn_back(box, _third(turned)), length, half
    )
    return distance, turn(box, n)


@lean
def _third(R: Rotation) -> Vector:
    """The z axis of a frame."""
    return R[2], R[5], R[8]


@lean
def _turn_back(R: Rotation, x: Vector) -> Vector:
    """A world vector in the axes of a frame."""
    return (
        R[0] * x[0] + R[3] * x[1] + R[6] * x[2],
        R[1] * x[0] + R[4] * x[1] + R[7] * x[2],
        R[2] * x[0] + R[5] * x[1] + R[8] * x[2],
    )


@lean
def _planar_gap(one: Side, other: Side, i: int, j: int, a: int, b: int, n: Vector) -> float:
    """How far apart planes square to n keep two bodies, each all along its own interval."""
    low = _least(one, i, a, n)
    high = -_least(other, j, b, scale(-1.0, n))
    return float(low - high)


@lean
def _least(side: Side, i: int, b: int, n: Vector) -> float:
    """How far along n the points of a body are at least, all along an interval."""
    swept, f = side.swept, side.outlines.frame[b]
    least = math.inf
    for t in (-1.0, 1.0):
        down = scale(-1.0, add(n, scale(t, cross(n, load_row(swept.omega[i], b)))))
        reach = -support(side.outlines, b, swept.R[i, f], swept.p[i, f], down)
        least = min(least, reach + t * dot(n, load_row(swept.origin[i], b)))
    return float(least - 0.5 * swept.bend[i, b] - swept.off[i, b])


@lean
def _box_gap(one: Side, other: Side, i: int, j: int, a: int, b: int) -> float:
    """A lower bound of the distance at the middles, from the boxes and balls that hold bodies."""
    step = subtract(load_row(one.swept.centre[i], a), load_row(other.swept.centre[j], b))
    gap = math.sqrt(dot(step, step)) - one.outlines.reach[a] - other.outlines.reach[b]
    for side in range(2):
        edges = one.swept.edges[i, a] if side == 0 else other.swept.edges[j, b]
        for k in range(3):
            e = load_row(edges, k)
            size = math.sqrt(dot(e, e))
            if size == 0.0:
                continue
            n = scale(1.0 / size, e)
            apart = abs(dot(n, step)) - _half_width(one, i, a, n) - _half_width(other, j, b, n)
            gap = max(gap, apart)
    return float(gap)


@lean
def _half_width(side: Side, i: int, b: int, n: Vector) -> float:
    width = 0.0
    for k in range(3):
        width += abs(dot(n, load_row(side.swept.edges[i, b], k)))
    return float(min(width, side.outlines.reach[b]))
