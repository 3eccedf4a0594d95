"""What bounds the speed along a path: robot, program and motion model as rows and ceilings.

Velocities bound x = σ̇² at the knots: joints |q'| √x ≤ v, TCP |p'| √x ≤ v_tcp, tool |ω| √x ≤ v_ori.
Accelerations are rows on u = σ̈ and x: joints q' u + q'' x, and along the path the change of the
TCP's speed |p'| u + (p' · p'' / |p'|) x and of the tool's rate of turn likewise. Joints that torque
limits (`torque.Torque`) have rows of their own behind these. Centripetal acceleration |p''⊥| x is a
ceiling again, and so are what velocities between samples allow (`between`) and how fast legs that
overlap drive zones (`superposed`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...program.speed import Speed
from ...robot.joint import JointKind
from ...robot.model import Robot
from ..geometry.pieces import Pieces
from ..geometry.segments import JOINT_SEGMENT, Segments
from ..geometry.swivel import pull_turn_shares, turn_shares
from ..gradients import stamping_adjoint
from ..model.motion_model import MotionModel
from ..path.tcp_samples import States
from . import stamping
from .between_samples import lower_between, pull_between
from .rates import pull_rates, pull_sideways, rates, sideways
from .superposed_legs import lower_ceilings, pull_ceilings, room_along
from .torque import Shares
from .torque_rows import pull_torque_rows, torque_rows

_TOGETHER = 20_000
"""Intervals whose rows of torque are made in one go."""
CENTRIPETAL = -3
"""Stands for a row in `PathLimits.binding` where centripetal acceleration is the ceiling."""


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
        return cls(*(np.zeros(count) for _ in cls.__dataclass_fields__))


@dataclass(frozen=True)
class SegmentLimits:
    """The limits of each segment.

    Args:
        velocity: (M, N + 2), of the joints, the TCP (m/s) and the tool (rad/s); may be inf.
        acceleration: (M, N + 2), likewise.
        torque: (M,), the share of the torques' limits that may be used.
        centripetal: greatest centripetal acceleration of the TCP, in limits of that along the path.
        turning: (M,), what share of its turn a segment's limits of turning count; see `swivel`.
        velocity_source, acceleration_source: (M, N + 2), name of the speed's number behind each
            and its derivative; used in reverse.
    """

    velocity: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    centripetal: float
    turning: FloatArray
    velocity_source: tuple[tuple[tuple[str, float] | None, ...], ...]
    acceleration_source: tuple[tuple[tuple[str, float] | None, ...], ...]

    @classmethod
    def of(
        cls, robot: Robot, model: MotionModel, speeds: Sequence[Speed], segments: Segments
    ) -> SegmentLimits:
        """The limits of segments driven at these speeds."""
        kinds, turning = segments.ends.kind, _turning(segments)
        known: dict[tuple[Speed, int], tuple[list[_Limit], list[_Limit]]] = {}
        for key in zip(speeds, map(int, kinds), strict=True):
            if key not in known:
                known[key] = _limits(robot, model, *key)
        made = [known[key] for key in zip(speeds, map(int, kinds), strict=True)]
        velocity = np.array([[value for value, _ in limits] for limits, _ in made])
        acceleration = np.array([[value for value, _ in limits] for _, limits in made])
        velocity[:, -1] /= turning
        acceleration[:, -1] /= turning
        return cls(
            velocity,
            acceleration,
            np.array([speed.joint_acceleration_fraction for speed in speeds]),
            math.inf if model.centripetal is None else model.centripetal,
            turning,
            tuple(tuple(source for _, source in limits) for limits, _ in made),
            tuple(tuple(source for _, source in limits) for _, limits in made),
        )

    def with_velocities_scaled(self, segments: Sequence[int], factor: float) -> SegmentLimits:
        """The same with all velocities of some segments multiplied."""
        velocity = self.velocity.copy()
        velocity[list(segments)] *= factor
        return replace(self, velocity=velocity)

    def pull(
        self,
        velocity_bar: FloatArray,
        acceleration_bar: FloatArray,
        torque_bar: FloatArray,
        out: SpeedGradient,
    ) -> FloatArray:
        """Reverse of `of`: adds to the gradient of the speeds, returns that (M,) of `turning`."""
        out.joint_acceleration_fraction += torque_bar
        turning_bar = np.zeros(len(self.turning))
        for bars, values, sources in (
            (velocity_bar, self.velocity, self.velocity_source),
            (acceleration_bar, self.acceleration, self.acceleration_source),
        ):
            bars[:, -1] /= self.turning
            turning_bar -= bars[:, -1] * np.where(bars[:, -1] == 0.0, 0.0, values[:, -1])
            for k, j in zip(*np.nonzero(bars), strict=True):
                source = sources[k][j]
                if source is not None:
                    getattr(out, source[0])[k] += bars[k, j] * source[1]
        return turning_bar


def _turning(segments: Segments) -> FloatArray:
    """(M,), the share of its turn that each segment's limits of turning count."""
    shares = turn_shares(segments.turn_a, segments.turn_b)
    return np.where(segments.ends.swivels, shares, 1.0)


