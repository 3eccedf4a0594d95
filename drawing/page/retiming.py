"""A motion laid on another clock: the same motion, with rests in which others are waited for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import BoolArray, FloatArray, IntArray
from .packing import Quantised
from .track_content import PageChannel, PageClearance, PageLimits, PageMotion, PageTrack

_SAME = 1e-7
"""s within which times are one."""


@dataclass(frozen=True)
class OtherClock:
    """How another clock runs beside a motion's own.

    Args:
        begin: s on the other clock, when the motion's own begins.
        at: (W,) s of the own clock at which the other one runs on alone, never falling.
        length: (W,) s that it does.
        lag: s by which the motion is behind what begins it: a rest that the motion comes to so
            soon behind the beginning of a move is before that move.
    """

    begin: float
    at: FloatArray
    length: FloatArray
    lag: float = 0.0

    def first(self, own: FloatArray) -> FloatArray:
        """The other clock's times (T,) at own times (T,): before rests."""
        return self._at(own, "left")

    def last(self, own: FloatArray) -> FloatArray:
        """The same behind rests."""
        return self._at(own, "right")

    def begins(self, own: FloatArray) -> FloatArray:
        """When what begins at own times (T,) begins: behind rests."""
        return self.last(own + self.lag) - self.lag

    def last_at(self, own: float) -> float:
        """The other clock's time at an own one, behind rests."""
        return float(self.last(np.array([own]))[0])

    def own(self, other: FloatArray) -> FloatArray:
        """Own times (T,) at times (T,) of the other clock; before the beginning below zero."""
        starts = self.at + self.begin + np.append(0.0, np.cumsum(self.length))[:-1]
        left = other - self.begin
        for start, length in zip(starts, self.length, strict=True):
            left = left - np.clip(other - start, 0.0, length)
        return np.asarray(left)

    def _at(self, own: FloatArray, side: str) -> FloatArray:
        passed = np.append(0.0, np.cumsum(self.length))
        edge = own - _SAME if side == "left" else own + _SAME
        rests = np.searchsorted(self.at, edge, "left" if side == "left" else "right")
        return np.asarray(own + self.begin + passed[rests])


def on_clock(track: PageTrack, clock: OtherClock, grid: FloatArray) -> PageTrack:
    """A track on another clock.

    Args:
        track: on its own.
        clock: beside it.
        grid: (G,) s of the other clock that become knots, so that curves over them can be added.
    """
    motion, channels = _with_rests(track.motion, track.channels, clock)
    motion, channels = _with_knots(motion, channels, grid)

    def moved(t: float | None, by: Callable[[FloatArray], FloatArray]) -> float | None:
        return None if t is None else float(by(np.array([t]))[0])

    return replace(
        track,
        duration=float(clock.last(np.array([track.duration]))[0]),
        motion=motion,
        channels=channels,
        moves=[
            replace(move, begin=moved(move.begin, clock.begins), end=moved(move.end, clock.first))
            for move in track.moves
        ],
        limits=None if track.limits is None else _limits(track.limits, clock),
        flags=[replace(flag, t=float(clock.first(np.array([flag.t]))[0])) for flag in track.flags],
        clearance=None if track.clearance is None else _clearance(track.clearance, clock),
    )


def cut_off(track: PageTrack, end: float) -> PageTrack:
    """A track as far as it goes before an end; moves behind it are not driven.

    Args:
        track: of any clock.
        end: s, a knot of its motion.
    """
    rows = track.motion.t.values <= end + _SAME
    motion = PageMotion(
        _kept(track.motion.t, rows),
        [_kept(column, rows) for column in track.motion.q],
        [_kept(column, rows) for column in track.motion.dq],
    )
    moves = [
        replace(move, begin=None, end=None)
        if move.begin is None or move.end is None or move.begin >= end - _SAME
        else replace(move, end=min(move.end, end))
        for move in track.moves
    ]
    limits = track.limits
    if limits is not None:
        begun = limits.begin.values < end
        limits = replace(
            limits,
            begin=_kept(limits.begin, begun),
            end=replace(limits.end, values=np.minimum(limits.end.values[begun], end)),
            which=_kept(limits.which, begun),
        )
    near = track.clearance
    if near is not None:
        before = near.t.values <= end
        first, second = _kept(near.first, before), _kept(near.second, before)
        near = replace(
            near,
            t=_kept(near.t, before),
            distance=_kept(near.distance, before),
            first=first,
            second=second,
            pair=_kept(near.pair, before),
        )
    return replace(
        track,
        duration=min(track.duration, end),
        motion=motion,
        channels=[replace(one, values=_kept(one.values, rows)) for one in track.channels],
        moves=moves,
        limits=limits,
        flags=[flag for flag in track.flags if flag.t < end],
        clearance=near,
    )


