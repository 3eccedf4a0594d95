"""Nominal segments: lines in joint space, lines and arcs of the TCP, for a whole path at once.

A segment runs from λ = 0 to 1. TCP segments turn by

    R(λ) = R₀ exp(λ a) exp(λ b),

with a = 0 and b = log(R₀ᵀ R₁) on a line, or, where the controller turns so, a the swivel of the
tool's x axis and b the rotation about it (`swivel`); on an arc whose tool follows it, a is the turn
of the arc and b the rest, so that the tool turns at a constant rate relative to the tangent.

Its scale Λ, the length it takes up on σ, is the joint distance in rad of a joint move, and
√(length² + (c turn)² + external²) of a TCP move, c = `TURN_LENGTH`; the turn is √(a² + b²), on arcs
b alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...spatial.rotation import matrix_from_rotation_vector, rotation_vector, skew
from .curves import ARC, LINE
from .swivel import pull_swivel, swivel

JOINT_SEGMENT, LINE_SEGMENT, ARC_SEGMENT = 0, 1, 2
_AMBIGUOUS = 2 * np.pi / 3
"""rad of arc, or of turn relative to it, beyond which the auxiliary point tells the way round."""
TURN_LENGTH = 0.3
"""m of path that a turn of 1 rad counts as."""


@dataclass(frozen=True)
class Ends:
    """What the segments run between; all frames are each segment's own work object.

    Args:
        kind: (M,) `JOINT_SEGMENT`, `LINE_SEGMENT` or `ARC_SEGMENT`.
        q: (M, 2, N), configurations at start and end.
        position: (M, 2, 3) m.
        rotation: (M, 2, 3, 3).
        prescribed: (M, 2, m), the axes that inverse kinematics does not solve for.
        via: (M, 3) m, the auxiliary point of arcs.
        via_rotation: (M, 3, 3), orientation at the auxiliary point, which tells the way round.
        follows: (M,) bool, arcs whose tool follows the tangent.
        swivels: (M,) bool, lines whose tool turns by swivel and rotation.
        speed: (M,) m/s, programmed of the TCP; inf where none is.
        acceleration: (M,) m/s², programmed of the TCP along its path; inf where none is.
        joint_speed: (M,) rad/s, programmed of the leading joint of joint moves; inf where none is.
        joint_acceleration: (M,) rad/s², likewise.
        joint_fraction, joint_acceleration_fraction: (M,), shares of the joints' own limits.
        override: (M,), what accelerations are multiplied by that the program does not state.
        duration: (M,) s, programmed in place of speeds; inf where none is.
    """

    kind: IntArray
    q: FloatArray
    position: FloatArray
    rotation: FloatArray
    prescribed: FloatArray
    via: FloatArray
    via_rotation: FloatArray
    follows: NDArray[np.bool_]
    swivels: NDArray[np.bool_]
    speed: FloatArray
    acceleration: FloatArray
    joint_speed: FloatArray
    joint_acceleration: FloatArray
    joint_fraction: FloatArray
    joint_acceleration_fraction: FloatArray
    override: FloatArray
    duration: FloatArray


@dataclass
class EndsGradient:
    """Gradient with respect to `Ends`; ``turn`` (M, 2, 3) is of left turns of the rotations."""

    q: FloatArray
    position: FloatArray
    turn: FloatArray
    prescribed: FloatArray
    via: FloatArray
    speed: FloatArray
    acceleration: FloatArray
    joint_speed: FloatArray
    joint_acceleration: FloatArray
    joint_fraction: FloatArray
    joint_acceleration_fraction: FloatArray

    @classmethod
    def zeros(cls, ends: Ends) -> EndsGradient:
        """A gradient to add to."""
        shape = ends.position.shape
        return cls(
            np.zeros(ends.q.shape),
            np.zeros(shape),
            np.zeros(shape),
            np.zeros(ends.prescribed.shape),
            np.zeros(ends.via.shape),
            *np.zeros((6, len(ends.kind))),
        )


@dataclass(frozen=True)
class Segments:
    """Geometry of M segments.

    Args:
        ends: what they run between.
        shape: (M,) `LINE` or `ARC`, of the position.
        delta_q: (M, N), joint difference of joint moves, else 0.
        position: (M, 3, 3), control vectors of the position: start and difference of a line;
            centre, radius vector to the start and its perpendicular of an arc.
        angle: (M,) rad, of arcs.
        turn_a, turn_b: (M, 3), rotation vectors in the start's orientation.
        turn: (M,) rad, how far the tool turns, on arcs beside following them.
        delta_prescribed: (M, m).
        length: (M,) m, of the TCP's path (0 for joint moves).
        scale: (M,), Λ.
    """

    ends: Ends
    shape: IntArray
    delta_q: FloatArray
    position: FloatArray
    angle: FloatArray
    turn_a: FloatArray
    turn_b: FloatArray
    turn: FloatArray
    delta_prescribed: FloatArray
    length: FloatArray
    scale: FloatArray

    @cached_property
    def joint_moves_alone(self) -> bool:
        """Whether no segment is one of the TCP."""
        return not self.ends.kind.any()


@dataclass
class SegmentsGradient:
    """Gradient with respect to the like-named arrays of `Segments`."""

    delta_q: FloatArray
    position: FloatArray
    angle: FloatArray
    turn_a: FloatArray
    turn_b: FloatArray
    turn: FloatArray
    delta_prescribed: FloatArray
    length: FloatArray
    scale: FloatArray

    @classmethod
    def zeros(cls, segments: Segments) -> SegmentsGradient:
        """A gradient to add to."""
        names = cls.__dataclass_fields__
        return cls(**{name: np.zeros(getattr(segments, name).shape) for name in names})


def make_segments(ends: Ends) -> Segments:
    """The segments between the ends."""
    tcp = ends.kind != JOINT_SEGMENT
    if not tcp.any():
        return _joint_segments(ends)
    arc = ends.kind == ARC_SEGMENT
    delta_q = np.where(tcp[:, None], 0.0, ends.q[:, 1] - ends.q[:, 0])
    position = np.zeros((len(tcp), 3, 3))
    position[:, 0] = ends.position[:, 0]
    position[:, 1] = ends.position[:, 1] - ends.position[:, 0]
    angle, turn_a = np.zeros(len(tcp)), np.zeros((len(tcp), 3))
    position[~tcp] = 0.0
    if arc.any():
        centre, normal, swept = _circle(ends, arc)
        radius = ends.position[arc, 0] - centre
        position[arc] = np.stack([centre, radius, np.cross(normal, radius)], 1)
        angle[arc] = swept
        follows = ends.follows[arc]
        turn_a[arc] = np.where(follows[:, None], swept[:, None] * _into(ends, arc, normal), 0.0)
    if ends.swivels.any():
        turn_a[ends.swivels] = swivel(_relative(ends, turn_a)[ends.swivels, :, 0])
    turn_b = np.zeros((len(tcp), 3))
    if tcp.any():
        turn_b[tcp] = rotation_vector(_relative(ends, turn_a)[tcp])
    if arc.any():
        turn_b[arc] = _way_round(ends, arc, position[arc], angle[arc], turn_a[arc], turn_b[arc])
    delta_prescribed = np.where(tcp[:, None], ends.prescribed[:, 1] - ends.prescribed[:, 0], 0.0)
    span = np.linalg.norm(position[:, 1], axis=1)
    length = np.where(arc, angle * span, np.where(tcp, span, 0.0))
    turn = np.hypot(
        np.where(arc, 0.0, np.linalg.norm(turn_a, axis=1)), np.linalg.norm(turn_b, axis=1)
    )
    external = np.linalg.norm(delta_prescribed, axis=1)
    scale = np.where(
        tcp,
        np.sqrt(length**2 + (TURN_LENGTH * turn) ** 2 + external**2),
        np.linalg.norm(delta_q, axis=1),
    )
    shape = np.where(arc, ARC, LINE)
    return Segments(
        ends, shape, delta_q, position, angle, turn_a, turn_b, turn, delta_prescribed, length, scale
    )


def _joint_segments(ends: Ends) -> Segments:
    """The segments of joint moves alone, of which nothing moves in TCP space."""
    count, delta_q = len(ends.kind), ends.q[:, 1] - ends.q[:, 0]
    none, vectors = np.zeros(count), np.zeros((count, 3))
    axes = np.zeros((count, ends.prescribed.shape[2]))
    scale, still = np.linalg.norm(delta_q, axis=1), (vectors, vectors, none, axes, none)
    position = np.zeros((count, 3, 3))
    return Segments(ends, np.full(count, LINE), delta_q, position, none, *still, scale)


def in_time(segments: Segments, ramp: float | None) -> Segments:
    """The segments with the speeds and accelerations that programmed times D stand for.

    Over the way L, driven from stop to stop, that is a speed of L / ((1 − r) D), reached with
    L / (r (1 − r) D²), as `flyby.core.motion.timing.programmed_durations` drives it.

    Args:
        segments: of a path.
        ramp: r, the share of D over which a move accelerates, and again brakes; None for a mean
            speed of L / D, with the accelerations of other moves.
    """
    ends = segments.ends
    timed = np.flatnonzero(np.isfinite(ends.duration))
    if not timed.size:
        return segments
    r, time = ramp or 0.0, ends.duration[timed]
    found: dict[str, Any] = {}
    ways = segments.length, np.abs(segments.delta_q).max(axis=1)
    for name, way in zip(("", "joint_"), ways, strict=True):
        # What does not go anywhere has no speed to reach.
        speed = np.where(way[timed] > 0.0, way[timed] / ((1.0 - r) * time), np.inf)
        rates = {"speed": speed}
        if ramp is not None:
            rates["acceleration"] = speed / (ramp * time)
        for rate, values in rates.items():
            found[name + rate] = getattr(ends, name + rate).copy()
            found[name + rate][timed] = values
    return replace(segments, ends=replace(ends, **found))


def _circle(ends: Ends, arc: NDArray[np.bool_]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Centres (A, 3), unit normals (A, 3) and swept angles (A,) of the arcs.

    The centre lies at (|a|² b − |b|² a) × w / (2 |w|²) from the start, w = a × b, with a and b
    the auxiliary point and the end seen from the start; about w the arc passes a before b.
    """
    start = ends.position[arc, 0]
    a, b = ends.via[arc] - start, ends.position[arc, 1] - start
    w = np.cross(a, b)
    square = np.sum(w * w, 1, keepdims=True)
    y = np.sum(a * a, 1, keepdims=True) * b - np.sum(b * b, 1, keepdims=True) * a
    offset = np.cross(y, w) / (2 * square)
    normal = w / np.sqrt(square)
    u, end = -offset, b - offset
    swept = np.arctan2(np.sum(np.cross(normal, u) * end, 1), np.sum(u * end, 1))
    return start + offset, normal, np.mod(swept, 2 * np.pi)


