"""Notes on moves whose motion passes a limit between samples of the path."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import Note
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import motion
from ...robot.kinematics.lean import inner, lean
from ...robot.model import Robot
from ..geometry.quintic import basis, bends, slopes
from ..model.torque import Torque
from ..path.between_states import step_of
from ..path.tcp_samples import States
from ..timing.control_points import (
    most_acceleration,
    most_speed,
    most_tool_speed,
    slope_points,
)
from ..timing.limits import SegmentLimits
from ..timing.timed_zones import ROOM
from ..timing.timing import Timing
from ..timing.torque import shares_taken

_EXCESS = 1.004
"""Share of a limit from which on it is reported: between the places looked at, 1.005 at most."""
_EXCESS_NEARLY = 1.002
"""The same for the tool, where the cubic is looked at that its twist is near."""
_CLOSE = 0.8
"""Share below which peaks between the places looked at are none that pass a limit."""
_BENT = 0.416
"""How far a quartic is at most from the line between two of five even places, in multiples of the
greatest second difference there: found by maximising over the place and the three differences."""
_TOGETHER = 5000
"""Times at which torques are worked out in one go."""
_NEAR_SINGULAR = 0.01
"""Conditioning below which a singular configuration is what makes joints turn so unevenly."""
_FEW, _MANY = np.linspace(0.0, 1.0, 5), np.linspace(0.05, 0.95, 10)
"""Where all intervals are looked at, and those that may pass a limit; at the ends limits hold."""
_AT_FEW, _AT_MANY = (
    np.stack([basis(places), slopes(places), bends(places)], axis=1) for places in (_FEW, _MANY)
)


def excesses(timing: Timing, limits: SegmentLimits, axis_names: Sequence[str]) -> list[Note]:
    """Moves that pass a limit of velocity or acceleration, each with the one it passes most.

    Args:
        timing: the motion as stamped.
        limits: of the path's segments, as programmed.
        axis_names: of the N axes.
    """
    path, owner = timing.path, timing.interval_segments
    left = path.pieces.interval_samples
    most, row = np.zeros(len(owner)), np.full(len(owner), -1)
    # Zones that are blended in time have limits of their own, behind those of the segments.
    timed = timing.path_limits.timed.timed[path.pieces.interval_pieces]
    zoned = owner + np.where(timed, len(limits.velocity), 0)
    velocity = np.concatenate([limits.velocity, limits.velocity])
    acceleration = np.concatenate([limits.acceleration, ROOM * limits.acceleration])
    chains = path.route.chains
    turns = np.flatnonzero([a is not b for a, b in pairwise(chains)]) + 1
    edges = np.searchsorted(owner, np.concatenate([[0], turns, [len(chains)]]))
    for first, last in pairwise(edges):
        _shares(
            chains[owner[first]],
            timing.along.states,
            timing.along.spacing,
            timing.stamp.x,
            np.arange(first, last),
            left,
            zoned,
            velocity,
            acceleration,
            most,
            row,
        )
    names = [f"velocity of joint {name}" for name in axis_names]
    names += ["speed of the TCP", "rate of turn of the tool"]
    names += [f"acceleration of joint {name}" for name in axis_names]
    notes = []
    for segment in np.unique(owner[most > _EXCESS]):
        own = np.flatnonzero(owner == segment)
        k = int(own[np.argmax(most[own])])
        notes.append(
            Note(
                f"{names[row[k]]} reaches {100 * most[k]:.1f} % of its limit between samples of "
                f"the path, {_why(timing, k)}; treat the timing of this move with care",
                path.route.moves[int(segment)],
            )
        )
    return notes


def torques_taken(
    torque: Torque, robot: Robot, timing: Timing, t: FloatArray, move: IntArray
) -> FloatArray:
    """(M, L), the greatest shares of limits of torque on each move, at times t (T,) on it (T,).

    Those of the motion as stamped, and of intervals where much is taken at an end: where little is
    at both, it is not much more between.
    """
    taken = np.zeros((int(move.max()) + 1, len(torque.own)))
    close = _torques_at_ends(timing) > _CLOSE
    enters = np.zeros(len(t) + 1, dtype=np.int64)
    np.add.at(enters, np.searchsorted(t, timing.begin[close]), 1)
    np.subtract.at(enters, np.searchsorted(t, timing.end[close], side="right"), 1)
    inside = np.flatnonzero(np.cumsum(enters[:-1]) > 0)
    for first in range(0, len(inside), _TOGETHER):
        rows = inside[first : first + _TOGETHER]
        found = shares_taken(torque, robot, *timing.states_at(t[rows]))
        np.maximum.at(taken, move[rows], found)
    return taken


def _torques_at_ends(timing: Timing) -> FloatArray:
    """(K,), the greatest share of a limit of torque at the ends of each interval."""
    shares, left = timing.path_limits.shares, timing.path.pieces.interval_samples
    assert shares is not None
    most = np.empty(len(left))
    _fill_torques(*shares, left, timing.along.spacing, timing.stamp.x, most)
    return most


@lean
def _fill_torques(
    by_u: FloatArray,
    by_x: FloatArray,
    held: FloatArray,
    fade: FloatArray,
    left: IntArray,
    spacing: FloatArray,
    x: FloatArray,
    most: FloatArray,
) -> None:
    for k in range(left.size):
        u, greatest = (x[k + 1] - x[k]) / (2.0 * spacing[k]), 0.0
        for e in range(2):
            s = left[k] + e
            for j in range(held.shape[1]):
                taken = abs(by_u[s, j] * u + by_x[s, j] * x[k + e] + held[s, j])
                greatest = max(greatest, taken + fade[s, j] * x[k + e])
        most[k] = greatest


def torque_excesses(share: FloatArray, axis_names: Sequence[str]) -> list[Note]:
    """Moves on which a torque passes its limit, by the greatest shares on each, (M, L)."""
    notes = []
    for move in np.flatnonzero(share.max(axis=1) > _EXCESS):
        axis = int(np.argmax(share[move]))
        notes.append(
            Note(
                f"torque of joint {axis_names[axis]} reaches {100 * share[move, axis]:.1f} % of "
                "its limit between samples of the path; treat the timing of this move with care",
                int(move),
            )
        )
    return notes


def _why(timing: Timing, k: int) -> str:
    """What makes rates change so much within an interval."""
    path = timing.path
    left = path.pieces.interval_samples[k]
    piece = path.pieces.sample_pieces[left]
    if path.conditioning[left : left + 2].min() < _NEAR_SINGULAR:
        return "near a singular configuration"
    middle = 0.5 * (path.pieces.edge[piece] + path.pieces.edge[piece + 1])
    extent, at = path.layout.extent, path.layout.waypoint[1:-1, None]
    inside = (at - extent[:, :, 0] < middle) & (middle < at + extent[:, :, 1])
    if inside.any():
        return "in a zone"
    return "where joints turn unevenly along the line"


def _shares(
    chain: Chain,
    states: States,
    spacing: FloatArray,
    x: FloatArray,
    intervals: IntArray,
    left: IntArray,
    owner: IntArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    most: FloatArray,
    row: IntArray,
) -> None:
    """Write the greatest share of a limit that is taken within each of some intervals, and whose:
    N velocities of joints, of the TCP, of the tool's turn, N accelerations of joints."""
    axes = states.q.shape[1]
    state, twist = np.zeros((3, axes)), np.empty((2, 6))
    few, many = np.zeros((2 * axes + 2, _FEW.size)), np.zeros((2 * axes + 2, _MANY.size))
    limits = velocity, acceleration
    given = chain, states, spacing, x, intervals, left, owner, *limits, most, row
    _fill_shares(*given, _FEW, _AT_FEW, _MANY, _AT_MANY, state, twist, few, many)