_Limit = tuple[float, tuple[str, float] | None]


def _least(*limits: _Limit) -> _Limit:
    return min(limits, key=lambda limit: limit[0])


def _given(value: float | None, name: str) -> _Limit:
    return (math.inf, None) if value is None else (value, (name, 1.0))


def _limits(
    robot: Robot, model: MotionModel, speed: Speed, kind: int
) -> tuple[list[_Limit], list[_Limit]]:
    """Velocity and acceleration limits (N + 2) of one segment with their sources."""
    velocity: list[_Limit] = []
    acceleration: list[_Limit] = []
    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    for index, joint in enumerate(joints):
        own = speed.joint_fraction * joint.velocity
        limits: list[_Limit] = [(own, ("joint_fraction", joint.velocity))]
        if index < robot.arm_size:
            if kind == JOINT_SEGMENT and speed.duration is None:
                limits.append(_given(speed.joint, "joint"))
        elif joint.kind is JointKind.PRISMATIC:
            limits.append(_given(speed.external_linear, "external_linear"))
        else:
            limits.append(_given(speed.external_angular, "external_angular"))
        velocity.append(_least(*limits))
        most = joint.acceleration
        if index < robot.arm_size:
            most *= model.acceleration_scale(index)
        own = speed.joint_acceleration_fraction * most
        limits = [(own, ("joint_acceleration_fraction", most))]
        if index < len(model.torque.own):
            limits = [(math.inf, None)]
        if kind == JOINT_SEGMENT:
            limits.append(_given(speed.joint_acceleration, "joint_acceleration"))
        acceleration.append(_least(*limits))
    # A programmed duration takes the place of the speeds (RAPID \\T, URScript t).
    timed = speed.duration is not None
    velocity.append(_given(None if timed else speed.tcp, "tcp"))
    velocity.append(_given(None if timed else speed.reorientation, "reorientation"))
    if kind == JOINT_SEGMENT:
        return velocity, [*acceleration, (math.inf, None), (math.inf, None)]
    tcp = _given(speed.tcp_acceleration, "tcp_acceleration")
    if speed.tcp_acceleration is None and model.tcp_acceleration is not None:
        tcp = (model.tcp_acceleration, None)
    turn = _given(speed.reorientation_acceleration, "reorientation_acceleration")
    if speed.reorientation_acceleration is None and model.reorientation_acceleration is not None:
        turn = (model.reorientation_acceleration, None)
    return velocity, [*acceleration, tcp, turn]


@njit(cache=True, error_model="numpy")
def _fill(
    states: States,
    first_sample: IntArray,
    first_interval: IntArray,
    segment: IntArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    centripetal: float,
    room: FloatArray,
    place: IntArray,
    a: FloatArray,
    b: FloatArray,
    bound: FloatArray,
    ceiling: FloatArray,
    binding: IntArray,
) -> None:
    """Write rows (K, 2, …), bounds and ceilings (K + 1,) with what binds them.

    ``place`` (N + 2,) says which row is whose; −1 of what is limited nowhere.
    """
    axes = states.q.shape[1]
    rate, bend = np.empty(axes + 2), np.empty(axes + 2)
    for p in range(segment.size):
        s = segment[p]
        count = first_interval[p + 1] - first_interval[p]
        for i in range(count + 1):
            k = first_sample[p] + i
            knot = first_interval[p] + i
            rates(states, k, axes, rate, bend)
            for j in range(axes + 2):
                if rate[j] != 0.0:
                    x = (velocity[s, j] / rate[j]) ** 2
                    if x < ceiling[knot]:
                        ceiling[knot] = x
                        binding[knot, 0], binding[knot, 1], binding[knot, 2] = k, j, s
            most = centripetal * acceleration[s, axes]
            if most < np.inf and sideways(states, k) * ceiling[knot] > most:
                ceiling[knot] = most / sideways(states, k)
                binding[knot, 0], binding[knot, 1], binding[knot, 2] = k, CENTRIPETAL, s
            for end in range(2):
                interval = knot - end
                if interval < first_interval[p] or interval >= first_interval[p + 1]:
                    continue
                for j in range(axes + 2):
                    row = place[j]
                    if row < 0:
                        continue
                    limited = acceleration[s, j] < np.inf
                    a[interval, end, row] = rate[j] if limited else 0.0
                    b[interval, end, row] = bend[j] if limited else 0.0
                    bound[interval, end, row] = acceleration[s, j] * (room[p] if j >= axes else 1.0)


