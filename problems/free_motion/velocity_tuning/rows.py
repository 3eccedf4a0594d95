"""Linear rows of a convex program for a fixed path, exact or as tangents inside the true limits.

Rows are A_x x + A_y y ≤ h over x = σ̇² and y ≤ √x at the knots. What is convex but for a term that
is concave on the smaller side is replaced by its tangent at a motion that is known, so that every
motion within the rows is within the true limits (convex–concave procedure; Debrouwere et al.,
"Time-optimal path following for robots with convex–concave constraints using sequential convex
programming", IEEE Transactions on Robotics 29(6), 2013):

- viscous friction that adds to a torque: v √x ≤ its tangent; where it helps, −v √x ≤ −v y;
- a torque limit that falls with speed: T(|q'| √x) is convex in x on each of its runs;
- jerk: |ä_k − ä_{k−1}| ≤ J (h_{k−1} + h_k) / 2, ä the acceleration in the middle of an interval and
  h = 2 Δ / (√x_k + √x_{k+1}) its time, which is convex in x.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from ....core.arrays import FloatArray, IntArray
from .drives import FallingCurve
from .path import FixedPath, at_ends
from .task import TuningTask

FLOOR = 1e-10
"""Share of the fastest motion's x at a knot below which no tangent is taken."""


@dataclass(frozen=True)
class LinearRows:
    """A_x x + A_y y ≤ h; A_y may be left out."""

    a_x: sp.csr_array
    upper: FloatArray
    a_y: sp.csr_array | None = None


class Knots:
    """Matrices that pick values of x out at the ends of intervals.

    Args:
        path: the path.
    """

    def __init__(self, path: FixedPath) -> None:
        self.count = len(path.limits.spacing)
        self.spacing = path.limits.spacing

    def combination(self, u: FloatArray, x: FloatArray) -> sp.csr_array:
        """Matrix (K * 2 * R, K + 1) of u·(path acceleration) + x·(x at the end), both (K, 2, R)."""
        rows = u.shape[2]
        slope = u / (2.0 * self.spacing)[:, None, None]
        left, right = -slope, slope.copy()
        left[:, 0] += x[:, 0]
        right[:, 1] += x[:, 1]
        k = np.broadcast_to(np.arange(self.count)[:, None, None], u.shape)
        row = np.arange(u.size)
        made = sp.coo_array(
            (
                np.concatenate([left.ravel(), right.ravel()]),
                (np.concatenate([row, row]), np.concatenate([k.ravel(), k.ravel() + 1])),
            ),
            shape=(self.count * 2 * rows, self.count + 1),
        )
        return sp.csr_array(made)


def kinematic_rows(task: TuningTask, knots: Knots) -> Iterator[LinearRows]:
    """Both sides of the rows that the path is stamped by, constant torque limits included."""
    limits = task.rows() if not _varying(task) else task.path.limits
    matrix = knots.combination(limits.a, limits.b)
    for sign, bound in ((1.0, limits.upper), (-1.0, -limits.lower)):
        flat = bound.ravel()
        live = np.flatnonzero(np.isfinite(flat) & (np.diff(matrix.indptr) > 0))
        yield _normalised(sign * matrix[live], flat[live])


def torque_rows(task: TuningTask, knots: Knots, at: FloatArray) -> Iterator[LinearRows]:
    """Torque limits that depend on speed, or torques that do.

    Args:
        task: the task.
        knots: of its path.
        at: (K + 1,), x of a motion that is known, above zero where the path moves.
    """
    if not _varying(task):
        return
    torques, path = task.torques, task.path
    root = np.sqrt(at_ends(at))
    for j, drive in enumerate(task.drives):
        if not np.isfinite(drive.torque.torque[0]):
            continue
        part = (slice(None), slice(None), slice(j, j + 1))
        v, rate = torques.v[part], np.abs(path.dq[part])
        for sign in (1.0, -1.0):
            adds = np.maximum(sign * v, 0.0)
            helps = np.maximum(-sign * v, 0.0)
            for run in drive.torque.runs:
                height, slope = _limit_tangent(run, rate, root)
                x = sign * torques.b[part] + _over(adds, 2.0 * root) - slope
                upper = height - sign * torques.c[part] - 0.5 * adds * root
                a_x = knots.combination(sign * torques.a[part], x)
                a_y = knots.combination(np.zeros_like(v), -helps)
                scale = 1.0 / drive.torque.torque[0]
                yield LinearRows(
                    sp.csr_array(scale * a_x), scale * upper.ravel(), sp.csr_array(scale * a_y)
                )


