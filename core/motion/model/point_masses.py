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
from ...robot.kinematics.chain_kernels import (
    AXIS,
    COLUMNS,
    ORIGIN,
    RISE,
    SPEED,
    pull_acceleration,
    pull_velocity,
    recall,
    walk_motion,
    walk_speeds,
)
from ...robot.kinematics.lean import inner, lean
from ...robot.kinematics.vectors import Vector, cross, dot, load, scale, subtract
from ...robot.model import Robot
from ...spatial.pose import Pose


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
    loads = MassLoads(*(np.zeros(q.shape) for _ in range(3)))
    at, weight = _weights(robot, masses, key, q.shape[1])
    if len(at):
        states = (np.ascontiguousarray(array) for array in (q, dq, ddq))
        # No further down the chain than the last mass.
        walk = np.empty((int(at[-1]) + 1, COLUMNS, 3))
        _load(robot.chain, at, weight, np.array(robot.gravity), *states, *loads, walk)
    return loads


def pull_mass_loads(
    robot: Robot,
    masses: Sequence[tuple[int, tuple[float, ...]]],
    key: str,
    states: tuple[FloatArray, FloatArray, FloatArray],
    bars: MassLoads,
    out: tuple[FloatArray, FloatArray, FloatArray],
) -> None:
    """Reverse of `mass_loads`.

    Args:
        robot, masses, key: as there.
        states: q and its derivatives (M, N).
        bars: gradient with respect to the loads.
        out: gradients (M, N) with respect to q and its derivatives, added to.
    """
    at, weight = _weights(robot, masses, key, states[0].shape[1])
    if len(at):
        own = (np.ascontiguousarray(array) for array in states)
        _pull(robot.chain, at, weight, np.array(robot.gravity), *own, *bars, *out)


def _weights(
    robot: Robot, masses: Sequence[tuple[int, tuple[float, ...]]], key: str, size: int
) -> tuple[IntArray, FloatArray]:
    """Joints of the chain (B,), in order, with masses on their axes, and their weights (B, N)."""
    chain = robot.chain
    weight = np.zeros((len(chain.joint), size))
    for joint, weights in masses:
        if joint > robot.arm_size:
            raise InputError(f"{key}: {robot.name} has {robot.arm_size} joints, no joint {joint}")
        stages = [*robot.base_stages(), *robot.arm_stages(joint - 1)]
        before = sum(not isinstance(stage, Pose) for stage in stages)
        weight[before - len(robot.joint_stages(joint - 1))] += filled(weights, size)
    at = np.flatnonzero(weight.any(axis=1))
    return at, weight[at]


@lean
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
    walk: FloatArray,
) -> None:
    for m in range(q.shape[0]):
        walk_motion(chain, q[m], dq[m], ddq[m], walk)
        for b in range(at.size):
            end = at[b]
            speed, rise = recall(walk, end, SPEED), recall(walk, end, RISE)
            for k in range(end):
                j = chain.joint[k]
                share = weight[b, j]
                if share == 0.0:
                    continue
                lever = scale(share, _lever(chain, walk, k, end))
                along[m, j] += dot(lever, speed)
                across[m, j] += dot(lever, rise)
                held[m, j] += dot(lever, load(gravity))


@njit(cache=True, error_model="numpy")
def _pull(
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
    q_bar: FloatArray,
    dq_bar: FloatArray,
    ddq_bar: FloatArray,
) -> None:
    """Add the gradient of Σ_b (J u)·(J q') + (J w)·p'' + (J z)·g, each of a mass b, with u, w and
    z the bars times its weights."""
    rows = chain.joint.size + 1
    own, other = np.empty((rows, COLUMNS, 3)), np.empty((rows, COLUMNS, 3))
    force, rates, whole = np.zeros(6), np.empty(q.shape[1]), np.ones(q.shape[1])
    for m in range(q.shape[0]):
        walk_motion(chain, q[m], dq[m], ddq[m], own)
        for k in range(at[-1] + 1):
            for i in range(3):
                other[k, AXIS, i], other[k, ORIGIN, i] = own[k, AXIS, i], own[k, ORIGIN, i]
        for b in range(at.size):
            end = at[b]
            walk, moved = own[: end + 1], other[: end + 1]
            for j in range(rates.size):
                rates[j] = weight[b, j] * held[m, j]
            walk_speeds(chain, rates, moved)
            force[:3] = gravity
            pull_velocity(chain, moved, force, q_bar[m])
            for j in range(rates.size):
                rates[j] = weight[b, j] * along[m, j]
            walk_speeds(chain, rates, moved)
            force[:3] = walk[end, SPEED]
            pull_velocity(chain, moved, force, q_bar[m])
            force[:3] = moved[end, SPEED]
            pull_velocity(chain, walk, force, q_bar[m])
            _push(chain, walk, force, whole, dq_bar[m])
            for j in range(rates.size):
                rates[j] = weight[b, j] * across[m, j]
            walk_speeds(chain, rates, moved)
            force[:3] = walk[end, RISE]
            pull_velocity(chain, moved, force, q_bar[m])
            force[:3] = moved[end, SPEED]
            pull_acceleration(chain, walk, force, q_bar[m], dq_bar[m])
            _push(chain, walk, force, whole, ddq_bar[m])


@inner
def _push(
    chain: Chain, walk: FloatArray, force: FloatArray, weight: FloatArray, out: FloatArray
) -> None:
    """Add Jᵀ of a force at the end of a walk, each joint's share times its weight."""
    last = walk.shape[0] - 1
    for k in range(last):
        j = chain.joint[k]
        out[j] += weight[j] * dot(_lever(chain, walk, k, last), load(force))


@inner
def _lever(chain: Chain, walk: FloatArray, k: int, end: int) -> Vector:
    """How the origin in row ``end`` of a walk moves with joint k."""
    lever: Vector = recall(walk, k, AXIS)
    if not chain.prismatic[k]:
        lever = cross(lever, subtract(recall(walk, end, ORIGIN), recall(walk, k, ORIGIN)))
    return lever


def filled(values: tuple[float, ...], size: int) -> FloatArray:
    """(size,), the values and zeros behind them."""
    out = np.zeros(size)
    out[: len(values)] = values[:size]
    return out
