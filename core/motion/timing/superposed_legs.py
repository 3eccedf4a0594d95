"""How fast zones are driven where each leg is planned from rest to rest.

A controller may begin the next leg while the one before still brakes. If that one brakes by A over
the last e₀ of its way, it does so in T = √(2 e₀ / A) and enters the zone at √(2 A e₀). Superposed
with a next leg that accelerates over its first e₁ in the same time,

    x_wp + (x_entry − x_wp) (1 − t/T)² + (x_exit − x_wp) (t/T)²,

it drives the blend with α = s and β = 0 at an even ds/dt: σ̇² goes from (2 e₀ / T)² to (2 e₁ / T)²,
linear in σ. A tangent arc entered at that speed is driven at it, and one that was made smaller
(`geometry.smaller_blends`) at the speed of the whole zone. Here this is a ceiling on σ̇², with
the longer T, or the lower speed, of those that both legs ask for. A is the greatest acceleration of
a leg, from rest, within the limits of its segment where it meets the zone.

In a parabola the two legs together may change the TCP's speed by up to twice what is programmed,
where it turns back.

Corners of TCP moves alone are driven so: logs of a KR 3 (KUKA) and of a UR10e (Universal Robots)
show it, and that corners of joint moves are not.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner, lean
from ..geometry.corners import POSITION, TCP_CORNER
from ..geometry.curves import ARC, Curves
from ..geometry.layout import Layout
from ..geometry.pieces import PieceIndices, Pieces
from ..path.tcp_samples import States
from .rates import bind, pull_rates, rates

ZONE = -2
"""What stands for a row in `limits.PathLimits.binding` where the ceiling is a zone's."""


class SuperposedZones(NamedTuple):
    """Zones of the TCP that are driven so.

    Args:
        at: (Z, 4), first piece, first behind the waypoint and last piece, and whether it is a
            tangent arc.
        planned: (Z,), the extent that the speed is planned with, in extents of the blend: more
            than one where that was made smaller.
        corner: (Z,), index of the corner.
    """

    at: IntArray
    planned: FloatArray
    corner: IntArray

    @classmethod
    def of(cls, layout: Layout, pieces: Pieces, position: Curves) -> SuperposedZones:
        """Those of a path whose legs are superposed."""
        corners = np.flatnonzero(layout.corners.kind == TCP_CORNER)
        zones = pieces.around(layout.waypoint[corners + 1], layout.extent[corners, POSITION])
        arc = position.kind[pieces.curve[zones[:, 0], POSITION]] == ARC
        kept = layout.corners.kept
        planned = np.ones(len(corners))
        for z, i in enumerate(map(int, corners)):
            if i in kept and arc[z]:
                planned[z] = 1.0 / kept[i].value
        return cls(np.column_stack([zones, arc]).astype(np.int64), planned, corners)

    @classmethod
    def none(cls) -> SuperposedZones:
        """Of a path whose legs are driven one after the other."""
        return cls(np.zeros((0, 4), np.int64), np.zeros(0), np.zeros(0, np.int64))

    def pull_planned(self, bar: FloatArray, corners: int) -> FloatArray:
        """Gradient (M − 1,) of what corners keep from that (Z,) of ``planned``."""
        kept_bar = np.zeros(corners)
        kept_bar[self.corner] = -bar * self.planned**2
        return kept_bar


def room_along(zones: SuperposedZones, pieces: Pieces) -> FloatArray:
    """(P,), what limits of acceleration along the path are multiplied by in each piece."""
    room = np.ones(len(pieces.segment))
    for first, _, last, arc in zones.at:
        if not arc:
            room[first : last + 1] = 2.0
    return room


@inner
def _brakes(
    states: States, k: int, limits: FloatArray, rate: FloatArray, bend: FloatArray
) -> tuple[float, int]:
    """Greatest acceleration from rest at sample k, and the row that bounds it."""
    rates(states, k, limits.size - 2, rate, bend)
    least, row = np.inf, -1
    for j in range(limits.size):
        if rate[j] != 0.0 and limits[j] < least * abs(rate[j]):
            least, row = limits[j] / abs(rate[j]), j
    return least, row


@inner
def _speed(states: States, k: int) -> float:
    """|p'|² at sample k."""
    square = 0.0
    for i in range(3):
        square += states.v[k, i] * states.v[k, i]
    return square


@inner
def _ends(
    spacing: FloatArray, pieces: PieceIndices, zone: IntArray
) -> tuple[tuple[int, int], tuple[int, int], tuple[float, float]]:
    """Samples at a zone's entry and exit, the segments there, and the zone's extents."""
    first_sample, first_interval, segment = pieces
    first, behind, last = zone[0], zone[1], zone[2]
    before = after = 0.0
    for i in range(first_interval[first], first_interval[behind]):
        before += spacing[i]
    for i in range(first_interval[behind], first_interval[last + 1]):
        after += spacing[i]
    samples = first_sample[first], first_sample[last + 1] - 1
    return samples, (segment[first], segment[last]), (before, after)


@inner
def _asked(
    states: States,
    samples: tuple[int, int],
    owners: tuple[int, int],
    extents: tuple[float, float],
    arc: int,
    planned: float,
    acceleration: FloatArray,
    rate: FloatArray,
    bend: FloatArray,
) -> tuple[float, int, float, int]:
    """How fast a zone is driven: (2 / T)² of a parabola, the speed squared of an arc.

    Beside it the side (0 entry, 1 exit) that asks for it, its acceleration and what bounds that.
    """
    least, side, most, row = np.inf, -1, 0.0, -1
    for end in range(2):
        A, j = _brakes(states, samples[end], acceleration[owners[end]], rate, bend)
        e = extents[end]
        square = 2.0 * A * e * planned * _speed(states, samples[end]) if arc else 2.0 * A / e
        if square < least:
            least, side, most, row = square, end, A, j
    return least, side, most, row


