"""What is to be transcribed: a motion of some joints through via points among boxes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np

from ...core.arrays import FloatArray
from ...core.cell.cell import Cell, Obstacle
from ...core.errors import InputError
from ...core.motion.model.blend import Blend
from ...core.program.tool import FLANGE, Tool
from ...core.robot.shape import Box, Capsule, Sphere
from ...core.spatial.pose import Pose
from .capsule_box import CapsuleAndBox, Clearances
from .kinematics import MovingPoint


class Overlap(StrEnum):
    """How far the zones of neighbouring via points may reach."""

    HALF = "half"
    """No radius exceeds half the TCP's distance to a neighbour, r ≤ d/2."""
    TOUCH = "touch"
    """Neighbouring spheres do not overlap, r + r' ≤ d."""


@dataclass(frozen=True, eq=False)
class TranscriptionTask:
    """A motion from rest to rest.

    Args:
        cell: the robot with its limits, capsules as link shapes, boxes as obstacles, and the
            clearance between them.
        waypoints: (M + 1, N) rad: start, via points, end; joints that do not move stand alike in
            all of them.
        blend: law of the blends; without β.
        tool: held by the robot; its shape is the cell's ``tool_geometries``.
        overlap: see `Overlap`.

    Raises:
        InputError: fewer than three waypoints, nothing moves, a blend, shape or tool that the
            transcription does not know.
    """

    cell: Cell
    waypoints: FloatArray
    blend: Blend
    tool: Tool = FLANGE
    overlap: Overlap = Overlap.HALF

    def __post_init__(self) -> None:
        robot = self.cell.robot
        shape = np.shape(self.waypoints)
        if len(shape) != 2 or shape[0] < 3 or shape[1] != robot.size:
            raise InputError(
                f"waypoints of {robot.name} are start, one via point or more, and end, each of "
                f"{robot.size} values; an array of shape {shape} does not fit"
            )
        if not self.free:
            raise InputError("all waypoints are the same: there is nothing to optimise")
        if self.blend.kind != "polynomial" or any(self.blend.beta):
            raise InputError("the transcription knows polynomial blends without β only")
        if not self.tool.robot_held:
            raise InputError(
                f"the transcription needs a tool that the robot holds; {self.tool.name!r} stands "
                "still"
            )
        obstacles = {obstacle.name for obstacle in self.cell.obstacles}
        for pair in self.cell.allowed:
            if obstacles & set(pair):
                raise InputError(
                    f"the transcription lets nothing touch an obstacle, but the cell allows {pair}"
                )

    @cached_property
    def free(self) -> tuple[int, ...]:
        """Indices of the joints that move."""
        return tuple(int(j) for j in np.flatnonzero(np.ptp(self.waypoints, axis=0) > 0.0))

    @property
    def points(self) -> FloatArray:
        """Waypoints of the joints that move (M + 1, n)."""
        return np.asarray(self.waypoints[:, self.free])

    @cached_property
    def tcp(self) -> MovingPoint:
        """The tool centre point in the world."""
        return self._point(self.cell.robot.arm_size + 1, np.array(self.tool.tcp.position), None)

    @cached_property
    def clearances(self) -> Clearances:
        """All pairs of a capsule that moves and a box."""
        pairs = [
            self._pair(name, link, shape, placement, obstacle)
            for name, link, shape, placement in self._capsules()
            for obstacle in self.cell.obstacles
        ]
        return Clearances(tuple(pairs))

    def _capsules(self) -> Iterator[tuple[str, int, Capsule | Sphere, Pose]]:
        """Name, link, shape and placement of every body that moves."""
        robot = self.cell.robot
        bodies = [(f"link {s.link}", s.link, s.shape, s.placement) for s in robot.shapes]
        mounted = self.cell.tool_geometries.get(self.tool.name)
        if mounted is not None:
            bodies.append(
                (self.tool.name, robot.arm_size + 1, mounted.shape, mounted.placement)  # type: ignore[arg-type]
            )
        for name, link, shape, placement in bodies:
            if link <= self.free[0]:
                continue
            if not isinstance(shape, Capsule | Sphere):
                raise InputError(
                    f"{name} is a {type(shape).__name__.lower()}; the transcription measures "
                    "capsules and spheres only"
                )
            yield name, link, shape, placement

    def _pair(
        self, name: str, link: int, shape: Capsule | Sphere, placement: Pose, obstacle: Obstacle
    ) -> CapsuleAndBox:
        box = obstacle.geometry.shape
        if not isinstance(box, Box) or obstacle.carried_by is not None:
            raise InputError(
                f"{obstacle.name}: the transcription measures distances from boxes that stand still"
            )
        half_length = 0.5 * shape.length if isinstance(shape, Capsule) else 0.0
        ends = [(placement @ Pose((0.0, 0.0, sign * half_length))).position for sign in (-1.0, 1.0)]
        a, b = (self._point(link, np.array(end), obstacle.geometry.placement) for end in ends)
        return CapsuleAndBox(
            f"{name} and {obstacle.name}", a, b, shape.radius, 0.5 * np.array(box.size)
        )

    def _point(self, link: int, point: FloatArray, frame: Pose | None) -> MovingPoint:
        return MovingPoint(
            self.cell.robot, link, point, self.free, np.array(self.waypoints[0]), frame
        )

    def limits(self) -> tuple[FloatArray, FloatArray]:
        """Largest speeds and accelerations (n,) of the joints that move."""
        limits, free = self.cell.robot.limits, list(self.free)
        return limits.velocity[free], limits.acceleration[free]

    def ranges(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper end (n,) of the joints that move."""
        limits, free = self.cell.robot.limits, list(self.free)
        return limits.lower[free], limits.upper[free]
