"""Drives of joints: what torque they have at what speed, and what friction takes of it.

At a joint, τ = (rigid-body torque) + I q̈ + f_c sign(q̇) + f_v q̇ is what the motor gives, and

    |τ| ≤ T(|q̇|)

its limit: a constant, or a curve that falls with speed. A curve is kept as the least of several
convex ones, T = min over runs; constant torque followed by constant power (T ~ 1/q̇) is two runs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from numbers import Real

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.robot.model import Robot
from ...checks import all_of_kind, not_negative, of_kind

_SAME = 1e-9
"""Share of the largest torque by which a curve's runs may miss its points."""


@dataclass(frozen=True)
class TorqueCurve:
    """Greatest torque of a drive as straight lines between points; constant beyond them.

    Args:
        speed: (P,) rad/s, rising; the first is 0.
        torque: (P,) N m at the joint, above zero and never rising.

    Raises:
        InputError: the points are no such curve, or one that falls steeply, then less, then
            steeply again: it is no minimum of convex runs.
    """

    speed: tuple[float, ...]
    torque: tuple[float, ...]

    def __post_init__(self) -> None:
        all_of_kind("TorqueCurve.speed", self.speed, Real)
        all_of_kind("TorqueCurve.torque", self.torque, Real)
        numbers = (*self.speed, *self.torque)
        if not self.speed or len(self.speed) != len(self.torque):
            raise InputError("TorqueCurve: as many torques as speeds are needed, one at least")
        if math.isnan(sum(numbers)) or not all(map(math.isfinite, self.speed)):
            raise InputError(f"TorqueCurve: speeds and torques must be numbers, not {numbers}")
        if self.speed[0] != 0.0 or any(b <= a for a, b in pairwise(self.speed)):
            raise InputError(f"TorqueCurve.speed begins with 0 and rises, unlike {self.speed}")
        if min(self.torque) <= 0.0 or any(b > a for a, b in pairwise(self.torque)):
            raise InputError(
                f"TorqueCurve.torque is above zero and never rises, unlike {self.torque}"
            )
        if len(self.torque) > 1:
            least = np.min([run.at(np.array(self.speed)) for run in self.runs], axis=0)
            if np.any(np.abs(least - self.torque) > _SAME * self.torque[0]):
                raise InputError(
                    "TorqueCurve: a curve that falls steeply, then less, then steeply again cannot "
                    f"be treated: {self.speed} rad/s, {self.torque} N m; leave out the middle"
                )

    @classmethod
    def constant(cls, torque: float) -> TorqueCurve:
        """The same torque at all speeds; may be inf for no limit."""
        return cls((0.0,), (torque,))

    @property
    def falls(self) -> bool:
        """Whether the torque depends on speed."""
        return self.torque[-1] < self.torque[0]

    def at(self, speed: FloatArray) -> FloatArray:
        """Torques at speeds ≥ 0."""
        return np.asarray(np.interp(speed, self.speed, self.torque))

    @cached_property
    def runs(self) -> tuple[FallingCurve, ...]:
        """Convex curves of which this one is the least."""
        if len(self.speed) == 1:
            return (FallingCurve(np.zeros(1), np.array(self.torque), np.zeros(1)),)
        points = np.array([self.speed, self.torque]).T
        slopes = list(np.diff(points[:, 1]) / np.diff(points[:, 0]))
        bounds = [0, *(k for k in range(1, len(slopes)) if slopes[k] < slopes[k - 1]), len(slopes)]
        runs = []
        for first, last in pairwise(bounds):
            part = slice(first, last)
            runs.append(FallingCurve(points[part, 0], points[part, 1], np.array(slopes[part])))
        if slopes[-1] < 0.0:
            # Constant beyond the last point: a further line of the last, convex run.
            run = runs[-1]
            runs[-1] = FallingCurve(
                np.append(run.speed, points[-1, 0]),
                np.append(run.torque, points[-1, 1]),
                np.append(run.slope, 0.0),
            )
        return tuple(runs)


@dataclass(frozen=True, eq=False)
class FallingCurve:
    """A convex falling curve: lines from points on; the first also before its point.

    Args:
        speed, torque: (L,), where each line begins.
        slope: (L,) ≤ 0, rising.
    """

    speed: FloatArray
    torque: FloatArray
    slope: FloatArray

    def lines(self, speed: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height at zero speed and slope of the line at each speed."""
        index = np.clip(np.searchsorted(self.speed, speed, "right") - 1, 0, None)
        slope = self.slope[index]
        return self.torque[index] - slope * self.speed[index], slope

    def at(self, speed: FloatArray) -> FloatArray:
        """Torques at speeds."""
        height, slope = self.lines(speed)
        return np.asarray(height + slope * speed)


UNLIMITED = TorqueCurve.constant(math.inf)


@dataclass(frozen=True)
class JointDrive:
    """What moves one joint.

    Args:
        torque: its limit.
        coulomb: friction against any motion, N m.
        viscous: friction per speed, N m s/rad.
        inertia: of the rotor as the joint feels it (times the gear ratio squared), kg m².

    Raises:
        InputError: a number is not finite or below zero.
    """

    torque: TorqueCurve = UNLIMITED
    coulomb: float = 0.0
    viscous: float = 0.0
    inertia: float = 0.0

    def __post_init__(self) -> None:
        of_kind("JointDrive.torque", self.torque, TorqueCurve)
        for name in ("coulomb", "viscous", "inertia"):
            not_negative(f"JointDrive.{name}", getattr(self, name))


def drives_of(robot: Robot) -> tuple[JointDrive, ...]:
    """One drive an axis with the torque limit of the robot's description, without friction."""
    return tuple(JointDrive(TorqueCurve.constant(float(most))) for most in robot.limits.effort)