@dataclass(frozen=True)
class PathLimits:
    """The limits along a sampled path, with what their reverse needs.

    Args:
        rows: for `stamping.stamp`; those of torque, 2 L of them, are the last.
        limited: (R − 2 L,), which of the N + 2 accelerations the others are of, rising: those that
            are limited somewhere.
        shares: (S, L), what the rows of torque are made of; None where torque limits nothing.
        zones: (Z, 4), zones that legs drive superposed; see `superposed`.
        binding: (K + 1, 3), at each knot the sample, the row and the segment whose velocity
            limit is the ceiling; `CENTRIPETAL` in the place of the row where that is; `ZONE` with
            the zone in the place of the segment where a zone is; a code from `BETWEEN` on where
            limits between samples are; -1 at stops.
    """

    rows: stamping.Limits
    limited: IntArray
    shares: Shares | None
    zones: IntArray
    binding: IntArray


def path_limits(
    states: States,
    spacing: FloatArray,
    pieces: Pieces,
    limits: SegmentLimits,
    zones: IntArray,
    shares: Shares | None = None,
    known: PathLimits | None = None,
) -> PathLimits:
    """Rows and ceilings for stamping a path.

    Args:
        states: (S,) samples, with respect to the parameter that is stamped.
        spacing: (K,), of the intervals in that parameter.
        pieces: the path's pieces.
        limits: of the segments.
        zones: (Z, 4), zones that legs drive superposed.
        shares: (S, L), what share of its torque's limit each joint takes; None if none is limited.
        known: of the same path with the same limits but of velocities; its rows are taken.
    """
    first_sample, first_interval = pieces.first_sample, pieces.first_interval
    limited = np.flatnonzero((limits.acceleration < np.inf).any(axis=0))
    place = np.full(limits.acceleration.shape[1], -1)
    place[limited] = np.arange(len(limited))
    count, rows = int(first_interval[-1]), len(limited)
    torques = 0 if shares is None else 2 * shares.h.shape[1]
    if known is None:
        a, b, lower, upper = (np.zeros((count, 2, rows + torques)) for _ in range(4))
    else:
        place[:] = -1
        a, b, lower, upper = known.rows.rows[:4]
    ceiling = np.full(count + 1, np.inf)
    binding = np.full((count + 1, 3), -1, dtype=np.int64)
    _fill(
        states,
        first_sample,
        first_interval,
        pieces.segment,
        limits.velocity,
        limits.acceleration,
        limits.centripetal,
        room_along(zones, pieces),
        place,
        a,
        b,
        upper,
        ceiling,
        binding,
    )
    stops = first_interval[pieces.stop]
    ceiling[stops] = 0.0
    binding[stops] = -1
    lower_between(states, spacing, pieces, limits.velocity, ceiling, binding)
    lower_ceilings(states, spacing, pieces, limits.acceleration, zones, ceiling, binding)
    if known is None:
        np.negative(upper, out=lower)
    if known is None and shares is not None:
        ends, left = interval_ends(pieces), _torque_left(pieces, limits)
        for first in range(0, count, _TOGETHER):
            part = slice(first, first + _TOGETHER)
            made = torque_rows(shares, ends[part], left[part])
            for whole, own in zip((a, b, lower, upper), made, strict=True):
                whole[part, :, rows:] = own
    found = stamping.Limits(spacing, a, b, lower, upper, ceiling)
    return PathLimits(found, limited, shares, zones, binding)


def _torque_left(pieces: Pieces, limits: SegmentLimits) -> FloatArray:
    """(K,), the share of the torques' limits that may be used in each interval."""
    return limits.torque[np.repeat(pieces.segment, pieces.intervals)]


