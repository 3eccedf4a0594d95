"""A robot in its cell, as a page draws it: frames that move, solids on them, limits of axes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...core.arrays import FloatArray
from ...core.cell.cell import Cell
from ...core.cell.floor import FLOOR
from ...core.cell.geometry import Geometry
from ...core.program.tool import FLANGE, WORLD, Tool, WorkObject
from ...core.robot.assembly import Stage
from ...core.robot.joint import ExternalRole, Joint, JointKind
from ...core.robot.model import Robot
from ...core.robot.shape import Capsule, pose_along
from ...core.spatial.pose import IDENTITY, Pose
from .arm_content import (
    PageArm,
    PageAxis,
    PageBody,
    PageFrame,
    PageNode,
    PageRole,
)
from .shapes import page_shape

_STICK = 0.02
"""Radius of the bars that stand for what has no shape, as a share of the robot's length."""
_NOTHING = 1e-4
"""m; what is shorter gets no bar."""


@dataclass
class Nodes:
    """The frames of a robot: the world, external axes, the base, the arm's joints, the flange.

    Attributes:
        made: all of them.
        axes: node behind each external axis by its name.
        base: the node of the base.
        links: node behind each of the arm's joints, what follows them included.
        flange: the node of the flange.
    """

    made: list[PageNode] = field(default_factory=list)
    axes: dict[str, int] = field(default_factory=dict)
    base: int = 0
    links: list[int] = field(default_factory=list)
    flange: int = 0

    @classmethod
    def of(cls, robot: Robot) -> Nodes:
        """The frames of a robot."""
        nodes = cls([PageNode("world", -1, np.eye(4))])
        for axis in robot.external_axes:
            nodes._external(robot, axis.name)
        tracks = [axis for axis in robot.external_axes if axis.role is ExternalRole.TRACK]
        below = {axis.carried_by for axis in tracks}
        carrying = next((axis.name for axis in tracks if axis.name not in below), None)
        nodes.base = nodes._add("base", nodes.carrier(carrying), robot.base.matrix())
        at = nodes.base
        nodes.links = [at] * robot.arm_size
        for index in robot.along:
            for stage in robot.joint_stages(index):
                at = nodes._stage(robot.joints[index].name, at, stage)
            nodes.links[index] = at
        nodes.flange = nodes._add("flange", at, robot.flange.matrix())
        return nodes

    def carrier(self, axis: str | None) -> int:
        """The node behind an external axis; the world's for None."""
        return 0 if axis is None else self.axes[axis]

    def link(self, link: int) -> int:
        """The node of a link: 0 for the base, k for what is behind the arm's joint k."""
        return self.base if link == 0 else self.links[link - 1]

    def _external(self, robot: Robot, name: str) -> int:
        if name not in self.axes:
            axis = robot.external_axis(name)
            under = axis.carried_by
            parent = 0 if under is None else self._external(robot, under)
            index = robot.axis_names.index(name)
            self.axes[name] = self._stage(name, parent, (axis.joint, index))
        return self.axes[name]

    def _stage(self, name: str, parent: int, stage: Stage) -> int:
        if isinstance(stage, Pose):
            return self._add(name, parent, stage.matrix())
        joint, index = stage
        slides = joint.kind is JointKind.PRISMATIC
        node = PageNode(name, parent, joint.placement.matrix(), index, joint.axis, slides)
        self.made.append(node)
        return len(self.made) - 1

    def _add(self, name: str, parent: int, place: FloatArray) -> int:
        self.made.append(PageNode(name, parent, place))
        return len(self.made) - 1


def page_arm(
    robot: Robot,
    cell: Cell | None = None,
    tools: Iterable[Tool] = (),
    frames: Iterable[WorkObject] = (),
    *,
    around: bool = True,
) -> PageArm:
    """A robot with its tools, and what stands around it.

    Args:
        robot: where it stands.
        cell: what stands around; None for nothing.
        tools: that the motion uses.
        frames: that its targets are given in.
        around: whether obstacles are drawn with it; not with the second robot of a cell.

    Raises:
        InputError: a mesh cannot be used.
    """
    nodes = Nodes.of(robot)
    used = list(dict.fromkeys([FLANGE, *tools]))
    bodies = [*_links(robot, nodes), *_tools(robot, nodes, cell, used)]
    if cell is not None and around:
        bodies += _obstacles(nodes, cell)
    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    return PageArm(
        robot.name,
        nodes.made,
        [_axis(joint) for joint in joints],
        bodies,
        [_tcp(nodes, tool) for tool in used],
        [_frame(nodes, frame) for frame in dict.fromkeys(frames) if frame != WORLD],
        nodes.flange,
    )


