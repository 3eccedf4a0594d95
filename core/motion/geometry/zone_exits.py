"""How far the TCP gets from a waypoint along a joint line, and by how much the tool turns.

That is what ends a zone of a joint move.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import jacobian, pose
from ...robot.kinematics.lean import inner, lean
from ...spatial.rotation import rotation_vector

Apart = tuple[float, FloatArray, FloatArray, float]
"""How far, in m or rad, its derivatives (N,) by the joints at the waypoint and at the line's other
end, the share held, and by the share; zero where it is none."""


@cache
def _scratch(size: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Arrays that the kernels of N = ``size`` axes write in."""
    return np.empty((3, 3)), np.empty((2, 3)), np.empty(size), np.empty((2, 6, size))


def first_exit(
    chain: Chain, q_wp: FloatArray, q_other: FloatArray, radius: float, limit: float
) -> float:
    """The smallest share of a joint line at which the TCP is ``radius`` from where it began.

    A bound on the TCP's speed makes each step of the search safe down to steps of 1e-4 of the
    line; bisection then finds the exit to rounding.

    Args:
        chain: the kinematics.
        q_wp, q_other: (N,), the waypoint and the line's other end.
        radius: m.
        limit: share at which the search ends.

    Returns:
        The share, or -1 if the TCP stays inside up to ``limit``.
    """
    return float(_first_exit(chain, q_wp, q_other, radius, limit, *_scratch(q_wp.size)[:3]))


@lean
def _first_exit(
    chain: Chain,
    q_wp: FloatArray,
    q_other: FloatArray,
    radius: float,
    limit: float,
    R: FloatArray,
    places: FloatArray,
    q: FloatArray,
) -> float:
    p0, p = places[0], places[1]
    pose(chain, q_wp, R, p0)
    arm, fastest = 0.0, 0.0
    # No joint carries the TCP further than the chain's links and slides are long together.
    for i in range(3):
        arm += chain.end_translation[i] ** 2
    arm = math.sqrt(arm)
    for k in range(chain.joint.size - 1, -1, -1):
        j = chain.joint[k]
        change = abs(q_other[j] - q_wp[j])
        if chain.prismatic[k]:
            arm += max(abs(q_wp[j]), abs(q_other[j]))
            fastest += change
        else:
            fastest += change * arm
        square = 0.0
        for i in range(3):
            square += chain.translation[k, i] ** 2
        arm += math.sqrt(square)
    if fastest == 0.0:
        return -1.0
    low, share, gap = 0.0, 0.0, radius
    while gap > 0.0:
        if share >= limit:
            return -1.0
        low = share
        share = min(limit, share + max(gap / fastest, 1e-4))
        gap = radius - _distance(chain, q_wp, q_other, share, q, R, p, p0)
        if share >= limit and gap > 0.0:
            return -1.0
    high = share
    for _ in range(100):
        middle = 0.5 * (low + high)
        gap = radius - _distance(chain, q_wp, q_other, middle, q, R, p, p0)
        if gap > 0.0:
            low = middle
        else:
            high = middle
        if high - low < 1e-15:
            break
    return 0.5 * (low + high)


@inner
def _distance(
    chain: Chain,
    q_wp: FloatArray,
    q_other: FloatArray,
    share: float,
    q: FloatArray,
    R: FloatArray,
    p: FloatArray,
    p0: FloatArray,
) -> float:
    for j in range(q.size):
        q[j] = (1 - share) * q_wp[j] + share * q_other[j]
    pose(chain, q, R, p)
    square = 0.0
    for i in range(3):
        square += (p[i] - p0[i]) ** 2
    return math.sqrt(square)


def tcp_apart(chain: Chain, q_wp: FloatArray, q_other: FloatArray, share: float) -> Apart:
    """How far the TCP is from the waypoint at a share of a joint line, and how that changes.

    Args:
        chain: the kinematics.
        q_wp, q_other: (N,), the waypoint and the line's other end.
        share: of the line.
    """
    slopes = np.zeros((2, q_wp.size))
    distance, speed = _tcp_apart(chain, q_wp, q_other, share, *_scratch(q_wp.size), slopes)
    return distance, slopes[0], slopes[1], speed


@lean
def _tcp_apart(
    chain: Chain,
    q_wp: FloatArray,
    q_other: FloatArray,
    share: float,
    R: FloatArray,
    places: FloatArray,
    q: FloatArray,
    columns: FloatArray,
    slopes: FloatArray,
) -> tuple[float, float]:
    """Distance and its slope by the share; writes those by the joints at both ends (2, N)."""
    p, p_wp, J, J_wp = places[0], places[1], columns[0], columns[1]
    for j in range(q.size):
        q[j] = (1 - share) * q_wp[j] + share * q_other[j]
    jacobian(chain, q_wp, R, p_wp, J_wp)
    jacobian(chain, q, R, p, J)
    square = 0.0
    for i in range(3):
        square += (p[i] - p_wp[i]) ** 2
    distance, speed = math.sqrt(square), 0.0
    if distance > 0.0:
        for j in range(q.size):
            there = at_waypoint = 0.0
            for i in range(3):
                there += (p[i] - p_wp[i]) / distance * J[i, j]
                at_waypoint += (p[i] - p_wp[i]) / distance * J_wp[i, j]
            slopes[0, j] = (1 - share) * there - at_waypoint
            slopes[1, j] = share * there
            speed += there * (q_other[j] - q_wp[j])
    return distance, speed


def first_turn(
    chain: Chain, q_wp: FloatArray, q_other: FloatArray, angle: float, limit: float
) -> float:
    """`first_exit` by the tool: the share at which it has turned by ``angle`` rad.

    No joint turns it faster than by itself, which makes each step of the search safe down to steps
    of 1e-4 of the line.
    """
    # An axis counts as often as it turns: followers may add to it.
    turns = np.bincount(chain.joint[~chain.prismatic], minlength=q_wp.size)
    fastest = float((turns * np.abs(q_other - q_wp)).sum())
    low = share = 0.0
    while True:
        gap = angle - tool_apart(chain, q_wp, q_other, share)[0]
        if gap <= 0.0:
            break
        if share >= limit or fastest == 0.0:
            return -1.0
        low, share = share, min(limit, share + max(gap / fastest, 1e-4))
    while share - low > 1e-15 * share:
        middle = 0.5 * (low + share)
        if middle in (low, share):
            break
        if tool_apart(chain, q_wp, q_other, middle)[0] < angle:
            low = middle
        else:
            share = middle
    return 0.5 * (low + share)


def tool_apart(chain: Chain, q_wp: FloatArray, q_other: FloatArray, share: float) -> Apart:
    """`tcp_apart` of the tool's orientation: the angle in rad between there and the waypoint."""
    q = (1 - share) * q_wp + share * q_other
    R, p, J = np.empty((2, 3, 3)), np.empty(3), np.empty((2, 6, q.size))
    jacobian(chain, q_wp, R[0], p, J[0])
    jacobian(chain, q, R[1], p, J[1])
    turn = rotation_vector(R[1] @ R[0].T)
    angle = float(np.linalg.norm(turn))
    if angle == 0.0:
        return 0.0, np.zeros(q.size), np.zeros(q.size), 0.0
    axis = turn / angle
    there = axis @ J[1, 3:]
    by_waypoint = (1 - share) * there - axis @ J[0, 3:]
    return angle, by_waypoint, share * there, float(there @ (q_other - q_wp))
