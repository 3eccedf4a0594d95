"""What models of masses on the axes of an arm's joints share: what they ask of the joints before.

A mass b at p_b with Jacobian J_b asks the joints for J_bᵀ p̈_b, and holds J_bᵀ g at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...errors import InputError
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import carry, place, turned_by
from ...robot.kinematics.lean import lean
from ...robot.kinematics.vectors import UNTURNED, ZERO, add, cross, dot, load_row, scale, subtract
from ...robot.model import Robot


class MassLoads(NamedTuple):
    """What weighed masses ask of the joints, Σ_b diag(weight_b) J_bᵀ …, (M, N) each.

    Args:
        along: … ṗ_b.
        across: … p̈_b.
        held: … g.
    """

    along: FloatArray
    across: FloatArray
    held: FloatArray


def mass_loads(
    robot: Robot,
    masses: Sequence[tuple[int, tuple[float, ...]]],
    key: str,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
) -> MassLoads:
    """What masses ask of the joints, in one pass down the chain.

    Args:
        robot: the robot.
        masses: the joint of the arm, counted from one, on whose axis each is, and its weights for
            the joints before that.
        key: of the figure that names the joints, for the message.
        q, dq, ddq: (M, N), configurations and derivatives.

    Raises:
        InputError: the arm has no such joint.
    """
    size = q.shape[1]
    loads = MassLoads(*(np.zeros(q.shape) for _ in range(3)))
    chain = robot.chain
    weight = np.zeros((len(chain.joint), size))
    for joint, weights in masses:
        weight[_link(robot, joint, key)] += filled(weights, size)
    (at,) = np.nonzero(weight.any(axis=1))
    if len(at):
        states = (np.ascontiguousarray(array) for array in (q, dq, ddq))
        _load(chain, at, weight[at], np.array(robot.gravity), *states, *loads)
    return loads


@njit(cache=True, error_model="numpy")
def _load(
    chain: Chain,
    at: IntArray,
    weight: FloatArray,
    gravity: FloatArray,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    along: FloatArray,
    across: FloatArray,
    held: FloatArray,
) -> None:
    axes, origins = np.empty((at[-1], 3)), np.empty((at[-1], 3))
    for m in range(q.shape[0]):
        _load_one(
            chain,
            at,
            weight,
            gravity,
            q[m],
            dq[m],
            ddq[m],
            axes,
            origins,
            along[m],
            across[m],
            held[m],
        )


@lean
def _load_one(
    chain: Chain,
    at: IntArray,
    weight: FloatArray,
    gravity: FloatArray,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    axes: FloatArray,
    origins: FloatArray,
    along: FloatArray,
    across: FloatArray,
    held: FloatArray,
) -> None:
    turned, origin = UNTURNED, ZERO
    omega, alpha, speed, rise = ZERO, ZERO, ZERO, ZERO
    b = 0
    for k in range(at[-1] + 1):
        turned, step, axis = place(chain, k, turned)
        velocity, acceleration = carry(omega, alpha, step)
        origin, speed, rise = add(origin, step), add(speed, velocity), add(rise, acceleration)
        if k == at[b]:
            for i in range(k):
                j = chain.joint[i]
                lever = load_row(axes, i)
                if not chain.prismatic[i]:
                    lever = cross(lever, subtract(origin, load_row(origins, i)))
                along[j] += weight[b, j] * dot(lever, speed)
                across[j] += weight[b, j] * dot(lever, rise)
                held[j] += weight[b, j] * dot(lever, (gravity[0], gravity[1], gravity[2]))
            b += 1
            if b == at.size:
                return
        axes[k, 0], axes[k, 1], axes[k, 2] = axis
        origins[k, 0], origins[k, 1], origins[k, 2] = origin
        j = chain.joint[k]
        rate = scale(dq[j], axis)
        if chain.prismatic[k]:
            slide = scale(q[j], axis)
            velocity, acceleration = carry(omega, alpha, slide)
            origin, speed = add(origin, slide), add(speed, add(velocity, rate))
            rise = add(rise, add(acceleration, scale(2.0, cross(omega, rate))))
            rise = add(rise, scale(ddq[j], axis))
        else:
            turned = turned_by(chain, k, q[j], turned)
            alpha = add(alpha, add(scale(ddq[j], axis), cross(omega, rate)))
            omega = add(omega, rate)


def _link(robot: Robot, joint: int, key: str) -> int:
    """Where in the chain an arm's joint is, counted from one."""
    if joint > robot.arm_size:
        raise InputError(f"{key}: {robot.name} has {robot.arm_size} joints, no joint {joint}")
    return int(np.flatnonzero(robot.chain.joint == joint - 1)[0])


def chain_to_axis(robot: Robot, joint: int, key: str) -> Chain:
    """The chain from the world to the origin of an arm's joint, counted from one.

    Args:
        robot: the robot.
        joint: where the chain ends.
        key: of the figure that names the joint, for the message.

    Raises:
        InputError: the arm has no such joint.
    """
    chain, k = robot.chain, _link(robot, joint, key)
    return Chain(
        chain.rotation[:k],
        chain.translation[:k],
        chain.axis[:k],
        chain.prismatic[:k],
        chain.joint[:k],
        chain.sign[:k],
        np.eye(3),
        chain.translation[k],
    )


def filled(values: tuple[float, ...], size: int) -> FloatArray:
    """(size,), the values and zeros behind them."""
    out = np.zeros(size)
    out[: len(values)] = values[:size]
    return out
