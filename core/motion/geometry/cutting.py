"""Cuts a path into pieces on which every channel is one curve, and says how densely to sample."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner, lean
from .corners import JOINT_CORNER, POSITION, PRESCRIBED, STOP, TCP_CORNER, TURNING
from .curves import POLYNOMIAL, Curves, TcpCurves, parameter_jet
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


class _Lengths(NamedTuple):
    """What tells how densely to sample the M segments; see `Segments`."""

    kind: IntArray
    scale: FloatArray
    length: FloatArray
    angle: FloatArray
    turn_a: FloatArray
    turn_b: FloatArray
    delta_q: FloatArray


class _Cuts(NamedTuple):
    """What is written of P pieces; see `Pieces`."""

    segment: IntArray
    joint_space: NDArray[np.bool_]
    curve: IntArray
    inside: NDArray[np.bool_]
    lean: IntArray
    even: IntArray
    graded: IntArray
    stop: NDArray[np.bool_]


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
    s, kind = layout.segments, layout.corners.kind
    channels = 3 if s.delta_prescribed.shape[1] > 0 else 2
    most = len(layout.waypoint) + 2 * channels * len(kind)
    edge, source = np.empty(most), np.empty((most, 3), dtype=np.int64)
    tiny = 8 * float(np.spacing(layout.waypoint[-1]))
    extent = layout.extent
    count = _bound(layout.waypoint, extent, kind, s.scale, channels, tiny, edge, source)
    edge, source = edge[:count], source[:count]
    cuts = _Cuts(
        np.empty(count - 1, dtype=np.int64),
        np.empty(count - 1, dtype=np.bool_),
        np.empty((count - 1, 3), dtype=np.int64),
        np.empty((count - 1, 3), dtype=np.bool_),
        np.empty(count - 1, dtype=np.int64),
        np.empty(count - 1, dtype=np.int64),
        np.empty((count - 1, 2), dtype=np.int64),
        np.empty(count, dtype=np.bool_),
    )
    _describe(
        edge,
        source,
        layout.waypoint,
        extent,
        kind,
        _Lengths(s.ends.kind, s.scale, s.length, s.angle, s.turn_a, s.turn_b, s.delta_q),
        tcp.position,
        (tcp.position.window, tcp.turning.window, tcp.prescribed.window, joint.window),
        paces,
        flat,
        (sampling.step, sampling.turn, sampling.joint),
        (sampling.blend, sampling.least, sampling.most, sampling.halvings),
        cuts,
    )
    graded = cuts.graded
    if sampling.approach > 0:
        zones = np.asarray(cuts.inside.any(axis=1))
        near = _approach(np.diff(edge) / cuts.even, zones, sampling.approach)
        graded = np.maximum(graded, near)
    return Pieces(
        edge,
        source,
        cuts.segment,
        cuts.joint_space,
        cuts.curve,
        cuts.even + graded.sum(1),
        cuts.even,
        cuts.lean,
        graded,
        cuts.stop,
    )


def _approach(step: FloatArray, inside: NDArray[np.bool_], most: int) -> IntArray:
    """(P, 2), how often intervals next to zones are halved, so as not to be longer than theirs."""
    halvings = np.zeros((len(step), 2), dtype=np.int64)
    ratio = np.log2(step[1:] / step[:-1])
    times = np.clip(np.ceil(np.abs(ratio) - 0.5), 0, most).astype(np.int64)
    halvings[1:, 0] = np.where(inside[:-1] & ~inside[1:] & (ratio > 0), times, 0)
    halvings[:-1, 1] = np.where(~inside[:-1] & inside[1:] & (ratio < 0), times, 0)
    return halvings


def curves_at(
    layout: Layout, sigma: FloatArray, segment: IntArray
) -> tuple[IntArray, IntArray, NDArray[np.bool_]]:
    """Curve index (P, 3) of each channel, corner (P,) of the position's zone, and whether (P, 3)
    zones are there; corner 0 where the position is in none."""
    count = len(sigma)
    curve, corner = np.empty((count, 3), dtype=np.int64), np.empty(count, dtype=np.int64)
    inside = np.empty((count, 3), dtype=np.bool_)
    _curves_at(layout.waypoint, layout.extent, sigma, segment, curve, corner, inside)
    return curve, corner, inside


@lean
def _curves_at(
    waypoint: FloatArray,
    extent: FloatArray,
    sigma: FloatArray,
    segment: IntArray,
    curve: IntArray,
    corner: IntArray,
    inside: NDArray[np.bool_],
) -> None:
    for p in range(sigma.size):
        corner[p] = _channels_at(waypoint, extent, sigma[p], segment[p], curve[p], inside[p])


@lean
def _bound(
    waypoint: FloatArray,
    extent: FloatArray,
    kind: IntArray,
    scale: FloatArray,
    channels: int,
    tiny: float,
    sigma: FloatArray,
    source: IntArray,
) -> int:
    """Write σ and source of all boundaries, in order and without doubles; how many there are."""
    count = 0
    for i in range(waypoint.size):
        if 0 < i < waypoint.size - 1 and kind[i - 1] != STOP:
            for channel in range(channels):
                if channel == POSITION or kind[i - 1] == TCP_CORNER:
                    at = waypoint[i] - extent[i - 1, channel, 0]
                    _insert(sigma, source, count, at, i, channel, 0)
                    at = waypoint[i] + extent[i - 1, channel, 1]
                    _insert(sigma, source, count + 1, at, i, channel, 1)
                    count += 2
        _insert(sigma, source, count, waypoint[i], i, WAYPOINT, 0)
        count += 1
    kept, s, before, allowed = 0, 0, 0.0, 0.0
    for k in range(count):
        here = sigma[k]
        s = _segment_at(waypoint, here, s)
        tolerance = _MERGED * scale[s] + tiny
        apart = k == 0 or here - before > max(tolerance, allowed)
        before, allowed = here, tolerance
        # A waypoint is never merged away: it replaces the boundary it would merge into.
        if not apart and source[k, 1] != WAYPOINT:
            continue
        kept += 1 if apart else 0
        sigma[kept - 1] = here
        for j in range(3):
            source[kept - 1, j] = source[k, j]
    return kept


@inner
def _insert(
    sigma: FloatArray,
    source: IntArray,
    count: int,
    at: float,
    index: int,
    channel: int,
    side: int,
) -> None:
    """Insert a boundary among the ``count`` that are in order: of equals waypoints come first,
    then position edges."""
    rank, k = 2 * channel + side, count
    while k > 0:
        there = 2 * source[k - 1, 1] + source[k - 1, 2]
        if sigma[k - 1] < at or (sigma[k - 1] == at and there <= rank):
            break
        sigma[k] = sigma[k - 1]
        for j in range(3):
            source[k, j] = source[k - 1, j]
        k -= 1
    sigma[k] = at
    source[k, 0], source[k, 1], source[k, 2] = index, channel, side


@inner
def _segment_at(waypoint: FloatArray, sigma: float, first: int) -> int:
    """The segment that σ lies in, no earlier than ``first``."""
    while first < waypoint.size - 2 and waypoint[first + 1] < sigma:
        first += 1
    return first


@lean
def _describe(
    edge: FloatArray,
    source: IntArray,
    waypoint: FloatArray,
    extent: FloatArray,
    kind: IntArray,
    lengths: _Lengths,
    position: Curves,
    windows: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
    paces: NDArray[np.bool_],
    flat: NDArray[np.bool_],
    steps: tuple[float, float, float],
    counts: tuple[int, int, int, int],
    cuts: _Cuts,
) -> None:
    """Write what the pieces between the boundaries are."""
    blend, least, most, halvings = counts
    for k in range(edge.size):
        at, waits = source[k, 0], source[k, 1] == WAYPOINT
        between = 0 < at < waypoint.size - 1
        cuts.stop[k] = not between or (waits and kind[at - 1] == STOP)
        near = halvings if cuts.stop[k] or (waits and paces[at]) else 0
        if k > 0:
            cuts.graded[k - 1, 1] = near
        if k < edge.size - 1:
            cuts.graded[k, 0] = near
    s = 0
    for p in range(edge.size - 1):
        middle = 0.5 * (edge[p] + edge[p + 1])
        s = _segment_at(waypoint, middle, s)
        cuts.segment[p] = s
        corner = _channels_at(waypoint, extent, middle, s, cuts.curve[p], cuts.inside[p])
        blended = cuts.inside[p, POSITION] and kind[corner] == JOINT_CORNER
        space = lengths.kind[s] == JOINT_SEGMENT or blended
        cuts.joint_space[p] = space
        cuts.lean[p] = _lean(edge[p], edge[p + 1], cuts.curve[p], space, windows)
        fine = 0.0
        if cuts.inside[p, 0] or cuts.inside[p, 1] or cuts.inside[p, 2]:
            fine = _FLAT if cuts.inside[p, POSITION] and flat[corner] else 1.0
            if not space:
                fine = max(fine, _sharpness(position, cuts.curve[p, POSITION]))
        wanted = max(blend * fine, float(least))
        share = (edge[p + 1] - edge[p]) / lengths.scale[s]
        turned = _size(lengths.turn_a[s]) + _size(lengths.turn_b[s])
        wanted = max(wanted, share * lengths.length[s] / steps[0])
        wanted = max(wanted, share * max(turned, lengths.angle[s]) / steps[1])
        wanted = max(wanted, share * _size(lengths.delta_q[s]) / steps[2])
        cuts.even[p] = int(min(math.ceil(wanted - 1e-9), float(most))) + 2 * abs(cuts.lean[p])


@inner
def _channels_at(
    waypoint: FloatArray,
    extent: FloatArray,
    middle: float,
    s: int,
    curve: IntArray,
    inside: NDArray[np.bool_],
) -> int:
    """Write each channel's curve at σ in a segment and whether it is a zone's; returns the corner
    of the position's zone, 0 where it is in none."""
    count, corner = waypoint.size - 1, 0
    for channel in range(3):
        curve[channel], inside[channel] = s, False
        if s < count - 1 and middle > waypoint[s + 1] - extent[s, channel, 0]:
            curve[channel], inside[channel] = count + s, True
        if s > 0 and middle < waypoint[s] + extent[s - 1, channel, 1]:
            curve[channel], inside[channel] = count + s - 1, True
        if channel == POSITION and inside[channel]:
            corner = curve[channel] - count
    return corner


