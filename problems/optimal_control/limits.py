"""The limits that count for a task, as arrays over the joints that move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import InputError
from .task import Task

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Limits:
    """Limits of the n joints that move; infinite where there is none.

    Args:
        lower, upper, velocity, acceleration, torque, jerk: (n,).
        line_joint: (L,), the joint (of those that move) of each speed-dependent torque limit.
        line_most, line_slope: (L,), |τ + slope v| ≤ most.
        tcp_speed: m/s.
    """

    lower: FloatArray
    upper: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    jerk: FloatArray
    line_joint: IntArray
    line_most: FloatArray
    line_slope: FloatArray
    tcp_speed: float

    @property
    def dynamic(self) -> bool:
        """Whether torques are limited."""
        return bool(np.isfinite(self.torque).any() or len(self.line_joint))

    @classmethod
    def of(cls, task: Task) -> Limits:
        """The limits of a task.

        Raises:
            InputError: one is not positive, a joint has neither an acceleration nor a torque to
                limit it, or a torque line names no joint that moves.
        """
        own, given, moving = task.robot.limits, task.limits, task.moving
        none = np.full(task.robot.size, np.inf)
        velocity = _chosen(task, "velocity", given.velocity, own.velocity)
        acceleration = _chosen(task, "acceleration", given.acceleration, own.acceleration)
        torque = _chosen(task, "torque", given.torque, own.effort)
        jerk = _chosen(task, "jerk", given.jerk, none)
        for j in range(len(moving)):
            if not min(acceleration[j], torque[j]) < np.inf:
                raise InputError(
                    f"joint {task.robot.axis_names[moving[j]]} has neither an acceleration nor a "
                    "torque limit: nothing would bound its motion"
                )
        try:
            speed = np.inf if given.tcp_speed is None else float(given.tcp_speed)
        except (TypeError, ValueError):
            speed = np.nan
        if not speed > 0.0:
            raise InputError(f"the TCP's speed limit must be positive, not {given.tcp_speed!r}")
        names = [task.robot.axis_names[j] for j in moving]
        for line in given.curves:
            if line.axis not in names:
                raise InputError(
                    f"a torque line is given for {line.axis!r}; the joints that move are "
                    f"{', '.join(names)}"
                )
        return cls(
            own.lower[moving],
            own.upper[moving],
            velocity,
            acceleration,
            torque,
            jerk,
            np.array([names.index(line.axis) for line in given.curves], dtype=np.int64),
            np.array([line.most for line in given.curves]),
            np.array([line.slope for line in given.curves]),
            speed,
        )


def _chosen(task: Task, name: str, given: ArrayLike | None, own: FloatArray) -> FloatArray:
    robot = task.robot
    try:
        values = own if given is None else np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"the {name} limits must be {robot.size} numbers, one an axis, not {given!r}"
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
    return np.asarray(values[task.moving], dtype=float)