def _way_round(
    ends: Ends,
    arc: NDArray[np.bool_],
    position: FloatArray,
    angle: FloatArray,
    turn_a: FloatArray,
    turn_b: FloatArray,
) -> FloatArray:
    """The turns b (A, 3) of the arcs, the longer way round where the auxiliary point says so.

    Its orientation "only selects the direction of reorientation" (RAPID Reference Manual, MoveC).
    Where both arc and turn are well below a half circle the turn goes the short way: programs
    often leave that orientation alone.
    """
    offset = ends.via[arc] - position[:, 0]
    reached = np.arctan2(np.sum(offset * position[:, 2], 1), np.sum(offset * position[:, 1], 1))
    share = (np.mod(reached, 2 * np.pi) / angle)[:, None]
    size = np.linalg.norm(turn_b, axis=1, keepdims=True)
    longer = turn_b * (1.0 - 2 * np.pi / np.where(size > 0, size, 1.0))

    def miss(turn: FloatArray) -> FloatArray:
        way = matrix_from_rotation_vector(share * turn_a) @ matrix_from_rotation_vector(
            share * turn
        )
        there = ends.rotation[arc, 0] @ way
        gap = np.swapaxes(there, 1, 2) @ ends.via_rotation[arc]
        return np.asarray(np.linalg.norm(rotation_vector(gap), axis=1, keepdims=True))

    in_doubt = (size > _AMBIGUOUS) | (angle[:, None] > _AMBIGUOUS)
    wanted = ends.follows[arc][:, None] & in_doubt & (miss(longer) < miss(turn_b))
    return np.where(wanted, longer, turn_b)


