"""Orientations as quaternions (w, x, y, z)."""

from __future__ import annotations

import math

from ...arrays import FloatArray
from .lean import inner


@inner
def write_quaternion(R: FloatArray, quaternion: FloatArray) -> None:
    """Write that of a rotation (3, 3): the same numbers as `quaternion_from_matrix`, a tenth of the
    time for samples."""
    a, b, c = R[0, 0], R[1, 1], R[2, 2]
    x, y, z = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    u, v, w = R[2, 1] + R[1, 2], R[0, 2] + R[2, 0], R[1, 0] + R[0, 1]
    trace = a + b + c
    if trace >= a and trace >= b and trace >= c:
        h = 1 + trace
    elif a >= b and a >= c:
        h, x, y, z = x, 1 + 2 * a - trace, w, v
    elif b >= c:
        h, x, y, z = y, w, 1 + 2 * b - trace, u
    else:
        h, x, y, z = z, v, u, 1 + 2 * c - trace
    factor = math.copysign(1.0 / math.sqrt(h * h + x * x + y * y + z * z), h)
    quaternion[0], quaternion[1] = factor * h, factor * x
    quaternion[2], quaternion[3] = factor * y, factor * z
