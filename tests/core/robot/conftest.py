"""Arms for the tests: lengths as published, inertias and limits made up."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.core.robot.inertia import Inertia
from flyby.core.robot.joint import Joint
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import IDENTITY, Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


@pytest.fixture(scope="session")
def robot_file() -> Callable[[str, str], Path]:
    """Path of a vendor's catalogue file."""
    root = Path(flyby.__file__).parent

    def path(vendor: str, model: str) -> Path:
        return root / "vendors" / vendor / "data" / "robots" / f"{model}.toml"

    return path


def turned(axis, degrees, position=(0.0, 0.0, 0.0)) -> Pose:
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(np.radians(degrees) * np.array(axis))
    matrix[:3, 3] = position
    return Pose.from_matrix(matrix)


def negative(axis):
    return tuple(-x for x in axis)


def arm(name, places, axes, flange, reach=2 * math.pi, links=True) -> Robot:
    joints = tuple(
        Joint(f"J{k}", place if isinstance(place, Pose) else Pose(place), axis, -reach, reach, 2, 8)
        for k, (place, axis) in enumerate(zip(places, axes, strict=True), 1)
    )
    rng = np.random.default_rng(len(name))
    bodies = []
    for k in range(len(joints)):
        root = rng.normal(size=(3, 3))
        tensor = (root @ root.T).tolist()
        centre = tuple(rng.normal(size=3).tolist())
        bodies.append(Inertia(30.0 / (k + 1), centre, tuple(map(tuple, tensor))))
    return Robot(name, joints, flange=flange, links=tuple(bodies) if links else ())


def abb(name, c1, a1, c2, a2, c3, c4, lateral=0.0) -> Robot:
    places = [(0, 0, 0), (a1, lateral, c1), (0, 0, c2), (0, 0, a2), (c3, 0, 0), (0, 0, 0)]
    return arm(name, places, [Z, Y, Y, X, Y, X], turned(Y, 90, (c4, 0, 0)))


def kuka(name, c1, a1, c2, a2, c3, c4) -> Robot:
    places = [(0, 0, 0), (a1, 0, c1), (c2, 0, 0), (0, 0, a2), (c3, 0, 0), (0, 0, 0)]
    axes = [negative(Z), Y, Y, negative(X), Y, negative(X)]
    return arm(name, places, axes, turned(Y, 90, (c4, 0, 0)))


def ur(name, d1, a2, a3, d4, d5, d6) -> Robot:
    alpha = [90, 0, 0, 90, -90, 0]
    steps = [(0, 0, d1), (a2, 0, 0), (a3, 0, 0), (0, 0, d4), (0, 0, d5), (0, 0, d6)]
    frames = [turned(X, angle, step) for angle, step in zip(alpha, steps, strict=True)]
    return arm(name, [IDENTITY, *frames[:-1]], [Z] * 6, frames[-1])


def iiwa() -> Robot:
    places = [(0, 0, 0.15), (0, 0, 0.19), (0, 0, 0.21), (0, 0, 0.19), (0, 0, 0.21), (0, 0, 0.19)]
    axes = [Z, Y, Z, negative(Y), Z, Y, Z]
    return arm(
        "iiwa 7", [*places, (0, 0, 0.081)], axes, Pose((0, 0, 0.045)), reach=math.radians(170)
    )


class Arms(dict[str, Robot]):
    """Arms by name, short in the reports of failing tests."""

    def __repr__(self) -> str:
        return "arms"


@pytest.fixture(scope="session")
def arms() -> Arms:
    """Arms by name; the angles may turn once around either way, the iiwa's ±170°."""
    robots = [
        abb("IRB 6640", 0.78, 0.32, 1.075, 0.2, 1.1425, 0.2),
        abb("IRB 1600", 0.4865, 0.15, 0.7, 0.0, 0.6, 0.065),
        abb("lateral offset", 0.4, 0.1, 0.5, 0.05, 0.4, 0.1, lateral=0.08),
        kuka("KR 30-3", 0.815, 0.35, 0.85, 0.145, 0.82, 0.17),
        kuka("KR 16", 0.675, 0.26, 0.68, -0.035, 0.67, 0.158),
        ur("UR5e", 0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996),
        ur("UR10e", 0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655),
        iiwa(),
    ]
    return Arms({robot.name: robot for robot in robots})
