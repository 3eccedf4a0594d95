"""Axis values as robot languages count them: degrees, and mm where an axis slides."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...arrays import FloatArray
from ...door import spelt
from ...robot.joint import JointKind
from ...robot.model import Robot


def axis_values(robot: Robot | None, q: Sequence[float] | FloatArray) -> list[float]:
    """Values of a robot's first axes in degrees and mm, of those in rad and m.

    Args:
        robot: None where it is not known: then all axes turn.
        q: (N,) rad or m.
    """
    slides = _slides(robot, len(q))
    pairs = zip(q, slides, strict=False)
    return [1e3 * float(v) if slide else math.degrees(float(v)) for v, slide in pairs]


def arm_values(robot: Robot | None, values: Sequence[float]) -> tuple[float, ...]:
    """Reverse of `axis_values`."""
    pairs = zip(values, _slides(robot, len(values)), strict=False)
    return tuple(v / 1e3 if slide else math.radians(v) for v, slide in pairs)


def _slides(robot: Robot | None, count: int) -> list[bool]:
    """Which of the first axes slide."""
    if robot is None:
        return [False] * count
    return [joint.kind is JointKind.PRISMATIC for joint in robot.joints]


def cell_axis(name: str, robot: Robot | None) -> str:
    """What to write into a cell file for an external axis, to stand at the end of a message."""
    arm = "vendor/robot" if robot is None else robot.name
    return (
        f'; to drive it, give a cell file ({spelt("cell")}): robot = "{arm}", '
        f'[external_axis.{name}] with role = "table" or "track", kind = "revolute", axis, '
        'range_deg, speed_deg_s and acceleration_deg_s2, or kind = "prismatic", axis, range_mm, '
        "speed_mm_s and acceleration_mm_s2; pose if it is not at the world's origin"
    )
