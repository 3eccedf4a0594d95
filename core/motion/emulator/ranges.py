"""Refuses paths and starts beyond the robot's ranges."""

from __future__ import annotations

import math

import numpy as np

from ...arrays import FloatArray
from ...errors import FaultCause, MotionError
from ...program.program import Program
from ...program.target import JointTarget
from ...robot.joint import JointKind
from ...robot.model import Robot
from ..path.path import Path

OTHER_TARGET = "choose another configuration or move the target"
"""Advice where a joint does not reach a target."""
OWN_VALUE = (
    "the program says this value itself: change it there, or see whether the robot is the right "
    "one, with the ranges that its own controller has"
)
"""The same where the target is the joints' values."""
_SLACK = 1e-6
"""rad or m by which a path may pass a joint limit: rounding of programmed values."""


def check_path(robot: Robot, program: Program, path: Path, started: bool) -> None:
    """Refuse the first move that passes a range.

    Args:
        robot: that drives it.
        program: whose path it is.
        path: all of it.
        started: whether someone said where the robot starts.

    Raises:
        MotionError: it passes one; the move is named.
    """
    limits, ends = robot.limits, path.route.ends.q[0, 0]
    lowest, highest = limits.lower - _SLACK, limits.upper + _SLACK
    if not robot.coupled_ranges and all(
        ((lowest <= q) & (q <= highest)).all() for q in (ends, path.q)
    ):
        return
    remedy = "start within the limits" if started else OTHER_TARGET
    check_standing(robot, path.route.ends.q[0, 0], remedy, "the start: ")
    beyond = _beyond(robot, path.q)
    samples = np.flatnonzero(beyond.max(axis=1) > _SLACK)
    if not len(samples):
        return
    moves = path.sample_moves()
    move = int(moves[samples[0]])
    samples = samples[moves[samples] == move]
    row, which = np.unravel_index(np.argmax(beyond[samples]), beyond[samples].shape)
    target = program.moves[move].target
    at_target = isinstance(target, JointTarget) and which < robot.arm_size
    remedy = OWN_VALUE if at_target else OTHER_TARGET
    said = _excess(robot, int(which), path.q[samples[row]], remedy)
    raise MotionError(said, move, cause=FaultCause.LIMIT)


def check_standing(robot: Robot, q: FloatArray, remedy: str = OTHER_TARGET, what: str = "") -> None:
    """Refuse a robot (N,) that stands beyond a range.

    Raises:
        MotionError: it does, and the remedy.
    """
    beyond = _beyond(robot, q[None])[0]
    if beyond.max() > _SLACK:
        said = _excess(robot, int(np.argmax(beyond)), q, remedy)
        raise MotionError(what + said, cause=FaultCause.LIMIT)


def _beyond(robot: Robot, q: FloatArray) -> FloatArray:
    """(M, N + C), rad or m by which configurations (M, N) are beyond each axis' range and each
    coupled one; not above zero within."""
    limits = robot.limits
    own = np.maximum(limits.lower - q, q - limits.upper)
    return np.concatenate([own, robot.beyond_coupled(q)], axis=1)


def _excess(robot: Robot, which: int, q: FloatArray, remedy: str) -> str:
    """What is wrong at q (N,) with an axis, or with a coupled range behind them."""
    if which >= robot.size:
        coupled = robot.coupled_ranges[which - robot.size]
        return f"{coupled.excess(float(coupled.row(robot.axis_names) @ q))}; {remedy}"
    limits, joints = robot.limits, [*robot.joints, *(a.joint for a in robot.external_axes)]
    joint, value = joints[which], float(q[which])
    if joint.held:
        return (
            f"the flange would tilt by {math.degrees(abs(value)):.2f}° about the axis of "
            f"{joint.name}, for which {robot.name} has no motor; {remedy}"
        )
    unit, factor = ("mm", 1e3) if joint.kind is JointKind.PRISMATIC else ("°", 180 / math.pi)
    bound = limits.lower[which] if value < limits.lower[which] else limits.upper[which]
    return (
        f"joint {joint.name} would stand at {factor * value:.2f} {unit}, "
        f"beyond its limit of {factor * bound:.2f} {unit}; {remedy}"
    )
