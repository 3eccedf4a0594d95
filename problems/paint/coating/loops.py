"""Compiled sums over sub-points and points: the coat, its adjoint, its Jacobian.

All take a range of groups, so that threads may share the work. ``amount`` (S,) is duration times
flow of each segment; ``visible`` (V, S) says which points a segment sees, (0, 0) for all.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ....core.arrays import BoolArray, FloatArray, IntArray
from .kernels import Blocks, Brush, Guns, across, gun_at, meets, profile, ray, slopes_of


@njit(cache=True, error_model="numpy", nogil=True)
def add_coat(
    brush: Brush,
    guns: Guns,
    blocks: Blocks,
    visible: BoolArray,
    amount: FloatArray,
    first: int,
    last: int,
    coat: FloatArray,
) -> None:
    """Add the thickness (V,) of the groups from ``first`` up to ``last``, m."""
    knots, coefficients, cone = brush
    points, normals, starts, centres, radii = blocks
    masked = len(visible) > 0
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        share = amount[i] * guns.weight[p]
        if share == 0.0:
            continue
        gun = gun_at(cone, guns, p)
        for g in range(first, last):
            if not meets(cone, gun, centres[g, 0], centres[g, 1], centres[g, 2], radii[g]):
                continue
            for k in range(starts[g], starts[g + 1]):
                if masked and not visible[k, i]:
                    continue
                px, py, pz = points[k, 0], points[k, 1], points[k, 2]
                nx, ny, nz = normals[k, 0], normals[k, 1], normals[k, 2]
                r, scale = ray(cone, gun, px, py, pz, nx, ny, nz)
                if r < 0.0:
                    continue
                coat[k] += share * scale * profile(knots, coefficients, r)


@njit(cache=True, error_model="numpy", nogil=True)
def live_segments(
    brush: Brush, guns: Guns, blocks: Blocks, first: int, last: int, live: BoolArray
) -> None:
    """Mark the segments (S,) whose cones may meet one of the groups."""
    cone, centres, radii = brush.cone, blocks.centres, blocks.radii
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        gun = gun_at(cone, guns, p)
        g = first
        while g < last and not live[i]:
            live[i] = meets(cone, gun, centres[g, 0], centres[g, 1], centres[g, 2], radii[g])
            g += 1


@njit(cache=True, error_model="numpy", nogil=True)
def fill_rates(
    brush: Brush,
    guns: Guns,
    blocks: Blocks,
    visible: BoolArray,
    column: IntArray,
    first: int,
    last: int,
    rates: FloatArray,
) -> None:
    """Add what each segment lays on each point in a second at nominal flow, m/s.

    Args:
        column: (S,) of each segment in ``rates``; -1 for those that are left out.
        rates: (points of the groups, columns).
    """
    knots, coefficients, cone = brush
    points, normals, starts, centres, radii = blocks
    masked = len(visible) > 0
    start = starts[first]
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        if column[i] < 0:
            continue
        own, weight = column[i], guns.weight[p]
        gun = gun_at(cone, guns, p)
        for g in range(first, last):
            if not meets(cone, gun, centres[g, 0], centres[g, 1], centres[g, 2], radii[g]):
                continue
            for k in range(starts[g], starts[g + 1]):
                if masked and not visible[k, i]:
                    continue
                px, py, pz = points[k, 0], points[k, 1], points[k, 2]
                nx, ny, nz = normals[k, 0], normals[k, 1], normals[k, 2]
                r, scale = ray(cone, gun, px, py, pz, nx, ny, nz)
                if r < 0.0:
                    continue
                rates[k - start, own] += weight * scale * profile(knots, coefficients, r)


@njit(cache=True, error_model="numpy", nogil=True)
def add_adjoint(
    brush: Brush,
    guns: Guns,
    blocks: Blocks,
    visible: BoolArray,
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
    knots, coefficients, cone = brush
    points, normals, starts, centres, radii = blocks
    masked = len(visible) > 0
    twist = np.zeros(3)
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        gun = gun_at(cone, guns, p)
        total, x, y, z, a, b, c = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for g in range(first, last):
            if not meets(cone, gun, centres[g, 0], centres[g, 1], centres[g, 2], radii[g]):
                continue
            for k in range(starts[g], starts[g + 1]):
                if masked and not visible[k, i]:
                    continue
                px, py, pz = points[k, 0], points[k, 1], points[k, 2]
                nx, ny, nz = normals[k, 0], normals[k, 1], normals[k, 2]
                r, _ = ray(cone, gun, px, py, pz, nx, ny, nz)
                if r < 0.0:
                    continue
                slopes = slopes_of(knots, coefficients, cone, gun, px, py, pz, nx, ny, nz, r)
                total += adjoint[k] * slopes.value
                x += adjoint[k] * slopes.x
                y += adjoint[k] * slopes.y
                z += adjoint[k] * slopes.z
                a += adjoint[k] * slopes.a
                b += adjoint[k] * slopes.b
                c += adjoint[k] * slopes.c
        ahead, weight = guns.share[p], guns.weight[p]
        by_amount[i] += weight * total
        twist[0], twist[1], twist[2] = across(gun, guns.length[p], a, b, c)
        for j, pull in enumerate((x, y, z)):
            scale = weight * amount[i]
            by_tcp[i, j] += (1.0 - ahead) * scale * pull
            by_tcp[i + 1, j] += ahead * scale * pull
            by_nozzle[i, j] += (1.0 - ahead) * scale * twist[j]
            by_nozzle[i + 1, j] += ahead * scale * twist[j]


@njit(cache=True, error_model="numpy", nogil=True)
def fill_jacobian(
    brush: Brush,
    guns: Guns,
    blocks: Blocks,
    visible: BoolArray,
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
    knots, coefficients, cone = brush
    points, normals, starts, centres, radii = blocks
    masked = len(visible) > 0
    start = starts[first]
    for p in range(len(guns.segment)):
        i = guns.segment[p]
        if column[i] < 0:
            continue
        gun = gun_at(cone, guns, p)
        weight, ahead = guns.weight[p], guns.share[p]
        front = ahead * weight * amount[i]
        rear = (1.0 - ahead) * weight * amount[i]
        here, there, own = place[i], place[i + 1], column[i]
        u, v = turns[i], turns[i + 1]
        for g in range(first, last):
            if not meets(cone, gun, centres[g, 0], centres[g, 1], centres[g, 2], radii[g]):
                continue
            for k in range(starts[g], starts[g + 1]):
                if masked and not visible[k, i]:
                    continue
                px, py, pz = points[k, 0], points[k, 1], points[k, 2]
                nx, ny, nz = normals[k, 0], normals[k, 1], normals[k, 2]
                r, _ = ray(cone, gun, px, py, pz, nx, ny, nz)
                if r < 0.0:
                    continue
                slopes = slopes_of(knots, coefficients, cone, gun, px, py, pz, nx, ny, nz, r)
                n = k - start
                a, b, c = across(gun, guns.length[p], slopes.a, slopes.b, slopes.c)
                rows[n, own] += weight * slopes.value
                rows[n, here] += rear * slopes.x
                rows[n, here + 1] += rear * slopes.y
                rows[n, here + 2] += rear * slopes.z
                rows[n, here + 3] += rear * (a * u[0, 0] + b * u[0, 1] + c * u[0, 2])
                rows[n, here + 4] += rear * (a * u[1, 0] + b * u[1, 1] + c * u[1, 2])
                rows[n, there] += front * slopes.x
                rows[n, there + 1] += front * slopes.y
                rows[n, there + 2] += front * slopes.z
                rows[n, there + 3] += front * (a * v[0, 0] + b * v[0, 1] + c * v[0, 2])
                rows[n, there + 4] += front * (a * v[1, 0] + b * v[1, 1] + c * v[1, 2])


@njit(cache=True, error_model="numpy", nogil=True)
def add_block(columns: IntArray, block: FloatArray, found: FloatArray) -> None:
    """Add a block (k, k) at the rows and columns (k,) of a matrix (n, n)."""
    for i in range(len(columns)):
        for j in range(len(columns)):
            found[columns[i], columns[j]] += block[i, j]
