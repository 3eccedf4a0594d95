"""Compiled Newton inverse kinematics from a nearby guess, the other joints prescribed."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray
from .chain import Chain
from .chain_kernels import jacobian
from .lean import inner, lean
from .linear import solve_in_place
from .vectors import Vector, dot, load_row

TOLERANCE = 1e-12
"""m and rad of pose error at which tracking has converged."""
ITERATIONS = 50
LONGEST_STEP = 0.5
"""rad or m that one joint moves in one iteration, so that a far guess keeps its branch."""
SMALLEST_PIVOT = 1e-7
"""Below, the Newton step is damped instead."""


@lean
def rotation_error(target: FloatArray, current: FloatArray) -> Vector:
    """The rotation vector (rad, in base axes) that takes ``current`` to ``target``, both (3, 3)."""
    # E = target currentᵀ. No array: this is called for every sample of every path.
    a, b, c = load_row(target, 0), load_row(target, 1), load_row(target, 2)
    u, v, w = load_row(current, 0), load_row(current, 1), load_row(current, 2)
    x = 0.5 * (dot(c, v) - dot(b, w))
    y = 0.5 * (dot(a, w) - dot(c, u))
    z = 0.5 * (dot(b, u) - dot(a, v))
    cosine = 0.5 * (dot(a, u) + dot(b, v) + dot(c, w) - 1.0)
    sine = math.sqrt(x * x + y * y + z * z)
    if sine > 1e-6:
        factor = math.atan2(sine, cosine) / sine
        return factor * x, factor * y, factor * z
    if cosine > 0.0:
        return x, y, z
    # A half turn: E + 1 = 2 u uᵀ, of which the longest column is the best known.
    first, second, third = dot(a, u) + 1.0, dot(b, v) + 1.0, dot(c, w) + 1.0
    if first >= second and first >= third:
        axis = (first, dot(b, u), dot(c, u))
    elif second >= third:
        axis = (dot(a, v), second, dot(c, v))
    else:
        axis = (dot(a, w), dot(b, w), third)
    factor = math.pi / math.sqrt(max(dot(axis, axis), 1e-300))
    return factor * axis[0], factor * axis[1], factor * axis[2]


@njit(cache=True, error_model="numpy")
def least_step(
    J: FloatArray, joints: NDArray[np.int64], error: FloatArray, damping: float, step: FloatArray
) -> float:
    """Write the joint step of least norm that takes ``error`` away.

    Six joints solve J step = error, more J Jᵀ y = error with step = Jᵀ y, fewer the normal
    equations. With ``damping`` > 0 it is (Jᵀ J + damping²) step = Jᵀ error, for any number.

    Args:
        J: (6, N).
        joints: (n,) columns of J to use.
        error: (6,).
        damping: 0 or a length (m, rad per rad).
        step: (n,), written.

    Returns:
        The smallest pivot met (its square root for products of J): 0 at a singularity.
    """
    count = joints.size
    if count == 6 and damping == 0.0:
        A = np.empty((6, 6))
        for i in range(6):
            step[i] = error[i]
            for j in range(6):
                A[i, j] = J[i, joints[j]]
        return float(solve_in_place(A, step))
    if count > 6:
        y = error.copy()
        A = np.zeros((6, 6))
        for i in range(6):
            A[i, i] = damping * damping
            for j in range(6):
                for k in range(count):
                    A[i, j] += J[i, joints[k]] * J[j, joints[k]]
        pivot = solve_in_place(A, y)
        for k in range(count):
            step[k] = 0.0
            for i in range(6):
                step[k] += J[i, joints[k]] * y[i]
        return math.sqrt(pivot)
    A = np.zeros((count, count))
    for k in range(count):
        step[k] = 0.0
        A[k, k] = damping * damping
        for i in range(6):
            step[k] += J[i, joints[k]] * error[i]
            for j in range(count):
                A[k, j] += J[i, joints[k]] * J[i, joints[j]]
    return math.sqrt(solve_in_place(A, step))


@inner
def pose_error(
    target_R: FloatArray, target_p: FloatArray, R: FloatArray, p: FloatArray, error: FloatArray
) -> float:
    """Write the twist (6,) that takes pose R, p to the target; its length is returned."""
    error[3], error[4], error[5] = rotation_error(target_R, R)
    total = 0.0
    for i in range(3):
        error[i] = target_p[i] - p[i]
    for i in range(6):
        total += error[i] * error[i]
    return math.sqrt(total)


@njit(cache=True, error_model="numpy")
def track(
    chain: Chain,
    q_guess: FloatArray,
    R: FloatArray,
    p: FloatArray,
    arm_joints: NDArray[np.int64],
    q_out: FloatArray,
) -> tuple[bool, int, float]:
    """The configuration near a guess whose TCP has the pose R, p.

    Newton's method on the pose error (position, rotation vector); with more than six arm joints
    the step of least norm. Near singularities the step is damped, which still converges to a
    pose that can be reached.

    Args:
        chain: over N values.
        q_guess: (N,); values that are not the arm's are prescribed by it.
        R: (3, 3) rotation to reach.
        p: (3,) m position to reach.
        arm_joints: indices of the n values to find.
        q_out: (N,), written, may be ``q_guess``.

    Returns:
        Whether the error is below `TOLERANCE`, the number of iterations, and the smallest pivot
        of the Jacobian at the result (0 at a singularity).
    """
    J = np.empty((6, q_guess.size))
    here_R, here_p = np.empty((3, 3)), np.empty(3)
    error, step = np.empty(6), np.empty(arm_joints.size)
    for j in range(q_guess.size):
        q_out[j] = q_guess[j]
    pivot = 0.0
    for iteration in range(ITERATIONS):
        jacobian(chain, q_out, here_R, here_p, J)
        size = pose_error(R, p, here_R, here_p, error)
        pivot = least_step(J, arm_joints, error, 0.0, step)
        if size < TOLERANCE:
            # The step in hand is the last correction; near a singularity it is only noise.
            if pivot > SMALLEST_PIVOT:
                for k in range(arm_joints.size):
                    q_out[arm_joints[k]] += step[k]
            return True, iteration, pivot
        if not pivot > SMALLEST_PIVOT:
            least_step(J, arm_joints, error, max(1e-6, 0.1 * min(size, 1.0)), step)
        longest = 0.0
        for k in range(arm_joints.size):
            longest = max(longest, abs(step[k]))
        shorten = LONGEST_STEP / longest if longest > LONGEST_STEP else 1.0
        for k in range(arm_joints.size):
            q_out[arm_joints[k]] += shorten * step[k]
    return False, ITERATIONS, pivot