def _axis(joint: Joint) -> PageAxis:
    slides = joint.kind is JointKind.PRISMATIC
    limits = joint.lower, joint.upper, joint.velocity, joint.acceleration
    return PageAxis(joint.name, slides, *limits, joint.effort)


def _tcp(nodes: Nodes, tool: Tool) -> PageFrame:
    return PageFrame(tool.name, nodes.flange if tool.robot_held else 0, tool.tcp.matrix())


def _frame(nodes: Nodes, frame: WorkObject) -> PageFrame:
    node = nodes.flange if frame.robot_held else nodes.carrier(frame.moved_by)
    return PageFrame(frame.name, node, frame.pose.matrix())


def _links(robot: Robot, nodes: Nodes) -> list[PageBody]:
    if not robot.shapes:
        return _skeleton(robot, nodes)
    names = ["base", *(joint.name for joint in robot.joints)]
    return [
        PageBody(
            names[shape.link],
            PageRole.LINK,
            nodes.link(shape.link),
            shape.placement.matrix(),
            page_shape(shape.shape),
        )
        for shape in robot.shapes
    ]


def _skeleton(robot: Robot, nodes: Nodes) -> list[PageBody]:
    """Bars from joint to joint, of an arm whose shapes nobody knows."""
    reach = sum(math.hypot(*joint.placement.position) for joint in robot.joints)
    bars, carrier = [], nodes.base
    for index in robot.along:
        joint = robot.joints[index]
        bars += _bar(joint.name, carrier, joint.placement, _STICK * reach, PageRole.LINK)
        carrier = nodes.links[index]
    return bars + _bar("flange", carrier, robot.flange, _STICK * reach, PageRole.LINK)


def _bar(
    name: str, node: int, end: Pose, radius: float, role: PageRole, tool: str = ""
) -> list[PageBody]:
    """A bar from a node to the origin of a frame in it."""
    to = np.array(end.position)
    length = float(np.linalg.norm(to))
    if length < _NOTHING:
        return []
    place = pose_along(np.zeros(3), to).matrix()
    return [PageBody(name, role, node, place, page_shape(Capsule(radius, length)), tool)]


def _tools(robot: Robot, nodes: Nodes, cell: Cell | None, used: Sequence[Tool]) -> list[PageBody]:
    """Tools with a shape in the cell; of others a bar from the flange to the centre point."""
    known = {} if cell is None else dict(cell.tool_geometries)
    reach = sum(math.hypot(*joint.placement.position) for joint in robot.joints)
    found = []
    for tool in used:
        if not tool.robot_held:
            continue
        if tool.name in known:
            found.append(_placed(tool.name, PageRole.TOOL, nodes.flange, known[tool.name], tool))
        else:
            radius = 0.5 * _STICK * reach
            found += _bar(tool.name, nodes.flange, tool.tcp, radius, PageRole.TOOL, tool.name)
    if cell is not None:
        standing = [name for name in known if not cell.tools[name].robot_held]
        found += [_placed(name, PageRole.TOOL, 0, known[name]) for name in standing]
    return found


def _obstacles(nodes: Nodes, cell: Cell) -> list[PageBody]:
    return [
        _placed(
            obstacle.name,
            PageRole.FLOOR if obstacle.name == FLOOR else PageRole.OBSTACLE,
            nodes.carrier(obstacle.carried_by),
            obstacle.geometry,
        )
        for obstacle in cell.obstacles
    ]


def _placed(
    name: str, role: PageRole, node: int, geometry: Geometry, tool: Tool | None = None
) -> PageBody:
    shape, place = page_shape(geometry.shape), geometry.placement or IDENTITY
    return PageBody(name, role, node, place.matrix(), shape, "" if tool is None else tool.name)
