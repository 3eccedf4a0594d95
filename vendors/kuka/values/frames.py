"""Frames: structures of KRL (mm, degrees) ↔ the core's poses; see `angles` for A, B and C."""

from __future__ import annotations

from collections.abc import Mapping

from ....core.spatial.pose import Pose
from .angles import angles, quaternion
from .values import Struct, Value


def pose_of(fields: Mapping[str, Value]) -> Pose:
    """The pose of X, Y, Z (mm), A, B, C (degrees); absent ones count as 0.

    Raises:
        InputError: a number is not finite.
    """
    return placed(*map(number_or_zero, map(fields.get, "xyzabc")))


def placed(x: float, y: float, z: float, a: float, b: float, c: float) -> Pose:
    """The same of numbers that are all there."""
    return Pose((x / 1000, y / 1000, z / 1000), quaternion(a, b, c))


def number_or_zero(value: Value | None) -> float:
    """A component; one that is not set, or not known, counts as 0."""
    return float(value) if isinstance(value, (float, int)) else 0.0


def frame_of(pose: Pose, type_name: str = "frame") -> Struct:
    """A pose as a structure."""
    x, y, z = (1000 * v for v in pose.position)
    a, b, c = angles(pose.quaternion)
    return Struct(type_name, {"x": x, "y": y, "z": z, "a": a, "b": b, "c": c})


def null_frame(label: str | None = None, shipped: bool = False) -> Struct:
    """A frame of zeros."""
    return Struct("frame", dict.fromkeys("xyzabc", 0.0), label, shipped)
