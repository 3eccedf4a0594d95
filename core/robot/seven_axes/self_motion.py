"""How an arm of seven axes moves while its flange stands still: closed curves of configurations.

All configurations that have a pose and an arm angle lie on these curves, where the arm angle passes
the value. A curve is followed all around, limits or not, in steps so short that nothing lies
between.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit

from ...arrays import BoolArray, FloatArray
from ..kinematics.chain import Chain
from ..kinematics.chain_kernels import jacobian
from ..kinematics.linear import solve_in_place
from ..kinematics.tracking import pose_error
from .arm_angle import AXES, ArmAngle, measure, settle, wrapped

STEP = 0.06
"""rad along a curve, the length over all joints."""
MOST_TURNED = 0.4
"""rad by which the arm angle changes in one step: near the reference direction it changes fast."""
SHORTEST = 1e-4
"""The same, below which a curve is given up: it ends at a singularity that no step crosses."""
MOST = 4000
"""Steps of a curve."""
NEAR = 1.5
"""Steps within which a configuration lies on a curve."""
_CLOSE = 1e-10
"""m and rad of pose error of configurations on a curve."""
_CORRECTIONS = 6
_SAME = 1e-6
"""rad within which two configurations are one, whole turns aside."""


@dataclass(frozen=True, eq=False)
class SelfMotion:
    """A curve of configurations at one pose.

    Args:
        q: (M, 7) rad, in steps of `STEP` at most, not brought into limits.
        angle: (M,) rad, the arm angle there.
    """

    q: FloatArray
    angle: FloatArray

    def passes(self, q: FloatArray) -> BoolArray:
        """(S,) of configurations (S, 7): which of them lie on it, whole turns aside."""
        # Of points on circles of radius 1: twice 1 - cos is the square of a small angle.
        squares = 2.0 * (AXES - _on_circles(q) @ _on_circles(self.q).T)
        passed: BoolArray = np.asarray((squares < (NEAR * STEP) ** 2).any(axis=1))
        return passed


def _on_circles(q: FloatArray) -> FloatArray:
    return np.hstack([np.cos(q), np.sin(q)])


def self_motions(
    chain: Chain, angle: ArmAngle, seeds: Sequence[FloatArray], R: FloatArray, p: FloatArray
) -> list[SelfMotion]:
    """The curves through some configurations at a pose, each once.

    Args:
        chain: from the base to the flange.
        seeds: (7,) each.
        R, p: (3, 3), (3,) m, the pose.
    """
    found: list[SelfMotion] = []
    left = np.array(seeds)
    while len(left):
        q, angles = np.empty((2 * MOST + 1, AXES)), np.empty(2 * MOST + 1)
        first, last = follow(chain, angle, left[0], R, p, q, angles)
        curve = SelfMotion(q[first : last + 1], angles[first : last + 1])
        found.append(curve)
        left = left[1:][~curve.passes(left[1:])]
    return found


def with_arm_angle(
    chain: Chain,
    angle: ArmAngle,
    curves: Sequence[SelfMotion],
    R: FloatArray,
    p: FloatArray,
    wanted: float,
) -> list[FloatArray]:
    """The configurations (7,) on curves of a pose at which the arm angle is ``wanted`` rad."""
    found: list[FloatArray] = []
    for curve in curves:
        left = np.remainder(curve.angle - wanted + math.pi, 2 * math.pi) - math.pi
        for k in _starts(left):
            q = curve.q[k].copy()
            if settle(chain, angle, R, p, wanted, q) and not any(_same(q, one) for one in found):
                found.append(q)
    return found


def _starts(left: FloatArray) -> list[int]:
    """Where on a curve to begin: beside each place at which the missing angle (M,) passes zero, or
    comes near to it and turns back, as two configurations may lie there, one on each side."""
    size = np.abs(left)
    passing = np.flatnonzero((left[:-1] * left[1:] <= 0.0) & (size[:-1] + size[1:] < math.pi))
    starts = {*passing.tolist(), *(passing + 1).tolist()}
    if len(left) > 2:
        turning = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])
        change = np.maximum(np.abs(np.diff(left))[:-1], np.abs(np.diff(left))[1:])
        near = 1 + np.flatnonzero(turning & (size[1:-1] < 4.0 * change))
        starts |= {*(near - 1).tolist(), *near.tolist(), *(near + 1).tolist()}
    return sorted(starts)


def _same(one: FloatArray, other: FloatArray) -> bool:
    apart = np.remainder(one - other + math.pi, 2 * math.pi) - math.pi
    return bool(np.abs(apart).max() < _SAME)


@njit(cache=True, error_model="numpy")
def follow(
    chain: Chain,
    angle: ArmAngle,
    start: FloatArray,
    R: FloatArray,
    p: FloatArray,
    q: FloatArray,
    angles: FloatArray,
) -> tuple[int, int]:
    """Follow a curve from a configuration until it is there again.

    Where a curve cannot be followed any further it is followed the other way, too.

    Args:
        start: (7,).
        R, p: the pose.
        q, angles: (2 MOST + 1, 7), (2 MOST + 1,), written, the start in the middle.

    Returns:
        First and last row that was written.
    """
    q[MOST] = start
    last, closed = _walk(chain, angle, R, p, q, angles, 1)
    first = MOST if closed else _walk(chain, angle, R, p, q, angles, -1)[0]
    return first, last


@njit(cache=True, error_model="numpy")
def _walk(
    chain: Chain,
    angle: ArmAngle,
    R: FloatArray,
    p: FloatArray,
    q: FloatArray,
    angles: FloatArray,
    way: int,
) -> tuple[int, bool]:
    """The row where walking one way ends, and whether that is the start again."""
    here_R, here_p, J = np.empty((3, 3)), np.empty(3), np.empty((6, AXES))
    tangent, first, trial = np.empty(AXES), np.empty(AXES), q[MOST].copy()
    jacobian(chain, trial, here_R, here_p, J)
    if not _first_tangent(J, tangent):
        angles[MOST] = measure(angle, here_R, here_p, J, tangent[:0])
        return MOST, False
    tangent *= way
    first[:] = tangent
    angles[MOST] = measure(angle, here_R, here_p, J, tangent[:0])
    row, step = MOST, STEP
    while abs(row - MOST) < MOST:
        trial[:] = q[row] + step * tangent
        reached = _correct(chain, R, p, tangent, trial, here_R, here_p, J)
        turned = measure(angle, here_R, here_p, J, tangent[:0]) if reached else 0.0
        far = abs(wrapped(turned - angles[row])) > MOST_TURNED
        if not reached or (far and step > 2.0 * SHORTEST):
            step *= 0.5
            if step < SHORTEST:
                return row, False
            continue
        row += way
        q[row] = trial
        angles[row] = turned
        _tangent(J, tangent)
        step = min(STEP, 2.0 * step)
        if abs(row - MOST) > 3 and _returned(q, row, way, tangent, first):
            return row, True
    return row, False


@njit(cache=True, error_model="numpy")
def _returned(q: FloatArray, row: int, way: int, tangent: FloatArray, first: FloatArray) -> bool:
    """Whether the last step of a walk passed where it began, whole turns aside."""
    ahead, cosine, aside = 0.0, 0.0, 0.0
    for j in range(AXES):
        apart = wrapped(q[row, j] - q[MOST, j])
        ahead += apart * first[j]
        aside += apart * apart
        cosine += tangent[j] * first[j]
    return cosine > 0.5 and aside < STEP * STEP and ahead >= 0.0


@njit(cache=True, error_model="numpy")
def _first_tangent(J: FloatArray, tangent: FloatArray) -> bool:
    """Write a direction (7,) in which the flange stands still; False at a singularity."""
    best = 0.0
    chosen = 0
    for k in range(AXES):
        tangent[:] = 0.0
        tangent[k] = 1.0
        size = _tangent(J, tangent)
        if size > best:
            best, chosen = size, k
    if best == 0.0:
        return False
    tangent[:] = 0.0
    tangent[chosen] = 1.0
    _tangent(J, tangent)
    return True


@njit(cache=True, error_model="numpy")
def _tangent(J: FloatArray, tangent: FloatArray) -> float:
    """Replace a direction (7,) by the one near it in which the flange stands still, of length one.

    Returns:
        The smallest pivot; the direction stays where it is 0.
    """
    A, x = np.empty((AXES, AXES)), np.zeros(AXES)
    A[:6], A[6] = J, tangent
    x[6] = 1.0
    pivot = solve_in_place(A, x)
    if pivot > 1e-12:
        tangent[:] = x / math.sqrt((x * x).sum())
    return float(pivot)


@njit(cache=True, error_model="numpy")
def _correct(
    chain: Chain,
    R: FloatArray,
    p: FloatArray,
    tangent: FloatArray,
    q: FloatArray,
    here_R: FloatArray,
    here_p: FloatArray,
    J: FloatArray,
) -> bool:
    """Bring q (7,) back to the pose, across the tangent; R, p and J there are written."""
    error, A, step = np.empty(6), np.empty((AXES, AXES)), np.empty(AXES)
    for _ in range(_CORRECTIONS):
        jacobian(chain, q, here_R, here_p, J)
        if pose_error(R, p, here_R, here_p, error) < _CLOSE:
            return True
        A[:6], A[6], step[:6], step[6] = J, tangent, error, 0.0
        if not solve_in_place(A, step) > 1e-12:
            return False
        if np.abs(step).max() > STEP:
            return False
        q += step
    return False
