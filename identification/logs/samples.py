"""Samples of a log in the order of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.errors import InputError

BACK = 10.0
"""Median periods by which a stamp may lie before an earlier one: arrival stamps come in bursts."""
MOST_OUT_OF_ORDER = 0.2
"""Share of samples whose time may not increase. A clock that is read to 1 ms repeats itself at
periods below that; beyond this share its stamps say too little."""


@dataclass(frozen=True, eq=False)
class LogSamples:
    """What a file says.

    Args:
        t: (T,) s, increasing.
        q: (T, N), joints in rad, linear axes in m.
        notes: what was left out, one sentence each.
    """

    t: FloatArray
    q: FloatArray
    notes: tuple[str, ...] = ()


def in_order(
    t: FloatArray, q: FloatArray, lines: IntArray, file: str, notes: tuple[str, ...] = ()
) -> LogSamples:
    """The samples whose time is later than that of all before.

    Args:
        t: (T,) s as it stands in the file.
        q: (T, N).
        lines: (T,) line of each sample.
        file: for messages.
        notes: of the reader so far.

    Raises:
        InputError: there are not two samples, or time runs back as no clock's reading does.
    """
    if len(t) < 2:
        raise InputError(f"{file}: a log needs at least two samples")
    latest = np.maximum.accumulate(t)
    later = np.concatenate([[True], t[1:] > latest[:-1]])
    if later.sum() < 2 and t.min() == t[0]:
        raise InputError(f"{file}: time stands still: all samples have the time {t[0]:g} s")
    period = float(np.median(np.diff(t[later]))) if later.sum() > 1 else 0.0
    behind = latest - t
    if behind.max() > BACK * period:
        at = int(np.argmax(behind > BACK * period))
        raise InputError(
            f"{file}:{lines[at]}: time runs back by {behind[at]:.4g} s: a log must be one run in "
            "the order of time; give each run a file of its own"
        )
    lost = int((~later).sum())
    if lost > MOST_OUT_OF_ORDER * len(t):
        at = int(np.argmin(later))
        raise InputError(
            f"{file}:{lines[at]}: the time of {lost} of {len(t)} samples does not increase: "
            "log with a finer clock, or name another column of time"
        )
    if lost:
        notes = (*notes, f"{lost} samples whose time does not increase are left out")
    return LogSamples(t[later], q[later], notes)
