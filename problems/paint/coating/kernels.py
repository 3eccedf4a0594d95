"""Compiled loops of the deposition; they hold no lock and share nothing, so threads may run them.

With v from the virtual source to a point of the surface, a the nozzle's direction, n the surface's
normal and s = v·a, the coat at the point grows at

    B = f(r) (−n·v / s) (D / s)²,   r = D √q,   q = a_y² (v·v/s² − 1) + (1 − a_y²) (v·e/s)²

where D is the distance of the plane of reference from the source, e the fan's long axis square to
a, and a_y the aspect; for symmetric footprints a_y = 1 and √q is the tangent of the angle off the
axis. A ray from the source carries the same paint to whatever it meets, so paint is conserved.

Functions for the inner loops take plain numbers where they return early: arrays that they took
would be counted at every call, which costs four times what the arithmetic does.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from ....core.arrays import FloatArray, IntArray

_CENTRE = 1e-12


class Cone(NamedTuple):
    """What projects a footprint.

    Args:
        source: distance behind the TCP, m.
        reach: distance of the plane of reference from the source, m.
        across: aspect squared; 1 for symmetric footprints.
        opening: of the cone along the long axis, R / D.
        widest: its square, the q of the rim.
    """

    source: float
    reach: float
    across: float
    opening: float
    widest: float


class Brush(NamedTuple):
    """A footprint as the kernels take it.

    Args:
        knots: (k,) m.
        coefficients: (k-1, 4).
        cone: the rest.
    """

    knots: FloatArray
    coefficients: FloatArray
    cone: Cone


class Blocks(NamedTuple):
    """Points of the surface in compact groups.

    Args:
        points, normals: (V, 3) group by group.
        starts: (G+1,) first point of each group.
        centres, radii: (G, 3), (G,) of a sphere round each group, m.
    """

    points: FloatArray
    normals: FloatArray
    starts: IntArray
    centres: FloatArray
    radii: FloatArray


class Guns(NamedTuple):
    """Where the gun is at every sub-point.

    Args:
        tcp, nozzle: (P, 3).
        fan: (P, 3), or (0, 3) for symmetric footprints.
        segment: (P,) of the trajectory.
        share: (P,) of the segment that is behind the gun.
        weight: (P,) share of the segment's duration.
        length: (P,) of the interpolated direction before it was made a unit vector.
    """

    tcp: FloatArray
    nozzle: FloatArray
    fan: FloatArray
    segment: IntArray
    share: FloatArray
    weight: FloatArray
    length: FloatArray


class Gun(NamedTuple):
    """One sub-point: the virtual source, the nozzle and the fan."""

    x: float
    y: float
    z: float
    ax: float
    ay: float
    az: float
    hx: float
    hy: float
    hz: float


class Slopes(NamedTuple):
    """The growth and its derivatives by the TCP (x, y, z) and by the nozzle (a, b, c)."""

    value: float
    x: float
    y: float
    z: float
    a: float
    b: float
    c: float


_njit = njit(cache=True, error_model="numpy", nogil=True, forceinline=True)


@_njit
def gun_at(cone: Cone, guns: Guns, p: int) -> Gun:
    """The gun at a sub-point."""
    ax, ay, az = guns.nozzle[p, 0], guns.nozzle[p, 1], guns.nozzle[p, 2]
    hx, hy, hz = 0.0, 0.0, 0.0
    if len(guns.fan):
        hx, hy, hz = guns.fan[p, 0], guns.fan[p, 1], guns.fan[p, 2]
    return Gun(
        guns.tcp[p, 0] - cone.source * ax,
        guns.tcp[p, 1] - cone.source * ay,
        guns.tcp[p, 2] - cone.source * az,
        ax,
        ay,
        az,
        hx,
        hy,
        hz,
    )


@_njit
def meets(cone: Cone, gun: Gun, x: float, y: float, z: float, radius: float) -> bool:
    """Whether the cone may meet a sphere."""
    x, y, z = x - gun.x, y - gun.y, z - gun.z
    s = x * gun.ax + y * gun.ay + z * gun.az
    if s < -radius:
        return False
    off = math.sqrt(max(0.0, x * x + y * y + z * z - s * s))
    return bool(off - s * cone.opening <= radius * math.sqrt(1.0 + cone.widest))


@_njit
def ray(
    cone: Cone, gun: Gun, px: float, py: float, pz: float, nx: float, ny: float, nz: float
) -> tuple[float, float]:
    """Radius r at which a point is seen, and B / f(r); r is negative where no paint arrives.

    Args:
        px, py, pz: the point.
        nx, ny, nz: its normal.
    """
    x, y, z = px - gun.x, py - gun.y, pz - gun.z
    s = x * gun.ax + y * gun.ay + z * gun.az
    if s <= 0.0:
        return -1.0, 0.0
    inverse = 1.0 / (s * s)
    q = (x * x + y * y + z * z) * inverse - 1.0
    if q >= cone.widest:
        return -1.0, 0.0
    c = -(x * nx + y * ny + z * nz)
    if c <= 0.0:
        return -1.0, 0.0
    if cone.across > 1.0:
        leaning = gun.hx * gun.ax + gun.hy * gun.ay + gun.hz * gun.az
        w = x * gun.hx + y * gun.hy + z * gun.hz - leaning * s
        along = w * w * inverse / (1.0 - leaning * leaning)
        q = cone.across * q + (1.0 - cone.across) * along
        if q >= cone.widest:
            return -1.0, 0.0
    return cone.reach * math.sqrt(max(0.0, q)), c * cone.reach * cone.reach * inverse / s


@_njit
def profile(knots: FloatArray, coefficients: FloatArray, r: float) -> float:
    """f(r) within the rim, m/s."""
    i = 0
    while i < len(knots) - 2 and r >= knots[i + 1]:
        i += 1
    t = r - knots[i]
    e = coefficients
    return float(e[i, 0] + t * (e[i, 1] + t * (e[i, 2] + t * e[i, 3])))


@_njit
def slope_over_radius(knots: FloatArray, coefficients: FloatArray, r: float) -> float:
    """f'(r) / r within the rim, which has a value at the centre too."""
    i = 0
    while i < len(knots) - 2 and r >= knots[i + 1]:
        i += 1
    t = r - knots[i]
    e = coefficients
    if r > _CENTRE * knots[-1]:
        return float((e[i, 1] + t * (2.0 * e[i, 2] + 3.0 * t * e[i, 3])) / r)
    return float(2.0 * e[0, 2])


