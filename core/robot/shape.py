"""Convex shapes of a robot's links, as values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..errors import InputError
from ..spatial.pose import IDENTITY, Pose, Vector3


@dataclass(frozen=True, slots=True)
class Sphere:
    """A ball of ``radius`` m about the origin."""

    radius: float

    def __post_init__(self) -> None:
        _require_positive("sphere", self.radius)

    @property
    def size(self) -> Vector3:
        """m along x, y, z of the box round it."""
        return (2.0 * self.radius,) * 3


@dataclass(frozen=True, slots=True)
class Capsule:
    """All points within ``radius`` m of a segment of ``length`` m along z about the origin."""

    radius: float
    length: float

    def __post_init__(self) -> None:
        _require_positive("capsule", self.radius, self.length)

    @property
    def size(self) -> Vector3:
        """m along x, y, z of the box round it."""
        return 2.0 * self.radius, 2.0 * self.radius, self.length + 2.0 * self.radius


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder of ``radius`` and ``length`` m along z about the origin."""

    radius: float
    length: float

    def __post_init__(self) -> None:
        _require_positive("cylinder", self.radius, self.length)

    @property
    def size(self) -> Vector3:
        """m along x, y, z of the box round it."""
        return 2.0 * self.radius, 2.0 * self.radius, self.length


@dataclass(frozen=True, slots=True)
class Box:
    """A box with edges ``size`` m along x, y, z about the origin."""

    size: Vector3

    def __post_init__(self) -> None:
        _require_positive("box", *self.size)


Shape = Sphere | Capsule | Cylinder | Box


@dataclass(frozen=True, slots=True)
class LinkShape:
    """A shape fixed to a link.

    Args:
        link: 0 for the base, k for the link behind the arm's joint k.
        shape: the shape.
        placement: its frame in the link's frame: the base's, or the one behind the joint.
    """

    link: int
    shape: Shape
    placement: Pose = IDENTITY


@dataclass(frozen=True, slots=True)
class TouchingLinks:
    """Two links that may touch, as somebody says who knows the arm.

    Args:
        first, second: 0 for the base, k for the link behind the arm's joint k.
        file: name of the file that says so.
        reason: why, in its words.
    """

    first: int
    second: int
    file: str
    reason: str


def pose_along(start: FloatArray, end: FloatArray) -> Pose:
    """The frame midway between two points with z from the first to the second."""
    z = (end - start) / np.linalg.norm(end - start)
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    matrix[:3, 3] = 0.5 * (start + end)
    return Pose.from_matrix(matrix)


def _require_positive(kind: str, *lengths: float) -> None:
    if not all(length > 0.0 for length in lengths):
        raise InputError(f"a {kind} needs positive lengths, not {lengths}")
