"""How far a log strays from an emulated motion: in space, and in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..core.errors import InputError
from ..core.motion.trajectory import Trajectory
from ..core.program.tool import Tool
from ..core.robot.model import Robot

FloatArray = NDArray[np.float64]

STILL = 1e-4
"""rad (m) from where a robot rests within which it counts as resting. Joint noise at rest is 30
µrad on the robots whose logs were seen, ABB's joint resolution 1.7 µrad."""


_CHUNK = 1024
"""Points looked at together; bounds the memory for pairs of points and pieces."""


@dataclass(frozen=True)
class Comparison:
    """A log beside an emulated motion.

    Args:
        deviation: (T,) m, distance of each log sample's TCP from the emulated path of the TCP.
        start, end: m, between the ends of both.
        moving: s, time in motion of the emulation, waits between moves included.
        logged_moving: s, the same of the log.
    """

    deviation: FloatArray
    start: float
    end: float
    moving: float
    logged_moving: float

    @property
    def cycle_time_ratio(self) -> float:
        """Emulated over logged time in motion."""
        return self.moving / self.logged_moving


def compare(
    robot: Robot, tool: Tool, t: FloatArray, q: FloatArray, emulated: Trajectory
) -> Comparison:
    """Compare a log with what was emulated for it.

    Args:
        robot: that moved.
        tool: robot-held, the same throughout the program.
        t: (T,) s, of the log.
        q: (T, N) rad.
        emulated: the emulated motion; its TCP is taken as straight between samples.

    Raises:
        InputError: the tool stands still, or the robot does in the log.
    """
    if not tool.robot_held:
        raise InputError("a log of a program with a stationary tool cannot be compared")
    tcp = tcp_positions(robot, tool, q)
    gaps = np.linalg.norm(tcp[[0, -1]] - emulated.position[[0, -1]], axis=1)
    return Comparison(
        distance_to_polyline(tcp, emulated.position),
        float(gaps[0]),
        float(gaps[1]),
        moving_time(emulated.t, emulated.q),
        moving_time(t, q),
    )


def tcp_positions(robot: Robot, tool: Tool, q: FloatArray) -> FloatArray:
    """TCP (T, 3) m in the world at configurations (T, N)."""
    rotation, position = robot.forward(q)
    return np.asarray(position + rotation @ np.array(tool.tcp.position))


def distance_to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    """Distances (P,) of points (P, 3) to a polyline with vertices (L, 3).

    Exact: a piece that comes nearer than the nearest vertex has its middle within that vertex'
    distance plus half the piece's own length.
    """
    moved = np.linalg.norm(np.diff(line, axis=0), axis=1) > 0
    line = line[np.concatenate([[True], moved])]
    distance = np.asarray(cKDTree(line).query(points)[0], dtype=float)
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    # Pieces of similar lengths together: a few long ones must not widen the search for all.
    octaves = np.floor(np.log2(lengths))
    for octave in np.unique(octaves):
        pieces = np.flatnonzero(octaves == octave)
        _lower_by_pieces(distance, points, line[pieces], line[pieces + 1])
    return distance


def _lower_by_pieces(
    distance: FloatArray, points: FloatArray, begin: FloatArray, end: FloatArray
) -> None:
    """Lower the distances (P,) of points to those from straight pieces, where these are nearer."""
    middles = cKDTree(0.5 * (begin + end))
    half = 0.5 * float(np.linalg.norm(end - begin, axis=1).max())
    for first in range(0, len(points), _CHUNK):
        rows = np.arange(first, min(first + _CHUNK, len(points)))
        near = middles.query_ball_point(points[rows], (distance[rows] + half) * (1 + 1e-12))
        counts = np.array([len(found) for found in near])
        if not counts.any():
            continue
        piece = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
        point = np.repeat(rows, counts)
        a = begin[piece]
        step, away = end[piece] - a, points[point] - a
        share = np.clip(np.sum(away * step, axis=1) / np.sum(step * step, axis=1), 0.0, 1.0)
        np.minimum.at(distance, point, np.linalg.norm(away - share[:, None] * step, axis=1))


def moving_time(t: FloatArray, q: FloatArray) -> float:
    """Time in s from leaving the first configuration to reaching the last one, within `STILL`.

    Raises:
        InputError: the robot never leaves.
    """
    away = np.abs(q - q[0]).max(axis=1) > STILL
    short = np.abs(q - q[-1]).max(axis=1) > STILL
    if not away.any() or not short.any():
        raise InputError(f"the robot stays within {STILL:g} rad of where it starts")
    left = int(np.argmax(away))
    arrived = len(t) - int(np.argmax(short[::-1]))
    if arrived <= left:
        raise InputError(f"the robot stays within {STILL:g} rad of where it starts")
    return float(t[arrived] - t[left - 1])
