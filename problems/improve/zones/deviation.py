"""How far smoothing in time takes the links off each segment."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.deviation.bounds import Deviation, by_interval
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run

_TOGETHER = 100
"""Segments that are looked at together."""


def segment_deviations(controller: Controller, run: Run, moves: Sequence[int]) -> FloatArray:
    """(M, N) rad or m, the most on the segments of moves, at every override.

    Args:
        controller: that drove the run.
        run: a program.
        moves: indices of its moves; one that is not driven is between others, and has the most of
            all of them.
    """
    waypoint, deviation_of_run = run.path.layout.waypoint, Deviation.of(controller, run)
    left = run.path.sigma[run.path.pieces.interval_samples]
    most = np.zeros((len(waypoint) - 1, run.path.q.shape[1]))
    for first in range(0, len(most), _TOGETHER):
        ends = waypoint[first : first + _TOGETHER + 1]
        begin = max(int(np.searchsorted(left, ends[0], "right")) - 1, 0)
        found = deviation_of_run.over(begin, max(int(np.searchsorted(left, ends[-1])), begin + 1))
        part = [by_interval(deviations, ends[:-1], ends[1:]).most for deviations in found]
        most[first : first + _TOGETHER] = np.max(part, axis=0)
    row = {move: k for k, move in enumerate(run.path.route.moves)}
    greatest = most.max(axis=0)
    return np.stack([most[row[move]] if move in row else greatest for move in moves])