@lean
def _fill_shares(
    chain: Chain,
    states: States,
    spacing: FloatArray,
    x: FloatArray,
    intervals: IntArray,
    left: IntArray,
    owner: IntArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    most: FloatArray,
    row: IntArray,
    at_few: FloatArray,
    weights_few: FloatArray,
    at_many: FloatArray,
    weights_many: FloatArray,
    state: FloatArray,
    twist: FloatArray,
    few: FloatArray,
    many: FloatArray,
) -> None:
    axes = states.q.shape[1]
    for n in range(intervals.size):
        k = intervals[n]
        s, own = left[k], (spacing[k], x[k], x[k + 1])
        limits = velocity[owner[k]], acceleration[owner[k]]
        if _keeps(states, s, *own, *limits):
            continue
        for m in range(at_few.size):
            z = at_few[m]
            _look(states, s, *own, z, weights_few[m], *limits, state, few[:, m])
            _twist_between(states, s, *own, z, twist[0])
            _look_at_tool(twist[0], limits[0], few[:, m])
        if not _may_pass(few):
            continue
        for m in range(at_many.size):
            _look(states, s, *own, at_many[m], weights_many[m], *limits, state, many[:, m])
            motion(chain, state[0], state[1], state[2], twist[0], twist[1])
            _look_at_tool(twist[0], limits[0], many[:, m])
        for j in range(2 * axes + 2):
            peak = _peak(many, j)
            if peak > most[k]:
                most[k], row[k] = peak, j


