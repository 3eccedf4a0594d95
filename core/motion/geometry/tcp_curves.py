"""The TCP-space curves of a whole path: nominal segments first, then the corners' blends.

With M segments, curves 0 … M − 1 are the segments' own and curve M + i is the blend of the corner
at waypoint i + 1 (a curve that is never evaluated where the corner is none).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...arrays import FloatArray
from ...spatial.rotation import matrix_from_rotation_vector
from ..model.blend import Blend, BlendGradient
from .corners import POSITION, PRESCRIBED, TCP_CORNER, TURNING
from .curves import ARC, POLYNOMIAL, Curves, TcpCurves
from .layout import (
    Layout,
    LayoutGradient,
    blend_windows,
    pull_blend_windows,
    pull_segment_windows,
    segment_windows,
)
from .segments import EndsGradient, Segments, SegmentsGradient, left_jacobian
from .tangent_arc import TangentArcs, pull_tangent_arcs, tangent_arcs


@dataclass(frozen=True)
class Legs:
    """The nominal positions next to the corners' edges, per λ of each leg.

    Args:
        at: (C, 3) m.
        rate, bend, jerk: (C, 3), first to third derivative with respect to λ.
    """

    at: FloatArray
    rate: FloatArray
    bend: FloatArray
    jerk: FloatArray


def _legs(segments: Segments, which: slice, share: FloatArray) -> Legs:
    """Positions of the segments ``which`` at λ = share (C,)."""
    arc = (segments.shape[which] == ARC)[:, None]
    first, second, third = (segments.position[which, i] for i in range(3))
    swept = segments.angle[which][:, None]
    c, s = np.cos(swept * share[:, None]), np.sin(swept * share[:, None])
    out, along = second * c + third * s, third * c - second * s
    zero = np.zeros_like(first)
    return Legs(
        first + np.where(arc, out, share[:, None] * second),
        np.where(arc, swept * along, second),
        np.where(arc, -(swept**2) * out, zero),
        np.where(arc, -(swept**3) * along, zero),
    )


def _pull_legs(
    segments: Segments,
    which: slice,
    share: FloatArray,
    legs: Legs,
    bars: tuple[FloatArray, FloatArray, FloatArray],
    segments_bar: SegmentsGradient,
) -> FloatArray:
    """Reverse of `_legs` for gradients of at, rate and bend; returns that of ``share``."""
    at, rate, bend = bars
    arc = (segments.shape[which] == ARC)[:, None]
    swept = segments.angle[which][:, None]
    lam = share[:, None]
    c, s = np.cos(swept * lam), np.sin(swept * lam)
    second, third = segments.position[which, 1], segments.position[which, 2]
    out, along = second * c + third * s, third * c - second * s
    second_bar = np.where(arc, c * at - swept * s * rate - swept**2 * c * bend, lam * at + rate)
    third_bar = np.where(arc, s * at + swept * c * rate - swept**2 * s * bend, 0.0)
    segments_bar.position[which, 0] += at
    segments_bar.position[which, 1] += second_bar
    segments_bar.position[which, 2] += third_bar
    by_angle = lam * along * at + (along - swept * lam * out) * rate
    by_angle -= (2 * swept * out + swept**2 * lam * along) * bend
    segments_bar.angle[which] += np.sum(np.where(arc, by_angle, 0.0), axis=1)
    return np.asarray(np.sum(at * legs.rate + rate * legs.bend + bend * legs.jerk, axis=1))


@dataclass(frozen=True)
class TcpGeometry:
    """The TCP curves of a path and what their reverse needs.

    Args:
        layout: σ of everything.
        blend: the law of positions.
        curves: 2 M − 1 curves of each channel.
        before, after: the legs at the entries and exits of the position zones.
        arcs: the tangent arcs, where the vendor blends by arcs.
        slopes: (3, M − 1, 2), of the channels' blends.
    """

    layout: Layout
    blend: Blend
    curves: TcpCurves
    before: Legs
    after: Legs
    arcs: TangentArcs | None
    slopes: FloatArray


def make_tcp_curves(layout: Layout, blend: Blend, orientation: Blend) -> TcpGeometry:
    """The TCP curves of a path.

    Args:
        layout: σ of everything.
        blend, orientation: the laws of positions, and of orientations and prescribed axes.
    """
    segments, corners = layout.segments, layout.corners
    if segments.joint_moves_alone:
        return _no_curves(layout, blend, orientation)
    count = len(segments.scale)
    reach = corners.reach
    before = _legs(segments, slice(None, -1), 1.0 - reach[:, POSITION, 0])
    after = _legs(segments, slice(1, None), reach[:, POSITION, 1])
    arcs = None
    if blend.kind == "arc":
        arcs = tangent_arcs(segments, corners, before.at, before.rate, after.rate)
    slopes = np.stack([law.slopes(count - 1) for law in (blend, orientation, orientation)])
    position = Curves.empty(2 * count - 1, 3, blend.coefficients)
    position.kind[:count] = segments.shape
    position.angle[:count] = segments.angle
    position.control[:count, :3] = segments.position
    position.kind[count:] = POLYNOMIAL
    position.control[count:] = _blend_controls(blend, reach[:, POSITION], before, after)
    if arcs is not None:
        arcs.write(position, slopes[POSITION], count)
    turning = Curves.empty(2 * count - 1, 6, orientation.coefficients)
    turning.control[:count, 1] = np.concatenate([segments.turn_a, segments.turn_b], 1)
    turning.kind[count:] = POLYNOMIAL
    _straight_controls(turning, count, reach[:, TURNING], *turns_at_waypoints(segments))
    reference = segments.ends.rotation[:, 0]
    prescribed = Curves.empty(
        2 * count - 1, segments.delta_prescribed.shape[1], orientation.coefficients
    )
    prescribed.control[:count, 0] = segments.ends.prescribed[:, 0]
    prescribed.control[:count, 1] = segments.delta_prescribed
    prescribed.kind[count:] = POLYNOMIAL
    steps = segments.delta_prescribed
    _straight_controls(prescribed, count, reach[:, PRESCRIBED], steps[:-1], steps[1:])
    prescribed.control[count:, 0] += segments.ends.prescribed[1:, 0]
    for channel, part in enumerate((position, turning, prescribed)):
        part.window[:count] = segment_windows(layout)
        part.window[count:] = blend_windows(layout, channel, slopes[channel])
    curves = TcpCurves(position, turning, np.concatenate([reference, reference[1:]]), prescribed)
    return TcpGeometry(layout, blend, curves, before, after, arcs, slopes)


def _no_curves(layout: Layout, blend: Blend, orientation: Blend) -> TcpGeometry:
    """Curves that stand still, for paths of joint moves, which evaluate none."""
    axes = layout.segments.delta_prescribed.shape[1]
    curves, legs, slopes = _still(len(layout.segments.scale), axes, blend, orientation)
    return TcpGeometry(layout, blend, curves, legs, legs, None, slopes)


@lru_cache(maxsize=32)
def _still(
    count: int, axes: int, blend: Blend, orientation: Blend
) -> tuple[TcpCurves, Legs, FloatArray]:
    """Curves, legs and slopes of ``count`` segments that stand still."""
    position, turning, prescribed = (
        Curves.empty(2 * count - 1, dimension, law.coefficients)
        for dimension, law in ((3, blend), (6, orientation), (axes, orientation))
    )
    reference = np.tile(np.eye(3), (2 * count - 1, 1, 1))
    curves = TcpCurves(position, turning, reference, prescribed)
    legs = Legs(*(np.zeros((count - 1, 3)) for _ in range(4)))
    return curves, legs, np.ones((3, count - 1, 2))


def _blend_controls(blend: Blend, reach: FloatArray, before: Legs, after: Legs) -> FloatArray:
    """Control vectors (C, 6, 3) e, E, X, c, K₁, K₂ of position blends."""
    into, out = reach[:, :1], reach[:, 1:]
    controls = np.zeros((len(reach), 6, 3))
    controls[:, 0] = before.at
    controls[:, 1] = into * before.rate
    controls[:, 2] = out * after.rate
    controls[:, 3] = after.at - before.at - controls[:, 1] - controls[:, 2]
    if blend.meets_curvature:
        controls[:, 4] = into**2 * before.bend
        controls[:, 5] = out**2 * after.bend
    return controls


def turns_at_waypoints(segments: Segments) -> tuple[FloatArray, FloatArray]:
    """Turn rates (C, 6) of the legs before and after the waypoints, in the waypoint's orientation.

    R₀ exp(λ a) exp(λ b) is R_wp exp((λ − 1) a') exp((λ − 1) b) with a' = exp(−b) a.
    """
    back = matrix_from_rotation_vector(-segments.turn_b[:-1])
    into = np.concatenate(
        [np.einsum("kij,kj->ki", back, segments.turn_a[:-1]), segments.turn_b[:-1]], 1
    )
    return into, np.concatenate([segments.turn_a[1:], segments.turn_b[1:]], 1)


def _straight_controls(
    curves: Curves, count: int, reach: FloatArray, into: FloatArray, out: FloatArray
) -> None:
    """Blends of straight legs through zero at the waypoint."""
    curves.control[count:, 0] = -reach[:, :1] * into
    curves.control[count:, 1] = reach[:, :1] * into
    curves.control[count:, 2] = reach[:, 1:] * out


def _pull_straight(
    control_bar: FloatArray, reach: FloatArray, into: FloatArray, out: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Reverse of `_straight_controls`: gradients of reach (C, 2), into and out."""
    toward = control_bar[:, 1] - control_bar[:, 0]
    away = control_bar[:, 2]
    reach_bar = np.stack([np.sum(toward * into, 1), np.sum(away * out, 1)], -1)
    return reach_bar, reach[:, :1] * toward, reach[:, 1:] * away


def pull_tcp_curves(
    geometry: TcpGeometry,
    bar: TcpCurves,
    layout_bar: LayoutGradient,
    reach_bar: FloatArray,
    segments_bar: SegmentsGradient,
    ends_bar: EndsGradient,
    tcp_bar: BlendGradient,
    orientation_bar: BlendGradient,
) -> None:
    """Reverse of `make_tcp_curves`; ``reach_bar`` (M − 1, 3, 2) and the rest are added to."""
    layout, segments = geometry.layout, geometry.layout.segments
    if segments.joint_moves_alone:
        return
    count = len(segments.scale)
    live = layout.corners.kind == TCP_CORNER
    for channel, curves_bar in enumerate((bar.position, bar.turning, bar.prescribed)):
        curves_bar.control[count:][~live] = 0.0
        curves_bar.window[count:][~live] = 0.0
        pull_segment_windows(curves_bar.window[:count], layout_bar, segments_bar)
        slopes_bar = pull_blend_windows(
            layout, channel, geometry.slopes[channel], curves_bar.window[count:], layout_bar
        )
        blend_bar = tcp_bar if channel == POSITION else orientation_bar
        blend_bar.coefficients += curves_bar.coefficients
        if channel == POSITION and geometry.arcs is not None:
            polynomial = ~geometry.arcs.live
            blend_bar.slopes += slopes_bar[polynomial].sum(0)
            pull_tangent_arcs(
                geometry.arcs, bar.position, slopes_bar, count, reach_bar, segments_bar
            )
        else:
            blend_bar.slopes += slopes_bar.sum(0)
    _pull_positions(geometry, bar.position, reach_bar, segments_bar)
    _pull_turning(geometry, bar.turning, reach_bar, segments_bar)
    turned = bar.reference[:, 0]
    ends_bar.turn[:, 0] += turned[:count]
    ends_bar.turn[1:, 0] += turned[count:]
    ends_bar.prescribed[:, 0] += bar.prescribed.control[:count, 0]
    ends_bar.prescribed[1:, 0] += bar.prescribed.control[count:, 0]
    segments_bar.delta_prescribed += bar.prescribed.control[:count, 1]
    steps = segments.delta_prescribed
    by_reach, into, out = _pull_straight(
        bar.prescribed.control[count:],
        layout.corners.reach[:, PRESCRIBED],
        steps[:-1],
        steps[1:],
    )
    reach_bar[:, PRESCRIBED] += by_reach
    segments_bar.delta_prescribed[:-1] += into
    segments_bar.delta_prescribed[1:] += out


def _pull_positions(
    geometry: TcpGeometry, bar: Curves, reach_bar: FloatArray, segments_bar: SegmentsGradient
) -> None:
    segments = geometry.layout.segments
    count = len(segments.scale)
    segments_bar.position += bar.control[:count, :3]
    segments_bar.angle += bar.angle[:count]
    reach = geometry.layout.corners.reach[:, POSITION]
    into, out = reach[:, :1], reach[:, 1:]
    e, entry, leave, close, k1, k2 = (bar.control[count:, i].copy() for i in range(6))
    if not geometry.blend.meets_curvature:
        k1[:] = 0.0
        k2[:] = 0.0
    e, entry, leave = e - close, entry - close, leave - close
    before, after = geometry.before, geometry.after
    share = _pull_legs(
        segments,
        slice(None, -1),
        1.0 - reach[:, 0],
        before,
        (e, into * entry, into**2 * k1),
        segments_bar,
    )
    reach_bar[:, POSITION, 0] += (
        np.sum(entry * before.rate + 2 * into * k1 * before.bend, 1) - share
    )
    share = _pull_legs(
        segments,
        slice(1, None),
        reach[:, 1],
        after,
        (close, out * leave, out**2 * k2),
        segments_bar,
    )
    reach_bar[:, POSITION, 1] += np.sum(leave * after.rate + 2 * out * k2 * after.bend, 1) + share


def _pull_turning(
    geometry: TcpGeometry, bar: Curves, reach_bar: FloatArray, segments_bar: SegmentsGradient
) -> None:
    segments = geometry.layout.segments
    count = len(segments.scale)
    segments_bar.turn_a += bar.control[:count, 1, :3]
    segments_bar.turn_b += bar.control[:count, 1, 3:]
    into, out = turns_at_waypoints(segments)
    by_reach, into_bar, out_bar = _pull_straight(
        bar.control[count:], geometry.layout.corners.reach[:, TURNING], into, out
    )
    reach_bar[:, TURNING] += by_reach
    segments_bar.turn_a[1:] += out_bar[:, :3]
    segments_bar.turn_b[1:] += out_bar[:, 3:]
    b = segments.turn_b[:-1]
    forward = matrix_from_rotation_vector(b)
    segments_bar.turn_a[:-1] += np.einsum("kij,kj->ki", forward, into_bar[:, :3])
    lever = np.cross(into_bar[:, :3], into[:, :3])
    segments_bar.turn_b[:-1] += into_bar[:, 3:]
    segments_bar.turn_b[:-1] += np.einsum("kji,kj->ki", left_jacobian(-b), lever)