def lower_ceilings(
    states: States,
    spacing: FloatArray,
    pieces: PieceIndices,
    acceleration: FloatArray,
    zones: SuperposedZones,
    ceiling: FloatArray,
    binding: IntArray,
) -> None:
    """Lower ceilings (K + 1,) to how fast zones are driven, noting where that binds.

    Args:
        states: (S,) samples.
        spacing: (K,) of the intervals.
        pieces: of the path.
        acceleration: (M, N + 2), limits of the segments.
        zones: those that are driven so.
        ceiling: lowered.
        binding: (K + 1, 3), becomes (`ZONE`, `ZONE`, index of the zone).
    """
    if len(zones.at):
        scratch = np.empty((2, acceleration.shape[1]))
        _lower_ceilings(states, spacing, pieces, acceleration, zones, ceiling, binding, scratch)


@lean
def _lower_ceilings(
    states: States,
    spacing: FloatArray,
    pieces: PieceIndices,
    acceleration: FloatArray,
    zones: SuperposedZones,
    ceiling: FloatArray,
    binding: IntArray,
    scratch: FloatArray,
) -> None:
    first_sample, first_interval, _ = pieces
    rate, bend = scratch[0], scratch[1]
    for z in range(zones.at.shape[0]):
        samples, owners, extents = _ends(spacing, pieces, zones.at[z])
        arc, planned = zones.at[z, 3], zones.planned[z]
        square, side, _, _ = _asked(
            states, samples, owners, extents, arc, planned, acceleration, rate, bend
        )
        if side < 0:
            continue
        before, after = extents
        begin, end = square * before * before, square * after * after
        way = 0.0
        for p in range(zones.at[z, 0], zones.at[z, 2] + 1):
            for i in range(first_interval[p + 1] - first_interval[p] + 1):
                knot = first_interval[p] + i
                if i > 0:
                    way += spacing[knot - 1]
                if arc:
                    x = square / _speed(states, first_sample[p] + i)
                else:
                    x = begin + (end - begin) * way / (before + after)
                if x < ceiling[knot]:
                    ceiling[knot] = x
                    bind(binding, knot, first_sample[p] + i, ZONE, z)


@njit(cache=True, error_model="numpy")
def pull_ceilings(
    states: States,
    spacing: FloatArray,
    pieces: PieceIndices,
    acceleration: FloatArray,
    zones: SuperposedZones,
    binding: IntArray,
    ceiling_bar: FloatArray,
    states_bar: States,
    spacing_bar: FloatArray,
    acceleration_bar: FloatArray,
    planned_bar: FloatArray,
) -> None:
    """Reverse of `lower_ceilings`: adds to the last four."""
    first_interval = pieces.first_interval
    size = acceleration.shape[1]
    rate, bend = np.empty(size), np.empty(size)
    rate_bar, bend_bar = np.zeros(size), np.zeros(size)
    for z in range(zones.at.shape[0]):
        samples, owners, extents = _ends(spacing, pieces, zones.at[z])
        arc, planned = zones.at[z, 3], zones.planned[z]
        square, side, A, row = _asked(
            states, samples, owners, extents, arc, planned, acceleration, rate, bend
        )
        if side < 0:
            continue
        before, after = extents
        whole = before + after
        begin, behind = first_interval[zones.at[z, 0]], first_interval[zones.at[z, 1]]
        end = first_interval[zones.at[z, 2] + 1]
        square_bar = before_bar = after_bar = 0.0
        # Of what is before each knot, backwards: way_bar belongs to the intervals passed so far.
        way, way_bar = whole, 0.0
        for knot in range(end, begin - 1, -1):
            if knot < end:
                spacing_bar[knot] += way_bar
                way -= spacing[knot]
            c = ceiling_bar[knot]
            if c == 0.0 or binding[knot, 1] != ZONE or binding[knot, 2] != z:
                continue
            if arc:
                k = binding[knot, 0]
                speed = _speed(states, k)
                square_bar += c / speed
                for i in range(3):
                    states_bar.v[k, i] -= 2.0 * c * square / speed**2 * states.v[k, i]
                continue
            share = way / whole
            square_bar += c * ((1.0 - share) * before**2 + share * after**2)
            before_bar += c * square * (1.0 - share) * 2.0 * before
            after_bar += c * square * share * 2.0 * after
            share_bar = c * square * (after**2 - before**2)
            # The knots' order is that of the intervals: what lies before this one moves it.
            way_bar += share_bar / whole
            before_bar -= share_bar * share / whole
            after_bar -= share_bar * share / whole
        e, k, owner = extents[side], samples[side], owners[side]
        if arc:
            speed = _speed(states, k)
            A_bar = square_bar * 2.0 * e * planned * speed
            e_bar = square_bar * 2.0 * A * planned * speed
            planned_bar[z] += square_bar * 2.0 * A * e * speed
            for i in range(3):
                states_bar.v[k, i] += square_bar * 2.0 * A * e * planned * 2.0 * states.v[k, i]
        else:
            A_bar, e_bar = square_bar * 2.0 / e, -square_bar * 2.0 * A / e**2
        if side == 0:
            before_bar += e_bar
        else:
            after_bar += e_bar
        for i in range(begin, behind):
            spacing_bar[i] += before_bar
        for i in range(behind, end):
            spacing_bar[i] += after_bar
        _brakes(states, k, acceleration[owner], rate, bend)
        acceleration_bar[owner, row] += A_bar / abs(rate[row])
        rate_bar[row] = -A_bar * A / rate[row]
        pull_rates(states, k, size - 2, rate_bar, bend_bar, states_bar)
        rate_bar[row] = 0.0
