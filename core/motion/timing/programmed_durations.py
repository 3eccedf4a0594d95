"""Stamps paths on which some moves are programmed to take a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ..geometry.segments import JOINT_SEGMENT, TURN_LENGTH, Segments
from ..path.path import Path
from .arc_length import ArcLength
from .limits import SegmentLimits
from .timing import Settling, Timing, stamp_path
from .torque_rows import Shares

_DURATION_ROUNDS = 60
_DURATION_MET = 1e-6
_RAMPED_ROUNDS = 4
_MOST_OFF = 0.05
"""Share of a time by which it is aimed beside it: more is no matter of samples."""


def stamp_programmed(
    path: Path,
    along: ArcLength,
    limits: SegmentLimits,
    shares: Shares | None,
    settling: Settling,
    durations: Sequence[float | None],
    ramp: float | None,
) -> Timing:
    """The fastest timing of a path within its limits, in which timed segments take their times.

    Args:
        path, along, limits, shares, settling: see `stamp_path`.
        durations: (M,) s, what each segment is programmed to take; None for as fast as it may.
        ramp: share of such a time over which a segment accelerates and brakes; None for as fast
            as it may.

    Raises:
        MotionError: the limits leave a move no speed.
    """
    times = {k: duration for k, duration in enumerate(durations) if duration is not None}
    if not times or ramp is None:
        timing = stamp_path(path, along, limits, shares, settling)
    else:
        timing = stamp_ramped(path, along, limits, shares, settling, times, ramp)
    if not times:
        return timing
    return hold_durations(timing, list(times), np.array(list(times.values())), settling)


def stamp_ramped(
    path: Path,
    along: ArcLength,
    limits: SegmentLimits,
    shares: Shares | None,
    settling: Settling,
    times: Mapping[int, float],
    ramp: float,
) -> Timing:
    """The timing in which timed segments accelerate and brake over a share of their time; see
    `ramped`.

    A stamp reaches its greatest speed at a sample and not between two: what this costs, and it is
    a per cent on coarse paths, is taken off the times that are aimed at.
    """
    timed, wanted = list(times), np.array(list(times.values()))
    aim = wanted
    for _ in range(_RAMPED_ROUNDS):
        within = ramped(limits, path.layout.segments, timed, aim, ramp)
        timing = stamp_path(path, along, within, shares, settling)
        share = wanted / timing.segment_durations()[timed]
        if (np.abs(share - 1.0) <= _DURATION_MET).all():
            break
        aim = np.clip(aim * share, (1 - _MOST_OFF) * wanted, (1 + _MOST_OFF) * wanted)
    return timing


def ramped(
    limits: SegmentLimits, segments: Segments, timed: list[int], wanted: FloatArray, ramp: float
) -> SegmentLimits:
    """Limits within which timed segments from stop to stop accelerate and brake over a share each
    of their time.

    Over the way D in the time T, with the share r, that is a speed of up to D / ((1 − r) T) and an
    acceleration of D / (r (1 − r) T²). They bound what goes furthest: a joint of a joint move, else
    the TCP or the tool's turn.

    Args:
        limits: otherwise.
        segments: all of the path.
        timed: those with a time.
        wanted: their times, s.
        ramp: r.
    """
    velocity, acceleration = limits.velocity.copy(), limits.acceleration.copy()
    for k, time in zip(timed, wanted, strict=True):
        row, way = _furthest(segments, k)
        if way > 0.0:
            speed = way / ((1 - ramp) * time)
            velocity[k, row] = min(velocity[k, row], speed)
            acceleration[k, row] = min(acceleration[k, row], speed / (ramp * time))
    return replace(limits, velocity=velocity, acceleration=acceleration)


def _furthest(segments: Segments, k: int) -> tuple[int, float]:
    """Which row of the limits belongs to what goes furthest on a segment, and how far it goes."""
    ends, size = segments.ends, segments.ends.q.shape[2]
    if ends.kind[k] == JOINT_SEGMENT:
        change = np.abs(ends.q[k, 1] - ends.q[k, 0])
        row = int(np.argmax(change))
        return row, float(change[row])
    turn = float(segments.turn[k])
    length = float(segments.length[k])
    return (size, length) if length >= TURN_LENGTH * turn else (size + 1, turn)


def hold_durations(
    timing: Timing, timed: list[int], wanted: FloatArray, settling: Settling
) -> Timing:
    """Slow segments down until they take the time that was programmed.

    Velocities of the segment are scaled in common; a time too short for the robot stays unmet.
    """
    factor = np.ones(len(timed))
    limits = _finite(timing, timed)
    shares = timing.path_limits.shares
    current = stamp_path(timing.path, timing.along, limits, shares, settling)
    for _ in range(_DURATION_ROUNDS):
        spent = current.segment_durations()[timed]
        slow = spent < wanted * (1 - _DURATION_MET)
        fast = (spent > wanted * (1 + _DURATION_MET)) & (factor < 1.0)
        if not (slow | fast).any():
            break
        factor = np.where(slow | fast, np.minimum(1.0, factor * spent / wanted), factor)
        scaled = limits
        for segment, share in zip(timed, factor, strict=True):
            scaled = scaled.with_velocities_scaled([segment], float(share))
        current = stamp_path(timing.path, timing.along, scaled, shares, settling)
    return current


def _finite(timing: Timing, timed: list[int]) -> SegmentLimits:
    """Limits in which each timed segment may go just as fast as it does without its time."""
    velocity = timing.limits.velocity.copy()
    path, stamped, states = timing.path, timing.stamp, timing.along.states
    rate = np.sqrt(np.maximum(stamped.x[:-1], stamped.x[1:]))
    top = np.zeros(len(path.route.moves))
    np.maximum.at(top, timing.interval_segments, rate)
    sample_segment = path.pieces.segment[path.pieces.sample_pieces]
    speeds = np.concatenate(
        [
            np.abs(states.dq),
            np.linalg.norm(states.v[:, :3], axis=1)[:, None],
            np.linalg.norm(states.v[:, 3:], axis=1)[:, None],
        ],
        axis=1,
    )
    for k in timed:
        reached = speeds[sample_segment == k].max(axis=0) * top[k]
        velocity[k] = np.minimum(velocity[k], np.maximum(reached, 1e-12))
    return replace(timing.limits, velocity=velocity)
