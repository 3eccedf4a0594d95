"""Numerical inverse kinematics from many starts, for arms without a closed form."""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray
from .chain import Chain
from .chain_kernels import jacobian
from .tracking import least_step, pose_error, track

STARTS = 96
LEVENBERG_ITERATIONS = 60
CLOSE = 1e-3
"""m and rad of pose error at which Newton's method takes over."""
SETTLED = 1e-12
"""The same at which Levenberg's method ends where Newton's does not: where axes are in line, the
error is a square of what is left to go, and undamped steps turn both axes without end."""
COARSE, FINE = (0.3, 1e-4), (1e-4, 1e-14)
"""Damping to begin with, and the least, of an approach from afar and of the last stretch."""


@njit(cache=True, error_model="numpy")
def approach(
    chain: Chain,
    q: FloatArray,
    R: FloatArray,
    p: FloatArray,
    dampings: tuple[float, float],
    close: float,
) -> float:
    """Move q (n,) towards a pose by Levenberg's method, until the error is below ``close``; the
    error left (m, rad) is returned.

    Args:
        dampings: to begin with, and the least.
    """
    size = q.size
    joints = np.arange(size)
    J = np.empty((6, size))
    here_R, here_p = np.empty((3, 3)), np.empty(3)
    error, step = np.empty(6), np.empty(size)
    jacobian(chain, q, here_R, here_p, J)
    left = pose_error(R, p, here_R, here_p, error)
    damping, least = dampings
    trial = np.empty(size)
    for _ in range(LEVENBERG_ITERATIONS):
        if left < close or damping > 1e3:
            break
        least_step(J, joints, error, damping, step)
        trial[:] = q + step
        jacobian(chain, trial, here_R, here_p, J)
        found = pose_error(R, p, here_R, here_p, error)
        if found < left:
            q[:] = trial
            left = found
            damping = max(least, 0.3 * damping)
        else:
            damping *= 3.0
            jacobian(chain, q, here_R, here_p, J)
            pose_error(R, p, here_R, here_p, error)
    return float(left)


def starts(lower: FloatArray, upper: FloatArray, count: int = STARTS) -> FloatArray:
    """Starts (count, n) spread evenly over the joints' ranges, the first in their middle.

    The additive recurrence of M. Roberts, "The unreasonable effectiveness of quasirandom
    sequences", 2018: the generalised golden ratio in n dimensions.
    """
    size = lower.size
    ratio = 2.0
    for _ in range(60):
        ratio = (1.0 + ratio) ** (1.0 / (size + 1))
    fractions = (0.5 + np.outer(np.arange(count), ratio ** -np.arange(1.0, size + 1))) % 1.0
    spread: FloatArray = lower + fractions * (upper - lower)
    return spread


def solve_numerically(
    chain: Chain,
    lower: FloatArray,
    upper: FloatArray,
    R: FloatArray,
    p: FloatArray,
    count: int = STARTS,
) -> tuple[list[FloatArray], float]:
    """Configurations (n,) found for a flange pose, and the smallest pose error left.

    Not every solution need be among them, and equal ones may come several times. Angles are not
    brought into the limits.

    Args:
        count: how many starts are tried.
    """
    found: list[FloatArray] = []
    least = np.inf
    joints = np.arange(lower.size)
    for start in starts(lower, upper, count):
        left = approach(chain, start, R, p, COARSE, CLOSE)
        least = min(least, left)
        if left < 10 * CLOSE:
            q = np.empty_like(start)
            if track(chain, start, R, p, joints, q)[0]:
                found.append(q)
            elif approach(chain, start, R, p, FINE, SETTLED) < SETTLED:
                found.append(start)
    return found, least
