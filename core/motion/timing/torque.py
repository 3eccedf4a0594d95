"""Limits of torque: what joints can accelerate by depends on posture, speed and each other.

A controller that knows its arm's dynamics accelerates as its motors allow. The share of its limit
that a joint takes is

    T = diag(own) q̈ + Σ_b diag(carried_b) J_bᵀ (p̈_b - diag(weight) g),    |T| ≤ 1 - diag(fade) q̇²,

each b a point mass on the axis of one of the arm's joints, at p_b with Jacobian J_b; p̈_b contains
the centrifugal and Coriolis terms, g is gravity. ``own`` is what does not depend on the posture:
the motor's own inertia behind its gear. A joint whose weight is balanced by a spring has no
``weight``; motors have the less torque the faster they run. Along a path q(ℓ), with u = ℓ̈ and
x = ℓ̇², T = a u + b x + h and q̇² = q'² x, so that all of it is linear in u and x (Bobrow, Dubowsky
and Gibson, "Time-optimal control of robotic manipulators along specified paths", Int. J. Robotics
Research 4(3), 1985).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ...errors import InputError
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import (
    acceleration_gradient,
    jacobians,
    motions,
    velocity_gradient,
)
from ...robot.model import Robot
from ..model.point_masses import chain_to_axis, filled, mass_loads
from ..model.torque import Borne, Torque
from .torque_rows import Shares


def torque_shares(
    torque: Torque, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray
) -> Shares:
    """Shares on a path at configurations (S, N) with derivatives with respect to ℓ.

    Raises:
        InputError: the arm has fewer joints.
    """
    count = len(torque.own)
    if count > robot.arm_size:
        raise InputError(f"torque.own_s2: {robot.name} has {robot.arm_size} joints, not {count}")
    masses = [(mass.joint, mass.share) for mass in torque.carried]
    loads = mass_loads(robot, masses, "torque.carried", q, dq, ddq)
    own, weight = np.array(torque.own), filled(torque.weight, count)
    a, b = (
        own * dq[:, :count] + loads.along[:, :count],
        own * ddq[:, :count] + loads.across[:, :count],
    )
    h = -weight * loads.held[:, :count]
    fade = filled(torque.fade, count) * dq[:, :count] ** 2
    return Shares(a, b, h, fade)


def shares_taken(
    torque: Torque, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray
) -> FloatArray:
    """Shares (T, L) that a motion takes at configurations, velocities and accelerations, with
    what is lost to speed; one is the limit."""
    _, inertial, weight, fade = torque_shares(torque, robot, q, dq, ddq)
    return np.abs(inertial + weight) + fade


def pull_torque_shares(
    torque: Torque,
    robot: Robot,
    path: tuple[FloatArray, FloatArray, FloatArray],
    bar: Shares,
    out: tuple[FloatArray, FloatArray, FloatArray],
) -> None:
    """Reverse of `torque_shares`.

    Args:
        torque: the limits.
        robot: that drives it.
        path: q and its derivatives (S, N).
        bar: gradient with respect to the shares.
        out: gradients (S, N) with respect to q and its derivatives, added to.
    """
    q, dq, ddq = (np.ascontiguousarray(array) for array in path)
    count, own = len(torque.own), np.array(torque.own)
    out[1][:, :count] += own * bar.a
    out[1][:, :count] += 2 * filled(torque.fade, count) * dq[:, :count] * bar.fade
    out[2][:, :count] += own * bar.b
    weight, gravity = filled(torque.weight, count), np.array(robot.gravity)
    for mass in torque.carried:
        chain, share = _at(torque, robot, mass)
        seeds = [np.zeros_like(q) for _ in range(3)]
        for seed, part in zip(seeds, (bar.a, bar.b, -weight * bar.h), strict=True):
            seed[:, :count] = share * part
        _pull_mass(chain, q, dq, ddq, gravity, seeds[0], seeds[1], seeds[2], *out)


def _at(torque: Torque, robot: Robot, mass: Borne) -> tuple[Chain, FloatArray]:
    chain = chain_to_axis(robot, mass.joint, "torque.carried")
    return chain, filled(mass.share, len(torque.own))


@njit(cache=True, error_model="numpy")
def _pull_mass(
    chain: Chain,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    gravity: FloatArray,
    along: FloatArray,
    across: FloatArray,
    held: FloatArray,
    q_bar: FloatArray,
    dq_bar: FloatArray,
    ddq_bar: FloatArray,
) -> None:
    """Add the gradient of Σ (J along)·(J q') + (J across)·p'' + (J held)·g to that of the path."""
    size = q.shape[1]
    w = np.zeros(6)
    J = jacobians(chain, q)
    v, pull = motions(chain, q, dq, ddq)
    for s in range(q.shape[0]):
        w[:3] = v[s, :3]
        velocity_gradient(chain, q[s], along[s], w, q_bar[s])
        w[:3] = pull[s, :3]
        velocity_gradient(chain, q[s], across[s], w, q_bar[s])
        w[:3] = gravity
        velocity_gradient(chain, q[s], held[s], w, q_bar[s])
        for i in range(3):
            w[i] = 0.0
            for j in range(size):
                w[i] += J[s, i, j] * along[s, j]
        velocity_gradient(chain, q[s], dq[s], w, q_bar[s])
        for j in range(size):
            dq_bar[s, j] += J[s, 0, j] * w[0] + J[s, 1, j] * w[1] + J[s, 2, j] * w[2]
        for i in range(3):
            w[i] = 0.0
            for j in range(size):
                w[i] += J[s, i, j] * across[s, j]
        acceleration_gradient(chain, q[s], dq[s], ddq[s], w, q_bar[s], dq_bar[s])
        for j in range(size):
            ddq_bar[s, j] += J[s, 0, j] * w[0] + J[s, 1, j] * w[1] + J[s, 2, j] * w[2]