def _into(ends: Ends, which: NDArray[np.bool_], vectors: FloatArray) -> FloatArray:
    """Vectors of the work object, in the orientation at the start."""
    return np.asarray(np.einsum("kij,ki->kj", ends.rotation[which, 0], vectors))


def _relative(ends: Ends, turn_a: FloatArray) -> FloatArray:
    """exp(−a) R₀ᵀ R₁, (M, 3, 3)."""
    back = matrix_from_rotation_vector(-turn_a)
    return np.asarray(np.einsum("kij,klj,klm->kim", back, ends.rotation[:, 0], ends.rotation[:, 1]))


def pull_segments(segments: Segments, bar: SegmentsGradient, out: EndsGradient) -> None:
    """Reverse of `make_segments`; adds to ``out`` and uses up ``bar``."""
    ends = segments.ends
    if segments.joint_moves_alone:
        safe = np.where(segments.scale > 0, segments.scale, 1.0)
        bar.delta_q += (bar.scale / safe)[:, None] * segments.delta_q
        out.q[:, 1] += bar.delta_q
        out.q[:, 0] -= bar.delta_q
        return
    tcp = ends.kind != JOINT_SEGMENT
    arc = ends.kind == ARC_SEGMENT
    line = tcp & ~arc
    safe = np.where(segments.scale > 0, segments.scale, 1.0)
    share = (bar.scale / safe)[:, None]
    bar.delta_q += np.where(tcp[:, None], 0.0, share * segments.delta_q)
    bar.turn += share[:, 0] * TURN_LENGTH**2 * segments.turn
    turned = np.where(segments.turn > 0, segments.turn, 1.0)
    along = (bar.turn / turned)[:, None]
    bar.turn_a += np.where(arc[:, None], 0.0, along * segments.turn_a)
    bar.turn_b += along * segments.turn_b
    bar.delta_prescribed += share * segments.delta_prescribed
    bar.length += np.where(tcp, share[:, 0] * segments.length, 0.0)
    span = np.linalg.norm(segments.position[:, 1], axis=1)
    unit = segments.position[:, 1] / np.where(span > 0, span, 1.0)[:, None]
    bar.position[:, 1] += (bar.length * np.where(arc, segments.angle, tcp))[:, None] * unit
    bar.angle += np.where(arc, bar.length * span, 0.0)

    out.q[:, 1] += bar.delta_q
    out.q[:, 0] -= bar.delta_q
    out.prescribed[:, 1] += np.where(tcp[:, None], bar.delta_prescribed, 0.0)
    out.prescribed[:, 0] -= np.where(tcp[:, None], bar.delta_prescribed, 0.0)
    out.position[line, 0] += bar.position[line, 0] - bar.position[line, 1]
    out.position[line, 1] += bar.position[line, 1]
    if tcp.any():
        _pull_turns(segments, bar, out, tcp)
    if ends.swivels.any():
        _pull_swivels(segments, bar, out)
    if arc.any():
        _pull_arcs(segments, bar, out, arc)


