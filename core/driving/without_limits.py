"""What a run would gain if one of its limits fell away: its path is stamped again without it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..errors import MotionError
from ..motion.emulator.binding_limits import CENTRIPETAL_NAME, CORNER, PROGRAMMED, PROGRAMMED_TIME
from ..motion.emulator.controller import Controller
from ..motion.emulator.run import Run
from ..motion.timing.limits import SegmentLimits
from ..motion.timing.torque_rows import Shares
from ..program.speed import Speed
from ..robot.joint import Joint
from ..robot.model import Robot

_FAR = 1e3
"""Times its limit, a joint is as good as without one."""
_STATED: Mapping[str, tuple[str, ...]] = {
    PROGRAMMED[field]: tuple(fields)
    for field, *fields in (
        ("tcp", "tcp"),
        ("reorientation", "reorientation"),
        ("joint", "joint", "joint_fraction"),
        ("external_linear", "external_linear", "external_angular"),
        ("joint_acceleration", "joint_acceleration", "joint_acceleration_fraction"),
        ("tcp_acceleration", "tcp_acceleration"),
        ("reorientation_acceleration", "reorientation_acceleration"),
    )
} | {PROGRAMMED_TIME: ("duration",)}
"""Limits that a program states, and the fields of its speeds that do."""


def seconds_without(controller: Controller, run: Run, name: str) -> float | None:
    """s that a run would be shorter without a limit; its path and all other limits stay.

    What is programmed leaves the robot's own limits behind it. A path is driven faster through the
    zones that it has: with other speeds a controller may cut them elsewhere.

    Args:
        controller: that drove it.
        run: of it.
        name: of the limit, see `binding_limits.interval_limits`.

    Returns:
        None where the limit is none that can fall away, or the robot could not move without it.
    """
    timing, path = run.timing, run.path
    program, robot, shares = run.program, controller.robot, timing.path_limits.shares
    if name in _STATED:
        moves = [replace(m, speed=_without(m.speed, _STATED[name])) for m in program.moves]
        program = program.with_moves(tuple(moves))
    axis, _, figure = name.rpartition(" ")
    if axis in robot.axis_names:
        index = robot.axis_names.index(axis)
        if figure == "torque":
            shares = _without_torque(shares, index)
        else:
            robot = _with_joint(robot, index, figure)
    speeds = [program.moves[k].speed for k in path.route.moves]
    limits = SegmentLimits.of(robot, controller.model, speeds, path.segments)
    changed = _along_path(limits, name)
    if changed is limits and name not in _STATED and axis not in robot.axis_names:
        return None
    try:
        made = controller.stamp_within(program, path, timing.along, changed, shares)
    except MotionError:
        return None
    return timing.duration - made.duration


def _without(speed: Speed, fields: tuple[str, ...]) -> Speed:
    """A speed that leaves some of its fields to the robot."""
    default = Speed()
    return replace(speed, **{field: getattr(default, field) for field in fields})


def _with_joint(robot: Robot, index: int, figure: str) -> Robot:
    """The robot with an axis that is far faster, or accelerates far faster."""

    if index < robot.arm_size:
        arm = list(robot.joints)
        arm[index] = _far(arm[index], figure)
        return replace(robot, joints=tuple(arm))
    axes = list(robot.external_axes)
    axis = axes[index - robot.arm_size]
    axes[index - robot.arm_size] = replace(axis, joint=_far(axis.joint, figure))
    return replace(robot, external_axes=tuple(axes))


def _far(joint: Joint, figure: str) -> Joint:
    if figure == "velocity":
        return replace(joint, velocity=_FAR * joint.velocity)
    return replace(joint, acceleration=_FAR * joint.acceleration)


def _without_torque(shares: Shares | None, joint: int) -> Shares | None:
    """What a path takes of torques, nothing of one joint's."""
    if shares is None:
        return None
    parts = [np.array(part) for part in shares]
    for part in parts:
        part[:, joint] = 0.0
    return Shares(*parts)


def _along_path(limits: SegmentLimits, name: str) -> SegmentLimits:
    """Limits without one of the model's own along the path; the same object for other names."""
    rows = {"TCP acceleration": -2, "reorientation acceleration": -1}
    if name in rows:
        row, acceleration = rows[name], limits.acceleration.copy()
        own = [sources[row] is None for sources in limits.acceleration_source]
        acceleration[own, row] = np.inf
        return replace(limits, acceleration=acceleration)
    if name == CENTRIPETAL_NAME:
        return replace(limits, centripetal=np.inf)
    if name == CORNER:
        return replace(limits, zones_bind=False)
    return limits
