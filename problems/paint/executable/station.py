"""Where a part is painted: robot, gun, and where the part stands."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....core.cell.cell import Cell, Obstacle
from ....core.cell.geometry import Geometry, Mesh, Triangles
from ....core.errors import InputError
from ....core.program.speed import Speed
from ....core.program.tool import WORLD, Load, Tool, WorkObject
from ....core.program.zone import Radius
from ....core.spatial.pose import IDENTITY, Pose
from ....core.vendor import Vendor
from ..surface.part import Part

PLAIN_GUN = Tool(
    "gun",
    Pose(
        (0.13, 0.0, 0.275), (math.cos(math.radians(30.0)), 0.0, math.sin(math.radians(30.0)), 0.0)
    ),
    Load(5.0, (0.02, 0.0, 0.15)),
)
"""Turned by 60° off the flange's axis, as bells on painting robots are: it reaches round parts
where a straight one does not. For where no other is known."""
GENTLE = 2.0
"""m/s², for languages in which lines need an acceleration."""
_PART = "part {}"
_WIDER = 1.5
"""Zone of reorientation by that of the TCP, as ABB predefines them."""


@dataclass(frozen=True)
class Station:
    """A robot with a gun, and a part before it.

    Args:
        vendor: whose program is to be written.
        cell: the robot and what stands around it.
        gun: the tool; it sprays along the z axis of its TCP, and the long axis of an elliptic
            footprint lies along its x axis.
        part_frame: where the part's frame stands.
    """

    vendor: Vendor
    cell: Cell
    gun: Tool = PLAIN_GUN
    part_frame: WorkObject = WORLD

    def __post_init__(self) -> None:
        if not self.gun.robot_held or self.part_frame.robot_held:
            raise InputError("the robot holds the gun, and the part stands: not the other way")
        if self.part_frame.moved_by is not None:
            raise InputError(
                f"the part stands on {self.part_frame.moved_by!r}, which may move; name a frame "
                "that stands still"
            )

    @property
    def place(self) -> Pose:
        """The part's frame in the world."""
        return self.part_frame.pose

    @property
    def target_frame(self) -> WorkObject:
        """What targets are given in: the part's frame, where the language has frames."""
        speaks = self.vendor.speaks
        return self.part_frame if speaks is None or speaks.work_objects else WORLD

    @property
    def to_targets(self) -> Pose:
        """The part's frame in that of the targets."""
        return self.place if self.target_frame is WORLD else IDENTITY

    def speed(self, tcp: float) -> Speed:
        """Of a line, as the language needs it.

        Args:
            tcp: m/s.
        """
        speaks = self.vendor.speaks
        needs = frozenset() if speaks is None else speaks.line.needs
        return Speed(tcp=tcp, tcp_acceleration=GENTLE if "tcp_acceleration" in needs else None)

    def zone(self, radius: float) -> Radius:
        """The vendor's predefined zone of that size (m), else one as ABB would grade it."""
        speaks = self.vendor.speaks
        known = () if speaks is None else speaks.zones()
        for zone in known:
            if abs(zone.tcp - radius) < 1e-9:
                return zone
        if speaks is not None and not speaks.zone_parts:
            return Radius(radius).with_one_distance()
        return Radius(radius, _WIDER * radius, _WIDER * radius)

    def with_part(self, part: Part, names: Iterable[str]) -> Station:
        """The station whose cell knows the gun, and the part as an obstacle.

        Args:
            part: what is painted.
            names: of the gun in the program; languages without named tools have one of their own.
        """
        # The part has copies of vertices along sharp edges, where a closed solid would seem open.
        vertices, which = np.unique(part.vertices, axis=0, return_inverse=True)
        shape = Mesh(Path(part.name), "m", Triangles(vertices, which.reshape(-1)[part.faces]))
        obstacle = Obstacle(_PART.format(part.name), Geometry(shape, self.place))
        cell = replace(
            self.cell,
            obstacles=(*self.cell.obstacles, obstacle),
            tools={**self.cell.tools, **{name: replace(self.gun, name=name) for name in names}},
        )
        return replace(self, cell=cell)