@inner
def _keeps(
    states: States,
    s: int,
    h: float,
    x0: float,
    x1: float,
    velocity: FloatArray,
    acceleration: FloatArray,
) -> bool:
    """Whether no limit can be passed in an interval."""
    axes = states.q.shape[1]
    keeps = True
    for j in range(axes):
        c = slope_points(states, s, j, step_of(states, s, j, h), h)
        # What is not a number keeps to nothing.
        keeps = keeps and most_speed(c, x0, x1) <= (_EXCESS * velocity[j]) ** 2
        keeps = keeps and most_acceleration(c, x0, x1, h) <= _EXCESS * acceleration[j]
    for part in range(2):
        most = most_tool_speed(states, s, part, h, x0, x1)
        keeps = keeps and most <= (_EXCESS_NEARLY * velocity[axes + part]) ** 2
    return keeps


@inner
def _look(
    states: States,
    s: int,
    h: float,
    x0: float,
    x1: float,
    z: float,
    weight: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    state: FloatArray,
    share: FloatArray,
) -> None:
    """Write position and rate of joints at a place z in an interval, and their shares of limits,
    with their sign; what weighs the samples' states for it is (3, 6)."""
    axes = states.q.shape[1]
    square, u = x0 + z * (x1 - x0), (x1 - x0) / (2 * h)
    pace = square**0.5
    for j in range(axes):
        step = step_of(states, s, j, h)
        value = states.q[s, j] + weight[0, 3] * step
        slope, bend = weight[1, 3] * step, weight[2, 3] * step
        for n in range(2):
            c = 3 * n
            v, a = h * states.dq[s + n, j], h * h * states.ddq[s + n, j]
            value += weight[0, c + 1] * v + weight[0, c + 2] * a
            slope += weight[1, c + 1] * v + weight[1, c + 2] * a
            bend += weight[2, c + 1] * v + weight[2, c + 2] * a
        slope, bend = slope / h, bend / (h * h)
        state[0, j], state[1, j] = value, slope * pace
        share[j] = slope * pace / velocity[j]
        share[axes + 2 + j] = (slope * u + bend * square) / acceleration[j]


@inner
def _twist_between(
    states: States, s: int, h: float, x0: float, x1: float, z: float, twist: FloatArray
) -> None:
    """Write the TCP's twist (6,) at a place z in an interval, by the cubic that has the samples'
    derivatives: enough to tell where to look closer."""
    rest, pace = 1.0 - z, (x0 + z * (x1 - x0)) ** 0.5
    w0, w1 = pace * rest * rest * (1.0 + 2.0 * z), pace * z * z * (1.0 + 2.0 * rest)
    c0, c1 = pace * h * z * rest * rest, -pace * h * z * z * rest
    for i in range(6):
        value = w0 * states.v[s, i] + w1 * states.v[s + 1, i]
        twist[i] = value + c0 * states.a[s, i] + c1 * states.a[s + 1, i]


@inner
def _look_at_tool(twist: FloatArray, velocity: FloatArray, share: FloatArray) -> None:
    """Write the shares of limits that a TCP's twist takes."""
    axes = velocity.size - 2
    for part in range(2):
        rate = 0.0
        for i in range(3 * part, 3 * part + 3):
            rate += twist[i] * twist[i]
        share[axes + part] = rate**0.5 / velocity[axes + part]


@inner
def _may_pass(share: FloatArray) -> bool:
    """Whether any row of values at a few even places may pass its limit anywhere between them.

    Accelerations of joints are quartics, which five places determine: none is farther from the
    line between two of them than `_BENT` of the greatest second difference. Speeds, which are
    slopes times the root of a line, are taken as if they were.
    """
    for j in range(share.shape[0]):
        peak = bent = 0.0
        for m in range(share.shape[1]):
            peak = max(peak, abs(share[j, m]))
            if 0 < m < share.shape[1] - 1:
                bent = max(bent, abs(share[j, m - 1] - 2.0 * share[j, m] + share[j, m + 1]))
        if peak + _BENT * bent > _EXCESS:
            return True
    return False


@inner
def _peak(share: FloatArray, j: int) -> float:
    """The greatest of a row's shares at places evenly apart, and of the parabolas through three."""
    peak = 0.0
    for m in range(share.shape[1]):
        peak = max(peak, abs(share[j, m]))
    if peak < _CLOSE:
        return peak
    for m in range(1, share.shape[1] - 1):
        before, here, behind = abs(share[j, m - 1]), abs(share[j, m]), abs(share[j, m + 1])
        bend = 2.0 * here - before - behind
        if here >= before and here >= behind and bend > 0.0:
            peak = max(peak, here + (behind - before) ** 2 / (8.0 * bend))
    return peak
