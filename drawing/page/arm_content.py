"""A robot and what stands around it on a page, as plain data: SI units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from ...core.arrays import FloatArray
from .packing import Quantised


class PageRole(StrEnum):
    """What a body is, which says how it is drawn and what switches it off."""

    LINK = "link"
    TOOL = "tool"
    OBSTACLE = "obstacle"
    PART = "part"
    FLOOR = "floor"


@dataclass(frozen=True)
class PageNode:
    """A frame that things ride on.

    Args:
        name: of the axis, or of what the frame is.
        parent: its index among the arm's nodes, before this one; -1 for the world.
        place: (4, 4), of the frame in its parent's with the axis at zero.
        value: index of the axis in a configuration; -1 where it stands still.
        axis: unit axis in the frame itself.
        slides: whether the axis is a linear one.
    """

    name: str
    parent: int
    place: FloatArray
    value: int = -1
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    slides: bool = False


@dataclass(frozen=True)
class PageMesh:
    """Triangles.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3), indices of them.
    """

    vertices: Quantised
    faces: Quantised


@dataclass(frozen=True)
class PageSolid:
    """A simple solid.

    Args:
        kind: ``box``, ``sphere``, ``cylinder`` or ``capsule``; the latter two along z.
        size: m; edges of a box, radius and length of the others.
    """

    kind: str
    size: tuple[float, ...]


@dataclass(frozen=True)
class PageBody:
    """A solid on a node.

    Args:
        name: that the user knows it by.
        role: what it is.
        node: that carries it.
        place: (4, 4), in the node's frame.
        shape: of it.
        tool: name of the tool with which it is mounted; empty where it is always there.
    """

    name: str
    role: PageRole
    node: int
    place: FloatArray
    shape: PageSolid | PageMesh
    tool: str = ""


@dataclass(frozen=True)
class PageAxis:
    """An axis of a configuration, with what its motion is a percentage of.

    Args:
        name: of it.
        linear: whether its values are m, not rad.
        lower, upper, velocity, acceleration: its limits.
        effort: N m or N; None where not known.
    """

    name: str
    linear: bool
    lower: float
    upper: float
    velocity: float
    acceleration: float
    effort: float | None


@dataclass(frozen=True)
class PageFrame:
    """A frame by its name: a work object, or a tool's centre point.

    Args:
        name: of it.
        node: that carries it.
        place: (4, 4), in the node's frame.
    """

    name: str
    node: int
    place: FloatArray


@dataclass(frozen=True)
class PageArm:
    """A robot with all that rides on it, and the cell round it.

    Args:
        name: of the robot.
        nodes: carriers before what they carry; the first is the world.
        axes: of its configurations.
        bodies: links, tools, obstacles.
        tools: centre points; the first is the flange.
        frames: work objects.
        flange: node of the flange.
    """

    name: str
    nodes: Sequence[PageNode]
    axes: Sequence[PageAxis]
    bodies: Sequence[PageBody]
    tools: Sequence[PageFrame]
    frames: Sequence[PageFrame]
    flange: int
