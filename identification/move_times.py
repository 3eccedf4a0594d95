"""What each move took in a log, beside its emulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import FloatArray
from .prediction import Prediction

_AWAY = 1e-3
"""rad (m) from where a robot stands at which it counts as gone."""
_STANDS = 0.02
"""s until it is gone from which on it stood."""


@dataclass(frozen=True)
class MoveTime:
    """One move of a run.

    Args:
        move: its index.
        emulated, logged: s, from where it begins to where the next does, with what it stands at
            its end. What the robot rests before it leaves, and at the end, is no part of it.
        off: m, the greatest distance of the log's TCP from the emulated path; None where the log
            has no sample of the move.
    """

    move: int
    emulated: float
    logged: float
    off: float | None

    @property
    def longer(self) -> float:
        """s that the robot took longer than emulated."""
        return self.logged - self.emulated


def move_times(compared: Prediction) -> list[MoveTime]:
    """The moves that a log and its emulation pass, in their order.

    A log is where the emulation is by place alone (`Alignment.time`), so offset and drift of its
    clock play no part in where moves begin.
    """
    driven, aligned, found = compared.driven.trajectory, compared.alignment, compared.residuals
    passed = _rising(aligned.time, found.t)
    starts = np.flatnonzero(np.diff(driven.move, prepend=driven.move[0] - 1))
    bounds, logged = [float(aligned.time[0])], [float(found.t[0])]
    for row in starts[1:]:
        left = _leaves(driven.t, driven.q_motor, int(row))
        if left - driven.t[row] <= _STANDS:
            left = float(driven.t[row])
        bounds.append(float(np.clip(left, bounds[-1], aligned.time[-1])))
        logged.append(max(float(np.interp(left, *passed)), logged[-1]))
    bounds.append(float(aligned.time[-1]))
    logged.append(float(found.t[-1]))
    times = []
    for k, start in enumerate(starts):
        if bounds[k + 1] <= bounds[k]:
            continue
        inside = (found.t >= logged[k]) & (found.t <= logged[k + 1])
        off_path = float(found.path[inside].max()) if inside.any() else None
        spans = bounds[k + 1] - bounds[k], logged[k + 1] - logged[k]
        times.append(MoveTime(int(driven.move[start]), *spans, off_path))
    return times


def _leaves(t: FloatArray, q: FloatArray, row: int) -> float:
    """s, when a motion is `_AWAY` from where it is at a row."""
    off = np.abs(q[row:] - q[row]).max(axis=1)
    behind = np.flatnonzero(off > _AWAY)
    if not len(behind):
        return float(t[-1])
    k = int(behind[0])
    return float(np.interp(_AWAY, off[k - 1 : k + 1], t[row + k - 1 : row + k + 1]))


def _rising(time: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Emulated and logged times (K,) of which the emulated ones only rise."""
    kept = time >= np.maximum.accumulate(time)
    return time[kept], t[kept]
