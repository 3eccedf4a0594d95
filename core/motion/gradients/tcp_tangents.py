"""Compiled: how configurations on TCP-space curves change along directions, through inverse
kinematics. K directions are the last axis.

At a place T(q) = X, so that J q̇ = Ẋ; with the other axes prescribed the six that are solved for
follow. States with their derivatives along σ change by as many reverse passes (`pull_tcp`) as they
have numbers: that is for the few edges of corners that are blended in joint space.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import jacobian
from ...robot.kinematics.linear import factor, solve
from ..geometry.curves import Curves, CurveTangents, Samples, TcpCurves, evaluate, push
from ..geometry.orientation_curves import orientation
from ..path.tcp_samples import SINGULAR, States, pull_tcp
from .curve_tangents import TcpCurvesTangents


@njit(cache=True, error_model="numpy")
def push_values(
    curves: Curves,
    piece: IntArray,
    sigma: FloatArray,
    tangents: CurveTangents,
    sigma_dot: FloatArray,
    value_dot: FloatArray,
) -> None:
    """Write how values on joint-space curves change.

    Args:
        curves: the curves.
        piece, sigma: (L,), which of them, and where.
        tangents: of the curves.
        sigma_dot: (L, K).
        value_dot: (L, D, K), written.
    """
    basis = np.empty((6, 4))
    for k in range(sigma.size):
        push(curves, piece[k], sigma[k], basis, tangents, sigma_dot[k], value_dot[k])


@njit(cache=True, error_model="numpy")
def push_tcp(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    q: FloatArray,
    tangents: TcpCurvesTangents,
    sigma_dot: FloatArray,
    q_dot: FloatArray,
) -> None:
    """Write how configurations change; where the arm is singular they are left as they are.

    Args:
        chain, solved, prescribed, curves: as in `state_at`.
        samples: L places.
        q: (L, N), the configurations there.
        tangents: of the curves.
        sigma_dot: (L, K), how σ of the places changes.
        q_dot: (L, N, K), written.
    """
    size = sigma_dot.shape[1]
    basis, scratch, R = np.empty((6, 4)), np.empty((3, 3, 3)), np.empty((3, 3))
    turns, by_turns = np.empty((3, 6)), np.empty((3, 6))
    moved, turned = np.empty((3, size)), np.empty((6, size))
    carried = np.empty((prescribed.size, size))
    p, J = np.empty(3), np.empty((6, q.shape[1]))
    square, order, twist = np.empty((6, 6)), np.empty(6, dtype=np.int64), np.empty(6)
    for s in range(samples.sigma.size):
        sigma, t = samples.sigma[s], samples.turning[s]
        jacobian(chain, q[s], R, p, J)
        for i in range(6):
            for j in range(6):
                square[i, j] = J[i, solved[j]]
        smallest, largest = factor(square, order, 6)
        if not smallest >= SINGULAR * largest:
            continue
        push(
            curves.position,
            samples.position[s],
            sigma,
            basis,
            tangents.position,
            sigma_dot[s],
            moved,
        )
        push(
            curves.prescribed,
            samples.prescribed[s],
            sigma,
            basis,
            tangents.prescribed,
            sigma_dot[s],
            carried,
        )
        push(curves.turning, t, sigma, basis, tangents.turning, sigma_dot[s], turned)
        evaluate(curves.turning, t, sigma, basis, turns)
        # A small turn of R by a change of A and B is the ω that A' and B' give.
        for c in range(6):
            turns[1:] = 0.0
            turns[1, c] = 1.0
            omega, _ = orientation(curves.reference[t], turns, scratch, R)
            by_turns[0, c], by_turns[1, c], by_turns[2, c] = omega
        for k in range(size):
            for i in range(3):
                twist[i], twist[3 + i] = moved[i, k], tangents.reference[t, i, k]
                for c in range(6):
                    twist[3 + i] += by_turns[i, c] * turned[c, k]
            for j in range(prescribed.size):
                q_dot[s, prescribed[j], k] = carried[j, k]
                for i in range(6):
                    twist[i] -= J[i, prescribed[j]] * carried[j, k]
            solve(square, order, twist, 6)
            for j in range(6):
                q_dot[s, solved[j], k] = twist[j]


@njit(cache=True, error_model="numpy")
def push_state(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    sample: Samples,
    state: States,
    tangents: TcpCurvesTangents,
    sigma_dot: FloatArray,
    state_dot: FloatArray,
) -> None:
    """Write how one state changes: configuration and two derivatives along σ.

    Args:
        chain, solved, prescribed, curves: as in `state_at`.
        sample, state: of one place.
        tangents: of the curves.
        sigma_dot: (K,).
        state_dot: (3, N, K), written.
    """
    size = state.q.shape[1]
    bar = States(
        np.zeros((1, size)),
        np.zeros((1, size)),
        np.zeros((1, size)),
        np.zeros((1, 6)),
        np.zeros((1, 6)),
    )
    sigma_bar = np.zeros(1)
    position, turning, reference, prescribes = (
        curves.position,
        curves.turning,
        curves.reference,
        curves.prescribed,
    )
    gradient = TcpCurves(
        _no_gradient(position),
        _no_gradient(turning),
        np.zeros_like(reference),
        _no_gradient(prescribes),
    )
    t = sample.turning[0]
    for order in range(3):
        for j in range(size):
            bar.q[:], bar.dq[:], bar.ddq[:] = 0.0, 0.0, 0.0
            if order == 0:
                bar.q[0, j] = 1.0
            elif order == 1:
                bar.dq[0, j] = 1.0
            else:
                bar.ddq[0, j] = 1.0
            sigma_bar[0] = 0.0
            pull_tcp(chain, solved, prescribed, curves, sample, state, bar, gradient, sigma_bar)
            out = state_dot[order, j]
            for k in range(out.size):
                out[k] = sigma_bar[0] * sigma_dot[k]
                for i in range(3):
                    out[k] += gradient.reference[t, 0, i] * tangents.reference[t, i, k]
            gradient.reference[t] = 0.0
            _contract(gradient.position, sample.position[0], tangents.position, out)
            _contract(gradient.turning, t, tangents.turning, out)
            _contract(gradient.prescribed, sample.prescribed[0], tangents.prescribed, out)


@njit(cache=True, error_model="numpy")
def _no_gradient(curves: Curves) -> Curves:
    return Curves(
        curves.kind,
        np.zeros_like(curves.window),
        np.zeros_like(curves.control),
        np.zeros_like(curves.angle),
        np.zeros_like(curves.coefficients),
    )


@njit(cache=True, error_model="numpy")
def _contract(gradient: Curves, piece: int, tangents: CurveTangents, out: FloatArray) -> None:
    """Add a curve's gradient times its tangents to (K,), and clear the gradient."""
    window, control = gradient.window[piece], gradient.control[piece]
    for k in range(out.size):
        total = gradient.angle[piece] * tangents.angle[piece, k]
        for i in range(window.size):
            total += window[i] * tangents.window[piece, i, k]
        for i in range(control.shape[0]):
            for d in range(control.shape[1]):
                total += control[i, d] * tangents.control[piece, i, d, k]
        out[k] += total
    window[:] = 0.0
    control[:] = 0.0
    gradient.angle[piece] = 0.0
