"""One arm's own kinematics laid on the arm of its type: calibrations, from whichever file.

A calibrated table puts the axes of the joints, all joints at zero, a little beside those of the
type. Each joint's frame is moved to its own axis, by no more than that: bodies and shapes stay
where they are. The rows themselves would not do: a table that the controller has linearised turns
the frames of the parallel axes, and moves them along by hundreds of metres.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose
from .urp.kinematics import JOINTS, DhTable

APART = 0.02
"""m by which a calibrated flange is off the nominal one at most: of 608 public programs 604 are off
by 5 mm and less, the others, whose arms are of other types, by 40 mm and more."""
SAME_TYPE = 0.005
"""m, the same where nobody names the type."""
_PLACES = 100
_SAME_WAY = 0.9
"""Cosine between the axes of a joint."""


def calibrated(robot: Robot, table: DhTable, file: str | Path) -> Robot:
    """An arm of a type with its own table.

    Args:
        robot: the type's, nominal.
        table: of this arm.
        file: that states it, for messages and origins.

    Raises:
        InputError: the table is of another type of arm.
    """
    off = apart(robot, table)
    if not off <= APART:
        raise InputError(
            f"{file}: by its calibration the flange is up to {1e3 * off:.0f} mm from where that of "
            f"a {robot.name} is, {1e3 * APART:.0f} mm at most are an arm of this type: name "
            "another robot"
        )
    axes = _axes(table)
    if not all(
        np.array(joint.axis) @ frame[:3, :3].T @ along > _SAME_WAY
        for frame, joint, (_, along) in zip(_frames(robot), robot.joints, axes, strict=True)
    ):
        raise InputError(f"{file}: by its calibration a joint turns the other way round")
    frames = [
        _onto(frame, np.array(joint.axis), *axis)
        for frame, joint, axis in zip(_frames(robot), robot.joints, axes, strict=True)
    ]
    flange = table.flanges(np.zeros((1, JOINTS)))[0]
    behind = [np.asarray(np.linalg.solve(a, b), float) for a, b in pairwise([*frames, flange])]
    placed = [frames[0], *behind]
    joints = [
        replace(joint, placement=Pose.from_matrix(place))
        for joint, place in zip(robot.joints, placed, strict=False)
    ]
    origins = {**robot.origins, "geometry": f"measured: {Path(file).name}, this arm's calibration"}
    return replace(
        robot, joints=tuple(joints), flange=Pose.from_matrix(placed[-1]), origins=origins
    )


def apart(robot: Robot, table: DhTable) -> float:
    """m by which the flanges of a type and of a table are apart at most, at many configurations."""
    if robot.arm_size != JOINTS:
        return math.inf
    q = np.random.default_rng(0).uniform(-math.pi, math.pi, (_PLACES, JOINTS))
    stated = table.flanges(q)[:, :3, 3]
    arm = replace(robot, base=Pose(), external_axes=())
    return float(np.linalg.norm(arm.forward(q)[1] - stated, axis=1).max())


def type_of(table: DhTable, arms: Iterable[Robot]) -> list[Robot]:
    """The arms whose type a table may be of, nearest first."""
    off = [(apart(arm, table), index, arm) for index, arm in enumerate(arms)]
    return [
        arm for distance, _, arm in sorted(off, key=lambda one: one[:2]) if distance <= SAME_TYPE
    ]


def nominal_table(robot: Robot) -> DhTable:
    """The table of a type, whose axes 2, 3 and 4 are parallel and 5 and 6 square to the one before.

    Raises:
        InputError: the arm has another structure.
    """
    if robot.arm_size != JOINTS:
        raise InputError(f"{robot.name} has {robot.arm_size} joints: no calibration is read of it")
    frames = _frames(robot)
    at = [frame[:3, 3] for frame in frames]
    tip = (np.linalg.multi_dot([frames[-1], robot.flange.matrix()]))[:3, 3]
    d1, a2, a3 = at[1][2], at[2][0] - at[1][0], at[3][0] - at[2][0]
    d4, d5 = -at[4][1], at[1][2] - at[5][2]
    quarter = math.pi / 2
    rows = (
        (0.0, 0.0, float(d1), quarter),
        (0.0, float(a2), 0.0, 0.0),
        (0.0, float(a3), 0.0, 0.0),
        (0.0, 0.0, float(d4), quarter),
        (0.0, 0.0, float(d5), -quarter),
        (0.0, 0.0, float(-tip[1] - d4), 0.0),
    )
    table = DhTable(rows, "NOT_INITIALIZED")
    if not apart(robot, table) < 1e-6:
        raise InputError(f"{robot.name} is built otherwise than arms of UR: no calibration is read")
    return table


def _frames(robot: Robot) -> list[FloatArray]:
    """Frames of the joints in the base's, all joints at zero."""
    frame, found = np.eye(4), []
    for joint in robot.joints:
        frame = frame @ joint.placement.matrix()
        found.append(frame)
    return found


def _axes(table: DhTable) -> list[tuple[FloatArray, FloatArray]]:
    """A point (3,) of each joint's axis, and its direction, in the base's frame, joints at zero."""
    found = []
    for count in range(JOINTS):
        rows = (*table.rows[:count], *((0.0,) * 4 for _ in range(JOINTS - count)))
        frame = DhTable(tuple((a, b, c, d) for a, b, c, d in rows)).flanges(np.zeros((1, JOINTS)))
        found.append((frame[0, :3, 3], frame[0, :3, 2]))
    return found


def _onto(frame: FloatArray, axis: FloatArray, point: FloatArray, along: FloatArray) -> FloatArray:
    """A frame moved and turned, by as little as can be, so that its axis is a given line."""
    own = frame[:3, :3] @ axis
    turn = np.cross(own, along)
    cosine = float(own @ along)
    K = np.array([[0.0, -turn[2], turn[1]], [turn[2], 0.0, -turn[0]], [-turn[1], turn[0], 0.0]])
    moved = np.eye(4)
    moved[:3, :3] = (np.eye(3) + K + K @ K / (1.0 + cosine)) @ frame[:3, :3]
    moved[:3, 3] = point + along * (along @ (frame[:3, 3] - point))
    return moved
