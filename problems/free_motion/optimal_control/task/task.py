"""What is asked of a robot: from where to where, past what, within which limits, for what price."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .....core.arrays import FloatArray
from .....core.errors import InputError
from .....core.motion.model.consumption import SQUARED_TORQUE, Consumption
from .....core.robot.inertia import Inertia
from .....core.robot.model import Robot
from .....core.spatial.pose import IDENTITY, Pose
from ....checks import all_of_kind, of_kind, positive, within

AT_REST = "at rest"


@dataclass(frozen=True, slots=True)
class TorqueLine:
    """Torque that falls with speed: |τ + slope · q̇| ≤ most, as a motor's voltage limits it.

    Driving at speed v the joint has most − slope v; braking it has more than ``most``, so that a
    constant limit usually stands beside it.

    Args:
        axis: name of the joint.
        most: N m (N) at standstill.
        slope: N m s/rad (N s/m), positive.
    """

    axis: str
    most: float
    slope: float

    def __post_init__(self) -> None:
        for name in ("most", "slope"):
            positive(f"torque line of {self.axis}: {name}", getattr(self, name))


@dataclass(frozen=True)
class ControlLimits:
    """Limits beside those of the robot's joints; None for the robot's own, or for none.

    Args:
        velocity: (N,) rad/s or m/s; None for the robot's.
        acceleration: (N,) rad/s² or m/s²; None for the robot's. Infinity leaves a joint to its
            torque.
        torque: (N,) N m or N; None for the robot's ``effort``, infinite where it is not known.
        jerk: (N,) rad/s³ or m/s³; None for none.
        curves: torque that depends on speed.
        tcp_speed: m/s; None for none.

    Raises:
        InputError: a curve is no `TorqueLine`, or the speed is no number above zero. Arrays are
            looked at with the robot.
    """

    velocity: ArrayLike | None = None
    acceleration: ArrayLike | None = None
    torque: ArrayLike | None = None
    jerk: ArrayLike | None = None
    curves: tuple[TorqueLine, ...] = ()
    tcp_speed: float | None = None

    def __post_init__(self) -> None:
        all_of_kind("ControlLimits.curves", self.curves, TorqueLine)
        if self.tcp_speed is not None and self.tcp_speed != math.inf:
            positive("ControlLimits.tcp_speed", self.tcp_speed)


@dataclass(frozen=True)
class MotionObjective:
    """f = w T/T₀ + (1 − w) E/E₀, with T₀ and E₀ of the first guess: E₀ is what it consumes and what
    it leaves over, ∫ |p| dt, so that it is never negative.

    Args:
        time_weight: w, 1 for time alone, 0 for energy alone.
        consumption: whose integral over time is E; figures are of all axes of the robot.
        longest: s, bound of the time; None for twenty times the first guess's.
        smoothing: where the consumption has a kink at p = 0, the search rounds it over this share
            of the first guess's mean |p|; see `Consumption.rounded`.

    Raises:
        InputError: a number out of its range.
    """

    time_weight: float = 1.0
    consumption: Consumption = SQUARED_TORQUE
    longest: float | None = None
    smoothing: float = 0.1

    def __post_init__(self) -> None:
        within("MotionObjective.time_weight", self.time_weight, 0.0, 1.0)
        of_kind("MotionObjective.consumption", self.consumption, Consumption)
        if self.longest is not None:
            positive("MotionObjective.longest", self.longest)
        positive("MotionObjective.smoothing", self.smoothing)


@dataclass(frozen=True)
class Waypoint:
    """A configuration to be passed.

    Args:
        q: (N,) rad or m.
        stop: whether the robot comes to rest there.
    """

    q: ArrayLike
    stop: bool = False


@dataclass(frozen=True)
class MotionTask:
    """A motion that is wanted.

    Args:
        robot: that moves.
        start, end: (N,) configurations, rad or m.
        waypoints: passed in this order.
        start_velocity, end_velocity: (N,) rad/s or m/s; None for rest.
        limits: beside the robot's.
        objective: what is to be small.
        loads: what the flange carries on each leg between waypoints, in the flange's frame; one
            for all legs, or one a leg.
        tcp: tool centre point in the flange's frame.
        joints: indices of the joints that may move; None for all. The others stay at ``start``.

    Raises:
        InputError: sizes do not fit each other, or a number is not finite.
    """

    robot: Robot
    start: ArrayLike
    end: ArrayLike
    waypoints: tuple[Waypoint, ...] = ()
    start_velocity: ArrayLike | None = None
    end_velocity: ArrayLike | None = None
    limits: ControlLimits = field(default_factory=ControlLimits)
    objective: MotionObjective = field(default_factory=MotionObjective)
    loads: tuple[Inertia | None, ...] = (None,)
    tcp: Pose = IDENTITY
    joints: Sequence[int] | None = None

    def __post_init__(self) -> None:
        of_kind("MotionTask.robot", self.robot, Robot)
        of_kind("MotionTask.limits", self.limits, ControlLimits)
        of_kind("MotionTask.objective", self.objective, MotionObjective)
        of_kind("MotionTask.tcp", self.tcp, Pose)
        all_of_kind("MotionTask.waypoints", self.waypoints, Waypoint)
        all_of_kind("MotionTask.loads", self.loads, Inertia | None)
        size = self.robot.size
        for name in ("start", "end", "start_velocity", "end_velocity"):
            value = getattr(self, name)
            if value is None:
                value = np.zeros(size)
            object.__setattr__(self, name, _vector(self.robot, name, value))
        for k, waypoint in enumerate(self.waypoints):
            _vector(self.robot, f"waypoint {k + 1}", waypoint.q)
        object.__setattr__(self, "joints", self._checked_joints())
        if len(self.loads) not in (1, self.legs):
            raise InputError(
                f"{len(self.loads)} loads were given for {self.legs} legs between waypoints; give "
                "one for all, or one a leg"
            )
        self.objective.consumption.squares(size)
        self._check_still()

    @property
    def legs(self) -> int:
        """Number of legs between start, waypoints and end."""
        return len(self.waypoints) + 1

    @property
    def stations(self) -> FloatArray:
        """(L + 1, N), start, waypoints and end."""
        return np.array([self.start, *(w.q for w in self.waypoints), self.end], dtype=float)

    @property
    def moving(self) -> NDArray[np.int64]:
        """(n,), indices of the joints that may move."""
        assert self.joints is not None
        return np.array(self.joints, dtype=np.int64)

    def whole(self, q: FloatArray) -> FloatArray:
        """(M, N), all joints from those that move (M, n); the others stay at the start."""
        out = np.tile(np.asarray(self.start, dtype=float), (len(q), 1))
        out[:, self.moving] = q
        return out

    def load(self, leg: int) -> Inertia | None:
        """What is carried on a leg."""
        return self.loads[leg % len(self.loads)]

    def _checked_joints(self) -> tuple[int, ...]:
        size = self.robot.size
        if self.joints is None:
            return tuple(range(size))
        joints = tuple(self.joints) if isinstance(self.joints, Iterable) else ()
        if not joints or len(set(joints)) != len(joints) or not set(joints) <= set(range(size)):
            raise InputError(
                f"MotionTask.joints are different indices below {size}, one at least, "
                f"not {self.joints!r}"
            )
        return joints

    def _check_still(self) -> None:
        still = np.setdiff1d(np.arange(self.robot.size), self.moving)
        away = np.abs(self.stations - self.stations[0])[:, still]
        rates = np.abs(np.array([self.start_velocity, self.end_velocity]))[:, still]
        for values in (away, rates):
            wrong = still[values.max(axis=0, initial=0.0) > 1e-12]
            if len(wrong):
                raise InputError(
                    f"joint {self.robot.axis_names[wrong[0]]} has to move, but is not among the "
                    "joints that may: add it to MotionTask.joints"
                )


def _vector(robot: Robot, name: str, value: ArrayLike) -> FloatArray:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"{name} needs one number an axis ({', '.join(robot.axis_names)}), not {value!r}"
        ) from None
    if array.shape != (robot.size,):
        raise InputError(
            f"{name} has shape {array.shape}; robot {robot.name} has {robot.size} axes "
            f"({', '.join(robot.axis_names)})"
        )
    if not np.isfinite(array).all():
        axis = robot.axis_names[int(np.flatnonzero(~np.isfinite(array))[0])]
        raise InputError(f"{name}: the value of joint {axis} is not finite")
    array.flags.writeable = False
    return array
