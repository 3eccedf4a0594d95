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
_EXACT = 4e-16
"""Share of a line, or of what the TCP makes on it at most, to which an exit is found."""
_SHARE = -1.0
"""In the place of a radius: the share is known."""
Exit = tuple[float, FloatArray, FloatArray, float]
"""The share of a line at which a zone ends, −1 where it does not; its derivatives (N,) by joints
at the waypoint and at the other end; and how fast the line leaves the zone there, by the
share, without which there are none."""


@cache
def _scratch(size: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Arrays that the kernels of N = ``size`` axes write in."""
    return np.empty((3, 3)), np.empty((2, 3)), np.empty(size), np.empty((2, 6, size))


def first_exit(
    chain: Chain, q_wp: FloatArray, q_other: FloatArray, radius: float, limit: float
) -> Exit:
    """The smallest share of a joint line at which the TCP is ``radius`` from where it began.

    A bound on the TCP's speed makes each step of the search safe down to steps of 1e-4 of the
    line; then the exit is found to rounding between two of them.

    Args:
        chain: the kinematics.
        q_wp, q_other: (N,), the waypoint and the line's other end.
        radius: m.
        limit: share at which the search ends.
    """
    line = np.array([q_wp, q_other])
    (found,), (slopes,) = _leave(chain, line[None], radius, limit)
    share, _, speed = found.tolist()
    if speed > 0.0:
        slopes /= -speed
    return share, slopes[0], slopes[1], speed


def ways(chain: Chain, q: FloatArray, share: float) -> tuple[FloatArray, FloatArray]:
    """How far the TCP gets along joint lines, from either end of each.

    Args:
        chain: the kinematics.
        q: (M, 2, N), the lines' ends.
        share: of the line.

    Returns:
        Distances (M, 2) in m from the ends, and their derivatives (M, 2, 2, N) by the joints at
        that end and at the other.
    """
    lines = np.stack([q, q[:, ::-1]], axis=1)
    found, slopes = _leave(chain, lines.reshape(-1, *q.shape[1:]), _SHARE, share)
    return found[:, 1].reshape(-1, 2), slopes.reshape(lines.shape)


def _leave(
    chain: Chain, lines: FloatArray, radius: float, limit: float
) -> tuple[FloatArray, FloatArray]:
    """Where the TCP is ``radius`` from where lines (L, 2, N) begin, up to the share ``limit``.

    Returns:
        (L, 3), the share (−1 where it is nowhere), the distance, and how fast that grows by the
        share; (L, 2, N), its derivatives by the joints at both ends.
    """
    found, slopes = np.zeros((len(lines), 3)), np.zeros(lines.shape)
    _fill_exits(chain, lines, radius, limit, *_scratch(lines.shape[2]), found, slopes)
    return found, slopes


@lean
def _fill_exits(
    chain: Chain,
    lines: FloatArray,
    radius: float,
    limit: float,
    R: FloatArray,
    places: FloatArray,
    q: FloatArray,
    columns: FloatArray,
    found: FloatArray,
    slopes: FloatArray,
) -> None:
    for k in range(lines.shape[0]):
        begin, end, share = lines[k, 0], lines[k, 1], limit
        if radius >= 0.0:
            share = _first_exit(chain, begin, end, radius, limit, R, places, q)
        found[k, 0] = share
        if share >= 0.0:
            found[k, 1], found[k, 2] = _tcp_apart(
                chain, begin, end, share, R, places, q, columns, slopes[k]
            )


@inner
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
    low, share, gap_low, gap = 0.0, 0.0, radius, radius
    while gap > 0.0:
        if share >= limit:
            return -1.0
        low, gap_low = share, gap
        share = min(limit, share + max(gap / fastest, 1e-4))
        gap = radius - _distance(chain, q_wp, q_other, share, q, R, p, p0)
        if share >= limit and gap > 0.0:
            return -1.0
    # Regula falsi; of the end that stays a second time half the gap counts (Illinois).
    high, gap_high, stays = share, gap, 0
    for _ in range(100):
        middle = low + (high - low) * gap_low / (gap_low - gap_high)
        if not low < middle < high:
            middle = 0.5 * (low + high)
        gap = radius - _distance(chain, q_wp, q_other, middle, q, R, p, p0)
        if abs(gap) < _EXACT * fastest or high - low < _EXACT:
            return middle
        if gap > 0.0:
            low, gap_low = middle, gap
            gap_high *= 0.5 if stays == 1 else 1.0
            stays = 1
        else:
            high, gap_high = middle, gap
            gap_low *= 0.5 if stays == -1 else 1.0
            stays = -1
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


@inner
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
) -> Exit:
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
            return -1.0, np.zeros(q_wp.size), np.zeros(q_wp.size), 0.0
        low, share = share, min(limit, share + max(gap / fastest, 1e-4))
    while share - low > 1e-15 * share:
        middle = 0.5 * (low + share)
        if middle in (low, share):
            break
        if tool_apart(chain, q_wp, q_other, middle)[0] < angle:
            low = middle
        else:
            share = middle
    share = 0.5 * (low + share)
    _, by_near, by_far, speed = tool_apart(chain, q_wp, q_other, share)
    if speed > 0.0:
        by_near, by_far = by_near / -speed, by_far / -speed
    return share, by_near, by_far, speed


def tool_apart(chain: Chain, q_wp: FloatArray, q_other: FloatArray, share: float) -> Apart:
    """By how much the tool is turned at a share of a joint line from how it is at the waypoint, and
    how that changes: see `Apart`."""
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
