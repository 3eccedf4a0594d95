"""Rests at stops on the way: always as long, or until the axes have been in position for a while.

A controller carries on from a fine point when all axes have been within a window round it for some
time (RAPID's ``inpos`` of a ``stoppointdata``; position window and position window time of drives
after CiA 402). A slow approach is within the window long before it has ended, and hardly rests.
With t_in, from when on the stamped motion is within the window for good, the rest at a stop is

    min(max(time − (t_stop − t_in), 0), most),

on the stamp's own clock; with a time as long as all averages reach over, the wait ends when all
that they look at is within the window. Between samples the motion is the quintic that
`Timing.states_at` drives. An axis that leaves the window and comes back between two samples has not
left it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ..geometry.pieces import Pieces
from ..geometry.quintic import at, coefficients
from .arc_length import ArcLength
from .stamping import Stamp

_HALVINGS = 52
"""Of an interval, until the place at which an axis comes into the window is exact."""


@dataclass(frozen=True)
class InPosition:
    """What a controller waits for at a stop.

    Args:
        window: rad (m for a linear axis), how near all axes are to be.
        time: s, how long.
    """

    window: float
    time: float


@dataclass(frozen=True)
class WindowEntries:
    """How the axes come within a window round S stops.

    Args:
        begin: (S,), knot at which the motion to each stop begins.
        interval: (S,), in which the last axis comes into the window; -1 where all of the motion is
            within it, which is entered at ``begin`` then.
        share: (S,), z of that interval.
        axis: (S,), which comes last.
        t: (S,) s, when, on the stamp's clock.
    """

    begin: IntArray
    interval: IntArray
    share: FloatArray
    axis: IntArray
    t: FloatArray


@dataclass(frozen=True)
class Rests:
    """The rests at the S stops on the way.

    Args:
        knot: (S,), the interval that begins at each stop.
        length: (S,) s.
        most: (S,) s, what it may be.
        in_position: what is waited for; None rests for ``most`` in any case.
        approach: (S,) s, from when on the motion is within the window, to the stop; 0 without.
        entries: by which they are shorter than the longest; None where all are equal.
        counted: (S,) bool, those that end a time after an entry.
    """

    knot: IntArray
    length: FloatArray
    most: FloatArray
    in_position: InPosition | None
    approach: FloatArray
    entries: WindowEntries | None
    counted: NDArray[np.bool_]

    @classmethod
    def of(
        cls,
        pieces: Pieces,
        along: ArcLength,
        stamp: Stamp,
        most: float | FloatArray,
        in_position: InPosition | None,
    ) -> Rests:
        """The rests of a stamped path.

        Args:
            pieces: of the path.
            along: its samples, as they were stamped.
            stamp: times without rests.
            most: s, of all or of each stop (S,).
            in_position: what is waited for; None rests for ``most`` in any case.
        """
        stops = np.flatnonzero(pieces.stop[1:-1]) + 1
        knot = pieces.first_interval[stops]
        none = np.zeros(len(knot))
        longest = most + none
        if in_position is None or not len(knot):
            return cls(knot, longest, longest, None, none, None, none > 0.0)
        entries = _entries(pieces, along, stamp, knot, in_position.window)
        approach = stamp.t[knot] - entries.t
        left = in_position.time - approach
        counted = (left > 0.0) & (left < longest)
        length = np.clip(left, 0.0, longest)
        return cls(knot, length, longest, in_position, approach, entries, counted)

    def where_time_runs(self, rate: float) -> FloatArray:
        """(S,) s, the rests where time runs at a rate, but that of what is waited for."""
        if self.in_position is None:
            return self.length
        return np.clip(self.in_position.time - self.approach / rate, 0.0, self.most)


def _entries(
    pieces: Pieces, along: ArcLength, stamp: Stamp, knot: IntArray, window: float
) -> WindowEntries:
    """When the axes are within a window round each stop for good."""
    begin = np.concatenate([np.zeros(min(len(knot), 1), dtype=np.int64), knot[:-1]])
    ends, q = pieces.interval_ends, along.states.q
    rest = q[ends[knot - 1, 1]]
    stop = np.repeat(np.arange(len(knot)), knot - begin)
    away = np.abs(q[ends[: len(stop), 0]] - rest[stop]).max(axis=1)
    far = np.flatnonzero(away > window)
    interval = np.full(len(knot), -1)
    np.maximum.at(interval, stop[far], far)
    share, axis, t = np.zeros(len(knot)), np.zeros(len(knot), dtype=np.int64), stamp.t[begin]
    outside = np.flatnonzero(interval >= 0)
    k = interval[outside]
    found = _shares(along, ends[k], along.spacing[k], rest[outside], window)
    axis[outside] = found.argmax(axis=1)
    z = share[outside] = found.max(axis=1)
    x0, x1 = stamp.x[k], stamp.x[k + 1]
    pace = np.sqrt(x0) + np.sqrt(x0 + z * (x1 - x0))
    t[outside] = stamp.t[k] + 2.0 * z * along.spacing[k] / pace
    return WindowEntries(begin, interval, share, axis, t)


def _shares(
    along: ArcLength, ends: IntArray, spacing: FloatArray, rest: FloatArray, window: float
) -> FloatArray:
    """(S, N), z at which axes that are beyond the window at the left end (S, 2) of an interval come
    into it; 0 of others."""
    states, h = along.states, spacing[:, None, None]
    parts = (states.q[ends] - rest[:, None], h * states.dq[ends], h**2 * states.ddq[ends])
    data = np.stack(parts, axis=2).reshape(len(ends), 6, rest.shape[1])
    beyond = np.abs(data[:, 0]) > window
    powers = coefficients(np.moveaxis(data, 1, -1)[beyond])
    lower, upper = np.zeros(len(powers)), np.ones(len(powers))
    for _ in range(_HALVINGS):
        middle = 0.5 * (lower + upper)
        away = np.abs(at(powers, middle)) > window
        lower, upper = np.where(away, middle, lower), np.where(away, upper, middle)
    shares = np.zeros_like(rest)
    shares[beyond] = upper
    return shares
