"""When several runs pass the same waypoints."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ...core.arrays import FloatArray
from ...core.difference.moves import move_pairs
from ..results.runs import Run


def meeting_times(runs: Sequence[Run]) -> FloatArray:
    """Times (W, R) s at which R runs of programs with as many moves begin each.

    Of two programs, one of which has moves that the other has not, moves that belong together
    count.
    """
    counts = [len(run.report.moves) for run in runs]
    if len(runs) == 2 and counts[0] != counts[1]:
        return differing_times(*runs)
    return _begins(runs, ((move,) * len(runs) for move in range(min(counts))))


def differing_times(before: Run, after: Run) -> FloatArray:
    """Times (W, 2) s at which two states of a program begin the moves that belong together."""
    return _begins((before, after), move_pairs(before.program.moves, after.program.moves))


def _begins(runs: Sequence[Run], moves: Iterable[Sequence[int]]) -> FloatArray:
    rows = [[0.0] * len(runs)]
    for indices in moves:
        own = [run.report.moves[move] for run, move in zip(runs, indices, strict=True)]
        if all(move.driven for move in own):
            rows.append([move.begin for move in own])
    rows.append([run.duration for run in runs])
    return np.asarray(np.maximum.accumulate(np.array(rows), axis=0))
