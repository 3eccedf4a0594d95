"""Convex shapes of a robot's links, as values."""

from __future__ import annotations

from dataclasses import dataclass

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


def _require_positive(kind: str, *lengths: float) -> None:
    if not all(length > 0.0 for length in lengths):
        raise InputError(f"a {kind} needs positive lengths, not {lengths}")
