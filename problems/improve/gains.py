"""What a program gains in time at each of its waypoints."""

from __future__ import annotations

import numpy as np

from ...core.arrays import FloatArray
from ...core.motion.emulator.run import Run


def seconds_gained(before: Run, after: Run) -> dict[int, float]:
    """s that a program takes less at each waypoint, by the index of the move that ends there.

    A waypoint's time runs from the middle of the move to it to the middle of the move from it, the
    first one's from the start and that of the last one that is passed to the end: together they are
    all that is gained.

    Returns:
        Nothing where other moves are driven than before.
    """
    moves = before.path.route.moves
    if moves != after.path.route.moves or len(moves) < 2:
        return {}
    spent = np.diff(_middles(before)) - np.diff(_middles(after))
    return {move: float(gain) for move, gain in zip(moves[:-1], spent, strict=True)}


def _middles(run: Run) -> FloatArray:
    """(M,) s, when the middles of the M moves are passed; of the first and the last move their
    outer ends."""
    timing, path = run.timing, run.path
    left = path.pieces.interval_samples
    sigma = np.stack([path.sigma[left], path.sigma[left + 1]], -1).ravel()
    t = np.stack([timing.begin, timing.end], -1).ravel()
    waypoint = path.layout.waypoint
    middles = np.interp(0.5 * (waypoint[:-1] + waypoint[1:]), sigma, t)
    middles[0], middles[-1] = 0.0, timing.duration
    return middles
