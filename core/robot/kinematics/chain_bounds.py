"""Compiled bounds of a chain's Jacobian, and of velocity products in its accelerations and jerks.

They hold wherever the joints are within a box about a known configuration.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from .chain import Chain
from .lean import inner


class ColumnBounds(NamedTuple):
    """Bounds for the K joints of a chain on a box.

    Args:
        linear, angular: (K,), lengths of the Jacobian's columns at the middle.
        lever: (K,), Λ.
        linear_change, angular_change: (K,), how much the columns differ from the middle's.
        linear_bent, angular_bent: (K,), likewise beyond first order.
    """

    linear: FloatArray
    angular: FloatArray
    lever: FloatArray
    linear_change: FloatArray
    angular_change: FloatArray
    linear_bent: FloatArray
    angular_bent: FloatArray


@inner
def turn_columns(
    chain: Chain,
    columns: FloatArray,
    inverse: FloatArray,
    turned: FloatArray,
    size_of: FloatArray,
) -> None:
    """Write how a chain's columns change with its joints, as seen through a matrix.

    With the columns (v_k, s_k), and a ≤ b the two joints m and k in the chain's order,

        ∂v_k/∂q_m = s_a × v_b,    ∂s_k/∂q_m = s_m × s_k where m < k, else 0.

    Args:
        chain: K joints.
        columns: (6, K).
        inverse: (6, 6), applied to every change.
        turned: (6, K, K), written: row, m, k.
        size_of: (6, K, K), written: absolute values.
    """
    size = chain.joint.size
    for a in range(size):
        s0, s1, s2 = columns[3, a], columns[4, a], columns[5, a]
        for b in range(a, size):
            v0, v1, v2 = columns[0, b], columns[1, b], columns[2, b]
            x, y, z = s1 * v2 - s2 * v1, s2 * v0 - s0 * v2, s0 * v1 - s1 * v0
            v0, v1, v2 = columns[3, b], columns[4, b], columns[5, b]
            u, v, w = s1 * v2 - s2 * v1, s2 * v0 - s0 * v2, s0 * v1 - s1 * v0
            for i in range(6):
                linear = inverse[i, 0] * x + inverse[i, 1] * y + inverse[i, 2] * z
                angular = inverse[i, 3] * u + inverse[i, 4] * v + inverse[i, 5] * w
                turned[i, b, a] = linear
                turned[i, a, b] = linear + angular
                size_of[i, b, a], size_of[i, a, b] = abs(linear), abs(linear + angular)


@inner
def bound_columns(chain: Chain, columns: FloatArray, rho: FloatArray, out: ColumnBounds) -> None:
    """Fill ``out`` for the box ``rho`` (N,) about the columns (6, K) at its middle.

    A joint turns the columns of the joints behind it, and the levers of those before it: products
    of derivatives by joints of which c is the last are no longer than the lever of c, so that

        |δv_k| ≤ Σ_m ρ_m Λ_max(m,k),             |δs_k| ≤ Σ_{m<k} ρ_m,

    and what is left beyond first order is bounded by

        Σ_{m,n} ρ_m ρ_n Λ_max(m,n,k) / 2,        (Σ_{m<k} ρ_m)² / 2.
    """
    size = chain.joint.size
    before = 0.0
    for k in range(size):
        if not chain.prismatic[k]:
            before += rho[chain.joint[k]]
    behind = bent = 0.0
    for k in range(size - 1, -1, -1):
        linear = angular = 0.0
        for i in range(3):
            linear += columns[i, k] ** 2
            angular += columns[3 + i, k] ** 2
        out.linear[k], out.angular[k] = np.sqrt(linear), np.sqrt(angular)
        # A slide's column joints behind it leave as it is.
        own = 0.0 if chain.prismatic[k] else 1.0
        reach = rho[chain.joint[k]]
        out.lever[k] = out.linear[k] + behind if own > 0.0 else 1.0
        out.linear_change[k], out.linear_bent[k] = own * behind, 0.5 * own * bent
        before -= own * reach
        behind += reach * out.lever[k]
        bent += reach * out.lever[k] * (2 * before + own * reach)
    before = 0.0
    for k in range(size):
        own = 0.0 if chain.prismatic[k] else 1.0
        turn = before + own * rho[chain.joint[k]]
        out.linear_change[k] += turn * out.lever[k]
        out.linear_bent[k] += 0.5 * turn**2 * out.lever[k]
        out.angular_change[k] = own * before
        out.angular_bent[k] = 0.5 * own * before**2
        before = turn


@inner
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