def _kept(column: Quantised, rows: BoolArray) -> Quantised:
    return replace(column, values=column.values[rows])


def _limits(limits: PageLimits, clock: OtherClock) -> PageLimits:
    begin, end = limits.begin, limits.end
    return replace(
        limits,
        begin=replace(begin, values=clock.begins(begin.values)),
        end=replace(end, values=clock.first(end.values)),
    )


def _clearance(clearance: PageClearance, clock: OtherClock) -> PageClearance:
    t = clearance.t
    return replace(clearance, t=replace(t, values=clock.first(t.values)))


def _with_rests(
    motion: PageMotion, channels: Sequence[PageChannel], clock: OtherClock
) -> tuple[PageMotion, list[PageChannel]]:
    """Two knots where a rest begins and ends, all on the other clock."""
    own = motion.t.values
    inside = np.clip(clock.at, own[0], own[-1])
    motion, channels = _with_knots(motion, channels, np.repeat(inside, 2))
    own = motion.t.values
    times = clock.last(own)
    still = np.zeros(len(own), dtype=bool)
    for at in inside:
        knots = np.flatnonzero(np.abs(own - at) <= _SAME)
        still[knots] = True
        # The rest lies between the two that were put in last.
        times[knots[:-1]] = clock.first(own[knots[:-1]])
    speeds = [replace(column, values=np.where(still, 0.0, column.values)) for column in motion.dq]
    return replace(motion, t=replace(motion.t, values=times), dq=speeds), channels


def _with_knots(
    motion: PageMotion, channels: Sequence[PageChannel], more: FloatArray
) -> tuple[PageMotion, list[PageChannel]]:
    """Further knots on the same curves, each behind those of its own time."""
    t = motion.t.values
    more = more[(more >= t[0] - _SAME) & (more <= t[-1] + _SAME)]
    every = np.concatenate([t, more])
    order = np.argsort(every, kind="stable")
    where: IntArray = np.searchsorted(t, more, "right") - 1
    where = np.clip(where, 0, max(len(t) - 2, 0))

    def joined(column: Quantised, added: FloatArray) -> Quantised:
        return replace(column, values=np.concatenate([column.values, added])[order])

    q, dq = [], []
    for position, speed in zip(motion.q, motion.dq, strict=True):
        places, rates = _cubic(t, position.values, speed.values, where, more)
        q.append(joined(position, places))
        dq.append(joined(speed, rates))
    made = [
        replace(one, values=joined(one.values, _linear(t, one, where, more))) for one in channels
    ]
    return PageMotion(replace(motion.t, values=every[order]), q, dq), made


def _cubic(
    t: FloatArray, q: FloatArray, dq: FloatArray, k: IntArray, more: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Places and rates on the cubics between knots."""
    following = np.minimum(k + 1, len(t) - 1)
    span = t[following] - t[k]
    safe = np.where(span > 0.0, span, 1.0)
    s = np.clip((more - t[k]) / safe, 0.0, 1.0)
    rise, first, last = q[following] - q[k], span * dq[k], span * dq[following]
    b, c = 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise
    places = q[k] + s * (first + s * (b + s * c))
    rates = np.where(span > 0.0, (first + s * (2.0 * b + 3.0 * s * c)) / safe, dq[k])
    return np.asarray(places), np.asarray(rates)


def _linear(t: FloatArray, channel: PageChannel, k: IntArray, more: FloatArray) -> FloatArray:
    values = channel.values.values
    following = np.minimum(k + 1, len(t) - 1)
    span = t[following] - t[k]
    s = np.where(
        span > 0.0, np.clip((more - t[k]) / np.where(span > 0.0, span, 1.0), 0.0, 1.0), 0.0
    )
    if channel.stepped:
        return np.where(s >= 1.0, values[following], values[k])
    return np.asarray(values[k] + s * (values[following] - values[k]))