@inner
def _lean(
    begin: float,
    end: float,
    curve: IntArray,
    space: bool,
    windows: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
) -> int:
    """How many times s(σ) of the most uneven channel doubles its rate along a piece."""
    if space:
        most = _doublings(windows[3][curve[POSITION]], begin, end)
    else:
        most = _doublings(windows[0][curve[POSITION]], begin, end)
        most = _further(most, _doublings(windows[1][curve[TURNING]], begin, end))
        most = _further(most, _doublings(windows[2][curve[PRESCRIBED]], begin, end))
    if not abs(most) >= _EVEN:
        return 0
    return int(min(max(math.floor(most + 0.5), float(-_MOST_LEAN)), float(_MOST_LEAN)))


@inner
def _further(a: float, b: float) -> float:
    """Which of two numbers is further from 0."""
    return b if abs(b) > abs(a) else a


@inner
def _doublings(window: FloatArray, begin: float, end: float) -> float:
    if window[2] == 1.0 and window[3] == 1.0:
        return 0.0
    return math.log2(parameter_jet(window, end)[1] / parameter_jet(window, begin)[1])


@inner
def _sharpness(position: Curves, curve: int) -> float:
    """How much denser to sample a blend: corners that turn back slow down within little path.

    1 up to a deflection δ of a right angle, then as 1 / cos(δ/2).
    """
    if position.kind[curve] != POLYNOMIAL:
        return 1.0
    one, two = position.control[curve, 1], position.control[curve, 2]
    size, along = _size(one) * _size(two), 0.0
    if not size > 0.0:
        return 1.0
    for i in range(one.size):
        along += one[i] * two[i]
    half = math.sqrt(min(max(0.5 + 0.5 * along / size, 1e-4), 1.0))
    return min(max(math.sqrt(0.5) / half, 1.0), _SHARPEST)


@inner
def _size(vector: FloatArray) -> float:
    square = 0.0
    for i in range(vector.size):
        square += vector[i] * vector[i]
    return math.sqrt(square)
