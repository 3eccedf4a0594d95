"""How segments and zones change along directions of the waypoints and of the zones' sizes.

Forward derivatives of K directions at once; K is the last axis of all arrays. Branches and active
rules are held, as in the reverse.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import jacobians
from ...spatial.rotation import matrix_from_rotation_vector
from ..geometry.corners import STOP, Corners
from ..geometry.reach import Reach
from ..geometry.segments import (
    ARC_SEGMENT,
    JOINT_SEGMENT,
    TURN_LENGTH,
    Ends,
    Segments,
    left_jacobian,
    left_jacobian_inverse,
)
from ..geometry.swivel import push_swivel

SIZES = ("tcp", "reorientation", "external", "angle")
"""Of zones, as `Reach.parts` names them."""
_HELD = {
    "speed",
    "acceleration",
    "joint_speed",
    "joint_acceleration",
    "joint_fraction",
    "joint_acceleration_fraction",
}
"""What a reach may depend on beside places and sizes: it stays."""


@dataclass(frozen=True)
class Directions:
    """K directions in which a path changes; speeds stay.

    Args:
        waypoints: (M + 1, N, K), of the configurations at the waypoints.
        sizes: (M − 1, K), of the zones, by names of `SIZES`; those that stay are left out. Sizes
            of other kinds of zones count as ``tcp``.
    """

    waypoints: FloatArray
    sizes: Mapping[str, FloatArray]

    @property
    def count(self) -> int:
        """K."""
        return int(self.waypoints.shape[-1])


@dataclass(frozen=True)
class EndsTangents:
    """How `Ends` change.

    Args:
        q: (M, 2, N, K).
        position, turn: (M, 2, 3, K), the latter of left turns of the rotations.
        prescribed: (M, 2, m, K).
    """

    q: FloatArray
    position: FloatArray
    turn: FloatArray
    prescribed: FloatArray


@dataclass(frozen=True)
class SegmentsTangents:
    """How the like-named arrays of `Segments` change, (M, ..., K)."""

    delta_q: FloatArray
    position: FloatArray
    angle: FloatArray
    turn_a: FloatArray
    turn_b: FloatArray
    turn: FloatArray
    delta_prescribed: FloatArray
    length: FloatArray
    scale: FloatArray


def push_ends(
    ends: Ends, chains: Sequence[Chain], prescribed: IntArray, waypoints: FloatArray
) -> EndsTangents:
    """How the segments' ends change with the waypoints (M + 1, N, K).

    Args:
        ends: of M segments.
        chains: (M,) their kinematics.
        prescribed: the axes that inverse kinematics does not solve for.
        waypoints: (M + 1, N, K).
    """
    q = np.stack([waypoints[:-1], waypoints[1:]], 1)
    twist = end_jacobians(ends.q, chains) @ q
    return EndsTangents(q, twist[:, :, :3], twist[:, :, 3:], q[:, :, prescribed])


def end_jacobians(q: FloatArray, chains: Sequence[Chain]) -> FloatArray:
    """(M, 2, 6, N), at start and end q (M, 2, N) of every segment, in its own chain."""
    J = np.empty((*q.shape[:2], 6, q.shape[2]))
    for rows in _same(chains):
        flat = np.ascontiguousarray(q[rows].reshape(-1, q.shape[2]))
        J[rows] = jacobians(chains[rows[0]], flat).reshape(len(rows), 2, 6, -1)
    return J


def _same(chains: Sequence[Chain]) -> list[list[int]]:
    """Indices grouped by identity."""
    groups: dict[int, list[int]] = {}
    for i, chain in enumerate(chains):
        groups.setdefault(id(chain), []).append(i)
    return list(groups.values())


def push_segments(segments: Segments, ends_dot: EndsTangents) -> SegmentsTangents:
    """Forward of `make_segments`."""
    ends = segments.ends
    tcp = (ends.kind != JOINT_SEGMENT)[:, None]
    arc = ends.kind == ARC_SEGMENT
    size = ends_dot.q.shape[-1]
    step = ends_dot.q[:, 1] - ends_dot.q[:, 0]
    delta_q = np.where(tcp[..., None], 0.0, step)
    position = np.zeros((len(arc), 3, 3, size))
    position[:, 0] = np.where(tcp[..., None], ends_dot.position[:, 0], 0.0)
    ahead = ends_dot.position[:, 1] - ends_dot.position[:, 0]
    position[:, 1] = np.where(tcp[..., None], ahead, 0.0)
    angle, turn_a = np.zeros((len(arc), size)), np.zeros((len(arc), 3, size))
    if arc.any():
        position[arc], angle[arc], turn_a[arc] = _push_arcs(segments, ends_dot)
    # exp(−a) R₀ᵀ (θ₁ − θ₀) in the tool's axes at the start, without exp(−a) at first.
    turned = np.einsum(
        "kji,kjn->kin", ends.rotation[:, 0], ends_dot.turn[:, 1] - ends_dot.turn[:, 0]
    )
    if ends.swivels.any():
        turn_a[ends.swivels] = push_swivel(_ends_of_x(ends), turned[ends.swivels])
    back = matrix_from_rotation_vector(-segments.turn_a)
    inner = back @ turned - left_jacobian(-segments.turn_a) @ turn_a
    turn_b = np.where(tcp[..., None], left_jacobian_inverse(segments.turn_b) @ inner, 0.0)
    swung = np.where(arc[:, None], 0.0, _along(segments.turn_a, turn_a))
    turn = (swung + _along(segments.turn_b, turn_b)) / _safe(segments.turn)
    prescribed = np.where(
        tcp[..., None], ends_dot.prescribed[:, 1] - ends_dot.prescribed[:, 0], 0.0
    )
    span = np.linalg.norm(segments.position[:, 1], axis=1)
    span_dot = _along(segments.position[:, 1], position[:, 1]) / _safe(span)
    length = np.where(
        arc[:, None], angle * span[:, None] + segments.angle[:, None] * span_dot, span_dot
    )
    length = np.where(tcp, length, 0.0)
    square = segments.length[:, None] * length + TURN_LENGTH**2 * segments.turn[:, None] * turn
    square += _along(segments.delta_prescribed, prescribed)
    square = np.where(tcp, square, _along(segments.delta_q, delta_q))
    scale = square / _safe(segments.scale)
    return SegmentsTangents(
        delta_q, position, angle, turn_a, turn_b, turn, prescribed, length, scale
    )


def _along(vectors: FloatArray, changes: FloatArray) -> FloatArray:
    """v · v̇, (M, D) and (M, D, K) → (M, K)."""
    return np.asarray(np.einsum("kd,kdn->kn", vectors, changes))


def _safe(sizes: FloatArray) -> FloatArray:
    """(M, 1), to divide by: where a size is none it has no derivative."""
    return np.where(sizes > 0.0, sizes, 1.0)[:, None]


def _ends_of_x(ends: Ends) -> FloatArray:
    """The tool's x axis at the end of lines that swivel, in its axes at the start."""
    lines = ends.swivels
    return np.asarray(
        np.einsum("kji,kj->ki", ends.rotation[lines, 0], ends.rotation[lines, 1, :, 0])
    )


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """a × b of (A, 3, K), either of them (A, 3) too."""
    a, b = (v if v.ndim == 3 else v[:, :, None] for v in (a, b))
    return np.cross(a, b, axis=1)


