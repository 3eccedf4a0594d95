"""A cell as a value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import FloatArray
from ..display import counted, in_line
from ..errors import Note, UnknownNameError
from ..notebook import PictureCurve, page, picture, table
from ..program.tool import FLANGE, WORLD, Tool, WorkObject
from ..robot.assembly import assemble
from ..robot.kinematics.chain_kernels import poses
from ..robot.model import Robot
from .geometry import Geometry, Mesh
from .workpiece import Workpiece

if TYPE_CHECKING:
    from ..registry import Registry
    from ..vendor import Vendor


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A thing that stands in the cell.

    Args:
        name: unique in the cell.
        geometry: its shape, placed in the world or in the frame of ``carried_by``.
        carried_by: name of the external axis that moves it; None if it stands still.
    """

    name: str
    geometry: Geometry
    carried_by: str | None = None


@dataclass(frozen=True)
class Cell:
    """A robot with tools and frames among obstacles.

    Args:
        robot: standing where it stands, with the cell's external axes.
        vendor: name of the robot's vendor.
        clearance: distance in m that every part must keep from every other.
        tools: by name; the bare flange (``tool0``) is always there.
        frames: work objects by name; the world (``wobj0``) is always there.
        tool_geometries: shapes of tools by the tool's name, in the flange's frame (in the world
            for a stationary tool).
        obstacles: what stands around.
        parts: what the robot picks and places.
        allowed: pairs of names that may touch; printed in every report.
        motion: file of how this robot is driven, on top of what its vendor states; None for that.
        file: the file that the cell was read from.
    """

    robot: Robot
    vendor: str
    clearance: float = 0.0
    tools: Mapping[str, Tool] = field(default_factory=dict)
    frames: Mapping[str, WorkObject] = field(default_factory=dict)
    tool_geometries: Mapping[str, Geometry] = field(default_factory=dict)
    obstacles: tuple[Obstacle, ...] = ()
    parts: tuple[Workpiece, ...] = ()
    allowed: tuple[tuple[str, str], ...] = ()
    motion: Path | None = None
    file: Path | None = None

    def __post_init__(self) -> None:
        tools = {FLANGE.name: FLANGE, **self.tools}
        frames = {WORLD.name: WORLD, **self.frames}
        object.__setattr__(self, "tools", MappingProxyType(tools))
        object.__setattr__(self, "frames", MappingProxyType(frames))
        object.__setattr__(self, "tool_geometries", MappingProxyType({**self.tool_geometries}))

    def __repr__(self) -> str:
        name = "" if self.file is None else f" {self.file.name}"
        told = [counted(self.obstacles, "obstacle"), counted(len(self.tools) - 1, "tool")]
        if self.parts:
            told.append(counted(self.parts, "kind of part", "kinds of parts"))
        told.append(f"clearance {1e3 * self.clearance:g} mm")
        return in_line(f"Cell{name} with {self.robot.name}: {', '.join(told)}")

    def _repr_html_(self) -> str:
        at = self.robot.outline()
        things: tuple[Obstacle | Workpiece, ...] = (*self.obstacles, *self.parts)
        boxes = {thing.name: self._box(thing) for thing in things}
        shapes = {thing.name: type(thing.geometry.shape).__name__ for thing in things}
        rows = [(name, shapes[name], *_reach(box)) for name, box in boxes.items()]
        rows.insert(0, (self.robot.name, "robot", *_reach(at)))
        curves = [
            PictureCurve("robot", at, at),
            *(PictureCurve("obstacles", b[_EDGES]) for b in boxes.values()),
        ]
        return page(repr(self)[1:-1], table(_COLUMNS, rows), picture(curves))

    def _box(self, thing: Obstacle | Workpiece) -> FloatArray:
        """Corners (8, 3) m in the world of the box round a thing, external axes at zero."""
        stages = [*self.robot.frame_stages(thing.carried_by), thing.geometry.placement]
        R, p = poses(assemble(stages), np.zeros((1, self.robot.size)))
        return np.asarray(thing.geometry.corners @ R[0].T + p[0])

    def find_vendor(self, registry: Registry) -> Vendor:
        """The robot's vendor, who knows the robot and drives it as the cell says.

        Raises:
            InputError: the motion file cannot be read, or is another robot's.
        """
        vendor = registry.find_vendor(self.vendor)
        if self.robot.name.removeprefix(f"{vendor.name}/") not in vendor.robots:
            vendor = vendor.with_robot(self.robot)
        return vendor if self.motion is None else vendor.driven_by(self.motion, self.robot)

    def tool(self, name: str) -> Tool:
        """The tool ``name``.

        Raises:
            UnknownNameError: the cell has no such tool.
        """
        if name not in self.tools:
            raise UnknownNameError("tool of the cell", name, self.tools)
        return self.tools[name]

    def frame(self, name: str) -> WorkObject:
        """The work object ``name``.

        Raises:
            UnknownNameError: the cell has no such frame.
        """
        if name not in self.frames:
            raise UnknownNameError("frame of the cell", name, self.frames)
        return self.frames[name]

    def check_meshes(self) -> tuple[Note, ...]:
        """Read every mesh, and say what is odd about them.

        Raises:
            InputError: a mesh cannot be used.
        """
        return tuple(note for mesh in self._meshes() for note in mesh.notes)

    def doubtful_units(self) -> tuple[str, ...]:
        """What speaks against the units of meshes: nothing else explains them as often where a
        program collides at once.

        Raises:
            InputError: a mesh cannot be used.
        """
        doubts = ((mesh.file, mesh.doubt) for mesh in self._meshes())
        return tuple(f"{file}: {doubt}" for file, doubt in doubts if doubt is not None)

    def _meshes(self) -> list[Mesh]:
        geometries = (
            *self.tool_geometries.values(),
            *(obstacle.geometry for obstacle in self.obstacles),
            *(part.geometry for part in self.parts),
        )
        return [g.shape for g in geometries if isinstance(g.shape, Mesh)]


def _reach(points: FloatArray) -> tuple[str, ...]:
    """From where to where points reach along each axis, mm."""
    ends = 1e3 * np.array([points.min(axis=0), points.max(axis=0)]) + 0.0
    return tuple(f"{low:.0f} … {high:.0f}" for low, high in ends.T)


_COLUMNS = (
    ("", "left"),
    ("shape", "left"),
    ("x, mm", "right"),
    ("y, mm", "right"),
    ("z, mm", "right"),
)
_EDGES = [0, 1, 3, 2, 0, 4, 5, 1, 5, 7, 3, 7, 6, 2, 6, 4]
"""A way round the corners of a box along all of its edges."""
