"""Compiled sums over sub-points and points: the coat, its adjoint, its Jacobian.

All take a range of groups, so that threads may share the work. ``amount`` (S,) is duration times
flow of each segment.
"""

from __future__ import annotations

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.robot.kinematics.vectors import ZERO, Vector, add, dot, load_row, scale
from .kernels import (
    Guns,
    Slopes,
    SprayPoint,
    Surface,
    across,
    compiled,
    gun_at,
    meets,
    profile,
    ray,
    slopes_at,
)


@compiled
def add_coat(
    surface: Surface, guns: Guns, amount: FloatArray, first: int, last: int, coat: FloatArray
) -> None:
    """Add the thickness (V,) of the groups from ``first`` up to ``last``, m."""
    brush, starts = surface.brush, surface.blocks.starts
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        share = amount[i] * guns.weight[p]
        if share == 0.0:
            continue
        gun = gun_at(brush.cone, guns, p)
        for g in range(first, last):
            if not meets(surface, gun, g):
                continue
            for k in range(starts[g], starts[g + 1]):
                r, spread = ray(surface, gun, i, k)
                if r >= 0.0:
                    coat[k] += share * spread * profile(brush, r)


@compiled
def live_segments(surface: Surface, guns: Guns, first: int, last: int, live: BoolArray) -> None:
    """Mark the segments (S,) whose cones may meet one of the groups."""
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        gun = gun_at(surface.brush.cone, guns, p)
        g = first
        while g < last and not live[i]:
            live[i] = meets(surface, gun, g)
            g += 1


@compiled
def fill_rates(
    surface: Surface, guns: Guns, column: IntArray, first: int, last: int, rates: FloatArray
) -> None:
    """Add what each segment lays on each point in a second at nominal flow, m/s.

    Args:
        column: (S,) of each segment in ``rates``; -1 for those that are left out.
        rates: (points of the groups, columns).
    """
    brush, starts = surface.brush, surface.blocks.starts
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        if column[i] < 0:
            continue
        own, weight = column[i], guns.weight[p]
        gun = gun_at(brush.cone, guns, p)
        for g in range(first, last):
            if not meets(surface, gun, g):
                continue
            for k in range(starts[g], starts[g + 1]):
                r, spread = ray(surface, gun, i, k)
                if r >= 0.0:
                    rates[k - starts[first], own] += weight * spread * profile(brush, r)


@compiled
def add_adjoint(
    surface: Surface,
    guns: Guns,
    amount: FloatArray,
    adjoint: FloatArray,
    first: int,
    last: int,
    by_tcp: FloatArray,
    by_nozzle: FloatArray,
    by_amount: FloatArray,
) -> None:
    """Add the derivatives of adjoint·coat.

    Args:
        adjoint: (V,).
        by_tcp, by_nozzle: (W, 3) by waypoints' positions, and directions as free vectors.
        by_amount: (S,).
    """
    starts = surface.blocks.starts
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        gun = gun_at(surface.brush.cone, guns, p)
        total, pull, twist = 0.0, ZERO, ZERO
        for g in range(first, last):
            if not meets(surface, gun, g):
                continue
            for k in range(starts[g], starts[g + 1]):
                r, _ = ray(surface, gun, i, k)
                if r < 0.0:
                    continue
                slopes = slopes_at(surface, gun, k, r)
                total += adjoint[k] * slopes.value
                pull = add(pull, scale(adjoint[k], slopes.tcp))
                twist = add(twist, scale(adjoint[k], slopes.nozzle))
        ahead, weight = guns.share[p], guns.weight[p]
        by_amount[i] += weight * total
        twist = across(gun, guns.length[p], twist)
        for w, share in ((i, 1.0 - ahead), (i + 1, ahead)):
            for j in range(3):
                by_tcp[w, j] += share * (weight * amount[i]) * pull[j]
                by_nozzle[w, j] += share * (weight * amount[i]) * twist[j]


@compiled
def _add_waypoint(
    rows: FloatArray, at: int, n: int, share: float, slopes: Slopes, turns: tuple[Vector, Vector]
) -> None:
    """Add derivatives by a waypoint's position and two angles to column n, from row ``at`` on."""
    rows[at, n] += share * slopes.tcp[0]
    rows[at + 1, n] += share * slopes.tcp[1]
    rows[at + 2, n] += share * slopes.tcp[2]
    rows[at + 3, n] += share * dot(slopes.nozzle, turns[0])
    rows[at + 4, n] += share * dot(slopes.nozzle, turns[1])


@compiled
def fill_jacobian(
    surface: Surface,
    guns: Guns,
    amount: FloatArray,
    turns: FloatArray,
    place: IntArray,
    row: IntArray,
    first: int,
    last: int,
    rows: FloatArray,
) -> None:
    """Add the derivatives of the thickness of each point.

    Args:
        turns: (W, 2, 3) derivatives of each waypoint's direction by its two angles.
        place: (W,) first of the five rows (position, angles) of a waypoint.
        row: (S,) of each segment's amount; -1 for segments that are left out.
        rows: (rows, points of the groups); points in a row, since they are worked through in turn.
    """
    starts = surface.blocks.starts
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        if row[i] < 0:
            continue
        gun = gun_at(surface.brush.cone, guns, p)
        weight, ahead = guns.weight[p], guns.share[p]
        front, rear = ahead * weight * amount[i], (1.0 - ahead) * weight * amount[i]
        own, ends = row[i], (place[i], place[i + 1])
        # What a turn does to a unit vector is symmetric: it is done once to the turns instead of to
        # each point's slopes.
        behind = _across_both(gun, guns.length[p], turns[i])
        before = _across_both(gun, guns.length[p], turns[i + 1])
        for g in range(first, last):
            if not meets(surface, gun, g):
                continue
            for k in range(starts[g], starts[g + 1]):
                r, _ = ray(surface, gun, i, k)
                if r < 0.0:
                    continue
                slopes = slopes_at(surface, gun, k, r)
                n = k - starts[first]
                rows[own, n] += weight * slopes.value
                _add_waypoint(rows, ends[0], n, rear, slopes, behind)
                _add_waypoint(rows, ends[1], n, front, slopes, before)


@compiled
def _across_both(gun: SprayPoint, length: float, turns: FloatArray) -> tuple[Vector, Vector]:
    """What two turns (2, 3) of the interpolated direction change of the unit vector."""
    first = across(gun, length, load_row(turns, 0))
    return first, across(gun, length, load_row(turns, 1))


@compiled
def add_block(columns: IntArray, block: FloatArray, found: FloatArray) -> None:
    """Add a block (k, k) at the rows and columns (k,) of a matrix (n, n)."""
    for i in range(len(columns)):
        for j in range(len(columns)):
            found[columns[i], columns[j]] += block[i, j]
