"""Compiled loops of the deposition; they hold no lock and share nothing, so threads may run them.

With v from the virtual source to a point of the surface, a the nozzle's direction, n the surface's
normal and s = v·a, the coat at the point grows at

    B = f(r) (−n·v / s) (D / s)²,   r = D √q,   q = a_y² (v·v/s² − 1) + (1 − a_y²) (v·e/s)²

where D is the distance of the plane of reference from the source, e the fan's long axis square to
a, and a_y the aspect; for symmetric footprints a_y = 1 and √q is the tangent of the angle off the
axis. A ray from the source carries the same paint to whatever it meets, so paint is conserved.

They make no array, and are compiled without numba's counts of references: counting those of the
arrays that inner functions take costs four times what the arithmetic does.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.robot.kinematics.vectors import Vector, add, dot, load_row, scale, subtract

_CENTRE = 1e-12

compiled = njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
"""See the module."""


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


class PointGroups(NamedTuple):
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


class Surface(NamedTuple):
    """What is painted by which footprint.

    Args:
        brush: the footprint.
        blocks: (V,) points.
        visible: (V, S) which points each segment sees; (0, 0) for all.
    """

    brush: Brush
    blocks: PointGroups
    visible: BoolArray


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


class SprayPoint(NamedTuple):
    """One sub-point: the virtual source, the nozzle and the fan, zero for symmetric footprints."""

    source: Vector
    nozzle: Vector
    fan: Vector


class Slopes(NamedTuple):
    """The growth and its derivatives by the TCP and by the nozzle."""

    value: float
    tcp: Vector
    nozzle: Vector


@compiled
def gun_at(cone: Cone, guns: Guns, p: int) -> SprayPoint:
    """The gun at a sub-point."""
    nozzle = load_row(guns.nozzle, p)
    fan = load_row(guns.fan, p) if len(guns.fan) else (0.0, 0.0, 0.0)
    return SprayPoint(subtract(load_row(guns.tcp, p), scale(cone.source, nozzle)), nozzle, fan)


@compiled
def meets(surface: Surface, gun: SprayPoint, g: int) -> bool:
    """Whether the cone may meet a group."""
    cone, radius = surface.brush.cone, surface.blocks.radii[g]
    v = subtract(load_row(surface.blocks.centres, g), gun.source)
    s = dot(v, gun.nozzle)
    if s < -radius:
        return False
    off = math.sqrt(max(0.0, dot(v, v) - s * s))
    return bool(off - s * cone.opening <= radius * math.sqrt(1.0 + cone.widest))


@compiled
def ray(surface: Surface, gun: SprayPoint, segment: int, k: int) -> tuple[float, float]:
    """Radius r at which point k is seen, and B / f(r); r is negative where no paint arrives."""
    cone, visible = surface.brush.cone, surface.visible
    if len(visible) and not visible[k, segment]:
        return -1.0, 0.0
    v = subtract(load_row(surface.blocks.points, k), gun.source)
    s = dot(v, gun.nozzle)
    if s <= 0.0:
        return -1.0, 0.0
    inverse = 1.0 / (s * s)
    q = dot(v, v) * inverse - 1.0
    if q >= cone.widest:
        return -1.0, 0.0
    c = -dot(v, load_row(surface.blocks.normals, k))
    if c <= 0.0:
        return -1.0, 0.0
    if cone.across > 1.0:
        leaning = dot(gun.fan, gun.nozzle)
        w = dot(v, gun.fan) - leaning * s
        along = w * w * inverse / (1.0 - leaning * leaning)
        q = cone.across * q + (1.0 - cone.across) * along
        if q >= cone.widest:
            return -1.0, 0.0
    return cone.reach * math.sqrt(max(0.0, q)), c * cone.reach * cone.reach * inverse / s


@compiled
def _piece(brush: Brush, r: float) -> int:
    """Where the spline has a radius within the rim."""
    i = 0
    while i < len(brush.knots) - 2 and r >= brush.knots[i + 1]:
        i += 1
    return i


@compiled
def profile(brush: Brush, r: float) -> float:
    """f(r) within the rim, m/s."""
    e, i = brush.coefficients, _piece(brush, r)
    t = r - brush.knots[i]
    return float(e[i, 0] + t * (e[i, 1] + t * (e[i, 2] + t * e[i, 3])))


@compiled
def _profile_and_slope(brush: Brush, r: float) -> tuple[float, float]:
    """f(r) and f'(r) / r within the rim; the latter has a value at the centre too."""
    e, i = brush.coefficients, _piece(brush, r)
    t = r - brush.knots[i]
    f = e[i, 0] + t * (e[i, 1] + t * (e[i, 2] + t * e[i, 3]))
    if r > _CENTRE * brush.knots[-1]:
        return f, (e[i, 1] + t * (2.0 * e[i, 2] + 3.0 * t * e[i, 3])) / r
    return f, 2.0 * e[0, 2]


@compiled
def slopes_at(surface: Surface, gun: SprayPoint, k: int, r: float) -> Slopes:
    """B at point k, that paint arrives at, and its derivatives.

    Args:
        r: radius at which it is seen.
    """
    cone = surface.brush.cone
    normal = load_row(surface.blocks.normals, k)
    f, slope = _profile_and_slope(surface.brush, r)
    v = subtract(load_row(surface.blocks.points, k), gun.source)
    s, vv, c = dot(v, gun.nozzle), dot(v, v), -dot(v, normal)
    near = 1.0 / s
    inverse = near * near
    # dq by v is v_v v + v_a a + v_h h; by a, with v held, a_v v + a_h h.
    v_v, v_a, v_h = 2.0 * inverse, -2.0 * vv * inverse * near, 0.0
    a_v, a_h = v_a, 0.0
    if cone.across > 1.0:
        leaning = dot(gun.fan, gun.nozzle)
        square = 1.0 - leaning * leaning
        w = dot(v, gun.fan) - leaning * s
        along = w * w * inverse / square
        rest = 1.0 - cone.across
        first = 2.0 * w * inverse / square
        v_v *= cone.across
        v_a = cone.across * v_a - rest * (first * leaning + 2.0 * along * near)
        v_h = rest * first
        a_v = v_a
        a_h = rest * (2.0 * along * leaning / square - first * s)
    spread = cone.reach * cone.reach * inverse * near
    by_c = f * spread
    by_q = 0.5 * slope * cone.reach * cone.reach * c * spread
    by_s = -3.0 * by_c * c * near
    by_v, by_a, by_h = by_q * v_v, by_q * v_a + by_s, by_q * v_h
    turn_v, turn_h = by_q * a_v + by_s, by_q * a_h
    by_point = add(add(scale(by_v, v), scale(by_a, gun.nozzle)), scale(by_h, gun.fan))
    by_point = subtract(by_point, scale(by_c, normal))
    turning = add(add(scale(turn_v, v), scale(turn_h, gun.fan)), scale(cone.source, by_point))
    return Slopes(by_c * c, scale(-1.0, by_point), turning)


@compiled
def across(gun: SprayPoint, length: float, slope: Vector) -> Vector:
    """From the slope by a unit vector to that by the vector of ``length`` it was made from."""
    x, y, z = subtract(slope, scale(dot(slope, gun.nozzle), gun.nozzle))
    return x / length, y / length, z / length
