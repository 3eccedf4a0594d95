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

from ...arrays import FloatArray
from ...errors import InputError
from ...robot.model import Robot
from ..model.point_masses import MassLoads, filled, mass_loads, pull_mass_loads
from ..model.torque import Torque
from .torque_rows import Shares

_CARRIED = "torque.carried"


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
    loads = mass_loads(robot, _masses(torque), _CARRIED, q, dq, ddq)
    own, weight = np.array(torque.own), filled(torque.weight, count)
    a = own * dq[:, :count] + loads.along[:, :count]
    b = own * ddq[:, :count] + loads.across[:, :count]
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
    bars = MassLoads(*(np.zeros_like(q) for _ in range(3)))
    bars.along[:, :count], bars.across[:, :count] = bar.a, bar.b
    bars.held[:, :count] = -filled(torque.weight, count) * bar.h
    pull_mass_loads(robot, _masses(torque), _CARRIED, (q, dq, ddq), bars, out)


def _masses(torque: Torque) -> list[tuple[int, tuple[float, ...]]]:
    return [(mass.joint, mass.share) for mass in torque.carried]
