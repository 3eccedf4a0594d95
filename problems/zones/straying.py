"""How far smoothing in time, and leads of elastic joints, take the joints off each segment."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...core.collision.strays import strays_of, stretches
from ...core.motion.controller import Controller, Run

FloatArray = NDArray[np.float64]


def segment_strays(controller: Controller, run: Run, moves: Sequence[int]) -> FloatArray:
    """(M, N) rad or m, the most on the segments of moves, at every override.

    Args:
        controller: that drove the run.
        run: a program.
        moves: indices of its moves; one that is not driven is between others, and has the most of
            all of them.
    """
    waypoint = run.path.layout.waypoint
    bands = strays_of(controller, run)
    found = [stretches(strays, waypoint[:-1], waypoint[1:]).most for strays in bands]
    most = np.max(found, axis=0)
    row = {move: k for k, move in enumerate(run.path.route.moves)}
    greatest = most.max(axis=0)
    return np.stack([most[row[move]] if move in row else greatest for move in moves])
