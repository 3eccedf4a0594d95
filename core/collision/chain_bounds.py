"""Compiled bounds of a chain's Jacobian, and of velocity products in its accelerations and jerks.

They hold wherever the joints are within a box about a known configuration.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..robot.chain import Chain

FloatArray = NDArray[np.float64]


class Columns(NamedTuple):
    """Bounds for the K joints of a chain on a box.

    Args:
        linear, angular: (K,), lengths of the Jacobian's columns at the middle.
        lever: (K,), Λ.
        linear_change, angular_change: (K,), how much the columns differ from the middle's.
    """

    linear: FloatArray
    angular: FloatArray
    lever: FloatArray
    linear_change: FloatArray
    angular_change: FloatArray


@njit(cache=True, error_model="numpy")
def bound_columns(chain: Chain, columns: FloatArray, rho: FloatArray, out: Columns) -> None:
    """Fill ``out`` for the box ``rho`` (N,) about the columns (6, K) at its middle."""
    size = chain.joint.size
    behind = 0.0
    for k in range(size - 1, -1, -1):
        linear = angular = 0.0
        for i in range(3):
            linear += columns[i, k] ** 2
            angular += columns[3 + i, k] ** 2
        out.linear[k], out.angular[k] = np.sqrt(linear), np.sqrt(angular)
        out.lever[k] = 1.0 if chain.prismatic[k] else out.linear[k] + behind
        # What the joints behind k do to its lever; a slide's column they leave as it is.
        out.linear_change[k] = 0.0 if chain.prismatic[k] else behind
        behind += rho[chain.joint[k]] * out.lever[k]
    before = total = 0.0
    for k in range(size):
        turn = 0.0 if chain.prismatic[k] else rho[chain.joint[k]]
        out.linear_change[k] += before * out.lever[k]
        if not chain.prismatic[k]:
            out.linear_change[k] += turn * out.lever[k]
            out.angular_change[k] = before
        else:
            out.angular_change[k] = 0.0
        before += turn
        total += turn
    slack = 0.6 * total if total < 1.0 else np.inf
    for k in range(size):
        if not chain.prismatic[k]:
            out.angular_change[k] += slack


@njit(cache=True, error_model="numpy")
def bias(
    chain: Chain, lever: FloatArray, first: FloatArray, second: FloatArray, out: FloatArray
) -> None:
    """Bounds of what acceleration and jerk hold beside J q'' and J q'''.

    The point's place in the frame before joint k is that behind it, turned by exp(q S): its
    derivatives follow by Leibniz' rule from tip to base.

    Args:
        chain: K joints.
        lever: (K,).
        first, second: (N,), bounds of |q'| and |q''|.
        out: (4,), written: linear acceleration, angular, linear jerk, angular.
    """
    velocity = acceleration = omega = alpha = 0.0
    # Without the part J q'': what is left is the bias.
    bias_2 = bias_3 = spin_2 = spin_3 = 0.0
    for k in range(chain.joint.size - 1, -1, -1):
        d1, d2 = first[chain.joint[k]], second[chain.joint[k]]
        if chain.prismatic[k]:
            velocity += d1
            acceleration += d2
            continue
        square, cube = d1 * d1, 3 * d1 * d2 + d1**3
        bias_3 += 3 * d1 * acceleration + 3 * (d2 + square) * velocity + cube * lever[k]
        bias_2 += 2 * d1 * velocity + square * lever[k]
        acceleration += 2 * d1 * velocity + (d2 + square) * lever[k]
        velocity += d1 * lever[k]
        spin_3 += 2 * d1 * alpha + (d2 + square) * omega
        spin_2 += d1 * omega
        alpha += d1 * omega + d2
        omega += d1
    out[0], out[1], out[2], out[3] = bias_2, spin_2, bias_3, spin_3
