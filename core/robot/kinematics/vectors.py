"""Compiled algebra of 3-vectors and rotations, held as tuples to stay in registers.

A vector is a tuple of three floats, a rotation one of nine (row by row).
"""

from __future__ import annotations

import numpy as np

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
def sine_cosine(angle: float) -> tuple[float, float]:
    """Sine and cosine of an angle in rad, to 3e-16 for angles of up to a million rad.

    Both at once and without a branch: two calls of the C library for each joint are a third of what
    a chain's pose takes. Quarter turns are taken off in three parts (Cody and Waite, "Software
    manual for the elementary functions", 1980; as in FreeBSD's msun), and what is left goes into
    the polynomials of S. L. Moshier's Cephes library.
    """
    quarters = np.rint(angle * 0.6366197723675814)
    x = angle - quarters * 1.57079632673412561417 - quarters * 6.07710050630396597660e-11
    x -= quarters * 2.02226624879595063154e-21
    z = x * x
    sine = -2.50507477628578072866e-8 + z * 1.58962301576546568060e-10
    sine = 2.75573136213857245213e-6 + z * sine
    sine = 8.33333333332211858878e-3 + z * (-1.98412698295895385996e-4 + z * sine)
    sine = x + x * z * (-1.66666666666666307295e-1 + z * sine)
    cosine = 2.08757008419747316778e-9 - z * 1.13585365213876817300e-11
    cosine = 2.48015872888517045348e-5 + z * (-2.75573141792967388112e-7 + z * cosine)
    cosine = 4.16666666666665929218e-2 + z * (-1.38888888888730564116e-3 + z * cosine)
    cosine = 1.0 - 0.5 * z + z * z * cosine
    number = int(quarters)
    first, second = (sine, cosine) if number & 1 == 0 else (cosine, sine)
    return (-first if number & 2 else first), (-second if (number + 1) & 2 else second)


@inner
def rotation_about(axis: Vector, angle: float) -> Rotation:
    """The rotation by ``angle`` (rad) about a unit axis (Rodrigues' formula)."""
    x, y, z = axis
    sine, cosine = sine_cosine(angle)
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
