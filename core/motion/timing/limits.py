"""What bounds the speed along a path: robot, program and motion model as rows and ceilings.

Velocities bound x = σ̇² at the knots: joints |q'| √x ≤ v, TCP |p'| √x ≤ v_tcp, tool |ω| √x ≤ v_ori.
Accelerations are rows on u = σ̈ and x: joints q' u + q'' x, and along the path the change of the
TCP's speed |p'| u + (p' · p'' / |p'|) x and of the tool's rate of turn likewise. Joints that torque
limits (`torque.Torque`) have rows of their own behind these. Centripetal acceleration |p''⊥| x is a
ceiling again, and so are what velocities between samples allow (`between_samples`), how fast legs
that overlap drive zones (`superposed_legs`), and what zones take at least (`least_zone_times`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...arrays import FloatArray, IntArray
from ...program.speed import Speed
from ...robot.joint import JointKind
from ...robot.kinematics.lean import lean
from ...robot.model import Robot
from ..geometry.pieces import PieceIndices, Pieces
from ..geometry.segments import JOINT_SEGMENT, Segments
from ..geometry.swivel import turn_shares
from ..model.motion_model import MotionModel
from ..path.tcp_samples import States
from . import stamping
from .between_samples import lower_between
from .least_zone_times import ZoneStretches
from .rates import bind, rates, sideways
from .stamping_kernels import StampRows
from .superposed_legs import SuperposedZones, lower_ceilings, room_along
from .timed_zones import ROOM, TimedZones
from .torque_rows import Shares, torque_rows

CENTRIPETAL = -3
"""Stands for a row in `PathLimits.binding` where centripetal acceleration is the ceiling."""


@dataclass(frozen=True)
class SegmentLimits:
    """The limits of each segment.

    Args:
        velocity: (M, N + 2), of the joints, the TCP (m/s) and the tool (rad/s); may be inf.
        acceleration: (M, N + 2), likewise.
        torque: (M,), the share of the torques' limits that may be used.
        override: (M,), what of it the override of accelerations makes.
        centripetal: greatest centripetal acceleration of the TCP, in limits of that along the path.
        turning: (M,), what share of its turn a segment's limits of turning count; see `swivel`.
        velocity_source, acceleration_source: (M, N + 2), name of the speed's number behind each
            and its derivative; used in reverse.
        speeds, kinds: (M,), of the segments, which all this follows from but for swivels.
        swivels: whether a segment turns its tool by one.
        zones_bind: whether zones have speeds of their own beside these: of legs that overlap,
            of the least time that a zone takes, of blends in time.
    """

    velocity: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    override: FloatArray
    centripetal: float
    turning: FloatArray
    velocity_source: tuple[tuple[tuple[str, float] | None, ...], ...]
    acceleration_source: tuple[tuple[tuple[str, float] | None, ...], ...]
    speeds: tuple[Speed, ...]
    kinds: IntArray
    swivels: bool
    zones_bind: bool = True

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
            segments.ends.override * [speed.joint_acceleration_fraction for speed in speeds],
            segments.ends.override,
            math.inf if model.centripetal is None else model.centripetal,
            turning,
            tuple(tuple(source for _, source in limits) for limits, _ in made),
            tuple(tuple(source for _, source in limits) for _, limits in made),
            tuple(speeds),
            kinds,
            bool(segments.ends.swivels.any()),
        )

    def hold(self, speeds: Sequence[Speed], segments: Segments) -> bool:
        """Whether they are those of segments driven at these speeds, too."""
        return (
            len(speeds) == len(self.speeds)
            and all(a is b for a, b in zip(speeds, self.speeds, strict=True))
            and segments.ends.kind.tobytes() == self.kinds.tobytes()
            and segments.ends.override.tobytes() == self.override.tobytes()
            and not (segments.ends.swivels.any() or self.swivels)
        )

    @cached_property
    def limited(self) -> tuple[IntArray, IntArray]:
        """Which of the N + 2 accelerations are limited somewhere, rising, and the place (N + 2,) of
        each among them; −1 of the others."""
        limited = np.flatnonzero((self.acceleration < np.inf).any(axis=0))
        place = np.full(self.acceleration.shape[1], -1)
        place[limited] = np.arange(len(limited))
        return limited, place

    def with_velocities_scaled(self, segments: Sequence[int], factor: float) -> SegmentLimits:
        """The same with all velocities of some segments multiplied."""
        velocity = self.velocity.copy()
        velocity[list(segments)] *= factor
        return replace(self, velocity=velocity)


def _turning(segments: Segments) -> FloatArray:
    """(M,), the share of its turn that each segment's limits of turning count."""
    if not segments.ends.swivels.any():
        return np.ones(len(segments.turn))
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
        most = joint.acceleration * speed.acceleration_override
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
    most = math.inf if model.tcp_speed is None else model.tcp_speed
    velocity.append(_least(_given(None if timed else speed.tcp, "tcp"), (most, None)))
    velocity.append(_given(None if timed else speed.reorientation, "reorientation"))
    if kind == JOINT_SEGMENT:
        return velocity, [*acceleration, (math.inf, None), (math.inf, None)]
    tcp = _given(speed.tcp_acceleration, "tcp_acceleration")
    if speed.tcp_acceleration is None and model.tcp_acceleration is not None:
        tcp = (model.tcp_acceleration * speed.acceleration_override, None)
    turn = _given(speed.reorientation_acceleration, "reorientation_acceleration")
    if speed.reorientation_acceleration is None and model.reorientation_acceleration is not None:
        turn = (model.reorientation_acceleration * speed.acceleration_override, None)
    return velocity, [*acceleration, tcp, turn]