@_njit
def slopes_of(
    knots: FloatArray,
    coefficients: FloatArray,
    cone: Cone,
    gun: Gun,
    px: float,
    py: float,
    pz: float,
    nx: float,
    ny: float,
    nz: float,
    r: float,
) -> Slopes:
    """B at a point that paint arrives at, and its derivatives.

    Args:
        px, py, pz, nx, ny, nz: the point and its normal.
        r: radius at which it is seen.
    """
    f = profile(knots, coefficients, r)
    slope = slope_over_radius(knots, coefficients, r)
    x, y, z = px - gun.x, py - gun.y, pz - gun.z
    s = x * gun.ax + y * gun.ay + z * gun.az
    inverse = 1.0 / (s * s)
    vv = x * x + y * y + z * z
    c = -(x * nx + y * ny + z * nz)
    # dq by v is v_v v + v_a a + v_h h; by a, with v held, a_v v + a_h h.
    v_v, v_a, v_h = 2.0 * inverse, -2.0 * vv * inverse / s, 0.0
    a_v, a_h = -2.0 * vv * inverse / s, 0.0
    if cone.across > 1.0:
        leaning = gun.hx * gun.ax + gun.hy * gun.ay + gun.hz * gun.az
        square = 1.0 - leaning * leaning
        w = x * gun.hx + y * gun.hy + z * gun.hz - leaning * s
        along = w * w * inverse / square
        rest = 1.0 - cone.across
        first = 2.0 * w * inverse / square
        v_v *= cone.across
        v_a = cone.across * v_a - rest * (first * leaning + 2.0 * along / s)
        v_h = rest * first
        a_v = cone.across * a_v - rest * (first * leaning + 2.0 * along / s)
        a_h = rest * (2.0 * along * leaning / square - first * s)
    by_c = f * cone.reach * cone.reach * inverse / s
    by_q = 0.5 * slope * cone.reach**4 * c * inverse / s
    by_s = -3.0 * by_c * c / s
    by_v, by_a, by_h = by_q * v_v, by_q * v_a + by_s, by_q * v_h
    turn_v, turn_h = by_q * a_v + by_s, by_q * a_h
    gx = by_v * x + by_a * gun.ax + by_h * gun.hx - by_c * nx
    gy = by_v * y + by_a * gun.ay + by_h * gun.hy - by_c * ny
    gz = by_v * z + by_a * gun.az + by_h * gun.hz - by_c * nz
    return Slopes(
        by_c * c,
        -gx,
        -gy,
        -gz,
        turn_v * x + turn_h * gun.hx + cone.source * gx,
        turn_v * y + turn_h * gun.hy + cone.source * gy,
        turn_v * z + turn_h * gun.hz + cone.source * gz,
    )


@_njit
def across(gun: Gun, length: float, a: float, b: float, c: float) -> tuple[float, float, float]:
    """From the slope by a unit vector to that by the vector of ``length`` it was made from."""
    along = a * gun.ax + b * gun.ay + c * gun.az
    return (
        (a - along * gun.ax) / length,
        (b - along * gun.ay) / length,
        (c - along * gun.az) / length,
    )
