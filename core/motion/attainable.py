"""The greatest accelerations that limits leave the joints anywhere on a path."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .limits import interval_ends
from .ramped import ramped
from .timing import Timing

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_INSIDE = 1e-9
"""Share of a limit by which a vertex may pass it through rounding."""


def attainable_accelerations(timing: Timing) -> FloatArray:
    """(N,) rad/s² or m/s², what the joints' accelerations do not exceed at the path's samples.

    However the path is driven within its limits of speed: the acceleration limit of each joint; of
    joints that torque limits instead, the greatest |q' u + q'' x| over all u = ℓ̈ and x = ℓ̇² that
    the rows allow, a linear program in two unknowns at each sample. Where time comes up to speed at
    the start, half as much more; where accelerations are ramped, what this motion reaches counts.
    """
    size = timing.path.q.shape[1]
    most = np.asarray(timing.limits.acceleration[:, :size].max(axis=0))
    most = timing.start.most_acceleration * _without_ramp(timing, most)
    if timing.ramp > 0.0:
        return np.maximum(most, _reached(timing))
    return most


def _reached(timing: Timing) -> FloatArray:
    """(N,), the greatest accelerations of the ramped motion.

    A ramp takes accelerations along the path to where the path bends otherwise.
    """
    motion = ramped(timing)
    ddq = np.gradient(motion.dq, motion.t, axis=0)
    return np.asarray(np.abs(ddq).max(axis=0))


def _without_ramp(timing: Timing, most: FloatArray) -> FloatArray:
    free = np.flatnonzero(np.isinf(most))
    if not len(free):
        return most
    most, found = most.copy(), np.zeros(len(most))
    rows, states = timing.path_limits.rows, timing.along.states
    ends = interval_ends(timing.path.pieces)
    _attain(*rows.rows, rows.ceiling, ends, states.dq, states.ddq, free, found)
    most[free] = found[free]
    return most


@njit(cache=True, error_model="numpy")
def _attain(
    a: FloatArray,
    b: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    ceiling: FloatArray,
    ends: IntArray,
    dq: FloatArray,
    ddq: FloatArray,
    free: IntArray,
    found: FloatArray,
) -> None:
    """Write the greatest accelerations of the joints in ``free``."""
    rows = a.shape[2]
    lines = np.empty((2 * rows + 2, 3))
    for k in range(a.shape[0]):
        for end in range(2):
            count = 0
            for r in range(rows):
                for side in range(2):
                    bound = upper[k, end, r] if side else -lower[k, end, r]
                    sign = 1.0 if side else -1.0
                    if bound < np.inf and (a[k, end, r] != 0.0 or b[k, end, r] != 0.0):
                        lines[count, 0] = sign * a[k, end, r]
                        lines[count, 1] = sign * b[k, end, r]
                        lines[count, 2] = bound
                        count += 1
            lines[count] = 0.0, -1.0, 0.0
            lines[count + 1] = 0.0, 1.0, ceiling[k + end]
            count += 2
            _visit(lines[:count], dq[ends[k, end]], ddq[ends[k, end]], free, found)


@njit(cache=True, error_model="numpy")
def _visit(
    lines: FloatArray, rate: FloatArray, bend: FloatArray, free: IntArray, found: FloatArray
) -> None:
    """Raise ``found`` to |rate u + bend x| at the vertices of a polygon p u + q x ≤ h."""
    for i in range(len(lines)):
        for j in range(i):
            det = lines[i, 0] * lines[j, 1] - lines[j, 0] * lines[i, 1]
            if det == 0.0:
                continue
            u = (lines[i, 2] * lines[j, 1] - lines[j, 2] * lines[i, 1]) / det
            x = (lines[i, 0] * lines[j, 2] - lines[j, 0] * lines[i, 2]) / det
            inside = True
            for r in range(len(lines)):
                p, q, h = lines[r]
                if p * u + q * x > h + _INSIDE * (abs(p * u) + abs(q * x) + abs(h)):
                    inside = False
                    break
            if inside:
                for axis in free:
                    found[axis] = max(found[axis], abs(rate[axis] * u + bend[axis] * x))
