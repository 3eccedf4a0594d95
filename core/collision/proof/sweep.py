"""Compiled lower bounds of the distance of two bodies all along an interval of a path.

With t from −1 to 1 along the interval, the frames known at its middle and bounds of the joints'
derivatives from an enclosure, a body seen from the other moves

    at most  Σ_j |q_j − q_j(0)| Λ_j,    Λ_j = λ_j + Σ_{k behind j} |q_k − q_k(0)| Λ_k,

λ_j being the farthest that it gets from axis j at the middle: only joints behind j change its
distance from that axis, and joints that carry both bodies do not count. So a distance d at the
middle, less that, is a first bound.

The second keeps a plane between the bodies. Along a unit normal n a point a of the first body
lies at n · a + t n · a' at least, less max |a''| t² / 2. What is linear in t is the support of the
body in the direction n ± n × ω, and least at t = ±1, since the least over the points is concave
in t. Near a grazing contact it is within the square of the interval's width of the distance,
where the first is within the width.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from ...robot.kinematics.vectors import (
    Vector,
    add,
    cross,
    dot,
    load_rotation,
    load_row,
    scale,
    subtract,
    turn,
)
from ..deviation.bounds import BoundsByInterval, DeviationBounds
from ..scene.frames import FrameTree, place_frames
from ..scene.outline import Outlines, lever, support
from .boxes import Boxes
from .items import Items, Sweeps

_FEW = 4
"""Stretches of deviations on an interval up to which each is looked at for itself."""


class _Travel(NamedTuple):
    """How a body moves in the frame of the joints that it shares with the other one.

    Args:
        reach: m, from where it is at the middle.
        bend: m, bound of |a''|, with what deviations of the joints do to it.
        deviation: m, what deviations of the joints and the residual add.
        omega, origin: angular velocity, and velocity of the point at the world's origin, by t at
            the middle.
    """

    reach: float
    bend: float
    deviation: float
    omega: Vector
    origin: Vector


class Middle(NamedTuple):
    """Bodies in the world at the middle of an interval.

    Args:
        tree, outlines: of F frames and B bodies.
        R, p: (F, 3, 3), (F, 3) m, the frames.
        axis: (F, 3), of their joints.
        levers: (B, F), Λ (m) of every body about every axis below it; 1 for slides.
        centre, edges: (B, 3), (B, 3, 3) m, boxes round the bodies.
    """

    tree: FrameTree
    outlines: Outlines
    R: FloatArray
    p: FloatArray
    axis: FloatArray
    levers: FloatArray
    centre: FloatArray
    edges: FloatArray


@njit(cache=True, error_model="numpy")
def middle_of(tree: FrameTree, outlines: Outlines) -> Middle:
    """Room for bodies at the middle of one interval after the other."""
    frames, bodies = tree.parent.size, outlines.frame.size
    return Middle(
        tree,
        outlines,
        np.empty((frames, 3, 3)),
        np.empty((frames, 3)),
        np.zeros((frames, 3)),
        np.zeros((bodies, frames)),
        np.empty((bodies, 3)),
        np.empty((bodies, 3, 3)),
    )


@njit(cache=True, error_model="numpy")
def sweep(
    tree: FrameTree,
    outlines: Outlines,
    pairs: IntArray,
    boxes: Boxes,
    deviations: DeviationBounds,
    stretches: BoundsByInterval,
    residual: float,
    items: Items,
    found: Sweeps,
) -> None:
    """Bound the distances of pairs of bodies on intervals.

    Args:
        tree: the frames.
        outlines: the bodies.
        pairs: (P, 2), indices of bodies.
        boxes: enclosures of the intervals; the items' ones are verified.
        deviations: how far joints may be from the path.
        stretches: where among them the intervals are.
        residual: m by which a moving body may be elsewhere.
        items: the questions.
        found: written.
    """
    at = middle_of(tree, outlines)
    current = -1
    for k in range(items.interval.size):
        i = items.interval[k]
        if i != current:
            current = i
            place(at, boxes.q[i])
            measure_levers(at, boxes.reach[i], stretches.most[i])
        a, b = pairs[items.pair[k], 0], pairs[items.pair[k], 1]
        first = travel(at, boxes, stretches.most[i], residual, i, a, b)
        second = travel(at, boxes, stretches.most[i], residual, i, b, a)
        found.travel[k] = first.reach + second.reach
        motion = first.reach + second.reach + first.deviation + second.deviation
        found.motion[k] = motion
        own = stretches.own[i]
        found.deviation[k] = _deviation(at, deviations.most[own], residual, a, b)
        n = load_row(items.normal, k)
        lower = items.distance[k] - motion
        if dot(n, n) > 0.0:
            gap = _planar_gap(at, a, b, first, second, n)
            off = first.deviation + second.deviation
            if stretches.last[i] - stretches.first[i] < _FEW:
                most = 0.0
                for c in range(stretches.first[i], stretches.last[i] + 1):
                    most = max(most, _lost(at, deviations, c, residual, a, b, n))
                off = min(off, most)
            bend = _deviation_bend(at, deviations.most[own], a, b)
            lost = _lost(at, deviations, own, residual, a, b, n)
            found.deviation[k] = min(found.deviation[k], lost + bend)
            lower = max(lower, gap - off)
        else:
            lower = max(lower, _box_gap(at, a, b) - motion)
        found.lower[k] = lower


@lean
def _apart(at: Middle, body: int, other: int, f: int) -> bool:
    """Whether frame f moves ``body`` against ``other``."""
    return not at.tree.rides[at.outlines.frame[other], f]


@lean
def _deviation(at: Middle, most_off: FloatArray, residual: float, a: int, b: int) -> float:
    """m by which deviations within ``most_off`` (N,) and the residual move two bodies at most."""
    total = 0.0
    for body, other in ((a, b), (b, a)):
        f = at.outlines.frame[body]
        if _apart(at, body, other, f):
            total += residual
        while _apart(at, body, other, f):
            total += most_off[at.tree.value[f]] * at.levers[body, f]
            f = at.tree.parent[f]
    return total


@lean
def _deviation_bend(at: Middle, most_off: FloatArray, a: int, b: int) -> float:
    """m by which they move them at most beside what is linear in them."""
    total = 0.0
    for body, other in ((a, b), (b, a)):
        f, speed = at.outlines.frame[body], 0.0
        while _apart(at, body, other, f):
            d, far = most_off[at.tree.value[f]], at.levers[body, f]
            if not at.tree.prismatic[f]:
                total += 0.5 * (2.0 * d * speed + d * d * far)
            speed += d * far
            f = at.tree.parent[f]
    return total


@lean
def _lost(
    at: Middle, deviations: DeviationBounds, c: int, residual: float, a: int, b: int, n: Vector
) -> float:
    """m that deviations and the residual may take along n, as far as it is linear in them."""
    total: float = _deviation(at, deviations.rest[c], residual, a, b)
    for w in range(deviations.ways.shape[1]):
        way = deviations.ways[c, w]
        least, most = deviations.share[c, w, 0], deviations.share[c, w, 1]
        if least == 0.0 and most == 0.0:
            continue
        low, high = _extent(at, way, a, b, n)
        total += max(-most * low, -least * high, 0.0)
        low, high = _extent(at, way, b, a, n)
        total += max(most * high, least * low, 0.0)
    return total


@lean
def _extent(at: Middle, way: FloatArray, body: int, other: int, n: Vector) -> tuple[float, float]:
    """How far along n the points of a body go against another, joints going a way (N,)."""
    f = own = at.outlines.frame[body]
    omega, origin, moved = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), False
    while _apart(at, body, other, f):
        rate = scale(way[at.tree.value[f]], load_row(at.axis, f))
        if at.tree.prismatic[f]:
            origin = add(origin, rate)
        else:
            omega = add(omega, rate)
            origin = add(origin, cross(load_row(at.p, f), rate))
        moved = True
        f = at.tree.parent[f]
    if not moved:
        return 0.0, 0.0
    across, along = cross(n, omega), dot(n, origin)
    low = along - support(at.outlines, body, at.R[own], at.p[own], scale(-1.0, across))
    return low, along + support(at.outlines, body, at.R[own], at.p[own], across)


@lean
def place(at: Middle, q: FloatArray) -> None:
    """Write frames, joint axes (F, 3), and the bodies' boxes in the world."""
    place_frames(at.tree, q, at.R, at.p)
    for f in range(1, at.tree.parent.size):
        s = turn(load_rotation(at.R, f), load_row(at.tree.axis, f))
        at.axis[f, 0], at.axis[f, 1], at.axis[f, 2] = s
    for b in range(at.outlines.frame.size):
        f = at.outlines.frame[b]
        turned = load_rotation(at.R, f)
        c = add(load_row(at.p, f), turn(turned, load_row(at.outlines.centre, b)))
        at.centre[b, 0], at.centre[b, 1], at.centre[b, 2] = c
        for i in range(3):
            e = turn(turned, load_row(at.outlines.edges[b], i))
            at.edges[b, i, 0], at.edges[b, i, 1], at.edges[b, i, 2] = e


