"""The cell of a robot whose surroundings are not known: the plane that its base stands on.

A base stands on something: a floor, a table, a wall, a ceiling. Nothing of the robot, and no TCP,
may go beyond that plane, unless the user knows that there is room.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from ..door import spelt, switched
from ..program.tool import FLANGE, Tool
from ..robot.joint import JointKind
from ..robot.model import Robot
from ..robot.shape import Box, Sphere
from ..spatial.pose import Pose
from .cell import Cell, Obstacle
from .geometry import Geometry

FLOOR = "the plane under the base"
"""Name of the obstacle."""
_SUNK, _THICK = 1e-3, 0.1
"""m by which it lies deeper, so that what merely lies on it may be reached; m of its depth."""
_POINT = 1e-4
"""m, radius of a TCP of whose tool no shape is known."""
_PARALLEL = 1e-9


def lifted() -> str:
    """Advice where the floor is in the way."""
    return (
        "no cell file says what stands around, so the plane that the robot's base stands on counts "
        f"as a floor: {switched('no_floor')} lifts it, {spelt('cell')} states the surroundings"
    )


def bare_cell(robot: Robot, vendor: str, tools: Iterable[Tool] = (), *, floor: bool = True) -> Cell:
    """A cell without anything but its floor.

    Args:
        robot: where it stands.
        vendor: its vendor.
        tools: that are mounted; of their shapes nothing is known, but their TCPs keep off the
            floor.
        floor: whether there is one.
    """
    known = {tool.name: tool for tool in tools}
    if not floor or not robot.has_arm:
        return Cell(robot, vendor, tools=known)
    held = {name: tool for name, tool in known.items() if tool.robot_held and name != FLANGE.name}
    arm = [joint.name for joint in robot.joints]
    allowed = [(FLOOR, name) for name in _level(robot)]
    allowed += [(name, part) for name in held for part in ("base", *arm)]
    return Cell(
        robot,
        vendor,
        tools=known,
        tool_geometries={
            name: Geometry(Sphere(_POINT), Pose(tool.tcp.position)) for name, tool in held.items()
        },
        obstacles=(Obstacle(FLOOR, _floor(robot, held.values())),),
        allowed=tuple(allowed),
    )


def _floor(robot: Robot, tools: Iterable[Tool]) -> Geometry:
    """As far round the base as the arm can reach."""
    places = [joint.step for joint in robot.joints] + [robot.flange]
    reach = sum(math.hypot(*place.position) for place in places)
    reach += max((math.hypot(*tool.tcp.position) for tool in tools), default=0.0)
    box = Box((2.0 * reach, 2.0 * reach, _THICK))
    top = -robot.base_height - _SUNK
    return Geometry(box, robot.base @ Pose((0.0, 0.0, top - 0.5 * _THICK)))


def _level(robot: Robot) -> list[str]:
    """Joints behind which a link only turns about the plane's normal: it cannot come nearer."""
    found: list[str] = []
    frame = Pose()
    for joint in (robot.joints[index] for index in robot.along):
        axis = (frame @ joint.placement).matrix()[:3, :3] @ joint.axis
        level = joint.kind is JointKind.REVOLUTE and abs(axis[2]) > 1.0 - _PARALLEL
        if not level or joint.followers:
            break
        frame = frame @ joint.step
        found.append(joint.name)
    return found
