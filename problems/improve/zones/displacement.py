"""How far bodies move between configurations, and what that leaves between them.

The displacement of a point of a rigid body is a linear function of the point, so no point of the
body moves further than some corner of a box that holds it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ....core.arrays import FloatArray, IntArray
from ....core.collision.scene.frames import FrameTree, place_frames
from ....core.collision.scene.outline import Outlines, lever, support
from ....core.robot.kinematics.vectors import load_row, scale


class Placed(NamedTuple):
    """World poses of F frames at K configurations: (K, F, 3, 3) and (K, F, 3) m."""

    rotation: FloatArray
    position: FloatArray


def placed(tree: FrameTree, q: FloatArray) -> Placed:
    """The frames at configurations q (K, N)."""
    size = tree.parent.size
    out = Placed(np.empty((len(q), size, 3, 3)), np.empty((len(q), size, 3)))
    _place(tree, np.ascontiguousarray(q), *out)
    return out


@njit(cache=True, error_model="numpy")
def _place(tree: FrameTree, q: FloatArray, R: FloatArray, p: FloatArray) -> None:
    for k in range(q.shape[0]):
        place_frames(tree, q[k], R[k], p[k])


@njit(cache=True, error_model="numpy")
def moved(outlines: Outlines, centre: Placed, around: Placed) -> FloatArray:
    """How far (C, B) m bodies are moved at most.

    Args:
        outlines: of B bodies.
        centre: C configurations.
        around: C · K configurations, the first K of which belong to the first of ``centre``.
    """
    cells, bodies = centre.rotation.shape[0], outlines.frame.size
    each = around.rotation.shape[0] // cells
    furthest = np.zeros((cells, bodies))
    turned, step = np.empty((3, 3)), np.empty(3)
    for c in range(cells):
        for b in range(bodies):
            f = outlines.frame[b]
            if f == 0:
                continue
            R0, p0 = centre.rotation[c, f], centre.position[c, f]
            most = 0.0
            for m in range(c * each, (c + 1) * each):
                for i in range(3):
                    step[i] = around.position[m, f, i] - p0[i]
                    for j in range(3):
                        turned[i, j] = around.rotation[m, f, i, j] - R0[i, j]
                most = max(most, _longest(outlines, b, turned, step))
            furthest[c, b] = np.sqrt(most)
    return furthest


@njit(cache=True, error_model="numpy")
def _longest(outlines: Outlines, b: int, turned: FloatArray, step: FloatArray) -> float:
    """Largest square of turned · x + step over the corners x of a body's box."""
    most = 0.0
    for corner in range(8):
        square = 0.0
        for i in range(3):
            moved = step[i]
            for j in range(3):
                x = outlines.centre[b, j]
                for edge in range(3):
                    side = 1.0 if corner & (1 << edge) else -1.0
                    x += side * outlines.edges[b, edge, j]
                moved += turned[i, j] * x
            square += moved * moved
        most = max(most, square)
    return most


@njit(cache=True, error_model="numpy")
def planar_gaps(
    outlines: Outlines,
    centre: Placed,
    around: Placed,
    cell: IntArray,
    pairs: IntArray,
    normal: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """How far planes square to a fixed direction keep pairs of bodies apart.

    That is a lower bound of their distance: of bodies that are convex it is the distance itself
    where the direction is that of the nearest points.

    Args:
        outlines: of the bodies.
        centre, around: as in `moved`.
        cell: (F,), the cell meant.
        pairs: (F, 2), indices of bodies.
        normal: (F, 3), unit vectors that lead from the second to the first.

    Returns:
        m, in the cells' centres (F,), and at least around them (F,).
    """
    each = around.rotation.shape[0] // centre.rotation.shape[0]
    here, least = np.empty(cell.size), np.full(cell.size, np.inf)
    for e in range(cell.size):
        c = cell[e]
        here[e] = _gap(outlines, centre, c, pairs[e], normal[e])
        for m in range(c * each, (c + 1) * each):
            least[e] = min(least[e], _gap(outlines, around, m, pairs[e], normal[e]))
    return here, least


@njit(cache=True, error_model="numpy")
def _gap(outlines: Outlines, at: Placed, m: int, pair: IntArray, normal: FloatArray) -> float:
    n = load_row(normal.reshape(1, 3), 0)
    fa, fb = outlines.frame[pair[0]], outlines.frame[pair[1]]
    low = -support(outlines, pair[0], at.rotation[m, fa], at.position[m, fa], scale(-1.0, n))
    high = support(outlines, pair[1], at.rotation[m, fb], at.position[m, fb], n)
    return float(low - high)


@njit(cache=True, error_model="numpy")
def deviated(
    tree: FrameTree, outlines: Outlines, pairs: IntArray, centre: Placed, deviation: FloatArray
) -> FloatArray:
    """How much nearer (C, P) m bodies come with joints off by up to ``deviation`` (N,) either way.

    Joints that carry both bodies of a pair leave their distance alone, as in the certificate.
    """
    cells, bodies = centre.rotation.shape[0], outlines.frame.size
    levers = np.zeros((bodies, tree.parent.size))
    total = np.zeros((cells, len(pairs)))
    for c in range(cells):
        R, p = centre.rotation[c], centre.position[c]
        for b in range(bodies):
            _measure_levers(tree, outlines, b, R, p, deviation, levers[b])
        for k in range(len(pairs)):
            a, b = pairs[k, 0], pairs[k, 1]
            total[c, k] = _nearer(tree, outlines, a, b, deviation, levers)
            total[c, k] += _nearer(tree, outlines, b, a, deviation, levers)
    return total


@njit(cache=True, error_model="numpy")
def _measure_levers(
    tree: FrameTree,
    outlines: Outlines,
    b: int,
    R: FloatArray,
    p: FloatArray,
    deviation: FloatArray,
    levers: FloatArray,
) -> None:
    """Write (F,) m, how far a body gets from every axis that carries it; 1 for slides."""
    own = outlines.frame[b]
    f, behind = own, 0.0
    while f > 0:
        levers[f] = 1.0
        if not tree.prismatic[f]:
            # In the body's frame, where its box is kept.
            axis = R[own].T @ (R[f] @ tree.axis[f])
            origin = R[own].T @ (p[f] - p[own])
            s, o = (axis[0], axis[1], axis[2]), (origin[0], origin[1], origin[2])
            levers[f] = lever(outlines, b, s, o) + behind
        behind += deviation[tree.value[f]] * levers[f]
        f = tree.parent[f]


@njit(cache=True, error_model="numpy")
def _nearer(
    tree: FrameTree,
    outlines: Outlines,
    body: int,
    other: int,
    deviation: FloatArray,
    levers: FloatArray,
) -> float:
    """m that a body moves at most, seen from the last joint that also carries the other."""
    f, shared = outlines.frame[body], tree.rides[outlines.frame[other]]
    total = 0.0
    while not shared[f]:
        total += deviation[tree.value[f]] * levers[body, f]
        f = tree.parent[f]
    return total