@lean
def measure_levers(at: Middle, reach: FloatArray, most_off: FloatArray) -> None:
    """Write the levers."""
    for b in range(at.outlines.frame.size):
        own = at.outlines.frame[b]
        f, behind = own, 0.0
        while f > 0:
            if at.tree.prismatic[f]:
                at.levers[b, f] = 1.0
            else:
                # In the body's frame, where its box is kept.
                step = subtract(load_row(at.p, f), load_row(at.p, own))
                s, o = _into(at.R, own, load_row(at.axis, f)), _into(at.R, own, step)
                at.levers[b, f] = lever(at.outlines, b, s, o) + behind
            j = at.tree.value[f]
            behind += (reach[j] + most_off[j]) * at.levers[b, f]
            f = at.tree.parent[f]


@lean
def _into(R: FloatArray, f: int, x: Vector) -> Vector:
    """A world vector in the axes of frame f."""
    return (
        R[f, 0, 0] * x[0] + R[f, 1, 0] * x[1] + R[f, 2, 0] * x[2],
        R[f, 0, 1] * x[0] + R[f, 1, 1] * x[1] + R[f, 2, 1] * x[2],
        R[f, 0, 2] * x[0] + R[f, 1, 2] * x[1] + R[f, 2, 2] * x[2],
    )


