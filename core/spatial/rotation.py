"""Rotations as matrices, quaternions (w, x, y, z) and rotation vectors, over leading axes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import FloatArray


def matrix_from_quaternion(quaternion: FloatArray) -> FloatArray:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    w, x, y, z = _parts(np.asarray(quaternion, dtype=float))
    return _matrix(w, x, y, z)


def _parts(vectors: FloatArray) -> Any:
    """What stands along the last axis: arrays, or numbers of a single vector."""
    # Python computes with its own numbers, not with NumPy's, ten times as fast.
    return vectors.tolist() if vectors.ndim == 1 else np.moveaxis(vectors, -1, 0)


def _matrix(w: Any, x: Any, y: Any, z: Any) -> FloatArray:
    """Rotation matrices (..., 3, 3) of unit quaternions by their parts (...,)."""
    R = np.empty((*np.shape(w), 3, 3))
    R[..., 0, 0], R[..., 1, 1] = 1 - 2 * (y * y + z * z), 1 - 2 * (x * x + z * z)
    R[..., 2, 2] = 1 - 2 * (x * x + y * y)
    R[..., 0, 1], R[..., 1, 0] = 2 * (x * y - w * z), 2 * (x * y + w * z)
    R[..., 0, 2], R[..., 2, 0] = 2 * (x * z + w * y), 2 * (x * z - w * y)
    R[..., 1, 2], R[..., 2, 1] = 2 * (y * z - w * x), 2 * (y * z + w * x)
    return R


def quaternion_from_matrix(matrix: FloatArray) -> FloatArray:
    """Unit quaternions (..., 4), w >= 0, of rotation matrices (..., 3, 3).

    Of the four forms of the conversion the best conditioned one is taken (Shepperd, J. Guidance
    and Control 1, 1978), so that half turns lose no digits.
    """
    m = np.asarray(matrix, dtype=float)
    single = m.ndim == 2
    a, xy, xz, yx, b, yz, zx, zy, c = _parts(m.reshape(*m.shape[:-2], 9))
    x, y, z = zy - yz, xz - zx, yx - xy
    u, v, w = zy + yz, xz + zx, yx + xy
    trace = a + b + c
    forms = (
        (1 + trace, x, y, z),
        (x, 1 + 2 * a - trace, w, v),
        (y, w, 1 + 2 * b - trace, u),
        (z, v, u, 1 + 2 * c - trace),
    )
    largest = (trace, a, b, c)
    if single:
        h, x, y, z = forms[largest.index(max(largest))]
        scale = math.copysign(1.0 / math.sqrt(h * h + x * x + y * y + z * z), h)
        return np.array([scale * h, scale * x, scale * y, scale * z])
    best = np.argmax(largest, axis=0)
    h, x, y, z = (np.choose(best, parts) for parts in zip(*forms, strict=True))
    scale = np.copysign(1.0 / np.sqrt(h * h + x * x + y * y + z * z), h)
    return np.stack([scale * h, scale * x, scale * y, scale * z], axis=-1)


def rotation_vector(matrix: FloatArray) -> FloatArray:
    """Rotation vectors (..., 3) in rad, length at most π, of rotation matrices (..., 3, 3)."""
    quaternion = quaternion_from_matrix(matrix)
    w, v = quaternion[..., :1], quaternion[..., 1:]
    sine = np.linalg.norm(v, axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, w)
    small = sine < 1e-9
    return np.where(small, 2.0, angle / np.where(small, 1.0, sine)) * v


def matrix_from_rotation_vector(vector: FloatArray) -> FloatArray:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) in rad."""
    v = np.asarray(vector, dtype=float)
    x, y, z = _parts(v)
    square = x * x + y * y + z * z
    if v.ndim == 1 and math.isfinite(square):
        half = 0.5 * math.sqrt(square)
        scale = 0.5 * math.sin(half) / half if half > 0.0 else 0.5
        return _matrix(math.cos(half), scale * x, scale * y, scale * z)
    half = 0.5 * np.sqrt(square)
    with np.errstate(invalid="ignore"):
        scale = 0.5 * np.divide(np.sin(half), half, out=np.ones_like(half), where=half > 0.0)
        return _matrix(np.cos(half), scale * x, scale * y, scale * z)


def euler_zyx(matrix: FloatArray) -> tuple[float, float, float]:
    """Angles a, b, c, rad, of a rotation about z, then the new y, then the new x (3, 3).

    Where b is a right angle, c is 0.
    """
    b = math.atan2(-matrix[2, 0], math.hypot(matrix[0, 0], matrix[1, 0]))
    if abs(matrix[2, 0]) > 1.0 - 1e-12:
        return math.atan2(-matrix[0, 1], matrix[1, 1]), b, 0.0
    return (
        math.atan2(matrix[1, 0], matrix[0, 0]),
        b,
        math.atan2(matrix[2, 1], matrix[2, 2]),
    )


def matrix_from_euler_zyx(a: float, b: float, c: float) -> FloatArray:
    """The rotation (3, 3) of angles, rad, about z, then the new y, then the new x."""
    axes = np.eye(3)
    turns = [matrix_from_rotation_vector(v * axis) for v, axis in zip((c, b, a), axes, strict=True)]
    return np.asarray(turns[2] @ turns[1] @ turns[0])


def euler_zyz(matrix: FloatArray) -> tuple[float, float, float]:
    """Angles a, b, c, rad, of a rotation about z, then the new y, then the new z (3, 3).

    b is 0 to π; at both ends of it, where the two axes are one, c is 0.
    """
    across = math.hypot(matrix[0, 2], matrix[1, 2])
    b = math.atan2(across, matrix[2, 2])
    if across < 1e-12:
        return math.atan2(-matrix[0, 1], matrix[1, 1]), b, 0.0
    a = math.atan2(matrix[1, 2], matrix[0, 2])
    # By what is left behind the first: near the ends of b the last row alone is noise.
    x, y, _ = math.cos(a) * matrix[1] - math.sin(a) * matrix[0]
    return a, b, math.atan2(x, y)


def matrix_from_euler_zyz(a: float, b: float, c: float) -> FloatArray:
    """The rotation (3, 3) of angles, rad, about z, then the new y, then the new z."""
    first, last = matrix_from_euler_zyx(a, b, 0.0), matrix_from_euler_zyx(c, 0.0, 0.0)
    return np.asarray(first @ last)


def skew(vector: FloatArray) -> FloatArray:
    """Matrices (..., 3, 3) of the cross product with vectors (..., 3)."""
    x, y, z = np.moveaxis(np.asarray(vector, dtype=float), -1, 0)
    o = np.zeros_like(x)
    rows = [np.stack([o, -z, y], -1), np.stack([z, o, -x], -1), np.stack([-y, x, o], -1)]
    return np.stack(rows, -2)


def angle_between(u: FloatArray, v: FloatArray) -> float:
    """Angle of two vectors (3,), rad."""
    return math.atan2(cross_length(u, v), float(u @ v))


def cross_length(u: FloatArray, v: FloatArray) -> float:
    """Length of the cross product of two vectors (3,); NumPy takes 20 µs for it."""
    a, b, c = map(float, u)
    x, y, z = map(float, v)
    return math.hypot(b * z - c * y, c * x - a * z, a * y - b * x)


def arc_angle(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    """Angle at the centre of the arc from ``a`` through ``b`` to ``c``, rad.

    By the inscribed angle theorem the arcs a-b and b-c are twice the angles at c and at a.
    """
    return 2 * (angle_between(b - a, c - a) + angle_between(a - c, b - c))
