"""What a controller calls the world, put to where that is among other controllers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..program.program import Program
from ..program.tool import Tool, WorkObject
from ..robot.joint import ExternalAxis
from ..robot.model import Robot
from ..spatial.pose import Pose
from .cell import Cell
from .geometry import Geometry


def moved_robot(robot: Robot, world: Pose) -> Robot:
    """A robot whose world stands at a pose in another one."""
    x, y, z = world.matrix()[:3, :3] @ np.array(robot.gravity)
    on_floor = not any(axis.role == "track" for axis in robot.external_axes)
    return replace(
        robot,
        base=world @ robot.base if on_floor else robot.base,
        external_axes=tuple(_axis(axis, world) for axis in robot.external_axes),
        gravity=(float(x), float(y), float(z)),
    )


def moved_cell(cell: Cell, robot: Robot, world: Pose) -> Cell:
    """A cell likewise.

    Args:
        cell: as its file has it.
        robot: of the cell, moved.
        world: where its world stands.
    """
    standing = {name for name, tool in cell.tools.items() if not tool.robot_held}
    return replace(
        cell,
        robot=robot,
        tools={name: _tool(tool, world) for name, tool in cell.tools.items()},
        frames={name: _frame(frame, world) for name, frame in cell.frames.items()},
        tool_geometries={
            name: _geometry(geometry, world) if name in standing else geometry
            for name, geometry in cell.tool_geometries.items()
        },
        obstacles=tuple(
            replace(o, geometry=_geometry(o.geometry, world)) if o.carried_by is None else o
            for o in cell.obstacles
        ),
        parts=tuple(
            replace(p, geometry=_geometry(p.geometry, world)) if p.carried_by is None else p
            for p in cell.parts
        ),
    )


def moved_program(program: Program, world: Pose) -> Program:
    """A program likewise: its joints are what they were."""
    return program.with_moves(
        tuple(
            replace(
                move,
                tool=_tool(move.tool, world),
                work_object=_frame(move.work_object, world),
            )
            for move in program.moves
        )
    )


def _axis(axis: ExternalAxis, world: Pose) -> ExternalAxis:
    if axis.carried_by is not None:
        return axis
    return replace(axis, joint=replace(axis.joint, placement=world @ axis.joint.placement))


def _tool(tool: Tool, world: Pose) -> Tool:
    return tool if tool.robot_held else replace(tool, tcp=world @ tool.tcp)


def _frame(frame: WorkObject, world: Pose) -> WorkObject:
    if frame.robot_held or frame.moved_by is not None or frame.not_followed is not None:
        return frame
    return replace(frame, user=world @ frame.user)


def _geometry(geometry: Geometry, world: Pose) -> Geometry:
    return replace(geometry, placement=world @ geometry.placement)
