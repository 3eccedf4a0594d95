"""Reverse of `flyby.core.motion.timing.limits`: rows and ceilings, carried back to samples and
speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from ..geometry.pieces import PieceIndices, Pieces
from ..geometry.segments import Segments
from ..geometry.swivel import pull_turn_shares
from ..path.tcp_samples import States
from ..timing.between_samples import pull_between
from ..timing.limits import CENTRIPETAL, PathLimits, SegmentLimits, rooms, torque_left
from ..timing.rates import pull_rates, pull_sideways, rates, sideways
from ..timing.stamping_kernels import StampRows
from ..timing.superposed_legs import pull_ceilings
from ..timing.timed_zones import TimedGradient
from ..timing.torque_rows import Shares
from .stamping_adjoint import StampGradient


@dataclass
class SpeedGradient:
    """Gradient with respect to the numbers of each segment's speed, (M,) each."""

    tcp: FloatArray
    reorientation: FloatArray
    external_linear: FloatArray
    external_angular: FloatArray
    joint: FloatArray
    joint_fraction: FloatArray
    tcp_acceleration: FloatArray
    reorientation_acceleration: FloatArray
    joint_acceleration: FloatArray
    joint_acceleration_fraction: FloatArray

    @classmethod
    def zeros(cls, count: int) -> SpeedGradient:
        """A gradient to add to."""
        return cls(*np.zeros((len(cls.__dataclass_fields__), count)))


def _pull_segment_limits(
    limits: SegmentLimits,
    velocity_bar: FloatArray,
    acceleration_bar: FloatArray,
    torque_bar: FloatArray,
    out: SpeedGradient,
) -> FloatArray:
    """Reverse of `SegmentLimits.of`: adds to the gradient of the speeds, returns that (M,) of
    `turning`."""
    out.joint_acceleration_fraction += torque_bar * limits.override
    turning_bar = np.zeros(len(limits.turning))
    for bars, values, sources in (
        (velocity_bar, limits.velocity, limits.velocity_source),
        (acceleration_bar, limits.acceleration, limits.acceleration_source),
    ):
        bars[:, -1] /= limits.turning
        turning_bar -= bars[:, -1] * np.where(bars[:, -1] == 0.0, 0.0, values[:, -1])
        for k, j in zip(*np.nonzero(bars), strict=True):
            source = sources[k][j]
            if source is not None:
                getattr(out, source[0])[k] += bars[k, j] * source[1]
    return turning_bar


def _pull_torque_rows(
    shares: Shares, ends: IntArray, most: FloatArray, bar: StampGradient
) -> tuple[Shares, FloatArray]:
    """Reverse of `torque_rows.torque_rows`, whose rows are the last of the stamp's.

    Returns:
        The gradients of the shares and of ``most`` (K,).
    """
    count = shares.h.shape[1]
    held, fade, below = shares.h[ends], shares.fade[ends], slice(-2 * count, -count)
    a_bar = bar.a[:, :, below] + bar.a[:, :, -count:]
    b_bar = bar.b[:, :, below] + bar.b[:, :, -count:]
    more = bar.b[:, :, -count:] - bar.b[:, :, below]
    lower, upper = bar.lower[:, :, below], bar.upper[:, :, -count:]
    most_bar = np.sum(upper * (1 - held) - lower * (1 + held) + more * fade, axis=(1, 2))
    most = most[:, None, None]
    out = Shares(*(np.zeros_like(part) for part in shares))
    for part, seed in zip(out, (a_bar, b_bar, -most * (upper + lower), most * more), strict=True):
        np.add.at(part, ends, seed)
    return out, np.asarray(most_bar)


