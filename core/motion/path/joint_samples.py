"""Compiled sampling of joint-space pieces, and its reverse."""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import (
    acceleration_gradient,
    jacobian,
    motion,
    velocity_gradient,
)
from ...robot.kinematics.lean import lean
from ..geometry.curves import Curves, evaluate, pull
from .tcp_samples import States


def sample_joint(
    chain: Chain, curves: Curves, piece: IntArray, sigma: FloatArray, states: States
) -> None:
    """Write the states at ``sigma`` (S,) on the curves ``piece`` (S,), D = N."""
    value = np.empty((3, states.q.shape[1]))
    _sample_joint(chain, curves, piece, sigma, states, np.empty((6, 4)), value)


@lean
def _sample_joint(
    chain: Chain,
    curves: Curves,
    piece: IntArray,
    sigma: FloatArray,
    states: States,
    basis: FloatArray,
    value: FloatArray,
) -> None:
    for k in range(sigma.size):
        evaluate(curves, piece[k], sigma[k], basis, value)
        for j in range(states.q.shape[1]):
            states.q[k, j], states.dq[k, j] = value[0, j], value[1, j]
            states.ddq[k, j] = value[2, j]
        motion(chain, states.q[k], states.dq[k], states.ddq[k], states.v[k], states.a[k])


@njit(cache=True, error_model="numpy")
def pull_joint(
    chain: Chain,
    curves: Curves,
    piece: IntArray,
    sigma: FloatArray,
    states: States,
    states_bar: States,
    gradient: Curves,
    sigma_bar: FloatArray,
) -> None:
    """Reverse of `sample_joint`; adds to ``gradient`` and ``sigma_bar`` (S,)."""
    size = states.q.shape[1]
    basis, value_bar = np.empty((6, 4)), np.empty((3, size))
    R, p, J = np.empty((3, 3)), np.empty(3), np.empty((6, size))
    for k in range(sigma.size):
        q, dq, ddq = states.q[k], states.dq[k], states.ddq[k]
        v_bar, a_bar = states_bar.v[k], states_bar.a[k]
        value_bar[0], value_bar[1] = states_bar.q[k], states_bar.dq[k]
        value_bar[2] = states_bar.ddq[k]
        moving = accelerating = False
        for i in range(6):
            moving = moving or v_bar[i] != 0.0
            accelerating = accelerating or a_bar[i] != 0.0
        if moving or accelerating:
            jacobian(chain, q, R, p, J)
        if moving:
            velocity_gradient(chain, q, dq, v_bar, value_bar[0])
            for j in range(size):
                for i in range(6):
                    value_bar[1, j] += J[i, j] * v_bar[i]
        if accelerating:
            acceleration_gradient(chain, q, dq, ddq, a_bar, value_bar[0], value_bar[1])
            for j in range(size):
                for i in range(6):
                    value_bar[2, j] += J[i, j] * a_bar[i]
        sigma_bar[k] += pull(curves, piece[k], sigma[k], basis, value_bar, gradient)
