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
    frames, bodies = tree.parent.size, outlines.frame.size
    R, p = np.empty((frames, 3, 3)), np.empty((frames, 3))
    axis = np.zeros((frames, 3))
    levers = np.zeros((bodies, frames))
    centre, edges = np.empty((bodies, 3)), np.empty((bodies, 3, 3))
    current = -1
    for k in range(items.interval.size):
        i = items.interval[k]
        if i != current:
            current = i
            _place(tree, outlines, boxes.q[i], R, p, axis, centre, edges)
            _measure_levers(tree, outlines, boxes.reach[i], stretches.most[i], R, p, axis, levers)
        a, b = pairs[items.pair[k], 0], pairs[items.pair[k], 1]
        first = _travel(
            tree, outlines, boxes, stretches.most[i], residual, levers, axis, p, i, a, b
        )
        second = _travel(
            tree, outlines, boxes, stretches.most[i], residual, levers, axis, p, i, b, a
        )
        found.travel[k] = first.reach + second.reach
        motion = first.reach + second.reach + first.deviation + second.deviation
        found.motion[k] = motion
        own = stretches.own[i]
        found.deviation[k] = _deviation(
            tree, outlines, deviations.most[own], levers, residual, a, b
        )
        n = load_row(items.normal, k)
        lower = items.distance[k] - motion
        if dot(n, n) > 0.0:
            gap = _planar_gap(outlines, R, p, a, b, first, second, n)
            off = first.deviation + second.deviation
            if stretches.last[i] - stretches.first[i] < _FEW:
                most = 0.0
                for c in range(stretches.first[i], stretches.last[i] + 1):
                    lost = _lost(
                        tree, outlines, deviations, c, residual, levers, axis, R, p, a, b, n
                    )
                    most = max(most, lost)
                off = min(off, most)
            bend = _deviation_bend(tree, outlines, deviations.most[own], levers, a, b)
            lost = _lost(tree, outlines, deviations, own, residual, levers, axis, R, p, a, b, n)
            found.deviation[k] = min(found.deviation[k], lost + bend)
            lower = max(lower, gap - off)
        else:
            lower = max(lower, _box_gap(outlines, centre, edges, a, b) - motion)
        found.lower[k] = lower


@njit(cache=True, error_model="numpy")
def _apart(tree: FrameTree, outlines: Outlines, body: int, other: int, f: int) -> bool:
    """Whether frame f moves ``body`` against ``other``."""
    return f > 0 and not tree.moves[outlines.frame[other], f - 1]


@njit(cache=True, error_model="numpy")
def _deviation(
    tree: FrameTree,
    outlines: Outlines,
    most_off: FloatArray,
    levers: FloatArray,
    residual: float,
    a: int,
    b: int,
) -> float:
    """m by which deviations within ``most_off`` (N,) and the residual move two bodies at most."""
    total = 0.0
    for body, other in ((a, b), (b, a)):
        f = outlines.frame[body]
        if _apart(tree, outlines, body, other, f):
            total += residual
        while _apart(tree, outlines, body, other, f):
            total += most_off[f - 1] * levers[body, f]
            f = tree.parent[f]
    return total


@njit(cache=True, error_model="numpy")
def _deviation_bend(
    tree: FrameTree, outlines: Outlines, most_off: FloatArray, levers: FloatArray, a: int, b: int
) -> float:
    """m by which they move them at most beside what is linear in them."""
    total = 0.0
    for body, other in ((a, b), (b, a)):
        f, speed = outlines.frame[body], 0.0
        while _apart(tree, outlines, body, other, f):
            d, far = most_off[f - 1], levers[body, f]
            if not tree.prismatic[f]:
                total += 0.5 * (2.0 * d * speed + d * d * far)
            speed += d * far
            f = tree.parent[f]
    return total


