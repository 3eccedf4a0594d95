"""The bodies of a cell with one tool mounted, each on the frame that carries it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from ...cell.cell import Cell, Obstacle
from ...cell.geometry import Geometry, Mesh
from ...errors import InputError, Note
from ...files.toml_text import key_text
from ...program.tool import FLANGE, Tool
from ...robot.model import Robot
from ...spatial.pose import Pose
from ..distance.convex import obstacle_solids, tool_solids
from ..distance.solid import Solid
from .frames import WORLD, base_place, frame_of_axis

SAME_TCP = 1e-4
"""m by which a tool's TCP may differ between program and cell without a note."""
BASE = "base"
"""What the robot's base is called in tables of allowed pairs."""


class BodyKind(StrEnum):
    """What a body is part of."""

    LINK = "link"
    TOOL = "tool"
    OBSTACLE = "obstacle"
    HELD = "held part"
    PART = "part"


@dataclass(frozen=True, slots=True)
class Body:
    """A solid that is carried as a whole.

    Args:
        name: for messages, unique in the scene: ``J3``, ``gun``, ``fixture (2)``.
        thing: what it is one of the bodies of: ``J3``, ``gun``, ``fixture``, ``crate 2``.
        part: what allowed pairs call it: ``base``, the joint before the link, the tool, the
            obstacle or the kind of part.
        kind: what the part is.
        frame: that carries it, a row of `flyby.core.collision.scene.frames.FrameTree`.
        solid: its shape.
        placement: the solid's frame in the carrying frame.
    """

    name: str
    thing: str
    part: str
    kind: BodyKind
    frame: int
    solid: Solid
    placement: Pose

    @property
    def own(self) -> bool:
        """Whether it is of the arm, or carried by it."""
        held = self.kind is BodyKind.TOOL and self.frame > WORLD
        return held or self.kind in (BodyKind.LINK, BodyKind.HELD)


class Bodies(NamedTuple):
    """The bodies of a scene, and what is odd about them."""

    bodies: tuple[Body, ...]
    notes: tuple[Note, ...]


def bodies_of(cell: Cell, tool: Tool) -> Bodies:
    """All bodies: links, the mounted tool, tools that stand in the cell, and obstacles.

    Raises:
        InputError: the robot has no shapes, the cell does not know the tool or holds it
            elsewhere, or a mesh cannot be used.
    """
    _check_robot(cell.robot)
    _check_tool(cell, tool)
    found: list[Body] = list(_links(cell.robot))
    notes: list[Note] = []
    for name in _present_tools(cell, tool):
        solids, odd = tool_like_solids(name, cell.tool_geometries[name])
        frame, placement = _tool_place(cell, name)
        notes += odd
        found += pieces_of(name, name, BodyKind.TOOL, frame, placement, solids)
    notes += _tool_notes(cell, tool)
    for obstacle in cell.obstacles:
        solids, odd = _obstacle_solids(obstacle.geometry)
        notes += odd
        found += _obstacle(cell.robot, obstacle, solids)
    if not found:
        raise InputError(
            f"nothing of {cell.robot.name} and its cell has a shape: give the table and what lies "
            "on it as [[obstacle]] with carried_by"
        )
    return Bodies(tuple(found), tuple(notes))


def _check_robot(robot: Robot) -> None:
    if robot.has_arm and not robot.shapes:
        raise InputError(
            f"robot {robot.name} has no shapes, so its collisions are not known; add [[shape]] "
            "tables (capsules round its links) to its catalogue file"
        )


def _check_tool(cell: Cell, tool: Tool) -> None:
    where = "the cell" if cell.file is None else str(cell.file)
    if tool.name not in cell.tools:
        known = ", ".join(repr(name) for name in sorted(cell.tools))
        raise InputError(
            f"{where} has no tool {tool.name!r}, so its shape is not known; it has {known}; "
            f"add [tool.{key_text(tool.name)}]"
        )
    held = cell.tools[tool.name].robot_held
    if held != tool.robot_held:
        places = {True: "held by the robot", False: "standing in the cell"}
        raise InputError(
            f"tool {tool.name!r} is {places[tool.robot_held]} in the program but "
            f"{places[held]} in {where}"
        )


def _tool_notes(cell: Cell, tool: Tool) -> Iterable[Note]:
    if tool.name == FLANGE.name:
        return
    if tool.name not in cell.tool_geometries:
        yield Note(f"tool {tool.name!r} has no shape in the cell: it passes through everything")
    ours, theirs = tool.tcp.position, cell.tools[tool.name].tcp.position
    if math.dist(ours, theirs) > SAME_TCP:
        yield Note(
            f"tool {tool.name!r} has its TCP {1e3 * math.dist(ours, theirs):.3g} mm away from "
            "where the cell has it; its shape is taken from the cell as it is"
        )


def _links(robot: Robot) -> Iterable[Body]:
    base = base_place(robot)
    for link in range(robot.arm_size + 1):
        shapes = [shape for shape in robot.shapes if shape.link == link]
        for number, shape in enumerate(shapes, 1):
            part = BASE if link == 0 else robot.joints[link - 1].name
            frame, placement = link, shape.placement
            if link == 0:
                frame, placement = base.frame, base.placement @ shape.placement
            full = part if len(shapes) == 1 else f"{part} ({number})"
            yield Body(full, part, part, BodyKind.LINK, frame, shape.shape, placement)


def _present_tools(cell: Cell, mounted: Tool) -> list[str]:
    """Names of the tools with a shape: the mounted one, and those that stand in the cell."""
    return [
        name
        for name in cell.tool_geometries
        if name == mounted.name or not cell.tools[name].robot_held
    ]


def _tool_place(cell: Cell, name: str) -> tuple[int, Pose]:
    geometry = cell.tool_geometries[name]
    if cell.tools[name].robot_held:
        return cell.robot.flange_link, cell.robot.flange @ geometry.placement
    return WORLD, geometry.placement


def tool_like_solids(name: str, geometry: Geometry) -> tuple[list[Solid], list[Note]]:
    """The convex solids of what a robot carries, and what is odd about them.

    Raises:
        InputError: the mesh cannot be used.
    """
    if isinstance(geometry.shape, Mesh):
        return tool_solids(name, geometry.shape)
    return [geometry.shape], []


def _obstacle_solids(geometry: Geometry) -> tuple[list[Solid], list[Note]]:
    if isinstance(geometry.shape, Mesh):
        return obstacle_solids(geometry.shape)
    return [geometry.shape], []


def _obstacle(robot: Robot, obstacle: Obstacle, solids: list[Solid]) -> list[Body]:
    carrier = obstacle.carried_by
    frame = WORLD if carrier is None else frame_of_axis(robot, carrier)
    name = obstacle.name
    return pieces_of(name, name, BodyKind.OBSTACLE, frame, obstacle.geometry.placement, solids)


def pieces_of(
    thing: str, part: str, kind: BodyKind, frame: int, placement: Pose, solids: list[Solid]
) -> list[Body]:
    """The bodies of one thing, see `Body`."""
    if len(solids) == 1:
        return [Body(thing, thing, part, kind, frame, solids[0], placement)]
    return [
        Body(f"{thing} ({number})", thing, part, kind, frame, solid, placement)
        for number, solid in enumerate(solids, 1)
    ]
