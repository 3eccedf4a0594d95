"""Cuts a path into pieces on which every channel is one curve, and says how densely to sample."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from .corners import JOINT_CORNER, POSITION, PRESCRIBED, STOP, TCP_CORNER, TURNING
from .curves import POLYNOMIAL, Curves, TcpCurves, parameter_slopes
from .layout import Layout
from .pieces import WAYPOINT, Pieces, Sampling
from .segments import JOINT_SEGMENT

_MERGED = 1e-9
"""Boundaries nearer than this share of a segment are one."""
_EVEN = 1.5
"""Doublings of the rate of s(σ) along a piece below which even steps will do."""
_MOST_LEAN = 40
_SHARPEST = 10.0
_FLAT = 3.0
"""How much denser to sample zones whose law is flat at its ends, as `_sharpness`."""


def cut(
    layout: Layout,
    tcp: TcpCurves,
    joint: Curves,
    paces: NDArray[np.bool_],
    flat: NDArray[np.bool_],
    sampling: Sampling,
) -> Pieces:
    """The pieces of a path.

    Args:
        layout: the path's geometry on σ.
        tcp, joint: its curves.
        paces: (M + 1,), waypoints at which the programmed speed changes.
        flat: (M − 1,), corners whose law is flat at its ends.
        sampling: how densely to sample.
    """
    edge, source = _boundaries(layout)
    middle = 0.5 * (edge[1:] + edge[:-1])
    last = len(layout.segments.scale) - 1
    segment = np.clip(np.searchsorted(layout.waypoint, middle) - 1, 0, last)
    curve, corner, inside = curves_at(layout, middle, segment)
    kind = np.concatenate([layout.corners.kind, [STOP]])[corner]
    joint_corner = inside[:, POSITION] & (kind == JOINT_CORNER)
    joint_space = (layout.segments.ends.kind[segment] == JOINT_SEGMENT) | joint_corner
    lean = _lean(edge, curve, joint_space, tcp, joint)
    fine = np.where(np.append(flat, False)[corner] & inside[:, POSITION], _FLAT, 1.0)
    fine = sampling.blend * np.maximum(fine, _sharpness(curve, joint_space, tcp))
    blend = np.where(inside.any(axis=1), fine, 0.0)
    even = _intervals(layout, sampling, np.diff(edge), segment, blend) + 2 * np.abs(lean)
    at_waypoint = source[:, 1] == WAYPOINT
    inner = np.clip(source[:, 0] - 1, 0, max(last - 1, 0))
    ends = (source[:, 0] == 0) | (source[:, 0] == last + 1)
    stop = ends.copy()
    if last > 0:
        stop |= at_waypoint & (layout.corners.kind[inner] == STOP)
    crowded = stop | (at_waypoint & paces[source[:, 0]])
    graded = sampling.halvings * np.stack([crowded[:-1], crowded[1:]], -1)
    if sampling.approach > 0:
        near = _approach(np.diff(edge) / even, np.asarray(inside.any(axis=1)), sampling.approach)
        graded = np.maximum(graded, near)
    intervals = even + graded.sum(1)
    return Pieces(
        edge,
        source,
        segment,
        joint_space,
        curve,
        intervals,
        even,
        lean,
        graded,
        stop,
    )


def _approach(step: FloatArray, inside: NDArray[np.bool_], most: int) -> IntArray:
    """(P, 2), how often intervals next to zones are halved, so as not to be longer than theirs."""
    halvings = np.zeros((len(step), 2), dtype=np.int64)
    ratio = np.log2(step[1:] / step[:-1])
    times = np.clip(np.ceil(np.abs(ratio) - 0.5), 0, most).astype(np.int64)
    halvings[1:, 0] = np.where(inside[:-1] & ~inside[1:] & (ratio > 0), times, 0)
    halvings[:-1, 1] = np.where(~inside[:-1] & inside[1:] & (ratio < 0), times, 0)
    return halvings


def _boundaries(layout: Layout) -> tuple[FloatArray, IntArray]:
    """σ and source of all boundaries, in order and without doubles."""
    count = len(layout.waypoint)
    values = [layout.waypoint]
    sources = [np.stack([np.arange(count), np.full(count, WAYPOINT), np.zeros(count, int)], -1)]
    channels = [POSITION, TURNING]
    if layout.segments.delta_prescribed.shape[1] > 0:
        channels.append(PRESCRIBED)
    for channel in channels:
        live = layout.corners.kind == TCP_CORNER
        if channel == POSITION:
            live = layout.corners.kind != STOP
        index = np.flatnonzero(live)
        for side, sign in ((0, -1.0), (1, 1.0)):
            values.append(layout.waypoint[index + 1] + sign * layout.extent[index, channel, side])
            one = np.ones(len(index), dtype=np.int64)
            sources.append(np.stack([index + 1, channel * one, side * one], -1))
    sigma, source = np.concatenate(values), np.concatenate(sources)
    # Waypoints first among equals, then position edges: the sort is stable.
    order = np.argsort(sigma, kind="stable")
    sigma, source = sigma[order], source[order]
    last = len(layout.segments.scale) - 1
    segment = np.clip(np.searchsorted(layout.waypoint, sigma) - 1, 0, last)
    tolerance = _MERGED * layout.segments.scale[segment] + 8 * np.spacing(sigma[-1])
    keep = np.concatenate([[True], np.diff(sigma) > np.maximum(tolerance[1:], tolerance[:-1])])
    # A waypoint is never merged away: it replaces the boundary it would merge into.
    kept = np.cumsum(keep) - 1
    for i in np.flatnonzero(~keep & (source[:, 1] == WAYPOINT)):
        first = np.searchsorted(kept, kept[i])
        sigma[first], source[first] = sigma[i], source[i]
    return sigma[keep], source[keep].astype(np.int64)


def curves_at(
    layout: Layout, middle: FloatArray, segment: IntArray
) -> tuple[IntArray, IntArray, NDArray[np.bool_]]:
    """Curve index (P, 3) of each channel, corner (P,) it may belong to, and whether (P, 3)."""
    count = len(layout.segments.scale)
    curve = np.repeat(segment[:, None], 3, axis=1)
    inside = np.zeros((len(middle), 3), dtype=bool)
    corner = np.full(len(middle), count - 1)
    for channel in (POSITION, TURNING, PRESCRIBED):
        before = np.concatenate([layout.extent[:, channel, 0], [0.0]])[segment]
        after = np.concatenate([[0.0], layout.extent[:, channel, 1]])[segment]
        entering = middle > layout.waypoint[segment + 1] - before
        leaving = middle < layout.waypoint[segment] + after
        curve[entering, channel] = count + segment[entering]
        curve[leaving, channel] = count + segment[leaving] - 1
        inside[:, channel] = entering | leaving
        if channel == POSITION:
            corner[entering] = segment[entering]
            corner[leaving] = segment[leaving] - 1
    return curve.astype(np.int64), corner, inside


def _lean(
    edge: FloatArray,
    curve: IntArray,
    joint_space: NDArray[np.bool_],
    tcp: TcpCurves,
    joint: Curves,
) -> IntArray:
    """How many times s(σ) of the most uneven channel doubles its rate along each piece."""
    most = np.zeros(len(joint_space))
    for channel, curves in enumerate((tcp.position, tcp.turning, tcp.prescribed)):
        window = curves.window[curve[:, channel]]
        window = np.where(joint_space[:, None], joint.window[curve[:, POSITION]], window)
        before, after = parameter_slopes(window, edge[:-1]), parameter_slopes(window, edge[1:])
        doublings = np.log2(after / before)
        most = np.where(np.abs(doublings) > np.abs(most), doublings, most)
    doubled = np.where(np.abs(most) < _EVEN, 0.0, np.round(most))
    return np.asarray(np.clip(doubled, -_MOST_LEAN, _MOST_LEAN).astype(np.int64))


def _sharpness(curve: IntArray, joint_space: NDArray[np.bool_], tcp: TcpCurves) -> FloatArray:
    """How much denser to sample each piece: corners that turn back slow down within little path.

    1 up to a deflection δ of a right angle, then as 1 / cos(δ/2).
    """
    control = tcp.position.control[curve[:, POSITION]]
    size = np.linalg.norm(control[:, 1], axis=1) * np.linalg.norm(control[:, 2], axis=1)
    blended = (tcp.position.kind[curve[:, POSITION]] == POLYNOMIAL) & ~joint_space & (size > 0)
    along = np.sum(control[:, 1] * control[:, 2], axis=1) / np.where(size > 0, size, 1.0)
    half = np.sqrt(np.clip(0.5 + 0.5 * along, 1e-4, 1.0))
    sharp = np.clip(math.sqrt(0.5) / half, 1.0, _SHARPEST)
    return np.asarray(np.where(blended, sharp, 1.0))


def _intervals(
    layout: Layout,
    sampling: Sampling,
    span: FloatArray,
    segment: IntArray,
    blend: FloatArray,
) -> IntArray:
    """How many intervals each piece gets, ``blend`` (P,) at least."""
    s = layout.segments
    share = span / s.scale[segment]
    turn = np.linalg.norm(s.turn_a, axis=1) + np.linalg.norm(s.turn_b, axis=1)
    swept = np.where(s.angle > 0, s.angle, 0.0)
    wanted = np.maximum.reduce(
        [
            share * s.length[segment] / sampling.step,
            share * np.maximum(turn, swept)[segment] / sampling.turn,
            share * np.linalg.norm(s.delta_q, axis=1)[segment] / sampling.joint,
            np.maximum(blend, float(sampling.least)),
        ]
    )
    return np.asarray(np.minimum(np.ceil(wanted - 1e-9), sampling.most).astype(np.int64))