@lean
def _pull_fill(
    states: States,
    pieces: PieceIndices,
    velocity: FloatArray,
    acceleration: FloatArray,
    centripetal: float,
    room: FloatArray,
    place: IntArray,
    binding: IntArray,
    rows_bar: StampRows,
    ceiling_bar: FloatArray,
    states_bar: States,
    velocity_bar: FloatArray,
    acceleration_bar: FloatArray,
    scratch: FloatArray,
) -> None:
    """Reverse of `limits._fill`."""
    first_sample, first_interval, segment = pieces
    axes = states.q.shape[1]
    rate, bend, rate_bar, bend_bar = scratch[0], scratch[1], scratch[2], scratch[3]
    for p in range(segment.size):
        s = segment[p]
        count = first_interval[p + 1] - first_interval[p]
        for i in range(count + 1):
            k = first_sample[p] + i
            knot = first_interval[p] + i
            rate_bar[:] = 0.0
            bend_bar[:] = 0.0
            j = binding[knot, 1]
            live = binding[knot, 0] == k and ceiling_bar[knot] != 0.0
            if live and j == CENTRIPETAL:
                x = centripetal * acceleration[s, axes] / sideways(states, k)
                pull_sideways(states, k, -x / sideways(states, k) * ceiling_bar[knot], states_bar)
                acceleration_bar[s, axes] += x / acceleration[s, axes] * ceiling_bar[knot]
            if live and 0 <= j < axes + 2:
                rates(states, k, axes, rate, bend)
                x = (velocity[s, j] / rate[j]) ** 2
                rate_bar[j] -= 2 * x / rate[j] * ceiling_bar[knot]
                velocity_bar[s, j] += 2 * x / velocity[s, j] * ceiling_bar[knot]
            for end in range(2):
                interval = knot - end
                if interval < first_interval[p] or interval >= first_interval[p + 1]:
                    continue
                for j in range(axes + 2):
                    row = place[j]
                    if row >= 0 and acceleration[s, j] < np.inf:
                        rate_bar[j] += rows_bar.a[interval, end, row]
                        bend_bar[j] += rows_bar.b[interval, end, row]
                        most_bar = rows_bar.upper[interval, end, row]
                        most_bar -= rows_bar.lower[interval, end, row]
                        acceleration_bar[s, j] += room[p, 1 if j >= axes else 0] * most_bar
            pull_rates(states, k, axes, rate_bar, bend_bar, states_bar)


def pull_path_limits(
    states: States,
    pieces: Pieces,
    limits: SegmentLimits,
    made: PathLimits,
    bar: StampGradient,
    states_bar: States,
    speeds_bar: SpeedGradient,
) -> tuple[Shares | None, FloatArray, FloatArray, TimedGradient]:
    """Reverse of `path_limits`; adds to the gradients of states, speeds and, in ``bar``, spacing.

    Returns:
        The gradients of the shares of torque, None without, of the segments' `turning` (M,), of
        what corners keep of their blends (M − 1,), and of those that are blended in time.
    """
    velocity_bar = np.zeros_like(limits.velocity)
    acceleration_bar = np.zeros_like(limits.acceleration)
    torque_bar = np.zeros_like(limits.torque)
    planned_bar, indices = np.zeros_like(made.zones.planned), pieces.indices
    made.stretches.pull(made.rows.spacing, made.binding, bar.ceiling, bar.spacing)
    pull_between(
        states,
        made.rows.spacing,
        indices,
        limits.velocity,
        made.rows.ceiling,
        made.binding,
        bar.ceiling,
        states_bar,
        bar.spacing,
        velocity_bar,
    )
    timed_bar = TimedGradient.zeros(len(states.q), len(limits.velocity) - 1)
    made.timed.pull(bar.ceiling, made.binding, timed_bar)
    pull_ceilings(
        states,
        made.rows.spacing,
        indices,
        limits.acceleration,
        made.zones,
        made.binding,
        bar.ceiling,
        states_bar,
        bar.spacing,
        acceleration_bar,
        planned_bar,
    )
    _pull_fill(
        states,
        indices,
        limits.velocity,
        limits.acceleration,
        limits.centripetal,
        rooms(made.zones, made.timed, pieces),
        limits.limited[1],
        made.binding,
        StampRows(bar.a, bar.b, bar.lower, bar.upper),
        bar.ceiling,
        states_bar,
        velocity_bar,
        acceleration_bar,
        np.empty((4, acceleration_bar.shape[1])),
    )
    shares_bar = None
    if made.shares is not None:
        ends, left = pieces.interval_ends, torque_left(pieces, limits)
        shares_bar, left_bar = _pull_torque_rows(made.shares, ends, left, bar)
        np.add.at(torque_bar, pieces.interval_segments, left_bar)
    turning_bar = _pull_segment_limits(
        limits, velocity_bar, acceleration_bar, torque_bar, speeds_bar
    )
    kept_bar = made.zones.pull_planned(planned_bar, len(limits.velocity) - 1)
    return shares_bar, turning_bar, kept_bar, timed_bar


def pull_turning(segments: Segments, turning_bar: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gradients (M, 3) of the segments' turns a and b from that of `SegmentLimits.turning`."""
    if not segments.ends.swivels.any():
        return np.zeros_like(segments.turn_a), np.zeros_like(segments.turn_b)
    bar = np.where(segments.ends.swivels, turning_bar, 0.0)
    return pull_turn_shares(segments.turn_a, segments.turn_b, bar)
