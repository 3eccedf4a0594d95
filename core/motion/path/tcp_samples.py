"""Compiled sampling of TCP-space pieces through inverse kinematics, and its reverse.

At a sample the curves give the TCP's pose X, velocity V and acceleration A with respect to σ and
the prescribed axes (external ones, and the redundant joint of a seven-axis arm). The six other
joints follow from T(q) = X by Newton's method from a guess (see `tcp_walk`), and

    J q' = V,    J q'' + J̇ q' = A.

In reverse, w₂ = J⁻ᵀ q̄'' goes to A and −w₂ · (J q'' + J̇ q') is differentiated by q and q', then
w₁ = J⁻ᵀ q̄' likewise, and w₀ = J⁻ᵀ q̄ arrives at X.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numba.extending import register_jitable

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import (
    acceleration_gradient,
    jacobian,
    velocity_gradient,
)
from ...robot.kinematics.lean import inner
from ...robot.kinematics.linear import factor, solve, solve_transposed
from ...robot.kinematics.tracking import pose_error
from ...robot.kinematics.vectors import ZERO, add, cross, scale
from ..geometry.curves import Samples, TcpCurves, evaluate, pull
from ..geometry.orientation_curves import orientation, pull_orientation

_ITERATIONS = 30
CONVERGED = 1e-9
"""m and rad of pose error below which Newton's method has converged: one more step leaves nothing
of it, and rates follow from the Jacobian there."""
_EXACT = 1e-11
"""m and rad below which it stops: rates are those of the Jacobian one step before, and difference
quotients of what follows from them show what that is off."""
_LONGEST_STEP = 0.3
SINGULAR = 1e-8
"""Ratio of pivots of the Jacobian below which a sample counts as singular."""


class States(NamedTuple):
    """A path's samples.

    Args:
        q, dq, ddq: (S, N), configuration and derivatives with respect to σ.
        v, a: (S, 6), the TCP's linear and angular velocity and acceleration in the work object,
            with respect to σ.
    """

    q: FloatArray
    dq: FloatArray
    ddq: FloatArray
    v: FloatArray
    a: FloatArray

    @staticmethod
    def zeros(count: int, size: int) -> States:
        """``count`` samples of N = ``size`` axes."""
        q, dq, ddq = (np.zeros((count, size)) for _ in range(3))
        return States(q, dq, ddq, np.zeros((count, 6)), np.zeros((count, 6)))

    def rows(self, start: int, stop: int) -> States:
        """A view of some samples."""
        return States(*(array[start:stop] for array in self))


class Scratch(NamedTuple):
    """Arrays that the kernels reuse from sample to sample.

    Args:
        basis, value, turns, carried, turning: of the curves.
        goal_R, R, p, error: the pose wanted, that where the joints are, and the twist between.
        values: (K,), what the chain's joints stand at.
        columns: (6, K), the Jacobian by the chain's joints, whichever axis they belong to.
        joints: (K,), 0, 1, 2 …
        place: (N,), where a solved axis stands among them, -1 for the others.
        square, order, rhs: of the square system.
    """

    basis: FloatArray
    value: FloatArray
    turns: FloatArray
    carried: FloatArray
    turning: FloatArray
    goal_R: FloatArray
    R: FloatArray
    p: FloatArray
    error: FloatArray
    values: FloatArray
    columns: FloatArray
    joints: IntArray
    place: IntArray
    square: FloatArray
    order: IntArray
    rhs: FloatArray


@register_jitable
def make_scratch(size: int, prescribed: int, joints: int) -> Scratch:
    """Scratch for N = ``size`` axes, some of them prescribed, and K = ``joints`` of a chain."""
    return Scratch(
        np.empty((6, 4)),
        np.empty((3, 3)),
        np.empty((3, 6)),
        np.empty((3, prescribed)),
        np.empty((3, 3, 3)),
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty(3),
        np.empty(6),
        np.empty(joints),
        np.empty((6, joints)),
        np.arange(joints),
        np.empty(size, dtype=np.int64),
        np.empty((6, 6)),
        np.empty(6, dtype=np.int64),
        np.empty(6),
    )


@inner
def set_places(solved: IntArray, work: Scratch) -> None:
    """Say which axes (6,) are solved for."""
    work.place[:] = -1
    for j in range(6):
        work.place[solved[j]] = j


@inner
def columns_at(chain: Chain, q: FloatArray, work: Scratch) -> None:
    """Write pose and columns at q (N,)."""
    single = Chain(
        chain.rotation,
        chain.translation,
        chain.axis,
        chain.prismatic,
        work.joints,
        chain.sign,
        chain.end_rotation,
        chain.end_translation,
    )
    for k in range(chain.joint.size):
        work.values[k] = q[chain.joint[k]]
    jacobian(single, work.values, work.R, work.p, work.columns)


@inner
def approach(
    chain: Chain,
    solved: IntArray,
    goal_R: FloatArray,
    goal_p: FloatArray,
    q: FloatArray,
    work: Scratch,
) -> tuple[float, float]:
    """Newton's method from q (N,) to the pose; only the axes ``solved`` (6,) move.

    Returns:
        The last error (m and rad) before the final correction, and the conditioning (smallest
        over largest pivot) of the Jacobian, whose factors stand in ``work``.
    """
    columns, square, order, error = work.columns, work.square, work.order, work.error
    best = np.inf
    for _ in range(_ITERATIONS):
        columns_at(chain, q, work)
        best = pose_error(goal_R, goal_p, work.R, work.p, error)
        square[:, :] = 0.0
        for k in range(chain.joint.size):
            j = work.place[chain.joint[k]]
            if j >= 0:
                for row in range(6):
                    square[row, j] += columns[row, k]
        smallest, largest = factor(square, order, 6)
        conditioning = smallest / largest
        if conditioning < SINGULAR:
            return best, conditioning
        solve(square, order, error, 6)
        longest = 0.0
        for j in range(6):
            longest = max(longest, abs(error[j]))
        scale = min(1.0, _LONGEST_STEP / longest) if longest > 0.0 else 1.0
        for j in range(6):
            q[solved[j]] += scale * error[j]
        if best < _EXACT:
            return best, conditioning
    return best, conditioning


@inner
def aim(
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    k: int,
    sigma: float,
    states: States,
    row: int,
    work: Scratch,
) -> None:
    """Write what the curves of sample k ask for at ``sigma``: the TCP's pose into ``work``
    (``goal_R`` and row 0 of ``value``), its motion and the prescribed axes into ``row``."""
    evaluate(curves.position, samples.position[k], sigma, work.basis, work.value)
    evaluate(curves.turning, samples.turning[k], sigma, work.basis, work.turns)
    if prescribed.size > 0:
        evaluate(curves.prescribed, samples.prescribed[k], sigma, work.basis, work.carried)
    reference = curves.reference[samples.turning[k]]
    omega, alpha = orientation(reference, work.turns, work.turning, work.goal_R)
    q, v, a = states.q[row], states.v[row], states.a[row]
    for j in range(prescribed.size):
        q[prescribed[j]] = work.carried[0, j]
    for i in range(3):
        v[i], a[i] = work.value[1, i], work.value[2, i]
    v[3], v[4], v[5] = omega
    a[3], a[4], a[5] = alpha


@inner
def state_at(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    k: int,
    sigma: float,
    states: States,
    row: int,
    work: Scratch,
) -> tuple[float, float]:
    """Write the state at ``sigma`` on the curves of sample k into ``row``, whose q is a guess.

    What is solved for has been said by `set_places`.

    Returns:
        What Newton's method says (see `approach`).
    """
    aim(prescribed, curves, samples, k, sigma, states, row, work)
    q, dq, ddq = states.q[row], states.dq[row], states.ddq[row]
    error, pivots = approach(chain, solved, work.goal_R, work.value[0], q, work)
    if not (error < CONVERGED and pivots >= SINGULAR):
        return error, pivots
    v, a = states.v[row], states.a[row]
    _rates(chain, solved, prescribed, work.carried[1], v, dq, work)
    _take_bias(chain, dq, a, work)
    _rates(chain, solved, prescribed, work.carried[2], work.error, ddq, work)
    return error, pivots


@inner
def _take_bias(chain: Chain, dq: FloatArray, a: FloatArray, work: Scratch) -> None:
    """Write a − J̇ q' (6,) into ``work.error``.

    With the columns (v_k, s_k), how they change with the joints (`turn_columns`) gives

        J̇ q' = (Σ_k q_k' (2 ω_k + q_k' s_k) × v_k,  Σ_k q_k' ω_k × s_k),   ω_k = Σ_{m<k} q_m' s_m.
    """
    linear = angular = omega = ZERO
    for k in range(chain.joint.size):
        rate = dq[chain.joint[k]]
        axis = (work.columns[3, k], work.columns[4, k], work.columns[5, k])
        spin = scale(rate, axis)
        lever = (work.columns[0, k], work.columns[1, k], work.columns[2, k])
        twice = add(scale(2.0, omega), spin)
        linear = add(linear, cross(twice, scale(rate, lever)))
        angular = add(angular, cross(omega, spin))
        omega = add(omega, spin)
    x, y, z = linear
    work.error[0], work.error[1], work.error[2] = a[0] - x, a[1] - y, a[2] - z
    x, y, z = angular
    work.error[3], work.error[4], work.error[5] = a[3] - x, a[4] - y, a[5] - z


@inner
def _rates(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    given: FloatArray,
    twist: FloatArray,
    rates: FloatArray,
    work: Scratch,
) -> None:
    """Write the rates (N,) with J rates = twist and the prescribed ones given."""
    rates[:] = 0.0
    for j in range(prescribed.size):
        rates[prescribed[j]] = given[j]
    for i in range(6):
        work.rhs[i] = twist[i]
    if prescribed.size > 0:
        for k in range(chain.joint.size):
            if work.place[chain.joint[k]] < 0:
                for i in range(6):
                    work.rhs[i] -= work.columns[i, k] * rates[chain.joint[k]]
    solve(work.square, work.order, work.rhs, 6)
    for j in range(6):
        rates[solved[j]] = work.rhs[j]


@inner
def _push(
    J: FloatArray,
    square: FloatArray,
    order: IntArray,
    solved: IntArray,
    prescribed: IntArray,
    bar: FloatArray,
    w: FloatArray,
    given_bar: FloatArray,
) -> None:
    """Reverse of `_rates`: w = J⁻ᵀ of the solved part, and the prescribed rates' gradient."""
    for j in range(6):
        w[j] = bar[solved[j]]
    solve_transposed(square, order, w, 6)
    for j in range(prescribed.size):
        given_bar[j] = bar[prescribed[j]]
        for i in range(6):
            given_bar[j] -= J[i, prescribed[j]] * w[i]


