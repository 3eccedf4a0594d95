"""The joint-space curves of a whole path: joint moves, and corners blended in joint space.

A corner is blended in joint space between two joint moves, between a joint move and a move of
the TCP, and where tool or work object change. Each leg enters by configuration and derivatives
at the zone's edge: a joint line's own, or those of inverse kinematics on the TCP's path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from ..model.blend import HERMITE, Blend, BlendGradient
from .corners import JOINT_CORNER, POSITION, Corners
from .curves import POLYNOMIAL, Curves
from .layout import (
    Layout,
    LayoutGradient,
    blend_windows,
    pull_blend_windows,
)
from .segments import JOINT_SEGMENT, EndsGradient, SegmentsGradient

_PARABOLA = np.array([[2, 0, 0], [0, 2, 0], [0, 0, 1], [-8, -4, 6], [4, 8, -6]], dtype=float)
"""As `quintics` of one corner: the parabola, and 3s² − 2s³ times the gap between the tangents."""


@dataclass
class CornerEdges:
    """Joint states at the edges of the corners blended in joint space; or their gradient.

    Args:
        q, dq, ddq: (M − 1, 2, N), at entry and exit, with respect to σ.
    """

    q: FloatArray
    dq: FloatArray
    ddq: FloatArray

    @classmethod
    def of_joint_legs(cls, layout: Layout) -> CornerEdges:
        """Edges on the joint lines; those on other legs are zero."""
        ends, s = layout.segments.ends, layout.segments
        shape = len(s.scale) - 1, 2, s.delta_q.shape[1]
        edges = cls(np.zeros(shape), np.zeros(shape), np.zeros(shape))
        reach = layout.corners.reach
        _enter_joint_legs(ends.kind, ends.q, s.delta_q, s.scale, reach, edges.q, edges.dq)
        return edges

    @classmethod
    def zeros_like(cls, edges: CornerEdges) -> CornerEdges:
        """A gradient to add to."""
        return cls(*np.zeros((3, *edges.q.shape)))


@lean
def _enter_joint_legs(
    kind: IntArray,
    ends: FloatArray,
    delta_q: FloatArray,
    scale: FloatArray,
    reach: FloatArray,
    q: FloatArray,
    dq: FloatArray,
) -> None:
    for i in range(q.shape[0]):
        for side in range(2):
            k = i + side
            if kind[k] != JOINT_SEGMENT:
                continue
            along = reach[i, POSITION, side] * (1.0 if side else -1.0)
            for j in range(q.shape[2]):
                q[i, side, j] = ends[k, 1 - side, j] + along * delta_q[k, j]
                dq[i, side, j] = delta_q[k, j] / scale[k] if scale[k] > 0.0 else delta_q[k, j]


def pull_joint_legs(
    layout: Layout,
    bar: CornerEdges,
    reach_bar: FloatArray,
    segments_bar: SegmentsGradient,
    ends_bar: EndsGradient,
) -> None:
    """Reverse of `CornerEdges.of_joint_legs`."""
    s, corners = layout.segments, layout.corners
    _pull_joint_legs(
        (corners.kind, s.ends.kind),
        s.delta_q,
        s.scale,
        corners.reach,
        (bar.q, bar.dq),
        ends_bar.q,
        segments_bar.delta_q,
        segments_bar.scale,
        reach_bar,
    )


@lean
def _pull_joint_legs(
    kinds: tuple[IntArray, IntArray],
    delta_q: FloatArray,
    scale: FloatArray,
    reach: FloatArray,
    bar: tuple[FloatArray, FloatArray],
    ends_bar: FloatArray,
    delta_bar: FloatArray,
    scale_bar: FloatArray,
    reach_bar: FloatArray,
) -> None:
    for i in range(reach.shape[0]):
        for side in range(2):
            k, sign = i + side, 1.0 if side else -1.0
            if kinds[0][i] != JOINT_CORNER or kinds[1][k] != JOINT_SEGMENT:
                continue
            length = scale[k] if scale[k] > 0.0 else 1.0
            by_reach = by_scale = 0.0
            for j in range(delta_q.shape[1]):
                q_bar, dq_bar = bar[0][i, side, j], bar[1][i, side, j]
                ends_bar[k, 1 - side, j] += q_bar
                by_reach += q_bar * delta_q[k, j]
                by_scale += dq_bar * delta_q[k, j]
                delta_bar[k, j] += sign * reach[i, POSITION, side] * q_bar + dq_bar / length
            reach_bar[i, POSITION, side] += sign * by_reach
            scale_bar[k] -= by_scale / length**2


def quintics(corners: Corners) -> FloatArray:
    """(M − 1, 5, 3), derivatives at entry and exit, way and second derivatives there of quintics
    over s, by the legs' tangents in the zone and the way from its entry to its exit.

    Those of corners that are blended in time, elsewhere the parabola.
    """
    shape = np.tile(_PARABOLA, (len(corners.kind), 1, 1))
    for i, blend in corners.timed.items():
        (m0, m1), (n0, n1) = blend.rates, blend.bends
        shape[i] = 0.0
        shape[i, [0, 1, 2, 3, 4], [0, 1, 2, 0, 1]] = m0.value, m1.value, 1.0, n0.value, n1.value
    return shape


def make_joint_curves(layout: Layout, blend: Blend, edges: CornerEdges) -> Curves:
    """2 M − 1 curves: the joint moves', and from M on the corners'."""
    s = layout.segments
    count = len(s.scale)
    basis = HERMITE if blend.kind == "quintic" else blend.coefficients
    curves = Curves.empty(2 * count - 1, s.delta_q.shape[1], basis)
    slopes = blend.entry_slope, blend.exit_slope
    _write(
        s.ends.kind,
        s.ends.q,
        s.delta_q,
        (s.scale, layout.waypoint, layout.extent),
        (edges.q, edges.dq, edges.ddq),
        slopes,
        blend.meets_curvature,
        curves,
    )
    if blend.kind == "quintic":
        before, after = layout.extent[:, POSITION, :1], layout.extent[:, POSITION, 1:]
        shape = quintics(layout.corners)
        entry, leave = before * edges.dq[:, 0], after * edges.dq[:, 1]
        legs = np.stack([entry, leave, edges.q[:, 1] - edges.q[:, 0]], 1)
        curves.control[count:, 1:] = shape @ legs
        own = np.ascontiguousarray(shape[:, [0, 1], [0, 1]])
        curves.window[count:] = blend_windows(layout, POSITION, own)
    return curves


@lean
def _write(
    kind: IntArray,
    ends: FloatArray,
    delta_q: FloatArray,
    along: tuple[FloatArray, FloatArray, FloatArray],
    edges: tuple[FloatArray, FloatArray, FloatArray],
    slopes: tuple[float, float],
    meets_curvature: bool,
    curves: Curves,
) -> None:
    """Write the curves of joint moves and of polynomial blends between them."""
    scale, waypoint, extent = along
    q, dq, ddq = edges
    count, window, control = kind.size, curves.window, curves.control
    for k in range(count):
        window[k, 0], window[k, 1] = waypoint[k], scale[k]
        for j in range(delta_q.shape[1]):
            control[k, 0, j] = ends[k, 0, j] if kind[k] == JOINT_SEGMENT else 0.0
            control[k, 1, j] = delta_q[k, j]
    for i in range(count - 1):
        k, before, after = count + i, extent[i, POSITION, 0], extent[i, POSITION, 1]
        curves.kind[k] = POLYNOMIAL
        window[k, 0] = waypoint[i + 1] - before
        if before > 0.0 and after > 0.0:
            window[k, 1] = before + after
            window[k, 2] = slopes[0] * before / (before + after)
            window[k, 3] = slopes[1] * after / (before + after)
        for j in range(delta_q.shape[1]):
            entry, leave = before * dq[i, 0, j], after * dq[i, 1, j]
            control[k, 0, j], control[k, 1, j], control[k, 2, j] = q[i, 0, j], entry, leave
            control[k, 3, j] = q[i, 1, j] - q[i, 0, j] - entry - leave
            if meets_curvature:
                control[k, 4, j] = before**2 * ddq[i, 0, j]
                control[k, 5, j] = after**2 * ddq[i, 1, j]


def pull_joint_curves(
    layout: Layout,
    blend: Blend,
    edges: CornerEdges,
    bar: Curves,
    layout_bar: LayoutGradient,
    segments_bar: SegmentsGradient,
    ends_bar: EndsGradient,
    blend_bar: BlendGradient,
    timed_bar: FloatArray,
) -> CornerEdges:
    """Reverse of `make_joint_curves`; returns the edges' gradient and adds to that (M − 1, 4) of
    the rates and bends of blends in time."""
    s = layout.segments
    count = len(s.scale)
    segments = s.scale, segments_bar.scale, segments_bar.delta_q, ends_bar.q
    _pull_joint_moves(layout.corners.kind, s.ends.kind, bar, layout_bar.waypoint, segments)
    if blend.kind == "quintic":
        return _pull_quintics(layout, edges, bar, layout_bar, timed_bar)
    blend_bar.coefficients += bar.coefficients
    out = CornerEdges.zeros_like(edges)
    _pull_blends(
        layout.extent,
        (edges.dq, edges.ddq),
        (blend.entry_slope, blend.exit_slope),
        blend.meets_curvature,
        bar.window[count:],
        bar.control[count:],
        (layout_bar.waypoint, layout_bar.extent, blend_bar.slopes),
        (out.q, out.dq, out.ddq),
    )
    return out


@lean
def _pull_joint_moves(
    corners: IntArray,
    kind: IntArray,
    bar: Curves,
    waypoint_bar: FloatArray,
    segments: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
) -> None:
    """Reverse of the joint moves' curves; clears the gradients of curves that are none's."""
    _, scale_bar, delta_bar, ends_bar = segments
    count, window, control = kind.size, bar.window, bar.control
    for k in range(2 * count - 1):
        live = kind[k] == JOINT_SEGMENT if k < count else corners[k - count] == JOINT_CORNER
        if not live:
            window[k] = 0.0
            control[k] = 0.0
            continue
        if k < count:
            waypoint_bar[k] += window[k, 0]
            scale_bar[k] += window[k, 1]
            for j in range(delta_bar.shape[1]):
                ends_bar[k, 0, j] += control[k, 0, j]
                delta_bar[k, j] += control[k, 1, j]


@lean
def _pull_blends(
    extent: FloatArray,
    edges: tuple[FloatArray, FloatArray],
    slopes: tuple[float, float],
    meets_curvature: bool,
    window_bar: FloatArray,
    control_bar: FloatArray,
    layout_bar: tuple[FloatArray, FloatArray, FloatArray],
    out: tuple[FloatArray, FloatArray, FloatArray],
) -> None:
    """Reverse of polynomial blends; ``layout_bar``: of waypoints, extents and the law's slopes."""
    dq, ddq = edges
    waypoint_bar, extent_bar, slopes_bar = layout_bar
    for i in range(extent.shape[0]):
        a, b = extent[i, POSITION, 0], extent[i, POSITION, 1]
        if a > 0.0 and b > 0.0:
            start, length = window_bar[i, 0], window_bar[i, 1]
            entry, leave = window_bar[i, 2], window_bar[i, 3]
            waypoint_bar[i + 1] += start
            turned = (slopes[0] * entry - slopes[1] * leave) / (a + b) ** 2
            extent_bar[i, POSITION, 0] += -start + length + turned * b
            extent_bar[i, POSITION, 1] += length - turned * a
            slopes_bar[0] += entry * a / (a + b)
            slopes_bar[1] += leave * b / (a + b)
        for j in range(dq.shape[2]):
            close = control_bar[i, 3, j]
            out[0][i, 0, j] += control_bar[i, 0, j] - close
            out[0][i, 1, j] += close
            for side in range(2):
                far = extent[i, POSITION, side]
                rate_bar = control_bar[i, 1 + side, j] - close
                out[1][i, side, j] += far * rate_bar
                extent_bar[i, POSITION, side] += rate_bar * dq[i, side, j]
                if meets_curvature:
                    bend_bar = control_bar[i, 4 + side, j]
                    out[2][i, side, j] += far**2 * bend_bar
                    extent_bar[i, POSITION, side] += 2 * far * bend_bar * ddq[i, side, j]


