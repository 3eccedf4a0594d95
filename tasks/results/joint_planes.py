"""What `flyby.cspace` returns."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.collision.joint_plane import JointPlane
from ...core.motion.emulator.run import Run
from ...core.robot.model import Robot

STILL = 0.01
"""rad or m by which another joint may move before the plane is only one of many."""


def _tenths(value: float) -> float:
    """rad rounded to tenths of a degree; of m these are less than two mm."""
    return math.radians(round(math.degrees(value), 1))


@dataclass(frozen=True, eq=False)
class ProgramPlane:
    """A plane of two joints with the path of a program in it.

    Args:
        plane: what was measured.
        robot: whose joints they are.
        run: of the program.
    """

    plane: JointPlane
    robot: Robot
    run: Run

    @property
    def names(self) -> tuple[str, str]:
        """Of the two joints."""
        first, second = self.plane.axes
        return self.robot.axis_names[first], self.robot.axis_names[second]

    @property
    def held(self) -> str:
        """Where the other joints stand, in words."""
        joints = [*self.robot.joints, *(axis.joint for axis in self.robot.external_axes)]
        told = (
            f"{name} {joint.shown(_tenths(value))}"
            for j, (name, joint, value) in enumerate(
                zip(self.robot.axis_names, joints, self.plane.held, strict=True)
            )
            if j not in self.plane.axes
        )
        return ", ".join(told)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the user should know."""
        others = [j for j in range(self.robot.size) if j not in self.plane.axes]
        off = np.abs(self.run.path.q[:, others] - self.plane.held[others]).max(axis=0, initial=0.0)
        if not len(off) or off.max() <= STILL:
            return ()
        far = others[int(off.argmax())]
        joints = [*self.robot.joints, *(axis.joint for axis in self.robot.external_axes)]
        most = joints[far].shown(_tenths(off.max()))
        return (
            "along the path the other joints leave where they are held, "
            f"{self.robot.axis_names[far]} by up to {most}: there the plane is another one",
        )

    def __repr__(self) -> str:
        first, second = self.names
        return f"<Plane of {first} and {second} of {self.robot.name}: {self.plane.free:.0%} free>"

    def picture(self, kind: str = "svg") -> bytes:
        """The plane drawn, as a file: ``png``, ``pdf`` or ``svg``."""
        from ...drawing.joint_plane import draw_joint_plane

        ends = self.run.path.route.ends.q
        waypoints = np.concatenate([ends[:1, 0], ends[:, 1]])
        paths = [self.run.trajectory.q]
        title = f"{self.run.program.name} on {self.robot.name}; {self.held}"
        numbers = [index + 1 for index in self.run.path.route.moves]
        return draw_joint_plane(self.plane, self.robot, paths, waypoints, numbers, title, kind)
