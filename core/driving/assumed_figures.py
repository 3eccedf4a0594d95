"""What a robot's assumed speeds and accelerations leave open of a program's time."""

from __future__ import annotations

from dataclasses import replace

from ..motion.emulator.controller import Controller
from ..motion.emulator.run import Run
from ..robot.model import Robot

_FIGURES = ("velocity", "acceleration")


def duration_range(controller: Controller, run: Run) -> tuple[float, float] | None:
    """Least and greatest duration (s) of a run with all assumed figures off by their spread.

    The path is stamped again with each assumed figure of every joint multiplied, then divided by
    its factor.

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
    joints = tuple(
        replace(joint, **{name: factor * getattr(joint, name) for name, factor in factors.items()})
        for joint in robot.joints
    )
    return replace(robot, joints=joints)
