"""Compiled algebra of 3-vectors and rotations, held as tuples to stay in registers.

A vector is a tuple of three floats, a rotation one of nine (row by row).
"""

from __future__ import annotations

import math

from ...arrays import FloatArray
from .lean import inner

Vector = tuple[float, float, float]
Rotation = tuple[float, float, float, float, float, float, float, float, float]

ZERO: Vector = (0.0, 0.0, 0.0)
UNTURNED: Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@inner
def load(array: FloatArray) -> Vector:
    """The vector of an array (3,)."""
    return array[0], array[1], array[2]


@inner
def load_row(array: FloatArray, row: int) -> Vector:
    """The vector in a row of an array (..., 3)."""
    return array[row, 0], array[row, 1], array[row, 2]


@inner
def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inner
def subtract(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inner
def scale(factor: float, a: Vector) -> Vector:
    """factor · a."""
    return factor * a[0], factor * a[1], factor * a[2]


@inner
def dot(a: Vector, b: Vector) -> float:
    """a · b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner
def cross(a: Vector, b: Vector) -> Vector:
    """a × b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@inner
def turn(rotation: Rotation, a: Vector) -> Vector:
    """The vector turned by the rotation."""
    return (
        rotation[0] * a[0] + rotation[1] * a[1] + rotation[2] * a[2],
        rotation[3] * a[0] + rotation[4] * a[1] + rotation[5] * a[2],
        rotation[6] * a[0] + rotation[7] * a[1] + rotation[8] * a[2],
    )


@inner
def compose(a: Rotation, b: Rotation) -> Rotation:
    """The rotation ``a`` followed, in its own frame, by ``b``: the matrix product."""
    return (
        a[0] * b[0] + a[1] * b[3] + a[2] * b[6],
        a[0] * b[1] + a[1] * b[4] + a[2] * b[7],
        a[0] * b[2] + a[1] * b[5] + a[2] * b[8],
        a[3] * b[0] + a[4] * b[3] + a[5] * b[6],
        a[3] * b[1] + a[4] * b[4] + a[5] * b[7],
        a[3] * b[2] + a[4] * b[5] + a[5] * b[8],
        a[6] * b[0] + a[7] * b[3] + a[8] * b[6],
        a[6] * b[1] + a[7] * b[4] + a[8] * b[7],
        a[6] * b[2] + a[7] * b[5] + a[8] * b[8],
    )


@inner
def load_rotation(matrices: FloatArray, k: int) -> Rotation:
    """The rotation of matrix ``k`` of an array (K, 3, 3)."""
    return (
        matrices[k, 0, 0],
        matrices[k, 0, 1],
        matrices[k, 0, 2],
        matrices[k, 1, 0],
        matrices[k, 1, 1],
        matrices[k, 1, 2],
        matrices[k, 2, 0],
        matrices[k, 2, 1],
        matrices[k, 2, 2],
    )


@inner
def rotation_about(axis: Vector, angle: float) -> Rotation:
    """The rotation by ``angle`` (rad) about a unit axis (Rodrigues' formula)."""
    x, y, z = axis
    sine = math.sin(angle)
    cosine = math.cos(angle)
    rest = 1.0 - cosine
    return (
        cosine + rest * x * x,
        rest * x * y - sine * z,
        rest * x * z + sine * y,
        rest * x * y + sine * z,
        cosine + rest * y * y,
        rest * y * z - sine * x,
        rest * x * z - sine * y,
        rest * y * z + sine * x,
        cosine + rest * z * z,
    )