@njit(cache=True, error_model="numpy")
def _lost(
    tree: FrameTree,
    outlines: Outlines,
    deviations: DeviationBounds,
    c: int,
    residual: float,
    levers: FloatArray,
    axis: FloatArray,
    R: FloatArray,
    p: FloatArray,
    a: int,
    b: int,
    n: Vector,
) -> float:
    """m that deviations and the residual may take along n, as far as it is linear in them."""
    total: float = _deviation(tree, outlines, deviations.rest[c], levers, residual, a, b)
    for w in range(deviations.ways.shape[1]):
        way, least, most = (
            deviations.ways[c, w],
            deviations.share[c, w, 0],
            deviations.share[c, w, 1],
        )
        if least == 0.0 and most == 0.0:
            continue
        low, high = _extent(tree, outlines, way, axis, R, p, a, b, n)
        total += max(-most * low, -least * high, 0.0)
        low, high = _extent(tree, outlines, way, axis, R, p, b, a, n)
        total += max(most * high, least * low, 0.0)
    return total


@njit(cache=True, error_model="numpy")
def _extent(
    tree: FrameTree,
    outlines: Outlines,
    way: FloatArray,
    axis: FloatArray,
    R: FloatArray,
    p: FloatArray,
    body: int,
    other: int,
    n: Vector,
) -> tuple[float, float]:
    """How far along n the points of a body go against another, joints going a way (N,)."""
    f = own = outlines.frame[body]
    omega, origin, moved = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), False
    while _apart(tree, outlines, body, other, f):
        rate = scale(way[f - 1], load_row(axis, f))
        if tree.prismatic[f]:
            origin = add(origin, rate)
        else:
            omega = add(omega, rate)
            origin = add(origin, cross(load_row(p, f), rate))
        moved = True
        f = tree.parent[f]
    if not moved:
        return 0.0, 0.0
    across, along = cross(n, omega), dot(n, origin)
    low = along - support(outlines, body, R[own], p[own], scale(-1.0, across))
    return low, along + support(outlines, body, R[own], p[own], across)


@njit(cache=True, error_model="numpy")
def _place(
    tree: FrameTree,
    outlines: Outlines,
    q: FloatArray,
    R: FloatArray,
    p: FloatArray,
    axis: FloatArray,
    centre: FloatArray,
    edges: FloatArray,
) -> None:
    """Write frames, joint axes (F, 3), and the bodies' boxes in the world."""
    place_frames(tree, q, R, p)
    for f in range(1, tree.parent.size):
        s = turn(load_rotation(R, f), load_row(tree.axis, f))
        axis[f, 0], axis[f, 1], axis[f, 2] = s
    for b in range(outlines.frame.size):
        f = outlines.frame[b]
        turned = load_rotation(R, f)
        c = add(load_row(p, f), turn(turned, load_row(outlines.centre, b)))
        centre[b, 0], centre[b, 1], centre[b, 2] = c
        for i in range(3):
            e = turn(turned, load_row(outlines.edges[b], i))
            edges[b, i, 0], edges[b, i, 1], edges[b, i, 2] = e


@njit(cache=True, error_model="numpy")
def _measure_levers(
    tree: FrameTree,
    outlines: Outlines,
    reach: FloatArray,
    most_off: FloatArray,
    R: FloatArray,
    p: FloatArray,
    axis: FloatArray,
    levers: FloatArray,
) -> None:
    """Write Λ (B, F), m, of every body about every axis below it; 1 for slides."""
    for b in range(outlines.frame.size):
        own = outlines.frame[b]
        f, behind = own, 0.0
        while f > 0:
            if tree.prismatic[f]:
                levers[b, f] = 1.0
            else:
                # In the body's frame, where its box is kept.
                step = subtract(load_row(p, f), load_row(p, own))
                s, o = _into(R, own, load_row(axis, f)), _into(R, own, step)
                levers[b, f] = lever(outlines, b, s, o) + behind
            behind += (reach[f - 1] + most_off[f - 1]) * levers[b, f]
            f = tree.parent[f]