@lean
def _fill(
    states: States,
    pieces: PieceIndices,
    velocity: FloatArray,
    acceleration: FloatArray,
    centripetal: float,
    room: FloatArray,
    place: IntArray,
    rows: StampRows,
    ceiling: FloatArray,
    binding: IntArray,
    scratch: FloatArray,
) -> None:
    """Write rows (K, 2, …), and ceilings (K + 1,) with what binds them.

    ``place`` (N + 2,) says which row is whose; −1 of what is limited nowhere.
    """
    first_sample, first_interval, segment = pieces
    axes = states.q.shape[1]
    rate, bend = scratch[0], scratch[1]
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
                        bind(binding, knot, k, j, s)
            most = centripetal * acceleration[s, axes]
            if most < np.inf and sideways(states, k) * ceiling[knot] > most:
                ceiling[knot] = most / sideways(states, k)
                bind(binding, knot, k, CENTRIPETAL, s)
            for end in range(2):
                interval = knot - end
                if interval < first_interval[p] or interval >= first_interval[p + 1]:
                    continue
                for j in range(axes + 2):
                    row = place[j]
                    if row < 0:
                        continue
                    limited = acceleration[s, j] < np.inf
                    rows.a[interval, end, row] = rate[j] if limited else 0.0
                    rows.b[interval, end, row] = bend[j] if limited else 0.0
                    most = acceleration[s, j] * room[p, 1 if j >= axes else 0]
                    rows.lower[interval, end, row], rows.upper[interval, end, row] = -most, most


@dataclass(frozen=True)
class PathLimits:
    """The limits along a sampled path, with what their reverse needs.

    Args:
        rows: for `stamping.stamp`; those of torque, 2 L of them, are the last.
        limited: (R − 2 L,), which of the N + 2 accelerations the others are of, rising: those that
            are limited somewhere.
        shares: (S, L), what the rows of torque are made of; None where torque limits nothing.
        zones: those that legs drive superposed.
        stretches: those that take at least a while.
        timed: those that are blended in time.
        binding: (K + 1, 3), at each knot the sample, the row and the segment whose velocity
            limit is the ceiling; `CENTRIPETAL` in the place of the row where that is; `ZONE` with
            the zone in the place of the segment where a zone is, `LEAST_TIME` with the stretch
            and `TIMED` with the corner; a code from `BETWEEN` on where limits between samples
            are; -1 at stops.
    """

    rows: stamping.StampLimits
    limited: IntArray
    shares: Shares | None
    zones: SuperposedZones
    stretches: ZoneStretches
    timed: TimedZones
    binding: IntArray


def path_limits(
    states: States,
    spacing: FloatArray,
    pieces: Pieces,
    limits: SegmentLimits,
    zones: SuperposedZones,
    stretches: ZoneStretches,
    timed: TimedZones,
    shares: Shares | None = None,
    known: PathLimits | None = None,
) -> PathLimits:
    """Rows and ceilings for stamping a path.

    Args:
        states: (S,) samples, with respect to the parameter that is stamped.
        spacing: (K,), of the intervals in that parameter.
        pieces: the path's pieces.
        limits: of the segments.
        zones: those that legs drive superposed.
        stretches: those that take at least a while.
        timed: those that are blended in time.
        shares: (S, L), what share of its torque's limit each joint takes; None if none is limited.
        known: of the same path with the same limits but of velocities; its rows are taken.
    """
    limited, place = limits.limited
    count, plain = int(pieces.first_interval[-1]), len(limited)
    torques = 0 if shares is None else 2 * shares.h.shape[1]
    if known is None:
        rows = StampRows(*(np.empty((count, 2, plain + torques)) for _ in range(4)))
    else:
        place = np.full_like(place, -1)
        rows = known.rows.rows
    ceiling = np.full(count + 1, np.inf)
    binding = np.full((count + 1, 3), -1, dtype=np.int64)
    velocity, acceleration = limits.velocity, limits.acceleration
    room = rooms(zones, timed, pieces)
    indices, most = pieces.indices, limits.centripetal
    given = states, indices, velocity, acceleration, most, room, place
    _fill(*given, rows, ceiling, binding, np.empty((2, velocity.shape[1])))
    stops = pieces.first_interval[pieces.stop]
    ceiling[stops] = 0.0
    binding[stops] = -1
    lower_between(states, spacing, indices, velocity, ceiling, binding)
    if limits.zones_bind:
        lower_ceilings(states, spacing, indices, acceleration, zones, ceiling, binding)
        stretches.lower(spacing, ceiling, binding)
        timed.lower(ceiling, binding)
    if known is None and shares is not None:
        torque_rows(shares, pieces.interval_ends, torque_left(pieces, limits), rows, plain)
    found = stamping.StampLimits(spacing, *rows, ceiling)
    return PathLimits(found, limited, shares, zones, stretches, timed, binding)


def rooms(zones: SuperposedZones, timed: TimedZones, pieces: Pieces) -> FloatArray:
    """(P, 2), what limits of acceleration are multiplied by in each piece: of joints, and along
    the path."""
    room = np.ones((len(pieces.segment), 2))
    room[timed.timed, 0] = ROOM
    room[:, 1] = room_along(zones, pieces)
    return room


def torque_left(pieces: Pieces, limits: SegmentLimits) -> FloatArray:
    """(K,), the share of the torques' limits that may be used in each interval."""
    return limits.torque[pieces.interval_segments]
