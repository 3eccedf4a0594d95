"""Joints, their limits, and the external axes that carry a robot or a work object."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple, Self

import numpy as np

from ..arrays import FloatArray
from ..errors import InputError
from ..spatial.pose import IDENTITY, Pose, Vector3
from .inertia import Inertia

COLUMNS = (
    ("joint", "left"),
    ("lower", "right"),
    ("upper", "right"),
    ("velocity /s", "right"),
    ("acceleration /s²", "right"),
    ("effort", "right"),
)
"""Of a table of joints."""


_ALONG = 1e-9


class JointKind(StrEnum):
    """How a joint moves along its axis."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"


@dataclass(frozen=True, slots=True)
class Follower:
    """A turn behind a joint that has no motor of its own: rods or gears make it.

    A forearm that a rod holds against the base turns back by the angle of the upper arm's joint:
    behind the joint of the forearm, a follower about the reversed axis.

    Args:
        driver: name of the arm's joint whose value it turns by.
        axis: unit axis in its own frame; the opposite one turns it against its driver.
        placement: its frame in the frame behind the joint, or the follower, before.

    Raises:
        InputError: the axis is no unit vector.
    """

    driver: str
    axis: Vector3
    placement: Pose = IDENTITY

    def __post_init__(self) -> None:
        if abs(math.hypot(*self.axis) - 1.0) > 1e-6:
            raise InputError(
                f"what follows joint {self.driver}: axis {self.axis} must have length 1"
            )

    @property
    def kind(self) -> JointKind:
        """Followers turn."""
        return JointKind.REVOLUTE


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint with one value: rad if revolute, m if prismatic.

    Args:
        name: as the vendor calls it.
        placement: the joint's frame in the frame behind the joint before, all values zero.
        axis: unit axis in the joint's frame; positive values follow the right-hand rule.
        lower, upper: range, rad or m.
        velocity: largest speed, rad/s or m/s.
        acceleration: largest acceleration, rad/s² or m/s².
        effort: largest torque N m (force N); None if it is not known.
        kind: revolute or prismatic.
        followers: turns by other joints' values, one behind the other; the frame behind the joint
            is that behind the last of them.

    Raises:
        InputError: a number is not finite, the range is empty, or the axis is no unit vector.
    """

    name: str
    placement: Pose
    axis: Vector3
    lower: float
    upper: float
    velocity: float
    acceleration: float
    effort: float | None = None
    kind: JointKind = JointKind.REVOLUTE
    followers: tuple[Follower, ...] = ()

    def __post_init__(self) -> None:
        if abs(math.hypot(*self.axis) - 1.0) > 1e-6:
            raise InputError(f"joint {self.name}: axis {self.axis} must have length 1")
        if not -math.inf < self.lower < self.upper < math.inf:
            raise InputError(
                f"joint {self.name}: lower limit {self.lower:g} must be below upper {self.upper:g}"
            )
        for name in ("velocity", "acceleration", "effort"):
            value = getattr(self, name)
            if value is not None and not 0.0 < value < math.inf:
                raise InputError(f"joint {self.name}: {name} {value:g} must be positive")

    @property
    def step(self) -> Pose:
        """The frame behind the joint in the frame behind the joint before, all values zero."""
        step = self.placement
        for follower in self.followers:
            step = step @ follower.placement
        return step

    def coupling(self) -> str | None:
        """What rods or gears make of the joint, in words; None if it turns by its own value."""
        terms: list[str] = [self.name]
        behind: list[str] = []
        for follower in self.followers:
            along = sum(a * b for a, b in zip(self.axis, follower.axis, strict=True))
            if not behind and abs(abs(along) - 1.0) < _ALONG and follower.placement == IDENTITY:
                terms.append(f"{'-' if along < 0 else '+'} {follower.driver}")
            else:
                behind.append(follower.driver)
        said = [f"the joint of {self.name} turns by {' '.join(terms)}"] if terms[1:] else []
        said += [f"a turn behind {self.name} follows {driver}" for driver in behind]
        return ", ".join(said) or None

    def cells(self) -> tuple[str, ...]:
        """Name and limits in degrees or mm, as `COLUMNS` names them."""
        turning = self.kind is JointKind.REVOLUTE
        unit, scale, force = ("°", math.pi / 180, "N m") if turning else ("mm", 1e-3, "N")
        figures = (self.lower, self.upper, self.velocity, self.acceleration)
        effort = "" if self.effort is None else f"{self.effort:g} {force}"
        return self.name, *(f"{value / scale:.6g} {unit}" for value in figures), effort

    def shown(self, value: float) -> str:
        """A value in degrees or mm, for messages."""
        if self.kind is JointKind.PRISMATIC:
            return f"{1e3 * value:.6g} mm"
        return f"{math.degrees(value):.6g}°"


class ExternalRole(StrEnum):
    """What an external axis carries."""

    TRACK = "track"
    """The robot's base."""
    TABLE = "table"
    """A work object."""


@dataclass(frozen=True, slots=True)
class ExternalAxis:
    """A joint outside the arm, driven by the robot's controller.

    Args:
        joint: the axis; its placement is in the world, or in the frame behind ``carried_by``.
        role: whether it carries the robot's base or a work object.
        carried_by: name of the external axis that this one stands on (the tilting axis under a
            turntable, the long axis of a gantry); None for the floor.
        inertia: of the moving part in the frame behind the joint; None if not known, and then
            the torque of this axis comes out as NaN.
    """

    joint: Joint
    role: ExternalRole
    carried_by: str | None = None
    inertia: Inertia | None = None

    @property
    def name(self) -> str:
        """The joint's name."""
        return self.joint.name


class JointLimits(NamedTuple):
    """Limits of all N values of a configuration; ``effort`` is infinite where it is not known."""

    lower: FloatArray
    upper: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    effort: FloatArray

    @classmethod
    def of(cls, joints: Sequence[Joint]) -> Self:
        """The limits of the joints, in their order; the arrays cannot be written to."""
        columns = [
            [joint.lower for joint in joints],
            [joint.upper for joint in joints],
            [joint.velocity for joint in joints],
            [joint.acceleration for joint in joints],
            [math.inf if joint.effort is None else joint.effort for joint in joints],
        ]
        arrays = [np.array(column, dtype=float) for column in columns]
        for array in arrays:
            array.flags.writeable = False
        return cls(*arrays)
