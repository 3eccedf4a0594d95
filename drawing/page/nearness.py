"""How near a driven program comes to its cell over time, with the pair that is nearest."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...core.collision.clearance import ClearanceMeter
from ...core.motion.command.trajectory import Trajectory
from ...core.motion.path.path import Path
from .packing import Quantised, whole
from .track_content import (
    PageClearance,
)

MOST = 600
"""Samples that are looked at: a page shows the course of it, and is no proof."""
WITHIN = 0.5
"""m, beyond which nothing is looked for."""
_STEP = 1e-5
"""m."""


def page_clearance(
    meter: ClearanceMeter,
    paths: Iterable[tuple[Path, int]],
    trajectory: Trajectory,
    wanted: float,
) -> PageClearance | None:
    """The clearance to the cell over time; None where nothing comes near.

    Args:
        meter: of the program in its cell.
        paths: of the program's driven parts, and the index of the first move of each.
        trajectory: of the program.
        wanted: m, what the cell wants to be kept.

    Raises:
        InputError: a mesh cannot be used.
    """
    count = len(trajectory.t)
    rows = np.unique(np.linspace(0, count - 1, min(count, MOST)).round().astype(np.int64))
    found = meter.along(paths, trajectory.q[rows], trajectory.move[rows].tolist(), WITHIN)
    if not np.isfinite(found.distance).any():
        return None
    pairs = list(dict.fromkeys(pair for pair in found.pairs if pair is not None))
    which = [-1 if pair is None else pairs.index(pair) for pair in found.pairs]
    return PageClearance(
        Quantised(trajectory.t[rows] - trajectory.t[0], 1e-4),
        Quantised(found.distance, _STEP),
        Quantised(found.first, _STEP),
        Quantised(found.second, _STEP),
        whole(which),
        pairs,
        wanted,
    )
