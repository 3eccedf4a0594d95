"""A stamped path: when the robot is where, waits included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ...display import counted, in_line
from ...errors import MotionError
from ...program.zone import Fine, Zone
from ...robot.kinematics.lean import lean
from ..model.rules import Pace
from ..path.between_states import joint_at
from ..path.path import Path
from ..path.tcp_samples import States
from .arc_length import ArcLength
from .interval import Intervals, progress, sigma_at
from .least_zone_times import ZoneStretches
from .limits import PathLimits, SegmentLimits, path_limits
from .rests import InPosition, Rests
from .stamping import Stamp, StampingError, stamp
from .start_ramp import SUDDEN, StartRamp
from .superposed_legs import SuperposedZones
from .timed_zones import TimedZones
from .torque_rows import Shares

_ROUNDING = 1e-12
"""s, by which times may be off."""


Motion = tuple[FloatArray, FloatArray, FloatArray]
"""Positions, velocities and accelerations, (T, N) each."""


@dataclass(frozen=True)
class Settling:
    """How long the stamped motion rests for what follows it in time.

    Args:
        stop: s, at each stop on the way, at most.
        end: s, after the last.
        ramp: s, of this what the place on the path is averaged over.
        start: how time comes up to speed when the motion begins.
        in_position: what is waited for at stops on the way; None waits for all of it.
        servo: s, by which stops that the program states may take longer than ``stop``.
    """

    stop: float = 0.0
    end: float = 0.0
    ramp: float = 0.0
    start: StartRamp = SUDDEN
    in_position: InPosition | None = None
    servo: float = 0.0

    def at(self, zones: Sequence[Zone]) -> FloatArray:
        """(S,) s, how long a stop at each of some waypoints may take."""
        waits = [not isinstance(zone, Fine) or zone.programmed for zone in zones]
        return self.stop + self.servo * np.array(waits, dtype=float)


@dataclass(frozen=True)
class Timing:
    """The stamp of a path.

    Args:
        path: the geometry.
        limits: of the segments.
        along: the samples with respect to ℓ, the parameter that was stamped.
        path_limits: what was stamped.
        stamp: x = (dℓ/dt)² and times without waits.
        begin: (K,) s, when each interval is entered, waits included.
        end: (K,) s, when it is left.
        duration: s, of everything, settling at the end included.
        rests: at stops on the way, beside programmed waits.
        ramp: s, what the place on the path is averaged over afterwards; see `ramped`.
        start: how the controller's time comes up to speed; `begin`, `end` and `states_at` are
            without, see `driven_at`.
        lag: s by which the commanded joints pass a place on the path later, as they are averaged
            over time: half of what they take to settle.
    """

    path: Path
    limits: SegmentLimits
    along: ArcLength
    path_limits: PathLimits
    stamp: Stamp
    begin: FloatArray
    end: FloatArray
    duration: float
    rests: Rests
    ramp: float = 0.0
    start: StartRamp = SUDDEN
    lag: float = 0.0

    def __repr__(self) -> str:
        moving = float((self.end - self.begin).sum())
        return in_line(
            f"Timing of {self.path.route.robot.name}: {self.duration:.3f} s, {moving:.3f} s of it "
            f"in motion, {counted(self.begin, 'interval')}"
        )

    @classmethod
    def of(
        cls,
        path: Path,
        limits: SegmentLimits,
        along: ArcLength,
        path_limits: PathLimits,
        stamp: Stamp,
        settling: Settling = Settling(),
    ) -> Timing:
        """The timing of a stamp on a path.

        Args:
            path, limits, along, path_limits, stamp: what was stamped.
            settling: rests that smoothing in time needs.
        """
        pieces = path.pieces
        waypoint_edge = np.flatnonzero(pieces.source[:, 1] < 0)
        first = pieces.first_interval
        wait = np.zeros(first[-1] + 1)
        wait[first[waypoint_edge]] = path.route.dwell[pieces.source[waypoint_edge, 0]]
        stops = 1 + np.flatnonzero(pieces.stop[1:-1])
        most = settling.at([path.route.zones[k - 1] for k in pieces.source[stops, 0]])
        rests = Rests.of(pieces, along, stamp, most, settling.in_position)
        wait[rests.knot] += rests.length
        wait[-1] += settling.end
        # A wait at a knot comes before the interval that leaves it.
        delay = np.cumsum(wait)
        begin, end = stamp.t[:-1] + delay[:-1], stamp.t[1:] + delay[:-1]
        start = settling.start.begun_at(float(begin[0]))
        duration = float(stamp.t[-1] + delay[-1]) + start.delay
        return cls(
            path,
            limits,
            along,
            path_limits,
            stamp,
            begin,
            end,
            duration,
            rests,
            settling.ramp,
            start,
            0.5 * settling.end,
        )

    @property
    def interval_segments(self) -> IntArray:
        """(K,), the segment of each interval."""
        pieces = self.path.pieces
        return np.repeat(pieces.segment, pieces.intervals)

    def waits(self, rests: FloatArray) -> FloatArray:
        """(K - 1,) s, how long the path rests behind each interval but the last.

        Programmed waits included, and with other rests (S,) s than it has.
        """
        wait = self.begin[1:] - self.end[:-1]
        other = self.rests.length != rests
        knot = self.rests.knot[other]
        left = wait[knot - 1] - (self.rests.length - rests)[other]
        # Beginnings and ends are sums, in which what is left of nothing is rounding.
        wait[knot - 1] = np.where(left > _ROUNDING, left, 0.0)
        return wait

    def segment_durations(self) -> FloatArray:
        """(M,) s, time spent on each segment between its waypoints, waits left out."""
        spent = np.zeros(len(self.path.route.moves))
        np.add.at(spent, self.interval_segments, self.end - self.begin)
        return spent

    def begins(self) -> FloatArray:
        """(M,) s, when the commanded joints enter each segment."""
        first = np.searchsorted(self.interval_segments, np.arange(len(self.path.route.moves)))
        entered = self.start.driven(self.begin[first])
        return np.concatenate([entered[:1], entered[1:] + self.lag])

    def settled_durations(self) -> FloatArray:
        """(M,) s, what each segment takes of the cycle time: settling included, not waits."""
        left = np.append(self.begins(), self.duration)
        return np.diff(left) - self.path.route.dwell[1:]

    def states_at(self, t: FloatArray, out: Motion | None = None) -> Motion:
        """Configuration, velocity and acceleration (T, N) at times t (T,) in s.

        Between samples the path is the quintic in ℓ that meets both samples' derivatives.

        Args:
            t: the times.
            out: written and returned; None for new arrays.
        """
        shape = len(t), self.path.q.shape[1]
        q, dq, ddq = out or (np.empty(shape), np.empty(shape), np.empty(shape))
        t = np.ascontiguousarray(t)
        _drive(t, self._entered(t), self.intervals, self.along.states, q, dq, ddq)
        return q, dq, ddq

    def driven_at(self, t: FloatArray, out: Motion | None = None) -> Motion:
        """`states_at`, with time that comes up to speed when the motion begins."""
        if self.start == SUDDEN:
            return self.states_at(t, out)
        stamped, rate, growth = self.start.stamped(t)
        q, dq, ddq = self.states_at(stamped, out)
        slow = np.flatnonzero((rate != 1.0) | (growth != 0.0))
        rate, growth = rate[slow, None], growth[slow, None]
        ddq[slow] = rate**2 * ddq[slow] + growth * dq[slow]
        dq[slow] *= rate
        return q, dq, ddq

    def place_at(self, t: FloatArray) -> FloatArray:
        """σ (T,) on the path at times t (T,) in s, with time that comes up to speed."""
        t = np.ascontiguousarray(self.start.stamped(t)[0])
        at = np.empty(len(t))
        _places(t, self._entered(t), self.intervals, self.path.sigma, self.along.rate, at)
        return at

    @property
    def intervals(self) -> Intervals:
        """The K intervals, as stamped."""
        sample = self.path.pieces.interval_samples
        return Intervals(self.begin, self.end, sample, self.along.spacing, self.stamp.x)

    def _entered(self, t: FloatArray) -> IntArray:
        """(T,), the interval that is entered last."""
        return np.clip(np.searchsorted(self.begin, t, side="right") - 1, 0, None)


@lean
def _drive(
    t: FloatArray,
    interval: IntArray,
    intervals: Intervals,
    states: States,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
) -> None:
    for i in range(t.size):
        k = interval[i]
        s, length = intervals.sample[k], intervals.spacing[k]
        z, rate = progress(intervals, k, t[i])
        change = (intervals.x[k + 1] - intervals.x[k]) / (2 * length)
        if not intervals.begin[k] <= t[i] <= intervals.end[k]:
            rate = change = 0.0
        for j in range(q.shape[1]):
            q[i, j], slope, bend = joint_at(states, s, j, length, z)
            dq[i, j] = slope * rate
            ddq[i, j] = bend * rate * rate + slope * change


@lean
def _places(
    t: FloatArray,
    interval: IntArray,
    intervals: Intervals,
    sigma: FloatArray,
    ratio: FloatArray,
    at: FloatArray,
) -> None:
    for i in range(t.size):
        k = interval[i]
        z, _ = progress(intervals, k, t[i])
        at[i] = sigma_at(sigma, ratio, intervals.sample[k], intervals.spacing[k], z)


def along_path(path: Path, acceleration: FloatArray) -> ArcLength:
    """The samples of a path over the parameter that is stamped.

    Args:
        path: the path.
        acceleration: (N,) rad/s² or m/s², the axes' limits.
    """
    flat = path.flat_corners
    return ArcLength.of(path.layout, path.pieces, flat, path.sigma, path.states, acceleration)


def stamp_path(
    path: Path,
    along: ArcLength,
    limits: SegmentLimits,
    shares: Shares | None,
    settling: Settling,
    known: PathLimits | None = None,
) -> Timing:
    """The fastest timing of a path within its limits; ``known`` ones but for velocities, if any.

    Raises:
        MotionError: the limits leave a move no speed.
    """
    zones = SuperposedZones.none()
    if path.model.pace is Pace.SUPERPOSED:
        zones = SuperposedZones.of(path.layout, path.pieces, path.tcp.curves.position)
    stretches = ZoneStretches.of(path.layout, path.pieces, along.states, path.model.zone_time)
    timed = TimedZones.of(path.layout, path.pieces, path.sigma, path.joint)
    made = path_limits(
        along.states, along.spacing, path.pieces, limits, zones, stretches, timed, shares, known
    )
    try:
        found = stamp(made.rows)
    except StampingError as error:
        knot = min(error.knot, len(made.rows.spacing) - 1)
        piece = int(np.searchsorted(path.pieces.first_interval, knot, "right")) - 1
        move = path.route.moves[int(path.pieces.segment[piece])]
        raise MotionError(f"the limits leave it no speed: {error.message}", move) from error
    return Timing.of(path, limits, along, made, found, settling)
