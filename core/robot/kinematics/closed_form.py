"""Compiled steps that both closed-form inverse kinematics share.

A solver writes up to eight solutions, numbered 4 shoulder + 2 elbow + wrist (bits of `Branch`),
with three measures each that vanish at the singularities.
"""

from __future__ import annotations

import math

from ...arrays import FloatArray
from .arm_geometry import ArmGeometry
from .lean import inner
from .vectors import Rotation, Vector, add, compose, cross, dot, load, scale, subtract

SLACK = 1e-10
"""m by which a target may lie out of reach and still be met at full stretch."""
ALIGNED = 1e-10
"""Sine below which two axes of the wrist count as aligned and the outer angle is set to 0."""
TOUCHING = 1e-13
"""m of the wrist's centre beyond its least distance from axis 1 that count as none: the square
root would make 1e-7 m of them, and tilt a wrist that is aligned."""
X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)


@inner
def row(matrix: FloatArray, i: int) -> Vector:
    """A row of a matrix (3, 3)."""
    return matrix[i, 0], matrix[i, 1], matrix[i, 2]


@inner
def rotation(matrix: FloatArray) -> Rotation:
    """The rotation of a matrix (3, 3)."""
    return (
        matrix[0, 0],
        matrix[0, 1],
        matrix[0, 2],
        matrix[1, 0],
        matrix[1, 1],
        matrix[1, 2],
        matrix[2, 0],
        matrix[2, 1],
        matrix[2, 2],
    )


@inner
def target_rotation(arm: ArmGeometry, R: FloatArray) -> Rotation:
    """The rotation from zero to the flange's rotation R (3, 3), in the arm's frame."""
    turned: Rotation = compose(compose(rotation(arm.frame), rotation(R)), rotation(arm.zero))
    return turned


@inner
def wrist_target(arm: ArmGeometry, R: FloatArray, p: FloatArray) -> Vector:
    """The wrist's centre in the arm's frame for a flange at R (3, 3), p (3,)."""
    c = load(arm.centre)
    at = (
        p[0] + R[0, 0] * c[0] + R[0, 1] * c[1] + R[0, 2] * c[2] - arm.origin[0],
        p[1] + R[1, 0] * c[0] + R[1, 1] * c[1] + R[1, 2] * c[2] - arm.origin[1],
        p[2] + R[2, 0] * c[0] + R[2, 1] * c[1] + R[2, 2] * c[2] - arm.origin[2],
    )
    return dot(row(arm.frame, 0), at), dot(row(arm.frame, 1), at), dot(row(arm.frame, 2), at)


@inner
def transposed(a: Rotation) -> Rotation:
    """The inverse rotation."""
    return a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]


@inner
def wrapped(angle: float) -> float:
    """The same angle in (-π, π]."""
    if -math.pi < angle <= math.pi:
        return angle
    turned: float = angle - 2 * math.pi * math.ceil(angle / (2 * math.pi) - 0.5)
    return turned


@inner
def about(axis: Vector, angle: float, a: Vector) -> Vector:
    """Vector ``a`` turned about a unit axis (Rodrigues' formula)."""
    sine, cosine = math.sin(angle), math.cos(angle)
    along = scale((1.0 - cosine) * dot(axis, a), axis)
    turned: Vector = add(add(scale(cosine, a), scale(sine, cross(axis, a))), along)
    return turned


@inner
def solve_shoulder(lateral: float, target: Vector, behind: bool) -> tuple[float, float, float]:
    """Angle of joint 1 that brings a point to lateral distance ``lateral`` from the arm's plane.

    Returns:
        The angle; x of the point in the turned plane (negative if ``behind``, 0 at the shoulder
        singularity); the distance (m) missing to reach it, 0 if it can.
    """
    radius = math.hypot(target[0], target[1])
    missing = max(0.0, abs(lateral) - radius)
    x = math.sqrt(max(0.0, (radius - lateral) * (radius + lateral)))
    if radius - abs(lateral) < TOUCHING:
        x = 0.0
    if behind:
        x = -x
    if radius < ALIGNED:
        return 0.0, x, missing
    angle = wrapped(math.atan2(target[1], target[0]) - math.atan2(lateral, x))
    return angle, x, missing


@inner
def solve_elbow(
    arm: ArmGeometry, x: float, z: float, flipped: bool
) -> tuple[float, float, float, float]:
    """Angles about +y of joints 2 and 3 that bring the wrist to (x, z) of the arm's plane.

    Angles of vectors are counted about +y, from z towards x.

    Returns:
        Both angles; the sine at the elbow (negative if ``flipped``, 0 for a straight or folded
        arm); the distance (m) missing to reach it, 0 if it can.
    """
    ux, uz = arm.elbow[0] - arm.shoulder[0], arm.elbow[1] - arm.shoulder[1]
    vx, vz = arm.wrist[0] - arm.elbow[0], arm.wrist[1] - arm.elbow[1]
    upper, fore = math.hypot(ux, uz), math.hypot(vx, vz)
    x, z = x - arm.shoulder[0], z - arm.shoulder[1]
    reach = math.hypot(x, z)
    missing = max(0.0, reach - upper - fore, abs(upper - fore) - reach)
    cosine = (reach * reach - upper * upper - fore * fore) / (2.0 * upper * fore)
    # Heron's form keeps the digits of the sine near a stretched arm.
    area = (upper + fore - reach) * (upper + fore + reach)
    area *= (reach + fore - upper) * (reach + upper - fore)
    sine = math.sqrt(max(0.0, area)) / (2.0 * upper * fore)
    if flipped:
        sine = -sine
    bend = math.atan2(sine, cosine)
    third = bend - (math.atan2(vx, vz) - math.atan2(ux, uz))
    inner = math.atan2(fore * math.sin(bend), upper + fore * math.cos(bend))
    second = math.atan2(x, z) - math.atan2(ux, uz) - inner
    return wrapped(second), wrapped(third), sine, missing


@inner
def outer_angle(axis: Vector, start: Vector, end: Vector) -> float:
    """Angle about a unit axis from ``start`` to ``end``, measured across the axis."""
    # Projected first: nearly along the axis, little of the vectors is left to compare.
    a = subtract(start, scale(dot(axis, start), axis))
    b = subtract(end, scale(dot(axis, end), axis))
    return math.atan2(dot(axis, cross(a, b)), dot(a, b))
