"""How far the TCP gets from a waypoint along a joint line, and by how much the tool turns.

That is what ends a zone of a joint move.
"""

from __future__ import annotations

import math

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import jacobian, pose
from ...robot.kinematics.lean import inner, lean
from ...spatial.rotation import rotation_vector

Apart = tuple[float, FloatArray, FloatArray]
"""How far, in m or rad, and its derivatives by the joints there and at the waypoint."""


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
    scratch = np.empty((2, 3)), np.empty(q_wp.size)
    return float(_first_exit(chain, q_wp, q_other, radius, limit, np.empty((3, 3)), *scratch))


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
    """How far the TCP is from the waypoint at a share of a joint line, and how fast that changes.

    Args:
        chain: the kinematics.
        q_wp, q_other: (N,), the waypoint and the line's other end.
        share: of the line.

    Returns:
        The distance, m, and its derivatives (N,) with respect to the joints there and at the
        waypoint; zero where the distance is.
    """
    size = q_wp.size
    pull, pull_wp = np.zeros(size), np.zeros(size)
    q = (1 - share) * q_wp + share * q_other
    J, R = np.empty((2, 6, size)), np.empty((3, 3))
    distance = _tcp_apart(chain, q_wp, q, R, np.empty((2, 3)), J, pull, pull_wp)
    return float(distance), pull, pull_wp


@lean
def _tcp_apart(
    chain: Chain,
    q_wp: FloatArray,
    q: FloatArray,
    R: FloatArray,
    places: FloatArray,
    columns: FloatArray,
    pull: FloatArray,
    pull_wp: FloatArray,
) -> float:
    p, p_wp, J, J_wp = places[0], places[1], columns[0], columns[1]
    size = q.size
    jacobian(chain, q_wp, R, p_wp, J_wp)
    jacobian(chain, q, R, p, J)
    square = 0.0
    for i in range(3):
        square += (p[i] - p_wp[i]) ** 2
    distance = math.sqrt(square)
    if distance > 0.0:
        for j in range(size):
            for i in range(3):
                pull[j] += (p[i] - p_wp[i]) / distance * J[i, j]
                pull_wp[j] += (p[i] - p_wp[i]) / distance * J_wp[i, j]
    return distance


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
        return 0.0, np.zeros(q.size), np.zeros(q.size)
    axis = turn / angle
    return angle, axis @ J[1, 3:], axis @ J[0, 3:]
