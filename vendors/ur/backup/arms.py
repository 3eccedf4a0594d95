"""Which arm a program was made on, and how far this one differs from its type."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace

from ....core.backup.backup import BackupRobot
from ....core.door import given
from ....core.errors import FlybyError, InputError
from ....core.robot.model import Robot
from ....core.spatial.pose import Pose
from ..calibration import calibrated, type_of
from ..urp.installation import Installation
from ..urp.kinematics import DhTable

TYPES = [
    "ur3",
    "ur5",
    "ur10",
    "ur3e",
    "ur5e",
    "ur10e",
    "ur16e",
    "ur20",
    "ur30",
    "ur7e",
    "ur12e",
    "ur15",
    "ur18",
    "ur8long",
]
"""Of two with the same kinematics (UR5e and UR7e, UR10e and UR12e) the one that came first."""
SERIES = {
    "30": "ur10",
    "33": "ur3",
    "35": "ur5",
    "52": "ur10e",
    "53": "ur3e",
    "55": "ur5e",
    "68": "ur20",
}
"""Types by the fifth and sixth digit of serial numbers (seen in 608 public programs)."""
_SERIAL = re.compile(r"\d{10,11}")
_SIMULATOR = "99999"
"""How serial numbers of simulators end."""


@dataclass(frozen=True)
class Stated:
    """What programs and installations say of their arm.

    Args:
        table: its kinematics; None if not stated.
        serial: number of the robot.
        file: that says so.
    """

    table: DhTable | None
    serial: str
    file: str


class Types:
    """The arms that flyby knows, loaded when they are asked for."""

    def __init__(self, find_robot: Callable[[str], Robot]) -> None:
        self._find = find_robot
        self._all: list[Robot] | None = None

    def named(self, name: str) -> Robot | None:
        """An arm by its model; None if it is not known."""
        try:
            return self._find(f"ur/{name}")
        except InputError:
            return None

    def all(self) -> list[Robot]:
        """All of them."""
        if self._all is None:
            self._all = [robot for name in TYPES if (robot := self.named(name)) is not None]
        return self._all


def backup_robot(
    stated: Stated, installation: Installation | None, types: Types, doubts: list[str]
) -> BackupRobot:
    """The robot that files are of.

    Args:
        stated: what they say of the arm.
        installation: its mounting and limits of safety.
        types: known arms.
        doubts: where it is said what contradicts it, or is not used.
    """
    serial = stated.serial if _SERIAL.fullmatch(stated.serial) else ""
    series = SERIES.get(serial[4:6])
    near = [] if stated.table is None else type_of(stated.table, types.all())
    robot = next((one for one in near if series and one.name == f"ur/{series}"), None)
    if robot is None and near:
        first = {one.name: one for one in near}
        robot = next(first[f"ur/{name}"] for name in TYPES if f"ur/{name}" in first)
    if robot is None and stated.table is None and series:
        robot = types.named(series)
    alike = [one.name for one in near if robot is not None and one is not robot]
    if alike and series is None:
        doubts.append(f"{', '.join(alike)} has the same kinematics: name it if it is that")
    elif robot is not None and series and robot.name != f"ur/{series}" and serial:
        doubts.append(
            f"its kinematics are those of {robot.name}, its serial number {serial} is one of a "
            f"{series.upper()}: {robot.name} is taken"
        )
    written = _written(robot, serial)
    unit = serial or "robot"
    if robot is None:
        return BackupRobot(unit, written, None, (_unknown(stated, series),))
    if stated.table is not None and stated.table.calibrated:
        try:
            robot = calibrated(robot, stated.table, stated.file)
        except FlybyError as error:
            doubts.append(f"its calibration is not used: {error}")
    if installation is not None:
        robot = _installed(robot, installation, doubts)
    return BackupRobot(unit, written, robot)


def _written(robot: Robot | None, serial: str) -> str:
    model = "" if robot is None else robot.name.removeprefix("ur/").upper().replace("E", "e")
    kind = " (simulator)" if serial.endswith(_SIMULATOR) else ""
    return f"{model} {serial}".strip() + kind


def _unknown(stated: Stated, series: str | None) -> str:
    if stated.table is None and series is None:
        return f"nothing says which arm it is: name one, {given('robot', 'NAME')}"
    if stated.table is None:
        return f"its serial number is one of a {str(series).upper()}, which is not known"
    also = f"; its serial number is one of a {series.upper()}" if series else ""
    return f"its kinematics in {stated.file} are those of no arm that is known{also}"


def _installed(robot: Robot, installation: Installation, doubts: list[str]) -> Robot:
    """The robot with the mounting and the limits of safety of an installation."""
    origins = dict(robot.origins)
    joints = robot.joints
    limits = installation.limits
    if limits is not None:
        try:
            joints = tuple(
                replace(joint, lower=low, upper=high, velocity=min(joint.velocity, speed))
                for joint, low, high, speed in zip(
                    joints, limits.lower, limits.upper, limits.speed, strict=True
                )
            )
            origins["range"] = "measured: installation, limits of safety"
            if any(a.velocity < b.velocity for a, b in zip(joints, robot.joints, strict=True)):
                origins["velocity"] = "measured: installation, limits of safety below the arm's own"
        except InputError as error:
            doubts.append(f"its limits of safety are not used: {error}")
            joints = robot.joints
    base = robot.base
    if installation.tilt or installation.turn:
        base = _turned("x", installation.tilt) @ _turned("z", installation.turn) @ base
        origins["base"] = "measured: installation, mounting"
    return replace(robot, joints=joints, base=base, origins=origins)


def _turned(axis: str, angle: float) -> Pose:
    c, s = math.cos(angle / 2), math.sin(angle / 2)
    return Pose(quaternion=(c, s, 0.0, 0.0) if axis == "x" else (c, 0.0, 0.0, s))