@njit(cache=True, error_model="numpy")
def pull_tcp(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    states: States,
    states_bar: States,
    gradient: TcpCurves,
    sigma_bar: FloatArray,
) -> None:
    """Reverse of `state_at` at each of the samples.

    Args:
        chain, solved, prescribed, curves: as there.
        samples, states: the samples, and what stands there.
        states_bar: gradient with respect to the states; used as scratch.
        gradient: added to; its ``reference`` (P, 3, 3) gets in its first row the gradient of a
            left turn of each R_ref.
        sigma_bar: (S,), added to.
    """
    basis, value_bar = np.empty((6, 4)), np.empty((3, 3))
    turns, turns_bar = np.empty((3, 6)), np.empty((3, 6))
    carried_bar, scratch = np.empty((3, prescribed.size)), np.empty((3, 3, 3))
    size = states.q.shape[1]
    R, p, J = np.empty((3, 3)), np.empty(3), np.empty((6, size))
    square, order = np.empty((6, 6)), np.empty(6, dtype=np.int64)
    w = np.empty((3, 6))
    for k in range(samples.sigma.size):
        q, dq, ddq = states.q[k], states.dq[k], states.ddq[k]
        q_bar, dq_bar, ddq_bar = states_bar.q[k], states_bar.dq[k], states_bar.ddq[k]
        jacobian(chain, q, R, p, J)
        for i in range(6):
            for j in range(6):
                square[i, j] = J[i, solved[j]]
        factor(square, order, 6)
        _push(J, square, order, solved, prescribed, ddq_bar, w[2], carried_bar[2])
        acceleration_gradient(chain, q, dq, ddq, -w[2], q_bar, dq_bar)
        _push(J, square, order, solved, prescribed, dq_bar, w[1], carried_bar[1])
        velocity_gradient(chain, q, dq, -w[1], q_bar)
        _push(J, square, order, solved, prescribed, q_bar, w[0], carried_bar[0])
        for i in range(6):
            w[1, i] += states_bar.v[k, i]
            w[2, i] += states_bar.a[k, i]
        for order_ in range(3):
            for i in range(3):
                value_bar[order_, i] = w[order_, i]
        sigma = samples.sigma[k]
        t = samples.turning[k]
        sigma_bar[k] += pull(
            curves.position, samples.position[k], sigma, basis, value_bar, gradient.position
        )
        sigma_bar[k] += pull(
            curves.prescribed, samples.prescribed[k], sigma, basis, carried_bar, gradient.prescribed
        )
        evaluate(curves.turning, t, sigma, basis, turns)
        turns_bar[:, :] = 0.0
        turned = pull_orientation(
            curves.reference[t],
            turns,
            (w[0, 3], w[0, 4], w[0, 5]),
            (w[1, 3], w[1, 4], w[1, 5]),
            (w[2, 3], w[2, 4], w[2, 5]),
            scratch,
            turns_bar,
        )
        for i in range(3):
            gradient.reference[t, 0, i] += turned[i]
        sigma_bar[k] += pull(curves.turning, t, sigma, basis, turns_bar, gradient.turning)
