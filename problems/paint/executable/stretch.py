"""What stretch of a trajectory a robot cannot reach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import FloatArray
from ....core.errors import MotionError
from ....core.robot.inverse.solution import UnreachableError
from ....core.robot.model import Robot
from ..spray.trajectory import PaintTrajectory
from .station import Station


@dataclass(frozen=True, slots=True)
class Stretch:
    """Waypoints from ``first`` to ``last``, both included; none where last < first."""

    first: int
    last: int

    @classmethod
    def first_of(cls, waypoints: NDArray[np.int64]) -> Stretch:
        """The first row of neighbours among waypoints (M,) in rising order."""
        breaks = np.flatnonzero(np.diff(waypoints) > 1)
        end = int(breaks[0]) if len(breaks) else len(waypoints) - 1
        return cls(int(waypoints[0]), int(waypoints[end]))


def unreachable(
    world: PaintTrajectory,
    trajectory: PaintTrajectory,
    stretch: Stretch | None,
    robot: Robot,
    frames: FloatArray,
    station: Station,
) -> MotionError:
    """The error that says which stretch of a trajectory cannot be reached, and why.

    Args:
        world: the trajectory in the world.
        trajectory: in the part's frame, as the user knows it.
        stretch: what is missed; None where a whole turn of a joint is in the way.
        robot: the robot.
        frames: (W, 3, 3) of the gun.
        station: robot, gun and place.
    """
    if stretch is None:
        return MotionError(
            f"{robot.name} reaches every waypoint of the curve, but not one after the other: a "
            "joint would have to turn all the way round on the way; move the part or the base, or "
            "paint it in several coats"
        )
    if stretch.last < stretch.first:
        stretch = Stretch(0, len(world.position) - 1)
    where = describe(trajectory, stretch)
    return MotionError(
        f"{robot.name} cannot reach {where}{_reason(world, stretch, frames, station)}; move the "
        "part or the base, take another gun, or leave that stretch out"
    )


def describe(trajectory: PaintTrajectory, stretch: Stretch) -> str:
    """A stretch in words: waypoints, lengths along the curve and places."""
    along = np.concatenate(([0.0], np.cumsum(trajectory.lengths)))
    first, last = (_place(trajectory.position[k]) for k in (stretch.first, stretch.last))
    count = len(trajectory.position)
    if stretch.first == stretch.last:
        return (
            f"waypoint {stretch.first + 1} of {count}, {along[stretch.first]:.2f} m along the "
            f"curve, at {first} mm of the part"
        )
    return (
        f"the stretch from waypoint {stretch.first + 1} to {stretch.last + 1} of {count}, "
        f"{along[stretch.first]:.2f} to {along[stretch.last]:.2f} m along the curve, from {first} "
        f"to {last} mm of the part"
    )


def _place(point: FloatArray) -> str:
    return "(" + ", ".join(f"{1e3 * value:.0f}" for value in point) + ")"


def _reason(world: PaintTrajectory, stretch: Stretch, frames: FloatArray, station: Station) -> str:
    """By how much the worst waypoint is missed, if it lies out of reach."""
    back = np.linalg.inv(station.gun.tcp.matrix())
    worst = 0.0
    for w in range(stretch.first, stretch.last + 1):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = frames[w], world.position[w]
        try:
            station.cell.robot.inverse(pose @ back)
        except UnreachableError as error:
            worst = max(worst, error.distance)
    if worst == 0.0:
        return " with one and the same configuration: joint limits are in the way"
    return f": the wrist is up to {1e3 * worst:.0f} mm out of reach"
