"""A motion laid on another clock: the same motion, with rests in which others are waited for.

Moves that are made together take as long as the slowest; others' motions are slower there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from ...core.arrays import BoolArray, FloatArray, IntArray
from ...core.station.station import ClockPace
from .curves import ACCELERATION, ENERGY, PUSH, SPEED, TORQUE
from .packing import Quantised
from .track_content import PageChannel, PageClearance, PageFlag, PageLimits, PageMotion, PageTrack

_SAME = 1e-7
"""s within which times are one."""
_SLOWED = 1e-3
"""Share of the speed by which a motion is slower, from which on its torques are others."""


@dataclass(frozen=True)
class OtherClock:
    """How another clock runs beside a motion's own.

    Args:
        begin: s on the other clock, when the motion's own begins.
        at: (W,) s of the own clock at which the other one runs on alone, never falling.
        length: (W,) s that it does.
        lag: s by which the motion is behind what begins it: a rest that the motion comes to so
            soon behind the beginning of a move is before that move.
        pace: at which the own clock passes between rests.
    """

    begin: float
    at: FloatArray
    length: FloatArray
    lag: float = 0.0
    pace: ClockPace = field(default_factory=ClockPace.steady)

    def first(self, own: FloatArray) -> FloatArray:
        """The other clock's times (T,) at own times (T,): before rests."""
        return self._passed(own, -np.inf) + self._rested(own, "left")

    def last(self, own: FloatArray) -> FloatArray:
        """The same behind rests."""
        return self._passed(own, np.inf) + self._rested(own, "right")

    def begins(self, own: FloatArray) -> FloatArray:
        """When what begins at own times (T,) begins: behind rests."""
        return self._passed(own, np.inf) + self._rested(own + self.lag, "right")

    def first_at(self, own: float) -> float:
        """The other clock's time at an own one, before rests."""
        return float(self.first(np.array([own]))[0])

    def last_at(self, own: float) -> float:
        """The other clock's time at an own one, behind rests."""
        return float(self.last(np.array([own]))[0])

    def speed(self, own: FloatArray, before: BoolArray) -> FloatArray:
        """s of its own a second (T,), just before own times (T,) or just behind them."""
        begin = np.where(before, own - _SAME, own)
        return np.asarray(_SAME / (self.pace.passed(begin + _SAME) - self.pace.passed(begin)))

    def _passed(self, own: FloatArray, to: float) -> FloatArray:
        """Begun and passed at the pace, just before own times or just behind them."""
        return np.asarray(self.begin + np.maximum(self.pace.passed(np.nextafter(own, to)), 0.0))

    def _rested(self, own: FloatArray, side: Literal["left", "right"]) -> FloatArray:
        """s of rests before own times, or up to behind them."""
        rested = np.append(0.0, np.cumsum(self.length))
        edge = own - _SAME if side == "left" else own + _SAME
        return np.asarray(rested[np.searchsorted(self.at, edge, side)])


def on_clock(track: PageTrack, clock: OtherClock, grid: FloatArray) -> PageTrack:
    """A track on another clock.

    Args:
        track: on its own.
        clock: beside it.
        grid: (G,) s of the other clock that become knots, so that curves over them can be added.

    What drives more slowly takes less acceleration and torque than the curves say: there they have
    no value, and the work has none from there on.
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
        flags=[_flag(flag, clock) for flag in track.flags],
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


def _flag(flag: PageFlag, clock: OtherClock) -> PageFlag:
    begin, end = clock.pace.passed(np.array([flag.t, flag.t + flag.duration]))
    return replace(flag, t=clock.first_at(flag.t), duration=float(end - begin))


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
    """Two knots where a rest begins and ends, or the pace changes, all on the other clock."""
    own = motion.t.values
    inside = np.clip(clock.at, own[0], own[-1])
    changes = clock.pace.own[(clock.pace.own > own[0]) & (clock.pace.own < own[-1])]
    motion, channels = _with_knots(motion, channels, np.repeat(np.append(inside, changes), 2))
    own = motion.t.values
    times = clock.last(own)
    still = np.zeros(len(own), dtype=bool)
    for at in inside:
        knots = np.flatnonzero(np.abs(own - at) <= _SAME)
        still[knots] = True
        # The rest lies between the two that were put in last.
        times[knots[:-1]] = clock.first(own[knots[:-1]])
    speed = clock.speed(own, np.append(np.diff(own) <= _SAME, False))
    speed[still] = 0.0
    scaled = [replace(column, values=column.values * speed) for column in motion.dq]
    motion = replace(motion, t=replace(motion.t, values=times), dq=scaled)
    return motion, [_at_speed(one, speed, still) for one in channels]


def _at_speed(channel: PageChannel, speed: FloatArray, still: BoolArray) -> PageChannel:
    slowed = (np.abs(speed - 1.0) > _SLOWED) & ~still
    values = channel.values.values
    if channel.chart == SPEED and not channel.stepped:
        values = np.where(still, values, values * speed)
    elif channel.chart in (ACCELERATION, TORQUE, PUSH):
        values = np.where(slowed, np.nan, values)
    elif channel.chart == ENERGY:
        values = np.where(np.cumsum(slowed) > 0, np.nan, values)
    return replace(channel, values=replace(channel.values, values=values))


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
