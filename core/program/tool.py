"""Loads, tools and work objects."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..robot.inertia import Inertia
from ..spatial.pose import IDENTITY, Pose, Quaternion, Vector3
from ..spatial.rotation import quaternion_from_matrix


@dataclass(frozen=True, slots=True)
class Load:
    """A rigid body carried by the flange.

    Args:
        mass: kg.
        centre: centre of mass in the frame the load is declared in (the tool's for a payload,
            the flange's for a tool), m.
        inertia: principal moments about the centre of mass, kg m².
        axes: orientation of the principal axes, quaternion w, x, y, z.
        name: name of the datum in the source.
    """

    mass: float
    centre: Vector3 = (0.0, 0.0, 0.0)
    inertia: Vector3 = (0.0, 0.0, 0.0)
    axes: Quaternion = (1.0, 0.0, 0.0, 0.0)
    name: str | None = None

    def __post_init__(self) -> None:
        numbers = (self.mass, *self.centre, *self.inertia, *self.axes)
        if not all(map(math.isfinite, numbers)) or self.mass < 0 or min(self.inertia) < 0:
            raise InputError(
                "a load needs finite numbers, mass and inertia not negative: mass "
                f"{self.mass:g} kg, inertia {', '.join(f'{part:g}' for part in self.inertia)} kgm²"
            )

    @classmethod
    def of_body(cls, body: Inertia, name: str | None = None) -> Load:
        """A body by its principal moments."""
        moments, axes = np.linalg.eigh(np.array(body.tensor))
        axes[:, 2] *= np.sign(np.linalg.det(axes))
        a, b, c = (max(0.0, float(moment)) for moment in moments)
        w, x, y, z = (float(part) for part in quaternion_from_matrix(axes))
        return cls(body.mass, body.centre, (a, b, c), (w, x, y, z), name)


@dataclass(frozen=True, slots=True)
class Tool:
    """A tool and its centre point.

    Args:
        name: as in the source; ``tool0`` is the bare flange.
        tcp: tool centre point in the flange's frame; in the world's frame if the tool stands
            still (``robot_held`` false: stationary TCP).
        load: mass of the tool, in the flange's frame.
        robot_held: False for a stationary tool; the robot then carries the work object.
    """

    name: str = "tool0"
    tcp: Pose = IDENTITY
    load: Load | None = None
    robot_held: bool = True


@dataclass(frozen=True, slots=True)
class WorkObject:
    """The frame that targets are given in (ABB wobjdata, KUKA base).

    Args:
        name: as in the source; ``wobj0`` is the world.
        user: user frame: in the world, in the flange's frame if ``robot_held``, or in the frame
            of the mechanical unit that moves it.
        frame: object frame in the user frame.
        robot_held: the robot carries the work object (stationary TCP).
        moved_by: name of the external axis whose table carries the user frame; None if it stands
            still.
        not_followed: name of a unit that moves it and is none of this robot's (a conveyor, another
            robot); it is taken to stand where it is declared.
    """

    name: str = "wobj0"
    user: Pose = IDENTITY
    frame: Pose = IDENTITY
    robot_held: bool = False
    moved_by: str | None = None
    not_followed: str | None = None

    @property
    def pose(self) -> Pose:
        """The object frame in the frame that carries it."""
        return self.user @ self.frame


FLANGE = Tool()
WORLD = WorkObject()