@njit(cache=True, error_model="numpy")
def _into(R: FloatArray, f: int, x: Vector) -> Vector:
    """A world vector in the axes of frame f."""
    return (
        R[f, 0, 0] * x[0] + R[f, 1, 0] * x[1] + R[f, 2, 0] * x[2],
        R[f, 0, 1] * x[0] + R[f, 1, 1] * x[1] + R[f, 2, 1] * x[2],
        R[f, 0, 2] * x[0] + R[f, 1, 2] * x[1] + R[f, 2, 2] * x[2],
    )


@njit(cache=True, error_model="numpy")
def _travel(
    tree: FrameTree,
    outlines: Outlines,
    boxes: Boxes,
    most_off: FloatArray,
    residual: float,
    levers: FloatArray,
    axis: FloatArray,
    p: FloatArray,
    i: int,
    body: int,
    other: int,
) -> _Travel:
    """How ``body`` moves on interval i, seen from the last joint that also carries ``other``.

    Its acceleration builds up from tip to base: turning a frame at ω adds 2 ω × v and
    ω × (ω × r) to what happens in it.
    """
    f = outlines.frame[body]
    shared = tree.moves[outlines.frame[other]]
    reach = bend = speed = 0.0
    deviation = residual if f > 0 and not shared[f - 1] else 0.0
    omega, origin = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    while f > 0 and not shared[f - 1]:
        j, far = f - 1, levers[body, f]
        d1, d2 = boxes.first[i, j] + most_off[j], boxes.second[i, j]
        s = load_row(axis, f)
        reach += boxes.reach[i, j] * far
        deviation += most_off[j] * far
        if tree.prismatic[f]:
            bend += d2
            origin = add(origin, scale(boxes.rate[i, j], s))
        else:
            bend += 2.0 * d1 * speed + (d2 + d1 * d1) * far
            rate = scale(boxes.rate[i, j], s)
            omega = add(omega, rate)
            origin = add(origin, cross(load_row(p, f), rate))
        speed += d1 * far
        f = tree.parent[f]
    return _Travel(reach, bend, deviation, omega, origin)


@njit(cache=True, error_model="numpy")
def _planar_gap(
    outlines: Outlines,
    R: FloatArray,
    p: FloatArray,
    a: int,
    b: int,
    first: _Travel,
    second: _Travel,
    n: Vector,
) -> float:
    """How far apart planes square to n keep bodies a and b all along the interval."""
    gap = math.inf
    fa, fb = outlines.frame[a], outlines.frame[b]
    for t in (-1.0, 1.0):
        down = scale(-1.0, add(n, scale(t, cross(n, first.omega))))
        low = -support(outlines, a, R[fa], p[fa], down) + t * dot(n, first.origin)
        up = add(n, scale(t, cross(n, second.omega)))
        high = support(outlines, b, R[fb], p[fb], up) + t * dot(n, second.origin)
        gap = min(gap, low - high)
    return gap - 0.5 * (first.bend + second.bend)


@njit(cache=True, error_model="numpy")
def _box_gap(outlines: Outlines, centre: FloatArray, edges: FloatArray, a: int, b: int) -> float:
    """A lower bound of the distance of two bodies from the boxes and balls that hold them."""
    step = subtract(load_row(centre, a), load_row(centre, b))
    gap = math.sqrt(dot(step, step)) - outlines.reach[a] - outlines.reach[b]
    for owner in (a, b):
        for i in range(3):
            e = load_row(edges[owner], i)
            size = math.sqrt(dot(e, e))
            if size == 0.0:
                continue
            n = scale(1.0 / size, e)
            apart = abs(dot(n, step)) - _half_width(outlines, edges, a, n)
            gap = max(gap, apart - _half_width(outlines, edges, b, n))
    return float(gap)


@njit(cache=True, error_model="numpy")
def _half_width(outlines: Outlines, edges: FloatArray, body: int, n: Vector) -> float:
    """Half the width along n of the box or ball that holds a body, whichever is less."""
    width = 0.0
    for i in range(3):
        width += abs(dot(n, load_row(edges[body], i)))
    return float(min(width, outlines.reach[body]))