def interval_samples(pieces: Pieces) -> IntArray:
    """(K,), index of the sample at the left end of each interval."""
    piece = np.repeat(np.arange(len(pieces.segment)), pieces.intervals)
    return np.arange(len(piece)) + piece


def interval_ends(pieces: Pieces) -> IntArray:
    """(K, 2), index of the samples at both ends of each interval."""
    left = interval_samples(pieces)
    return np.stack([left, left + 1], -1)


@njit(cache=True, error_model="numpy")
def _pull_fill(
    states: States,
    first_sample: IntArray,
    first_interval: IntArray,
    segment: IntArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    centripetal: float,
    room: FloatArray,
    binding: IntArray,
    a_bar: FloatArray,
    b_bar: FloatArray,
    bound_bar: FloatArray,
    ceiling_bar: FloatArray,
    states_bar: States,
    velocity_bar: FloatArray,
    acceleration_bar: FloatArray,
) -> None:
    """Reverse of `_fill`."""
    axes = states.q.shape[1]
    rate, bend = np.empty(axes + 2), np.empty(axes + 2)
    rate_bar, bend_bar = np.empty(axes + 2), np.empty(axes + 2)
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
                    if acceleration[s, j] < np.inf:
                        rate_bar[j] += a_bar[interval, end, j]
                        bend_bar[j] += b_bar[interval, end, j]
                        times = room[p] if j >= axes else 1.0
                        acceleration_bar[s, j] += times * bound_bar[interval, end, j]
            pull_rates(states, k, axes, rate_bar, bend_bar, states_bar)


def pull_path_limits(
    states: States,
    pieces: Pieces,
    limits: SegmentLimits,
    made: PathLimits,
    bar: stamping_adjoint.StampGradient,
    states_bar: States,
    speeds_bar: SpeedGradient,
) -> tuple[Shares | None, FloatArray]:
    """Reverse of `path_limits`; adds to the gradients of states, speeds and, in ``bar``, spacing.

    Returns:
        The gradients of the shares of torque, None without, and of the segments' `turning` (M,).
    """
    velocity_bar = np.zeros_like(limits.velocity)
    acceleration_bar = np.zeros_like(limits.acceleration)
    torque_bar = np.zeros_like(limits.torque)
    shape = (len(made.rows.spacing), 2, limits.acceleration.shape[1])
    a_bar, b_bar, bound_bar = (np.zeros(shape) for _ in range(3))
    plain = len(made.limited)
    a_bar[:, :, made.limited] = bar.a[:, :, :plain]
    b_bar[:, :, made.limited] = bar.b[:, :, :plain]
    bound_bar[:, :, made.limited] = (bar.upper - bar.lower)[:, :, :plain]
    pull_between(
        states,
        made.rows.spacing,
        pieces,
        limits.velocity,
        made.rows.ceiling,
        made.binding,
        bar.ceiling,
        states_bar,
        bar.spacing,
        velocity_bar,
    )
    pull_ceilings(
        states,
        made.rows.spacing,
        pieces,
        limits.acceleration,
        made.zones,
        made.binding,
        bar.ceiling,
        states_bar,
        bar.spacing,
        acceleration_bar,
    )
    _pull_fill(
        states,
        pieces.first_sample,
        pieces.first_interval,
        pieces.segment,
        limits.velocity,
        limits.acceleration,
        limits.centripetal,
        room_along(made.zones, pieces),
        made.binding,
        a_bar,
        b_bar,
        bound_bar,
        bar.ceiling,
        states_bar,
        velocity_bar,
        acceleration_bar,
    )
    shares_bar = None
    if made.shares is not None:
        ends, left = interval_ends(pieces), _torque_left(pieces, limits)
        shares_bar, left_bar = pull_torque_rows(made.shares, ends, left, bar)
        np.add.at(torque_bar, np.repeat(pieces.segment, pieces.intervals), left_bar)
    turning_bar = limits.pull(velocity_bar, acceleration_bar, torque_bar, speeds_bar)
    return shares_bar, turning_bar


def pull_turning(segments: Segments, turning_bar: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gradients (M, 3) of the segments' turns a and b from that of `SegmentLimits.turning`."""
    bar = np.where(segments.ends.swivels, turning_bar, 0.0)
    return pull_turn_shares(segments.turn_a, segments.turn_b, bar)