def jerk_rows(task: TuningTask, knots: Knots, at: FloatArray) -> Iterator[LinearRows]:
    """Jerk limits, with the intervals' times by their tangents at a motion that is known."""
    if task.jerk is None:
        return
    time, before, after = _time_tangents(task.path, at)
    middle = knots.combination(0.5 * task.path.dq, 0.5 * task.path.ddq)
    stops = task.path.stops
    for j in np.flatnonzero(np.isfinite(task.jerk)):
        rows = np.arange(knots.count) * 2 * task.path.size + j
        acceleration = middle[rows] + middle[rows + task.path.size]
        half = 0.5 * task.jerk[j]
        spread = sp.csr_array(
            sp.diags_array((half * before, half * after), offsets=(0, 1), shape=acceleration.shape)
        )
        into, out = _stepping(stops, knots.count)
        step = out @ acceleration - into @ acceleration
        span = sp.csr_array(abs(into) + abs(out))
        for sign in (1.0, -1.0):
            yield _normalised(sp.csr_array(sign * step - span @ spread), span @ (half * time))


def _stepping(stops: NDArray[np.bool_], count: int) -> tuple[sp.csr_array, sp.csr_array]:
    """Which interval lies before and which behind each change of acceleration.

    A knot that is passed is one change; a stop ends one motion and begins another.
    """
    inner = np.flatnonzero(~stops[1:-1]) + 1
    begins, ends = np.flatnonzero(stops[:-1]), np.flatnonzero(stops[1:])
    total = len(inner) + len(begins) + len(ends)
    first, second = np.arange(len(inner)), len(inner) + np.arange(len(begins))
    third = len(inner) + len(begins) + np.arange(len(ends))

    def picked(rows: IntArray, columns: IntArray) -> sp.csr_array:
        made = sp.coo_array((np.ones(len(rows)), (rows, columns)), shape=(total, count))
        return sp.csr_array(made)

    into = picked(np.concatenate([first, third]), np.concatenate([inner - 1, ends]))
    out = picked(np.concatenate([first, second]), np.concatenate([inner, begins]))
    return into, out


def _time_tangents(path: FixedPath, at: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """h at zero by its tangent, and its slopes in x at both ends of each interval, (K,) each."""
    root = np.sqrt(at)
    total = root[:-1] + root[1:]
    time = path.steps(at)
    slopes = [_over(-time, 2.0 * total * part) for part in (root[:-1], root[1:])]
    return time - slopes[0] * at[:-1] - slopes[1] * at[1:], slopes[0], slopes[1]


def _limit_tangent(
    run: FallingCurve, rate: FloatArray, root: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Height at x = 0 and slope in x of the tangent to T(rate √x)."""
    height, slope = run.lines(rate * root)
    by_root = slope * rate
    return height + 0.5 * by_root * root, _over(by_root, 2.0 * root)


def _over(value: FloatArray, by: FloatArray) -> FloatArray:
    """A quotient; 0 where the path stands still, where x is no variable."""
    return np.asarray(np.where(by > 0.0, value / np.where(by > 0.0, by, 1.0), 0.0))


def _varying(task: TuningTask) -> bool:
    """Whether torques or their limits depend on speed."""
    return task.limited and any(drive.torque.falls or drive.viscous > 0.0 for drive in task.drives)


def _normalised(matrix: sp.csr_array, upper: FloatArray) -> LinearRows:
    """Rows over their bounds, where those are above zero."""
    scale = 1.0 / np.where(upper > 0.0, upper, 1.0)
    return LinearRows(sp.csr_array(sp.diags_array(scale) @ matrix), scale * upper)
