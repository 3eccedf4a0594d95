"""The chain from a work object to the TCP for a robot, a tool and a work object."""

from __future__ import annotations

from typing import Protocol

from ..errors import InputError
from ..spatial.pose import Pose
from .assembly import assemble, joined, reversed_chain
from .joint import ExternalRole
from .kinematics.chain import Chain
from .model import Robot


class PlacedTool(Protocol):
    """What a chain needs of a tool: see `flyby.core.program.tool.Tool`."""

    @property
    def name(self) -> str: ...
    @property
    def tcp(self) -> Pose: ...
    @property
    def robot_held(self) -> bool: ...


class PlacedWorkObject(Protocol):
    """What a chain needs of a work object: see `flyby.core.program.tool.WorkObject`."""

    @property
    def name(self) -> str: ...
    @property
    def pose(self) -> Pose: ...
    @property
    def robot_held(self) -> bool: ...
    @property
    def moved_by(self) -> str | None: ...


def work_chain(robot: Robot, tool: PlacedTool, work_object: PlacedWorkObject) -> Chain:
    """The TCP in the work object's frame as a chain over the robot's N values.

    The chain runs from the work object to the world (back through the table that moves it, or
    back through the arm that holds it) and from there to the TCP.

    Raises:
        InputError: robot holds both or neither of tool and work object, or the work object is
            moved by something that is no table.
        UnknownNameError: the robot has no external axis ``work_object.moved_by``.
    """
    _check_holding(tool, work_object)
    tcp = robot.flange_stages() if tool.robot_held else []
    to_tcp = assemble([*tcp, tool.tcp])
    if work_object.robot_held:
        held_by = robot.flange_stages()
    else:
        _check_table(robot, work_object)
        held_by = robot.frame_stages(work_object.moved_by)
    to_object = assemble([*held_by, work_object.pose])
    return joined(reversed_chain(to_object), to_tcp)


def _check_holding(tool: PlacedTool, work_object: PlacedWorkObject) -> None:
    if tool.robot_held and work_object.robot_held:
        raise InputError(
            f"the robot holds both tool {tool.name!r} and work object {work_object.name!r}; "
            "one of them must stand still, or nothing moves between them"
        )
    if not tool.robot_held and not work_object.robot_held:
        raise InputError(
            f"the robot holds neither tool {tool.name!r} nor work object {work_object.name!r}; "
            "a stationary tool needs a work object that the robot holds"
        )
    if work_object.robot_held and work_object.moved_by is not None:
        raise InputError(
            f"work object {work_object.name!r} is held by the robot and moved by "
            f"{work_object.moved_by!r}; it can only be one of them"
        )


def _check_table(robot: Robot, work_object: PlacedWorkObject) -> None:
    if work_object.moved_by is None:
        return
    axis = robot.external_axis(work_object.moved_by)
    if axis.role is not ExternalRole.TABLE:
        raise InputError(
            f"work object {work_object.name!r} is moved by {axis.name!r}, "
            f"which is a {axis.role}, not a table"
        )
