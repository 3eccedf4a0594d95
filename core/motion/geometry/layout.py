"""Where segments and zones lie on the path parameter σ.

Waypoint i lies at W_i = Σ Λ; segment k spans [W_k, W_k + Λ_k] and a zone reaches from
W_i − ρ_in Λ_{i−1} to W_i + ρ_out Λ_i. Zones never shift the waypoints.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from .corners import JOINT_CORNER, STOP, TCP_CORNER, Corners
from .segments import Segments, SegmentsGradient


@dataclass(frozen=True)
class Layout:
    """σ of everything.

    Args:
        segments: M segments.
        corners: the M − 1 corners.
        waypoint: (M + 1,), σ of the waypoints.
        extent: (M − 1, 3, 2), extent on σ of each zone and channel before and after its waypoint.
    """

    segments: Segments
    corners: Corners
    waypoint: FloatArray
    extent: FloatArray

    @classmethod
    def of(cls, segments: Segments, corners: Corners) -> Layout:
        """The layout of these segments and corners."""
        waypoint, extent = np.zeros(len(segments.scale) + 1), np.zeros(corners.reach.shape)
        _lay_out(segments.scale, corners.kind, corners.reach, waypoint, extent)
        return cls(segments, corners, waypoint, extent)


@lean
def _lay_out(
    scale: FloatArray,
    kind: IntArray,
    reach: FloatArray,
    waypoint: FloatArray,
    extent: FloatArray,
) -> None:
    for k in range(scale.size):
        waypoint[k + 1] = waypoint[k] + scale[k]
    for i in range(kind.size):
        if kind[i] == STOP:
            continue
        for channel in range(3):
            for side in range(2):
                extent[i, channel, side] = reach[i, channel, side] * scale[i + side]


@dataclass
class LayoutGradient:
    """Gradient with respect to the like-named arrays of `Layout`."""

    waypoint: FloatArray
    extent: FloatArray

    @classmethod
    def zeros(cls, layout: Layout) -> LayoutGradient:
        """A gradient to add to."""
        return cls(np.zeros(layout.waypoint.shape), np.zeros(layout.extent.shape))


def pull_layout(layout: Layout, bar: LayoutGradient, segments_bar: SegmentsGradient) -> FloatArray:
    """Reverse of `Layout.of`: adds to the scales' gradient, returns that of the reaches."""
    reach_bar = np.empty(bar.extent.shape)
    scale, reach = layout.segments.scale, layout.corners.reach
    _pull_layout(scale, reach, bar.waypoint, bar.extent, segments_bar.scale, reach_bar)
    return reach_bar


@lean
def _pull_layout(
    scale: FloatArray,
    reach: FloatArray,
    waypoint_bar: FloatArray,
    extent_bar: FloatArray,
    scale_bar: FloatArray,
    reach_bar: FloatArray,
) -> None:
    later = 0.0
    for k in range(scale.size - 1, -1, -1):
        later += waypoint_bar[k + 1]
        scale_bar[k] += later
    for i in range(reach.shape[0]):
        for channel in range(3):
            for side in range(2):
                bar = extent_bar[i, channel, side]
                scale_bar[i + side] += bar * reach[i, channel, side]
                reach_bar[i, channel, side] = bar * scale[i + side]


def flat_corners(kind: IntArray, tcp: bool, joint: bool) -> NDArray[np.bool_]:
    """(M − 1,), whether a corner's blend law is flat at its ends (α' = 0): its path then runs two
    to three times as fast over σ at the waypoint as at the zone's edges.

    Args:
        kind: (M − 1,), of the corners.
        tcp, joint: whether the laws of TCP positions and of joints are flat.
    """
    return np.asarray(((kind == JOINT_CORNER) & joint) | ((kind == TCP_CORNER) & tcp))


def segment_windows(layout: Layout) -> FloatArray:
    """Windows (M, 4) of the nominal curves; see `curves.Curves`."""
    count = len(layout.segments.scale)
    ones = np.ones(count)
    return np.stack([layout.waypoint[:-1], layout.segments.scale, ones, ones], -1)


def blend_windows(layout: Layout, channel: int, slopes: FloatArray) -> FloatArray:
    """Windows (M − 1, 4) of one channel's blends.

    Args:
        layout: the layout.
        channel: which channel's extents.
        slopes: (M − 1, 2), how fast a blend leaves and enters its legs, per s and in units of
            the legs' extents (f'(0) and g'(1) of `blend`).
    """
    before, after = layout.extent[:, channel, 0], layout.extent[:, channel, 1]
    live = (before > 0) & (after > 0)
    length = np.where(live, before + after, 1.0)
    entry = np.where(live, slopes[:, 0] * before / length, 1.0)
    leave = np.where(live, slopes[:, 1] * after / length, 1.0)
    return np.stack([layout.waypoint[1:-1] - before, length, entry, leave], -1)


def pull_segment_windows(
    window_bar: FloatArray, bar: LayoutGradient, segments_bar: SegmentsGradient
) -> None:
    """Reverse of `segment_windows`."""
    bar.waypoint[:-1] += window_bar[:, 0]
    segments_bar.scale += window_bar[:, 1]


def pull_blend_windows(
    layout: Layout,
    channel: int,
    slopes: FloatArray,
    window_bar: FloatArray,
    bar: LayoutGradient,
) -> FloatArray:
    """Reverse of `blend_windows`; returns the gradient (M − 1, 2) of the slopes."""
    before, after = layout.extent[:, channel, 0], layout.extent[:, channel, 1]
    live = (before > 0) & (after > 0)
    a, b = np.where(live, before, 1.0), np.where(live, after, 1.0)
    start, length, entry, leave = (np.where(live, window_bar[:, i], 0.0) for i in range(4))
    k0, k1 = slopes[:, 0], slopes[:, 1]
    bar.waypoint[1:-1] += start
    turned = (k0 * entry - k1 * leave) / (a + b) ** 2
    bar.extent[:, channel, 0] += -start + length + turned * b
    bar.extent[:, channel, 1] += length - turned * a
    return np.stack([entry * a / (a + b), leave * b / (a + b)], -1)
