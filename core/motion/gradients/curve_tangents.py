"""How the curves of a path change along directions: forward of `layout`, `tcp_curves` and
`joint_curves`. K directions are the last axis of all arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...spatial.rotation import matrix_from_rotation_vector
from ..geometry.corners import POSITION, PRESCRIBED, STOP, TURNING
from ..geometry.curves import ARC, Curves, CurveTangents
from ..geometry.joint_curves import CornerEdges, quintics
from ..geometry.layout import Layout
from ..geometry.segments import JOINT_SEGMENT, Segments, left_jacobian
from ..geometry.tangent_arc import CornerArc
from ..geometry.tcp_curves import Legs, TcpGeometry, turns_at_waypoints
from ..model.blend import Blend
from .segment_tangents import EndsTangents, ReachTangents, SegmentsTangents


@dataclass(frozen=True)
class LayoutTangents:
    """How a `Layout` and the reaches of its corners change.

    Args:
        reach: (M − 1, 3, 2, K).
        waypoint: (M + 1, K).
        extent: (M − 1, 3, 2, K).
    """

    reach: FloatArray
    waypoint: FloatArray
    extent: FloatArray


def push_layout(
    layout: Layout, reaches: ReachTangents, segments_dot: SegmentsTangents
) -> LayoutTangents:
    """Forward of `Layout.of`."""
    scale, scale_dot = layout.segments.scale, segments_dot.scale
    reach = reaches.of_corners(layout.corners)
    waypoint = np.concatenate([np.zeros((1, scale_dot.shape[1])), np.cumsum(scale_dot, axis=0)])
    both = np.stack([scale[:-1], scale[1:]], -1)[:, None, :, None]
    both_dot = np.stack([scale_dot[:-1], scale_dot[1:]], 1)[:, None]
    extent = reach * both + layout.corners.reach[..., None] * both_dot
    extent[layout.corners.kind == STOP] = 0.0
    return LayoutTangents(reach, waypoint, extent)


def _segment_windows(layout_dot: LayoutTangents, segments_dot: SegmentsTangents) -> FloatArray:
    """(M, 4, K), forward of `segment_windows`."""
    zero = np.zeros_like(segments_dot.scale)
    return np.stack([layout_dot.waypoint[:-1], segments_dot.scale, zero, zero], 1)


def _blend_windows(
    layout: Layout,
    layout_dot: LayoutTangents,
    channel: int,
    slopes: FloatArray,
    slopes_dot: FloatArray | None = None,
) -> FloatArray:
    """(M − 1, 4, K), forward of `blend_windows`; slopes (M − 1, 2, K) that stay are None."""
    before, after = layout.extent[:, channel, 0], layout.extent[:, channel, 1]
    live = ((before > 0) & (after > 0))[:, None]
    a, b = (np.where(live, v[:, None], 1.0) for v in (before, after))
    a_dot, b_dot = layout_dot.extent[:, channel, 0], layout_dot.extent[:, channel, 1]
    turned = (a_dot * b - a * b_dot) / (a + b) ** 2
    entry, leave = slopes[:, :1] * turned, -slopes[:, 1:] * turned
    if slopes_dot is not None:
        entry = entry + slopes_dot[:, 0] * a / (a + b)
        leave = leave + slopes_dot[:, 1] * b / (a + b)
    found = np.stack(
        [layout_dot.waypoint[1:-1] - a_dot, a_dot + b_dot, entry, leave],
        1,
    )
    return np.where(live[:, None], found, 0.0)


class TcpCurvesTangents(NamedTuple):
    """How `TcpCurves` change.

    Args:
        position, turning, prescribed: of the channels' curves.
        reference: (P, 3, K), left turns of R_ref.
    """

    position: CurveTangents
    turning: CurveTangents
    reference: FloatArray
    prescribed: CurveTangents


def push_tcp_curves(
    geometry: TcpGeometry,
    ends_dot: EndsTangents,
    segments_dot: SegmentsTangents,
    layout_dot: LayoutTangents,
) -> TcpCurvesTangents:
    """Forward of `make_tcp_curves`; blend laws stay."""
    layout, curves = geometry.layout, geometry.curves
    segments = layout.segments
    count, size = len(segments.scale), segments_dot.scale.shape[1]
    position, turning, prescribed = (
        CurveTangents.zeros(channel, size)
        for channel in (curves.position, curves.turning, curves.prescribed)
    )
    position.control[:count, :3] = segments_dot.position
    position.angle[:count] = segments_dot.angle
    position.control[count:] = _push_blends(geometry, segments_dot, layout_dot.reach[:, POSITION])
    slopes_dot = _push_arcs(geometry, segments_dot, layout_dot.reach[:, POSITION], position)
    turning.control[:count, 1] = np.concatenate([segments_dot.turn_a, segments_dot.turn_b], 1)
    reach = layout.corners.reach
    _push_straight(
        turning.control[count:],
        reach[:, TURNING],
        layout_dot.reach[:, TURNING],
        turns_at_waypoints(segments),
        _push_turns(segments, segments_dot),
    )
    prescribed.control[:count, 0] = ends_dot.prescribed[:, 0]
    prescribed.control[:count, 1] = segments_dot.delta_prescribed
    steps, steps_dot = segments.delta_prescribed, segments_dot.delta_prescribed
    _push_straight(
        prescribed.control[count:],
        reach[:, PRESCRIBED],
        layout_dot.reach[:, PRESCRIBED],
        (steps[:-1], steps[1:]),
        (steps_dot[:-1], steps_dot[1:]),
    )
    prescribed.control[count:, 0] += ends_dot.prescribed[1:, 0]
    for channel, part in enumerate((position, turning, prescribed)):
        part.window[:count] = _segment_windows(layout_dot, segments_dot)
        part.window[count:] = _blend_windows(
            layout,
            layout_dot,
            channel,
            geometry.slopes[channel],
            slopes_dot if channel == POSITION else None,
        )
    reference = ends_dot.turn[:, 0]
    return TcpCurvesTangents(
        position, turning, np.concatenate([reference, reference[1:]]), prescribed
    )


def _push_legs(
    segments: Segments,
    segments_dot: SegmentsTangents,
    which: slice,
    share: FloatArray,
    share_dot: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """How at, rate and bend of `Legs` change, (C, 3, K) each."""
    arc = (segments.shape[which] == ARC)[:, None, None]
    first_dot, second_dot, third_dot = (segments_dot.position[which, i] for i in range(3))
    second, third = (segments.position[which, i][..., None] for i in (1, 2))
    swept, lam = segments.angle[which][:, None, None], share[:, None, None]
    swept_dot, lam_dot = segments_dot.angle[which][:, None], share_dot[:, None]
    c, s = np.cos(swept * lam), np.sin(swept * lam)
    turned = swept_dot * lam + swept * lam_dot
    out, along = second * c + third * s, third * c - second * s
    out_dot = second_dot * c + third_dot * s + along * turned
    along_dot = third_dot * c - second_dot * s - out * turned
    straight = lam_dot * second + lam * second_dot
    return (
        first_dot + np.where(arc, out_dot, straight),
        np.where(arc, swept_dot * along + swept * along_dot, second_dot),
        np.where(arc, -2 * swept * swept_dot * out - swept**2 * out_dot, 0.0),
    )


def _push_blends(
    geometry: TcpGeometry, segments_dot: SegmentsTangents, reach_dot: FloatArray
) -> FloatArray:
    """(C, 6, 3, K), how the control vectors of position blends change with the reaches' changes
    (C, 2, K) and the legs'."""
    segments = geometry.layout.segments
    reach = geometry.layout.corners.reach[:, POSITION]
    into, into_dot, out, out_dot = reach[:, 0], reach_dot[:, 0], reach[:, 1], reach_dot[:, 1]
    before = _push_legs(segments, segments_dot, slice(None, -1), 1.0 - into, -into_dot)
    after = _push_legs(segments, segments_dot, slice(1, None), out, out_dot)
    controls = np.zeros((len(reach), 6, 3, reach_dot.shape[-1]))
    controls[:, 0] = before[0]
    sides = (
        (1, geometry.before, before, into, into_dot),
        (2, geometry.after, after, out, out_dot),
    )
    for index, legs, legs_dot, share, share_dot in sides:
        controls[:, index], bend = _scaled_leg(legs, legs_dot, share, share_dot)
        if geometry.blend.meets_curvature:
            controls[:, 3 + index] = bend
    controls[:, 3] = after[0] - before[0] - controls[:, 1] - controls[:, 2]
    return controls


