"""Compiled sums over sub-points and points: the coat, its adjoint, its Jacobian.

All take a range of groups, so that threads may share the work. ``amount`` (S,) is duration times
flow of each segment.
"""

from __future__ import annotations

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.robot.kinematics.vectors import ZERO, Vector, add, dot, load_row, scale
from .kernels import (
    Guns,
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
    rows: FloatArray, n: int, at: int, share: float, pull: Vector, twist: Vector, turns: FloatArray
) -> None:
    """Add derivatives by a waypoint's position and two angles to row n, from column ``at`` on."""
    for j in range(3):
        rows[n, at + j] += share * pull[j]
    for j in range(2):
        rows[n, at + 3 + j] += share * dot(twist, load_row(turns, j))


@compiled
def fill_jacobian(
    surface: Surface,
    guns: Guns,
    amount: FloatArray,
    turns: FloatArray,
    place: IntArray,
    column: IntArray,
    first: int,
    last: int,
    rows: FloatArray,
) -> None:
    """Add the derivatives of the thickness of each point.

    Args:
        turns: (W, 2, 3) derivatives of each waypoint's direction by its two angles.
        place: (W,) first of the five columns (position, angles) of a waypoint.
        column: (S,) of each segment's amount; -1 for segments that are left out.
        rows: (points of the groups, columns).
    """
    starts = surface.blocks.starts
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        if column[i] < 0:
            continue
        gun = gun_at(surface.brush.cone, guns, p)
        weight, ahead = guns.weight[p], guns.share[p]
        front, rear = ahead * weight * amount[i], (1.0 - ahead) * weight * amount[i]
        for g in range(first, last):
            if not meets(surface, gun, g):
                continue
            for k in range(starts[g], starts[g + 1]):
                r, _ = ray(surface, gun, i, k)
                if r < 0.0:
                    continue
                slopes = slopes_at(surface, gun, k, r)
                n = k - starts[first]
                twist = across(gun, guns.length[p], slopes.nozzle)
                rows[n, column[i]] += weight * slopes.value
                _add_waypoint(rows, n, place[i], rear, slopes.tcp, twist, turns[i])
                _add_waypoint(rows, n, place[i + 1], front, slopes.tcp, twist, turns[i + 1])


@compiled
def add_block(columns: IntArray, block: FloatArray, found: FloatArray) -> None:
    """Add a block (k, k) at the rows and columns (k,) of a matrix (n, n)."""
    for i in range(len(columns)):
        for j in range(len(columns)):
            found[columns[i], columns[j]] += block[i, j]
