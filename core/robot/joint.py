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


HELD_WITHIN = 2e-4
"""rad by which a joint without a motor may miss zero: quaternions of four digits do by 1e-4."""
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
        held: whether the arm has no motor for it: it stands at zero (see `held_joint`).

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
    held: bool = False

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
        if self.held:
            signs = ("-" if self._along(f) < 0 else "" for f in self.followers)
            turns = " ".join(f"{s}{f.driver}" for s, f in zip(signs, self.followers, strict=True))
            return f"what is behind {self.name} turns by {turns}" if turns else None
        terms: list[str] = [self.name]
        behind: list[str] = []
        for follower in self.followers:
            along = self._along(follower)
            if not behind and abs(abs(along) - 1.0) < _ALONG and follower.placement == IDENTITY:
                terms.append(f"{'-' if along < 0 else '+'} {follower.driver}")
            else:
                behind.append(follower.driver)
        said = [f"the joint of {self.name} turns by {' '.join(terms)}"] if terms[1:] else []
        said += [f"a turn behind {self.name} follows {driver}" for driver in behind]
        return ", ".join(said) or None

    def _along(self, follower: Follower) -> float:
        """Cosine between a follower's axis and the joint's."""
        return sum(a * b for a, b in zip(self.axis, follower.axis, strict=True))

    def cells(self) -> tuple[str, ...]:
        """Name and limits in degrees or mm, as `COLUMNS` names them."""
        if self.held:
            return self.name, "held at 0", "", "", "", ""
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


def held_joint(
    name: str, placement: Pose, axis: Vector3, followers: tuple[Follower, ...] = ()
) -> Joint:
    """A joint that the arm has no motor for.

    Poses ask six values, and programs state as many; an arm with fewer motors holds the others at
    zero, within what rounded orientations of programs miss.
    """
    limits = (-HELD_WITHIN, HELD_WITHIN, 1.0, 100.0)
    return Joint(name, placement, axis, *limits, followers=followers, held=True)


@dataclass(frozen=True, slots=True)
class CoupledRange:
    """A range of a sum of turning joints' values, beside the ranges of each.

    Args:
        terms: joints and what their values are multiplied with.
        lower, upper: rad.
        reason: what keeps it, in words.

    Raises:
        InputError: the range is empty, or no joint is named.
    """

    terms: tuple[tuple[str, float], ...]
    lower: float
    upper: float
    reason: str

    def __post_init__(self) -> None:
        if not self.terms or not -math.inf < self.lower < self.upper < math.inf:
            raise InputError(
                f"the range of {self.sum} from {self.lower:g} to {self.upper:g} rad is none"
            )

    @property
    def sum(self) -> str:
        """The joints as a sum: ``J3 - J2``."""
        told = ""
        for name, factor in self.terms:
            size = "" if abs(factor) == 1.0 else f"{abs(factor):g} "
            sign = "-" if factor < 0.0 else "+"
            told += f" {sign} {size}{name}" if told else f"{sign.strip('+')}{size}{name}"
        return told

    def row(self, names: Sequence[str]) -> FloatArray:
        """(N,), the factors of axes of these names."""
        factors = dict(self.terms)
        return np.array([factors.get(name, 0.0) for name in names])

    @property
    def fixed(self) -> bool:
        """Whether it leaves one value, but for rounding."""
        return self.upper - self.lower < 4.0 * HELD_WITHIN

    def shown(self) -> str:
        """The range in degrees, with its reason."""
        ends = [math.degrees(end) for end in (self.lower, self.upper)]
        if self.fixed:
            return f"{self.sum} is {0.5 * sum(ends):.4g}°: {self.reason}"
        return f"{self.sum} lies between {ends[0]:.4g}° and {ends[1]:.4g}°: {self.reason}"

    def excess(self, value: float) -> str:
        """What is wrong with a value (rad) of the sum."""
        ends = [math.degrees(end) for end in (self.lower, self.upper)]
        allowed = f"not {0.5 * sum(ends):.4g}°"
        if not self.fixed:
            allowed = f"beyond its range of {ends[0]:.4g}° to {ends[1]:.4g}°"
        return f"{self.sum} would be {math.degrees(value):.4g}°, {allowed}: {self.reason}"


def beyond_coupled(
    ranges: Sequence[CoupledRange], names: Sequence[str], q: FloatArray
) -> FloatArray:
    """(..., C) rad by which values (..., N) of axes of these names are beyond each of C ranges."""
    beyond = np.zeros((*q.shape[:-1], len(ranges)))
    for k, one in enumerate(ranges):
        sums = q @ one.row(names)
        beyond[..., k] = np.maximum(one.lower - sums, sums - one.upper)
    return beyond


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
        number: the controller's own, from 1, where targets of programs have places for axes that
            the robot has not; None for the one after the axis before it.
    """

    joint: Joint
    role: ExternalRole
    carried_by: str | None = None
    inertia: Inertia | None = None
    number: int | None = None

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