def _scaled_leg(
    legs: Legs,
    legs_dot: tuple[FloatArray, FloatArray, FloatArray],
    share: FloatArray,
    share_dot: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """How ρ rate and ρ² bend change."""
    rho, rho_dot = share[:, None, None], share_dot[:, None]
    rate = rho_dot * legs.rate[..., None] + rho * legs_dot[1]
    bend = 2 * rho * rho_dot * legs.bend[..., None] + rho**2 * legs_dot[2]
    return rate, bend


def _push_turns(
    segments: Segments, segments_dot: SegmentsTangents
) -> tuple[FloatArray, FloatArray]:
    """(C, 6, K) each, forward of `turns_at_waypoints`."""
    b, b_dot = segments.turn_b[:-1], segments_dot.turn_b[:-1]
    back = matrix_from_rotation_vector(-b)
    seen = np.einsum("kij,kj->ki", back, segments.turn_a[:-1])
    turned = left_jacobian(-b) @ -b_dot
    into = back @ segments_dot.turn_a[:-1] + np.cross(turned, seen[..., None], axis=1)
    leaving = np.concatenate([segments_dot.turn_a[1:], segments_dot.turn_b[1:]], 1)
    return np.concatenate([into, b_dot], 1), leaving


def _push_straight(
    control_dot: FloatArray,
    reach: FloatArray,
    reach_dot: FloatArray,
    steps: tuple[FloatArray, FloatArray],
    steps_dot: tuple[FloatArray, FloatArray],
) -> None:
    """Write how blends (C, 6, D, K) of straight legs through zero at the waypoint change."""
    into, out = (
        reach_dot[:, side, None] * steps[side][..., None]
        + reach[:, side, None, None] * steps_dot[side]
        for side in range(2)
    )
    control_dot[:, 0], control_dot[:, 1], control_dot[:, 2] = -into, into, out


def _push_arcs(
    geometry: TcpGeometry,
    segments_dot: SegmentsTangents,
    reach_dot: FloatArray,
    position: CurveTangents,
) -> FloatArray | None:
    """Put the changes of tangent arcs in place of those of polynomial blends; returns how the
    slopes of all blends change (C, 2, K), None where they stay."""
    arcs = geometry.arcs
    if arcs is None or not arcs.live.any():
        return None
    count = len(segments_dot.scale)
    slopes_dot = np.zeros((len(arcs.live), 2, segments_dot.scale.shape[1]))
    for i in map(int, np.flatnonzero(arcs.live)):
        arc = CornerArc.of(arcs.reach[i], arcs.step[i])
        step_dot = segments_dot.position[i : i + 2, 1]
        lengths_dot = np.stack([arc.first @ step_dot[0], arc.second @ step_dot[1]])
        units_dot = [
            (step_dot[side] - np.outer(unit, lengths_dot[side])) / arc.lengths[side]
            for side, unit in enumerate((arc.first, arc.second))
        ]
        zone_dot = reach_dot[i, 0] * arc.lengths[0] + arcs.reach[i, 0] * lengths_dot[0]
        cosine_dot = arc.second @ units_dot[0] + arc.first @ units_dot[1]
        sine, half = np.sin(arc.deflection), 0.5 * arc.deflection
        turn_dot = -cosine_dot / sine
        inward_dot = units_dot[1] - np.outer(arc.first, cosine_dot) - arc.cosine * units_dot[0]
        inward_dot = (inward_dot - np.outer(arc.inward, arc.cosine * turn_dot)) / sine
        radius_dot = zone_dot / np.tan(half) - 0.5 * arc.zone * turn_dot / np.sin(half) ** 2
        out_dot = np.outer(arc.inward, radius_dot) + arc.radius * inward_dot
        # The arc begins at the leg's start + (1 − ρ) step.
        start_dot = segments_dot.position[i, 0] + (1.0 - arcs.reach[i, 0]) * step_dot[0]
        start_dot = start_dot - np.outer(arcs.step[i, 0], reach_dot[i, 0])
        position.control[count + i] = 0.0
        position.control[count + i, 0] = start_dot + out_dot
        position.control[count + i, 1] = -out_dot
        position.control[count + i, 2] = np.outer(arc.first, radius_dot) + arc.radius * units_dot[0]
        position.angle[count + i] = turn_dot
        speed_dot = radius_dot * arc.deflection + arc.radius * turn_dot
        extent = (arcs.reach[i] * arc.lengths)[:, None]
        extent_dot = reach_dot[i] * arc.lengths[:, None] + arcs.reach[i][:, None] * lengths_dot
        speed = arc.radius * arc.deflection
        slopes_dot[i] = (speed_dot - speed * extent_dot / extent) / extent
    return slopes_dot


def push_joint_legs(
    layout: Layout,
    waypoints_dot: FloatArray,
    segments_dot: SegmentsTangents,
    layout_dot: LayoutTangents,
) -> CornerEdges:
    """Forward of `CornerEdges.of_joint_legs` for waypoints that change by (M + 1, N, K)."""
    s, reach = layout.segments, layout.corners.reach[:, POSITION]
    reach_dot = layout_dot.reach[:, POSITION]
    scale = np.where(s.scale > 0, s.scale, 1.0)[:, None, None]
    rate_dot = segments_dot.delta_q / scale
    rate_dot = rate_dot - s.delta_q[..., None] * segments_dot.scale[:, None] / scale**2
    joint = (s.ends.kind == JOINT_SEGMENT)[:, None, None]
    at = waypoints_dot[1:-1]
    q, dq = [], []
    for side, which, sign in ((0, slice(None, -1), -1.0), (1, slice(1, None), 1.0)):
        way = reach_dot[:, side, None] * s.delta_q[which][..., None]
        way = way + reach[:, side, None, None] * segments_dot.delta_q[which]
        q.append(np.where(joint[which], at + sign * way, 0.0))
        dq.append(np.where(joint[which], rate_dot[which], 0.0))
    edges = np.stack(q, 1)
    return CornerEdges(edges, np.stack(dq, 1), np.zeros_like(edges))


def push_joint_curves(
    layout: Layout,
    blend: Blend,
    edges: CornerEdges,
    edges_dot: CornerEdges,
    curves: Curves,
    waypoints_dot: FloatArray,
    segments_dot: SegmentsTangents,
    layout_dot: LayoutTangents,
    reaches: ReachTangents,
) -> CurveTangents:
    """Forward of `make_joint_curves`."""
    s, size = layout.segments, segments_dot.scale.shape[1]
    count = len(s.scale)
    made = CurveTangents.zeros(curves, size)
    joint = (s.ends.kind == JOINT_SEGMENT)[:, None, None]
    made.control[:count, 0] = np.where(joint, waypoints_dot[:-1], 0.0)
    made.control[:count, 1] = segments_dot.delta_q
    made.window[:count] = _segment_windows(layout_dot, segments_dot)
    made.control[count:, 0] = edges_dot.q[:, 0]
    way = edges.q[:, 1] - edges.q[:, 0]
    way_dot = edges_dot.q[:, 1] - edges_dot.q[:, 0]
    legs_dot = [_push_leg(layout, layout_dot, edges.dq, edges_dot.dq, side, 1) for side in range(2)]
    if blend.kind == "quintic":
        shape, shape_dot = quintics(layout.corners), np.zeros((count - 1, 5, 3, size))
        for i, timed in layout.corners.timed.items():
            rows = (0, 0), (1, 1), (3, 0), (4, 1)
            for row, reach in zip(rows, timed.parts, strict=True):
                shape_dot[(i, *row)] = reaches.of(reach)
        extent = layout.extent[:, POSITION, :, None]
        legs = np.concatenate([extent * edges.dq, way[:, None]], 1)
        changes = np.stack([*legs_dot, way_dot], 1)
        made.control[count:, 1:] = np.einsum("kij,kjdn->kidn", shape, changes)
        made.control[count:, 1:] += np.einsum("kijn,kjd->kidn", shape_dot, legs)
        slopes = np.ascontiguousarray(shape[:, [0, 1], [0, 1]])
        slopes_dot = shape_dot[:, [0, 1], [0, 1]]
        made.window[count:] = _blend_windows(layout, layout_dot, POSITION, slopes, slopes_dot)
        return made
    made.control[count:, 1], made.control[count:, 2] = legs_dot
    made.control[count:, 3] = way_dot - legs_dot[0] - legs_dot[1]
    if blend.meets_curvature:
        for side in range(2):
            bend = _push_leg(layout, layout_dot, edges.ddq, edges_dot.ddq, side, 2)
            made.control[count:, 4 + side] = bend
    slopes = blend.slopes(count - 1)
    made.window[count:] = _blend_windows(layout, layout_dot, POSITION, slopes)
    return made


def _push_leg(
    layout: Layout,
    layout_dot: LayoutTangents,
    rate: FloatArray,
    rate_dot: FloatArray,
    side: int,
    power: int,
) -> FloatArray:
    """(C, N, K), how extent^power times a derivative at the edge (C, 2, N) changes."""
    extent = layout.extent[:, POSITION, side, None, None]
    extent_dot = layout_dot.extent[:, POSITION, side, None]
    grown = power * extent ** (power - 1) * extent_dot * rate[:, side, :, None]
    return np.asarray(grown + extent**power * rate_dot[:, side])
