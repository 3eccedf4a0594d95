"""Compiled sampling of joint-space pieces, and its reverse."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import (
    COLUMNS,
    motion,
    pull_acceleration,
    pull_rates,
    pull_velocity,
    walk_motion,
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
    value_bar, walk = np.empty((3, states.q.shape[1])), np.empty((chain.joint.size + 1, COLUMNS, 3))
    scratch = np.empty((6, 4)), value_bar, walk
    _pull_joint(chain, curves, piece, sigma, states, states_bar, *scratch, gradient, sigma_bar)


@lean
def _pull_joint(
    chain: Chain,
    curves: Curves,
    piece: IntArray,
    sigma: FloatArray,
    states: States,
    states_bar: States,
    basis: FloatArray,
    value_bar: FloatArray,
    walk: FloatArray,
    gradient: Curves,
    sigma_bar: FloatArray,
) -> None:
    for k in range(sigma.size):
        v_bar, a_bar = states_bar.v[k], states_bar.a[k]
        moving = accelerating = False
        for i in range(6):
            moving = moving or v_bar[i] != 0.0
            accelerating = accelerating or a_bar[i] != 0.0
        for j in range(value_bar.shape[1]):
            value_bar[0, j], value_bar[1, j] = states_bar.q[k, j], states_bar.dq[k, j]
            value_bar[2, j] = states_bar.ddq[k, j]
        if moving or accelerating:
            walk_motion(chain, states.q[k], states.dq[k], states.ddq[k], walk)
        if moving:
            pull_velocity(chain, walk, v_bar, value_bar[0])
            pull_rates(chain, walk, v_bar, value_bar[1])
        if accelerating:
            pull_acceleration(chain, walk, a_bar, value_bar[0], value_bar[1])
            pull_rates(chain, walk, a_bar, value_bar[2])
        sigma_bar[k] += pull(curves, piece[k], sigma[k], basis, value_bar, gradient)
