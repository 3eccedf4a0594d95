"""The limits that count for a task, as arrays over the joints that move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .....core.arrays import FloatArray, IntArray
from .....core.errors import InputError
from .task import MotionTask


class TorqueLimits(NamedTuple):
    """R limits |τ + slope q̇| ≤ most, those that are constant first.

    Attributes:
        axis: (R,), of all N axes.
        most: (R,) N m or N.
        slope: (R,) N m s/rad or N s/m; 0 where the limit is constant.
    """

    axis: IntArray
    most: FloatArray
    slope: FloatArray

    def shares(self, torque: FloatArray, rate: FloatArray) -> FloatArray:
        """(Z, R), what is used of them by torques and joint velocities (Z, N); ±1 is all."""
        driven = torque[:, self.axis] + self.slope * rate[:, self.axis]
        return np.asarray(driven / self.most)


@dataclass(frozen=True)
class MotionLimits:
    """Limits of the n joints that move, and of the torques of all N axes: those that stand still
    have to be held. Infinite where there is none.

    Args:
        lower, upper, velocity, acceleration, jerk: (n,).
        torque: (N,), the constant ones of the N axes.
        torques: all that count.
        tcp_speed: m/s.
    """

    lower: FloatArray
    upper: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray
    torque: FloatArray
    torques: TorqueLimits
    tcp_speed: float

    @property
    def dynamic(self) -> bool:
        """Whether torques are limited."""
        return len(self.torques.axis) > 0

    @classmethod
    def of(cls, task: MotionTask) -> MotionLimits:
        """The limits of a task.

        Raises:
            InputError: one is not positive, a joint has neither an acceleration nor a torque to
                limit it, or a torque line names no axis.
        """
        own, given, moving = task.robot.limits, task.limits, task.moving
        none = np.full(task.robot.size, np.inf)
        velocity = _chosen(task, "velocity", given.velocity, own.velocity)
        acceleration = _chosen(task, "acceleration", given.acceleration, own.acceleration)
        torque = _chosen(task, "torque", given.torque, own.effort)
        jerk = _chosen(task, "jerk", given.jerk, none)
        for j in moving:
            if not min(acceleration[j], torque[j]) < np.inf:
                raise InputError(
                    f"joint {task.robot.axis_names[j]} has neither an acceleration nor a torque "
                    "limit: nothing would bound its motion"
                )
        return cls(
            own.lower[moving],
            own.upper[moving],
            velocity[moving],
            acceleration[moving],
            jerk[moving],
            torque,
            _torques(task, torque),
            np.inf if given.tcp_speed is None else given.tcp_speed,
        )


def _torques(task: MotionTask, constant: FloatArray) -> TorqueLimits:
    """Limits of axes, from constant ones (N,) and the task's lines."""
    names, lines = task.robot.axis_names, task.limits.curves
    # External axes that stand still are held by their brakes.
    driven = np.arange(task.robot.size) < task.robot.arm_size
    driven[task.moving] = True
    known = [name for name, counts in zip(names, driven, strict=True) if counts]
    for line in lines:
        if line.axis not in known:
            raise InputError(
                f"a torque line is given for {line.axis!r}; the axes are {', '.join(known)}"
            )
    own = np.flatnonzero(np.isfinite(constant) & driven)
    return TorqueLimits(
        np.array([*own, *(names.index(line.axis) for line in lines)], dtype=np.int64),
        np.array([*constant[own], *(line.most for line in lines)]),
        np.array([*(0.0 for _ in own), *(line.slope for line in lines)]),
    )


def _chosen(task: MotionTask, name: str, given: ArrayLike | None, own: FloatArray) -> FloatArray:
    robot = task.robot
    try:
        values = own if given is None else np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"the {name} limits need one number an axis ({', '.join(robot.axis_names)}), not "
            f"{given!r}"
        ) from None
    if values.shape != (robot.size,):
        raise InputError(
            f"the {name} limits have shape {values.shape}; robot {robot.name} has {robot.size} axes"
        )
    wrong = np.flatnonzero(~(values > 0.0))
    if len(wrong):
        raise InputError(
            f"joint {robot.axis_names[wrong[0]]}: the {name} limit must be positive, not "
            f"{values[wrong[0]]:g}"
        )
    return np.asarray(values, dtype=float)
