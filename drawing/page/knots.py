"""Which samples of a motion a page keeps: as few as show all the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.motion.command.trajectory import Trajectory

LONGEST = 0.25
"""s from one knot to the next at most: speeds are kept in steps, and their errors grow with it."""


@dataclass(frozen=True)
class DrawnCurves:
    """Curves over the samples that are to be seen as they are, linear between knots.

    Args:
        values: (T,) of each; where they are not finite they do not count.
        tolerance: by how much each may be off.
    """

    values: Sequence[FloatArray]
    tolerance: Sequence[float]


def knots(trajectory: Trajectory, tolerance: FloatArray, curves: DrawnCurves) -> IntArray:
    """Indices (K,) of the samples that are kept, the ends and both sides of gaps among them.

    Args:
        trajectory: T samples.
        tolerance: (N,) rad or m, by which the cubics between knots may miss joints at samples.
        curves: that are drawn beside.
    """
    count = len(trajectory.t)
    kept = np.zeros(count, dtype=np.bool_)
    kept[[0, -1]] = True
    for gap in trajectory.gaps:
        kept[[gap - 1, gap]] = True
    steps = np.floor((trajectory.t - trajectory.t[0]) / LONGEST)
    kept[1:] |= np.diff(steps) > 0
    flat = [np.nan_to_num(value) / tol for value, tol in zip(*_pairs(curves), strict=True)]
    lines = np.stack(flat, axis=1) if flat else np.zeros((count, 0))
    while True:
        edges = np.flatnonzero(kept)
        off = _off(trajectory, tolerance, lines, edges)
        worst = _worst(off, edges)
        if not len(worst):
            return edges
        kept[worst] = True


def _pairs(curves: DrawnCurves) -> tuple[Sequence[FloatArray], Sequence[float]]:
    return curves.values, curves.tolerance


def _off(
    trajectory: Trajectory, tolerance: FloatArray, lines: FloatArray, edges: IntArray
) -> FloatArray:
    """(T,), by how much each sample is missed, in tolerances."""
    t, q, dq = trajectory.t, trajectory.q, trajectory.dq
    rows = np.arange(len(t))
    left = np.searchsorted(edges, rows, side="right") - 1
    a = edges[left]
    b = edges[np.minimum(left + 1, len(edges) - 1)]
    span = t[b] - t[a]
    share = np.divide(t - t[a], span, out=np.zeros_like(t), where=span > 0)[:, None]
    cubic = hermite(share, span[:, None], (q[a], q[b]), (dq[a], dq[b]))
    off = (np.abs(q - cubic) / tolerance).max(axis=1)
    if lines.shape[1]:
        straight = lines[a] + share * (lines[b] - lines[a])
        off = np.maximum(off, np.abs(lines - straight).max(axis=1))
    off[edges] = 0.0
    return np.asarray(off)


def _worst(off: FloatArray, edges: IntArray) -> IntArray:
    """The sample of each stretch that is missed most, where that is too much."""
    most = np.maximum.reduceat(off, edges)
    stretches = np.flatnonzero(most > 1.0)
    if not len(stretches):
        return stretches
    owner = np.searchsorted(edges, np.arange(len(off)), side="right") - 1
    at = np.flatnonzero((off == most[owner]) & (most[owner] > 1.0))
    _, first = np.unique(owner[at], return_index=True)
    return np.asarray(at[first])


def hermite(
    share: FloatArray,
    span: FloatArray,
    values: tuple[FloatArray, FloatArray],
    slopes: tuple[FloatArray, FloatArray],
) -> FloatArray:
    """Cubics that meet values and slopes at both ends, at shares of their spans."""
    s = share
    rise = values[1] - values[0]
    first, last = span * slopes[0], span * slopes[1]
    bend = first + last - 2 * rise
    return np.asarray(values[0] + s * (first + s * (3 * rise - 2 * first - last + s * bend)))