def _push_arcs(
    segments: Segments, ends_dot: EndsTangents
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """How centre, radius vector and its perpendicular (A, 3, 3, K), swept angle (A, K) and the
    turn that follows (A, 3, K) change; see `segments` for their formulas."""
    ends = segments.ends
    arc = ends.kind == ARC_SEGMENT
    start, start_dot = ends.position[arc, 0], ends_dot.position[arc, 0]
    a, b = ends.via[arc] - start, ends.position[arc, 1] - start
    a_dot, b_dot = -start_dot, ends_dot.position[arc, 1] - start_dot
    w, w_dot = np.cross(a, b), _cross(a_dot, b) + _cross(a, b_dot)
    square = np.sum(w * w, 1)[:, None, None]
    aa, bb = (np.sum(v * v, 1)[:, None] for v in (a, b))
    lever = aa * b - bb * a
    lever_dot = 2 * _along(a, a_dot)[:, None] * b[..., None] + aa[..., None] * b_dot
    lever_dot -= 2 * _along(b, b_dot)[:, None] * a[..., None] + bb[..., None] * a_dot
    offset = np.cross(lever, w) / (2 * square[..., 0])
    offset_dot = (_cross(lever_dot, w) + _cross(lever, w_dot)) / (2 * square)
    offset_dot -= offset[..., None] * (2 * _along(w, w_dot)[:, None] / square)
    root = np.sqrt(square)
    normal = w / root[..., 0]
    normal_dot = (w_dot - normal[..., None] * _along(normal, w_dot)[:, None]) / root
    u, v = segments.position[arc, 1], segments.position[arc, 2]
    u_dot = -offset_dot
    v_dot = _cross(normal_dot, u) + _cross(normal, u_dot)
    end, end_dot = b - offset, b_dot - offset_dot
    y, x = (np.sum(side * end, 1)[:, None] for side in (v, u))
    y_dot = _along(end, v_dot) + _along(v, end_dot)
    x_dot = _along(end, u_dot) + _along(u, end_dot)
    swept, swept_dot = segments.angle[arc], (x * y_dot - y * x_dot) / (x * x + y * y)
    back = np.swapaxes(ends.rotation[arc, 0], 1, 2)
    into = np.einsum("kij,kj->ki", back, normal)
    into_dot = back @ (normal_dot - _cross(ends_dot.turn[arc, 0], normal))
    turn = swept_dot[:, None] * into[..., None] + swept[:, None, None] * into_dot
    turn = np.where(ends.follows[arc][:, None, None], turn, 0.0)
    return np.stack([start_dot + offset_dot, u_dot, v_dot], 1), swept_dot, turn


class ReachTangents:
    """How reaches of zones change.

    Args:
        directions: of the change.
        ends, segments: how they change; None on paths of joint moves alone, whose reaches depend
            on configurations and sizes only.
    """

    def __init__(
        self,
        directions: Directions,
        ends: EndsTangents | None = None,
        segments: SegmentsTangents | None = None,
    ) -> None:
        self._count = directions.count
        waypoints = directions.waypoints
        self._known: dict[str, FloatArray] = {"q0": waypoints[:-1], "q1": waypoints[1:]}
        self._known |= {name: directions.sizes[name] for name in SIZES if name in directions.sizes}
        if ends is not None and segments is not None:
            self._known |= {
                "length": segments.length,
                "arc": segments.angle,
                "turn": segments.turn,
                "position0": ends.position[:, 0],
                "position1": ends.position[:, 1],
            }

    def of(self, reach: Reach) -> FloatArray:
        """(K,), of one reach, or of the room between zones; speeds that it depends on stay."""
        total = np.zeros(self._count)
        for name, index, part in reach.parts:
            if name in self._known:
                # A number times a number, or a row of derivatives times a vector.
                total += np.dot(part, self._known[name][index])
            elif name not in _HELD and name not in SIZES:
                raise ValueError(f"no tangent is known of {name}")
        return total

    def of_corners(self, corners: Corners) -> FloatArray:
        """(M − 1, 3, 2, K), of what the zones reach; zero at stops."""
        found = np.zeros((len(corners.kind), 3, 2, self._count))
        for i, pairs in enumerate(corners.sources):
            if corners.kind[i] == STOP:
                continue
            made: dict[int, FloatArray] = {}
            for channel, pair in enumerate(pairs):
                for side, reach in enumerate(pair):
                    # Channels that reach as far as the position share its reach.
                    if id(reach) not in made:
                        made[id(reach)] = self.of(reach)
                    found[i, channel, side] = made[id(reach)]
        return found