@lean
def travel(
    at: Middle, boxes: Boxes, most_off: FloatArray, residual: float, i: int, body: int, other: int
) -> _Travel:
    """How ``body`` moves on interval i, seen from the last joint that also carries ``other``.

    Its acceleration builds up from tip to base: turning a frame at ω adds 2 ω × v and
    ω × (ω × r) to what happens in it.
    """
    f = at.outlines.frame[body]
    shared = at.tree.rides[at.outlines.frame[other]]
    reach = bend = speed = 0.0
    deviation = 0.0 if shared[f] else residual
    omega, origin = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    while not shared[f]:
        j, far = at.tree.value[f], at.levers[body, f]
        d1, d2 = boxes.first[i, j] + most_off[j], boxes.second[i, j]
        s = load_row(at.axis, f)
        reach += boxes.reach[i, j] * far
        deviation += most_off[j] * far
        if at.tree.prismatic[f]:
            bend += d2
            origin = add(origin, scale(boxes.rate[i, j], s))
        else:
            bend += 2.0 * d1 * speed + (d2 + d1 * d1) * far
            rate = scale(boxes.rate[i, j], s)
            omega = add(omega, rate)
            origin = add(origin, cross(load_row(at.p, f), rate))
        speed += d1 * far
        f = at.tree.parent[f]
    return _Travel(reach, bend, deviation, omega, origin)


@lean
def _planar_gap(at: Middle, a: int, b: int, first: _Travel, second: _Travel, n: Vector) -> float:
    """How far apart planes square to n keep bodies a and b all along the interval."""
    gap = math.inf
    fa, fb = at.outlines.frame[a], at.outlines.frame[b]
    for t in (-1.0, 1.0):
        down = scale(-1.0, add(n, scale(t, cross(n, first.omega))))
        low = -support(at.outlines, a, at.R[fa], at.p[fa], down) + t * dot(n, first.origin)
        up = add(n, scale(t, cross(n, second.omega)))
        high = support(at.outlines, b, at.R[fb], at.p[fb], up) + t * dot(n, second.origin)
        gap = min(gap, low - high)
    return gap - 0.5 * (first.bend + second.bend)


@lean
def _box_gap(at: Middle, a: int, b: int) -> float:
    """A lower bound of the distance of two bodies from the boxes and balls that hold them."""
    step = subtract(load_row(at.centre, a), load_row(at.centre, b))
    gap = math.sqrt(dot(step, step)) - at.outlines.reach[a] - at.outlines.reach[b]
    for owner in (a, b):
        for i in range(3):
            e = load_row(at.edges[owner], i)
            size = math.sqrt(dot(e, e))
            if size == 0.0:
                continue
            n = scale(1.0 / size, e)
            apart = abs(dot(n, step)) - _half_width(at, a, n)
            gap = max(gap, apart - _half_width(at, b, n))
    return float(gap)


@lean
def _half_width(at: Middle, body: int, n: Vector) -> float:
    """Half the width along n of the box or ball that holds a body, whichever is less."""
    width = 0.0
    for i in range(3):
        width += abs(dot(n, load_row(at.edges[body], i)))
    return float(min(width, at.outlines.reach[body]))
