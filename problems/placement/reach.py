"""Whether all targets of a program are in reach from a base, and how far joints have to go."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import MotionError
from ...core.handling.flange import FlangeFollower
from ...core.program.program import Program
from ...core.program.target import JointTarget
from ...core.program.tool import Tool
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose

_MARGIN = math.radians(2.0)
"""rad within the ranges that a solution must be to be taken."""


@dataclass(frozen=True)
class Stops:
    """What a program's moves go to, whatever the base.

    Args:
        start: (N,), where the robot stands before the first move; None for at its target.
        ends: of each move: (N,) joint values, or where the flange is in the world.
        tools: of each move.
    """

    start: FloatArray | None
    ends: tuple[FloatArray | Pose, ...]
    tools: tuple[Tool, ...]

    @classmethod
    def of(cls, robot: Robot, program: Program, start: JointTarget | None) -> Stops:
        """Of a program; targets by joint values move with the base, others do not."""
        follower = FlangeFollower(robot, start)
        ends: list[FloatArray | Pose] = []
        tools: list[Tool] = []
        for move in program.moves:
            follower.moved(move)
            if isinstance(move.target, JointTarget):
                ends.append(np.array(move.target.joints))
            elif follower.flange is not None:
                ends.append(follower.flange)
            else:
                continue
            tools.append(move.tool)
        at = None if start is None else np.array(start.joints)
        return cls(at, tuple(ends), tuple(tools))

    @property
    def anywhere(self) -> bool:
        """Whether no target stays where it is: any base will do."""
        return not any(isinstance(end, Pose) for end in self.ends)

    def route(self, robot: Robot) -> tuple[float, FloatArray]:
        """What the joints need at full speed from each target to the next.

        Of the solutions of each target that is taken which the joints reach soonest.

        Args:
            robot: at the base that is looked at.

        Returns:
            s, infinite if a target is out of reach; and the configurations (M, N) at the M ends.
        """
        velocity = robot.limits.velocity[: robot.arm_size]
        lower, upper = robot.limits.lower + _MARGIN, robot.limits.upper - _MARGIN
        at, spent = self.start, 0.0
        rows: list[FloatArray] = []
        for end in self.ends:
            choices: list[FloatArray] = []
            if not isinstance(end, Pose):
                choices = [end]
            else:
                with suppress(MotionError):
                    found = [np.asarray(solution.q) for solution in robot.inverse(end)]
                    choices = [q for q in found if (q >= lower).all() and (q <= upper).all()]
            if not choices:
                return math.inf, np.empty((0, robot.size))
            if at is None:
                at = min(choices, key=lambda q: float(abs(q).max()))
            times = [float((abs(q - at) / velocity).max()) for q in choices]
            best = int(np.argmin(times))
            at, spent = choices[best], spent + times[best]
            rows.append(at)
        return spent, np.array(rows)
