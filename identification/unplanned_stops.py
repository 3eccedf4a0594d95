"""Stops that a log shows where its program passes a zone.

A controller that has not planned the next move by the time the robot comes to a zone stops it at
the point (ABB's *corner path failure*). No program says where that happens, but the log does: the
TCP all but stands still near the point, where the emulation passes at speed. No fine point waits
there for the servos to be in position, so that it takes what commands need to come to rest alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..core.arrays import FloatArray
from ..core.motion.emulator.run import Run
from ..core.program.program import Program
from ..core.program.tool import FLANGE
from ..core.program.zone import Fine, Radius
from ..core.robot.model import Robot
from .alignment import Alignment
from .residuals import Residuals
from .tcp_path import tcp_positions

STILL = 0.1
"""Share of the emulated speed, times what it usually is in a log, below which a TCP all but stands
still."""
SAMPLES = 3
"""Samples in a row by which it does: jitter of stamps shortens one step or two."""
SLOWEST = 0.02
"""m/s below which an emulation tells no stop."""


def unplanned_stops(
    robot: Robot, driven: Run, alignment: Alignment, found: Residuals
) -> tuple[int, ...]:
    """Indices of the moves at whose end a log stands still although they have a zone.

    Args:
        robot: that moved.
        driven: the emulation.
        alignment: of the log with it.
        found: how far the log is from it.
    """
    places = _places(driven, alignment, found)
    moves, stops = driven.program.moves, []
    for segment, index in enumerate(driven.path.route.moves[:-1]):
        zone, tool = moves[index].zone, moves[index].tool
        if not isinstance(zone, Radius) or zone.tcp == 0.0 or not len(places):
            continue
        held = tool if tool.robot_held else FLANGE
        point = tcp_positions(robot, held, driven.path.route.ends.q[segment, 1:])
        if (np.linalg.norm(places - point, axis=1) < zone.tcp).any():
            stops.append(index)
    return tuple(stops)


def _places(driven: Run, alignment: Alignment, found: Residuals) -> FloatArray:
    """(P, 3) m, where the TCP of a log stands still and that of its emulation does not."""
    t = driven.trajectory.t
    if len(found.t) <= SAMPLES:
        return np.zeros((0, 3))
    middle = 0.5 * (alignment.time[1:] + alignment.time[:-1])
    emulated = np.interp(middle, t, np.linalg.norm(np.gradient(found.line, t, axis=0), axis=1))
    speed = np.linalg.norm(np.diff(found.tcp, axis=0), axis=1) / np.diff(found.t)
    moves = emulated > SLOWEST
    if not moves.any():
        return np.zeros((0, 3))
    share = speed / np.maximum(emulated, SLOWEST)
    still = moves & (share < STILL * np.median(share[moves]))
    begin = np.flatnonzero(np.lib.stride_tricks.sliding_window_view(still, SAMPLES).all(axis=1))
    return np.asarray(found.tcp[begin + SAMPLES // 2])


def with_stops(program: Program, moves: tuple[int, ...]) -> Program:
    """A program that stops at the end of some of its moves, as no program says."""
    return program.with_moves(
        tuple(
            replace(move, zone=Fine(programmed=False)) if index in moves else move
            for index, move in enumerate(program.moves)
        )
    )