def left_jacobian_inverse(vector: FloatArray) -> FloatArray:
    """Inverse left Jacobians (..., 3, 3) of rotation vectors (..., 3): δφ = J⁻¹ (left turn)."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    half = 0.5 * np.where(angle > 1e-4, angle, 1.0)
    factor = np.where(
        angle > 1e-4, (1.0 - half / np.tan(half)) / (4 * half**2), 1.0 / 12 + angle**2 / 720
    )
    cross = skew(vector)
    return np.asarray(np.eye(3) - 0.5 * cross + factor * (cross @ cross))


def left_jacobian(vector: FloatArray) -> FloatArray:
    """Left Jacobians (..., 3, 3) of rotation vectors (..., 3): left turn = J δφ."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    safe = np.where(angle > 1e-4, angle, 1.0)
    first = np.where(angle > 1e-4, (1 - np.cos(safe)) / safe**2, 0.5 - angle**2 / 24)
    second = np.where(angle > 1e-4, (safe - np.sin(safe)) / safe**3, 1.0 / 6 - angle**2 / 120)
    cross = skew(vector)
    return np.asarray(np.eye(3) + first * cross + second * (cross @ cross))


def _pull_turns(
    segments: Segments, bar: SegmentsGradient, out: EndsGradient, tcp: NDArray[np.bool_]
) -> None:
    """b = log(exp(−a) R₀ᵀ R₁): δb = J(b)⁻¹ (exp(−a) R₀ᵀ (δθ₁ − δθ₀) − J(−a) δa)."""
    ends = segments.ends
    inner = np.einsum("kji,kj->ki", left_jacobian_inverse(segments.turn_b), bar.turn_b)
    inner = np.where(tcp[:, None], inner, 0.0)
    bar.turn_a -= np.einsum("kji,kj->ki", left_jacobian(-segments.turn_a), inner)
    forward = matrix_from_rotation_vector(segments.turn_a)
    outer = np.einsum("kij,kjl,kl->ki", ends.rotation[:, 0], forward, inner)
    out.turn[:, 1] += outer
    out.turn[:, 0] -= outer