def _pull_quintics(
    layout: Layout,
    edges: CornerEdges,
    bar: Curves,
    layout_bar: LayoutGradient,
    timed_bar: FloatArray,
) -> CornerEdges:
    count = len(layout.segments.scale)
    shape, out = quintics(layout.corners), CornerEdges.zeros_like(edges)
    slopes = np.ascontiguousarray(shape[:, [0, 1], [0, 1]])
    timed_bar[:, :2] += pull_blend_windows(layout, POSITION, slopes, bar.window[count:], layout_bar)
    control_bar = bar.control[count:, 1:]
    extent = layout.extent[:, POSITION]
    legs_bar = np.swapaxes(shape, 1, 2) @ control_bar
    out.q[:, 0] += bar.control[count:, 0] - legs_bar[:, 2]
    out.q[:, 1] += legs_bar[:, 2]
    for side in range(2):
        out.dq[:, side] += extent[:, side, None] * legs_bar[:, side]
        layout_bar.extent[:, POSITION, side] += np.sum(legs_bar[:, side] * edges.dq[:, side], 1)
        leg = extent[:, side, None] * edges.dq[:, side]
        timed_bar[:, side] += np.sum(control_bar[:, side] * leg, 1)
        timed_bar[:, 2 + side] += np.sum(control_bar[:, 3 + side] * leg, 1)
    return out
