"""When several runs pass the same waypoints."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...drawing.page.packing import Quantised
from ..results.runs import Run


def meeting_times(runs: Sequence[Run]) -> Quantised | None:
    """Times (W, R) s at which R runs of programs with as many moves begin each; None for others."""
    counts = {len(run.report.moves) for run in runs}
    if len(runs) < 2 or len(counts) != 1:
        return None
    rows = [
        [run.report.moves[move].begin for run in runs]
        for move in range(counts.pop())
        if all(run.report.moves[move].driven for run in runs)
    ]
    rows = [[0.0] * len(runs), *rows, [run.duration for run in runs]]
    return Quantised(np.maximum.accumulate(np.array(rows), axis=0), 1e-4)