def _pull_swivels(segments: Segments, bar: SegmentsGradient, out: EndsGradient) -> None:
    """Swivels follow from the x axis at the end, R₀ᵀ R₁ x."""
    ends, lines = segments.ends, segments.ends.swivels
    x = _relative(ends, np.zeros_like(segments.turn_a))[lines, :, 0]
    turned = pull_swivel(x, bar.turn_a[lines])
    outer = np.einsum("kij,kj->ki", ends.rotation[lines, 0], turned)
    out.turn[lines, 1] += outer
    out.turn[lines, 0] -= outer


def _pull_arcs(
    segments: Segments, bar: SegmentsGradient, out: EndsGradient, arc: NDArray[np.bool_]
) -> None:
    """Reverse of `_circle` and of what is made from it."""
    ends = segments.ends
    start = ends.position[arc, 0]
    a, b = ends.via[arc] - start, ends.position[arc, 1] - start
    centre, u, v = (segments.position[arc, i] for i in range(3))
    swept = segments.angle[arc][:, None]
    w = np.cross(a, b)
    square = np.sum(w * w, 1, keepdims=True)
    root = np.sqrt(square)
    normal = w / root

    rotated = _into(ends, arc, normal)
    a_bar_turn = np.where(ends.follows[arc][:, None], bar.turn_a[arc], 0.0)
    swept_bar = bar.angle[arc][:, None] + np.sum(a_bar_turn * rotated, 1, keepdims=True)
    normal_bar = swept * np.einsum("kij,kj->ki", ends.rotation[arc, 0], a_bar_turn)
    out.turn[arc, 0] += np.cross(normal_bar, normal)

    centre_bar, u_bar, v_bar = (bar.position[arc, i].copy() for i in range(3))
    # swept = atan2(v · e, u · e) with e = b − offset = end − centre, |e| = r.
    end = ends.position[arc, 1] - centre
    y, x = np.sum(v * end, 1, keepdims=True), np.sum(u * end, 1, keepdims=True)
    weight = swept_bar / (x * x + y * y)
    v_bar += weight * x * end
    u_bar -= weight * y * end
    end_bar = weight * (x * v - y * u)
    # v = normal × u, u = start − centre.
    normal_bar += np.cross(u, v_bar)
    u_bar += np.cross(v_bar, normal)
    start_bar, end_point_bar = u_bar, end_bar
    centre_bar -= u_bar + end_bar
    start_bar = start_bar + centre_bar
    offset_bar = centre_bar
    # offset = (y × w) / (2 |w|²), normal = w / |w|.
    aa, bb = np.sum(a * a, 1, keepdims=True), np.sum(b * b, 1, keepdims=True)
    lever = aa * b - bb * a
    offset = np.cross(lever, w) / (2 * square)
    scaled = offset_bar / (2 * square)
    lever_bar = np.cross(w, scaled)
    w_bar = np.cross(scaled, lever)
    w_bar -= 2 * w / square * np.sum(offset_bar * offset, 1, keepdims=True)
    w_bar += (normal_bar - normal * np.sum(normal * normal_bar, 1, keepdims=True)) / root
    b_bar = aa * lever_bar - 2 * b * np.sum(lever_bar * a, 1, keepdims=True)
    a_bar = -bb * lever_bar + 2 * a * np.sum(lever_bar * b, 1, keepdims=True)
    a_bar += np.cross(b, w_bar)
    b_bar += np.cross(w_bar, a)
    out.via[arc] += a_bar
    out.position[arc, 1] += b_bar + end_point_bar
    out.position[arc, 0] += start_bar - a_bar - b_bar
