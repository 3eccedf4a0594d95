"""What a robot's assumed speeds and accelerations leave open of a program's time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ..motion.emulator.controller import Controller
from ..motion.emulator.run import Run
from ..robot.joint import Joint
from ..robot.model import Robot

_FIGURES = ("velocity", "acceleration")


def duration_range(controller: Controller, run: Run) -> tuple[float, float] | None:
    """Least and greatest duration (s) of a run with all assumed figures off by their spread.

    The path is stamped again with each assumed figure of every joint multiplied, then divided by
    its factor; so are those of external axes of which something is assumed.

    Args:
        controller: that drove it.
        run: of it.

    Returns:
        None where no figure of the robot has a spread.
    """
    if not controller.robot.spread:
        return None
    changes = [0.0]
    for power in (1.0, -1.0):
        off = controller.with_robot(_off_by(controller.robot, power))
        timing = off.stamp(run.program, run.path)
        changes.append(timing.duration - run.timing.duration)
    return run.duration + min(changes), run.duration + max(changes)


def _off_by(robot: Robot, power: float) -> Robot:
    factors = {name: robot.spread[name] ** power for name in _FIGURES if name in robot.spread}
    axes = robot.external_axes
    if "assumed" in robot.origins.get("external axes", ""):
        axes = tuple(replace(axis, joint=_times(axis.joint, factors)) for axis in axes)
    joints = tuple(_times(joint, factors) for joint in robot.joints)
    return replace(robot, joints=joints, external_axes=axes)


def _times(joint: Joint, factors: Mapping[str, float]) -> Joint:
    changed = {name: factor * getattr(joint, name) for name, factor in factors.items()}
    return replace(joint, **changed)
