"""Poses in TOML tables: ``xyz_mm`` (or ``xyz_m``) and one form of the orientation, all optional.

``quat_wxyz``, ``abc_deg`` (KUKA: about z, then the new y, then the new x), ``rpy_deg`` (URDF: about
the fixed x, then y, then z) or ``rotvec_rad`` (Universal Robots: axis times angle).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..files.tables import LENGTH, TomlTable
from ..spatial.pose import Pose, Vector3
from ..spatial.rotation import matrix_from_quaternion, matrix_from_rotation_vector

FORMS = ("quat_wxyz", "abc_deg", "rpy_deg", "rotvec_rad")
QUATERNION_TOLERANCE = 1e-2
"""Quaternions written by hand have three digits; they are scaled to length 1."""


def read_pose(table: TomlTable) -> Pose:
    """The pose in a table that may hold other keys too."""
    matrix = np.eye(4)
    matrix[:3, :3] = _rotation(table)
    matrix[:3, 3] = read_vector(table, "xyz", (0.0, 0.0, 0.0))
    return Pose.from_matrix(matrix)


def pose_at(table: TomlTable, key: str) -> Pose:
    """The pose in the table at ``key``, which holds nothing else; no turn, no shift if absent."""
    inner = table.table(key)
    pose = read_pose(inner)
    inner.finish()
    return pose


def read_vector(table: TomlTable, key: str, default: Vector3 | None = None) -> Vector3:
    """Three lengths in m, given as ``key_mm`` or ``key_m``."""
    if default is not None and table.unit_key(key, LENGTH) is None:
        return default
    x, y, z = table.quantities(key, LENGTH, 3)
    return x, y, z


def _rotation(table: TomlTable) -> NDArray[np.float64]:
    given = [form for form in FORMS if table.has(form)]
    if len(given) > 1:
        raise table.error(given[1], f"the orientation is given by {given[0]} already")
    if not given:
        return np.eye(3)
    if given[0] == "quat_wxyz":
        quaternion = np.array(table.numbers("quat_wxyz", 4))
        length = float(np.linalg.norm(quaternion))
        if abs(length - 1.0) > QUATERNION_TOLERANCE:
            raise table.error("quat_wxyz", f"must have length 1, not {length:.4g}")
        return matrix_from_quaternion(quaternion / length)
    x, y, z = table.numbers(given[0], 3)
    if given[0] == "rotvec_rad":
        return matrix_from_rotation_vector(np.array([x, y, z]))
    yaw, pitch, roll = (x, y, z) if given[0] == "abc_deg" else (z, y, x)
    return _about(2, yaw) @ _about(1, pitch) @ _about(0, roll)


def _about(axis: int, degrees: float) -> NDArray[np.float64]:
    return matrix_from_rotation_vector(math.radians(degrees) * np.eye(3)[axis])
