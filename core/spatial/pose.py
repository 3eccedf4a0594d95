"""A rigid transform as an immutable value."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

import numpy as np

from ..arrays import FloatArray
from ..errors import InputError
from .rotation import quaternion_from_matrix

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Pose:
    """A frame's place in another: position in m and unit quaternion w, x, y, z.

    Raises:
        InputError: a number is not finite, or the quaternion is not of unit length (1e-6).
    """

    position: Vector3 = (0.0, 0.0, 0.0)
    quaternion: Quaternion = (1.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, (*self.position, *self.quaternion))):
            raise InputError(f"a pose needs finite numbers, not {self.position} {self.quaternion}")
        norm = math.sqrt(sum(x * x for x in self.quaternion))
        if abs(norm - 1.0) > 1e-6:
            raise InputError(
                f"a pose needs a unit quaternion; {self.quaternion} has length {norm:.6g}"
            )

    @classmethod
    def from_matrix(cls, matrix: FloatArray) -> Self:
        """The pose of a homogeneous matrix (4, 4), position in m."""
        x, y, z = (float(v) for v in matrix[:3, 3])
        w, i, j, k = (float(v) for v in quaternion_from_matrix(matrix[:3, :3]))
        return cls((x, y, z), (w, i, j, k))

    def matrix(self) -> FloatArray:
        """The homogeneous matrix (4, 4)."""
        a, b, c = _rows(self.quaternion)
        x, y, z = self.position
        return np.array([(*a, x), (*b, y), (*c, z), (0.0, 0.0, 0.0, 1.0)])

    def __matmul__(self, other: Pose) -> Pose:
        """This pose followed by ``other``: frames chain from left to right."""
        x, y, z = self.position
        dx, dy, dz = _turned(self.quaternion, other.position)
        w1, x1, y1, z1 = self.quaternion
        w2, x2, y2, z2 = other.quaternion
        turn = _unit(
            w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
            w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
            w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
            w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2,
        )
        return Pose((x + dx, y + dy, z + dz), turn)

    def inverse(self) -> Pose:
        """The pose of the parent frame seen from this one."""
        w, x, y, z = self.quaternion
        back = _unit(w, -x, -y, -z)
        px, py, pz = _turned(back, self.position)
        return Pose((-px, -py, -pz), back)


# In plain floats: poses come one at a time, where an array costs fifty times its arithmetic.


def _unit(w: float, x: float, y: float, z: float) -> Quaternion:
    """The quaternion of length 1 with w >= 0."""
    scale = math.copysign(1.0 / math.sqrt(w * w + x * x + y * y + z * z), w)
    return w * scale, x * scale, y * scale, z * scale


def _rows(quaternion: Quaternion) -> tuple[Vector3, Vector3, Vector3]:
    """Rows of the rotation matrix."""
    w, x, y, z = quaternion
    s = 2.0 / (w * w + x * x + y * y + z * z)
    return (
        (1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)),
        (s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)),
        (s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)),
    )


def _turned(quaternion: Quaternion, vector: Vector3) -> Vector3:
    x, y, z = vector
    a, b, c = _rows(quaternion)
    return (
        a[0] * x + a[1] * y + a[2] * z,
        b[0] * x + b[1] * y + b[2] * z,
        c[0] * x + c[1] * y + c[2] * z,
    )


IDENTITY = Pose()
