"""The joint-space curves of a whole path: joint moves, and corners blended in joint space.

A corner is blended in joint space between two joint moves, between a joint move and a move of
the TCP, and where tool or work object change. Each leg enters by configuration and derivatives
at the zone's edge: a joint line's own, or those of inverse kinematics on the TCP's path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ..model.blend import HERMITE, Blend, BlendGradient
from .corners import JOINT_CORNER, POSITION, Corners
from .curves import POLYNOMIAL, Curves
from .layout import (
    Layout,
    LayoutGradient,
    blend_windows,
    pull_blend_windows,
    pull_segment_windows,
    segment_windows,
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
        reach = layout.corners.reach[:, POSITION]
        rate = s.delta_q / np.where(s.scale > 0, s.scale, 1.0)[:, None]
        joint = (ends.kind == JOINT_SEGMENT)[:, None]
        entry = ends.q[:-1, 1] - reach[:, :1] * s.delta_q[:-1]
        leave = ends.q[1:, 0] + reach[:, 1:] * s.delta_q[1:]
        q = np.stack([np.where(joint[:-1], entry, 0.0), np.where(joint[1:], leave, 0.0)], 1)
        dq = np.stack([np.where(joint[:-1], rate[:-1], 0.0), np.where(joint[1:], rate[1:], 0.0)], 1)
        return cls(q, dq, np.zeros_like(q))

    @classmethod
    def zeros_like(cls, edges: CornerEdges) -> CornerEdges:
        """A gradient to add to."""
        return cls(*(np.zeros_like(edges.q) for _ in range(3)))


def pull_joint_legs(
    layout: Layout,
    bar: CornerEdges,
    reach_bar: FloatArray,
    segments_bar: SegmentsGradient,
    ends_bar: EndsGradient,
) -> None:
    """Reverse of `CornerEdges.of_joint_legs`."""
    s = layout.segments
    reach = layout.corners.reach[:, POSITION]
    for side, which, near, sign in ((0, slice(None, -1), 1, -1.0), (1, slice(1, None), 0, 1.0)):
        live = (layout.corners.kind == JOINT_CORNER) & (s.ends.kind[which] == JOINT_SEGMENT)
        q_bar = np.where(live[:, None], bar.q[:, side], 0.0)
        dq_bar = np.where(live[:, None], bar.dq[:, side], 0.0)
        step, scale = s.delta_q[which], np.where(s.scale[which] > 0, s.scale[which], 1.0)[:, None]
        ends_bar.q[which, near] += q_bar
        reach_bar[:, POSITION, side] += sign * np.sum(q_bar * step, 1)
        segments_bar.delta_q[which] += sign * reach[:, side : side + 1] * q_bar + dq_bar / scale
        segments_bar.scale[which] -= np.sum(dq_bar * step, 1) / scale[:, 0] ** 2


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
    joint = (s.ends.kind == JOINT_SEGMENT)[:, None]
    curves.control[:count, 0] = np.where(joint, s.ends.q[:, 0], 0.0)
    curves.control[:count, 1] = s.delta_q
    curves.kind[count:] = POLYNOMIAL
    before, after = layout.extent[:, POSITION, :1], layout.extent[:, POSITION, 1:]
    entry, leave = before * edges.dq[:, 0], after * edges.dq[:, 1]
    curves.control[count:, 0] = edges.q[:, 0]
    curves.window[:count] = segment_windows(layout)
    if blend.kind == "quintic":
        shape = quintics(layout.corners)
        legs = np.stack([entry, leave, edges.q[:, 1] - edges.q[:, 0]], 1)
        curves.control[count:, 1:] = shape @ legs
        slopes = np.ascontiguousarray(shape[:, [0, 1], [0, 1]])
        curves.window[count:] = blend_windows(layout, POSITION, slopes)
        return curves
    curves.control[count:, 1] = entry
    curves.control[count:, 2] = leave
    curves.control[count:, 3] = edges.q[:, 1] - edges.q[:, 0] - entry - leave
    if blend.meets_curvature:
        curves.control[count:, 4] = before**2 * edges.ddq[:, 0]
        curves.control[count:, 5] = after**2 * edges.ddq[:, 1]
    curves.window[count:] = blend_windows(layout, POSITION, blend.slopes(count - 1))
    return curves


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
    dead = layout.corners.kind != JOINT_CORNER
    bar.control[count:][dead] = 0.0
    bar.window[count:][dead] = 0.0
    tcp = s.ends.kind != JOINT_SEGMENT
    bar.control[:count][tcp] = 0.0
    bar.window[:count][tcp] = 0.0
    ends_bar.q[:, 0] += bar.control[:count, 0]
    segments_bar.delta_q += bar.control[:count, 1]
    pull_segment_windows(bar.window[:count], layout_bar, segments_bar)
    if blend.kind == "quintic":
        return _pull_quintics(layout, edges, bar, layout_bar, timed_bar)
    slopes = blend.slopes(count - 1)
    slopes_bar = pull_blend_windows(layout, POSITION, slopes, bar.window[count:], layout_bar)
    blend_bar.slopes += slopes_bar.sum(0)
    blend_bar.coefficients += bar.coefficients
    out = CornerEdges.zeros_like(edges)
    close = bar.control[count:, 3]
    before, after = layout.extent[:, POSITION, :1], layout.extent[:, POSITION, 1:]
    out.q[:, 0] += bar.control[count:, 0] - close
    out.q[:, 1] += close
    for side, extent, first, second in ((0, before, 1, 4), (1, after, 2, 5)):
        rate_bar = bar.control[count:, first] - close
        out.dq[:, side] += extent * rate_bar
        layout_bar.extent[:, POSITION, side] += np.sum(rate_bar * edges.dq[:, side], 1)
        if blend.meets_curvature:
            bend_bar = bar.control[count:, second]
            out.ddq[:, side] += extent**2 * bend_bar
            layout_bar.extent[:, POSITION, side] += np.sum(
                2 * extent * bend_bar * edges.ddq[:, side], 1
            )
    return out


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
