"""Solids at drawn places, arms among obstacles, and meshes in files."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.cell.cell import Cell
from flyby.core.cell.geometry import Mesh
from flyby.core.collision.distance.engine import BodyPoses
from flyby.core.collision.distance.solid import Polytope, Solid, TriangleMesh
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Follower, Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.robot.shape import Box, Capsule, Cylinder, LinkShape, Sphere
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

lengths = st.floats(0.02, 0.6)
spheres = st.builds(Sphere, lengths)
capsules = st.builds(Capsule, lengths, lengths)
cylinders = st.builds(Cylinder, lengths, lengths)
boxes = st.builds(Box, st.tuples(lengths, lengths, lengths))
coordinates = st.floats(-1.0, 1.0)
turns = st.tuples(coordinates, coordinates, coordinates).map(lambda v: np.pi * np.array(v))
positions = st.tuples(coordinates, coordinates, coordinates).map(np.array)


@st.composite
def places(draw: st.DrawFn, count: int = 2) -> BodyPoses:
    """World poses of ``count`` bodies."""
    rotation = [matrix_from_rotation_vector(draw(turns)) for _ in range(count)]
    return BodyPoses(np.array(rotation), np.array([draw(positions) for _ in range(count)]))


@st.composite
def polytopes(draw: st.DrawFn) -> Polytope:
    from flyby.core.collision.distance.convex import hull

    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    return hull(rng.uniform(-0.4, 0.4, (draw(st.integers(6, 24)), 3)))


def surface(mesh: trimesh.Trimesh, closed: bool = True) -> TriangleMesh:
    return TriangleMesh(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64), closed)


def shell(size: float, wall: float) -> trimesh.Trimesh:
    """A closed mesh of a hollow cube: its inside is the wall."""
    outer, inner = trimesh.creation.box((size,) * 3), trimesh.creation.box((size - 2 * wall,) * 3)
    inner.invert()
    return trimesh.util.concatenate([outer, inner])


def u_profile() -> trimesh.Trimesh:
    """A closed mesh that is not convex: two uprights on a floor."""
    corners = [
        (0, 0),
        (0.6, 0),
        (0.6, 0.6),
        (0.4, 0.6),
        (0.4, 0.2),
        (0.2, 0.2),
        (0.2, 0.6),
        (0, 0.6),
    ]
    points = np.array(corners) - 0.3
    front = np.column_stack([points, np.full(8, -0.1)])
    caps = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 5), (0, 5, 7), (5, 6, 7)]
    sides = [(k, (k + 1) % 8) for k in range(8)]
    faces = [(c, b, a) for a, b, c in caps] + [(a + 8, b + 8, c + 8) for a, b, c in caps]
    faces += [(a, b, b + 8) for a, b in sides] + [(a, b + 8, a + 8) for a, b in sides]
    return trimesh.Trimesh(
        np.concatenate([front, front + np.array([0, 0, 0.2])]), faces, process=False
    )


def u_parts() -> list[np.ndarray]:
    """Corners of the three boxes that `u_profile` is made of."""
    spans = [((-0.3, 0.3), (-0.3, -0.1)), ((-0.3, -0.1), (-0.1, 0.3)), ((0.1, 0.3), (-0.1, 0.3))]
    return [np.array(np.meshgrid(*span, (-0.1, 0.1))).reshape(3, 8).T for span in spans]


@pytest.fixture
def mesh_file(tmp_path: Path) -> Callable[..., Mesh]:
    """Writes a mesh and gives it as a cell does."""

    def write(mesh: trimesh.Trimesh, units: str = "m", name: str = "part") -> Mesh:
        file = tmp_path / f"{name}.stl"
        mesh.export(file)
        return Mesh(file, units)

    return write


def joint(k: int, at: Sequence[float], axis: Sequence[float], reach: float = 2.5) -> Joint:
    x, y, z = at
    a, b, c = axis
    return Joint(f"J{k}", Pose((x, y, z)), (a, b, c), -reach, reach, 2.0, 8.0)


def with_rods(robot: Robot) -> Robot:
    """The arm with its last link held by rods: it turns back as the joints before it turn."""
    follower = Follower("J2", (0.0, -1.0, 0.0), Pose((0.1, 0.0, 0.0)))
    twist = Follower("J1", (0.6, 0.0, 0.8), Pose((0.0, 0.05, 0.1)))
    *others, last = robot.joints
    return replace(robot, joints=(*others, replace(last, followers=(follower, twist))))


def track() -> ExternalAxis:
    axis = Joint(
        "track",
        Pose((0.0, 0.0, 0.1)),
        (0.0, 1.0, 0.0),
        -2.0,
        2.0,
        1.0,
        2.0,
        kind=JointKind.PRISMATIC,
    )
    return ExternalAxis(axis, ExternalRole.TRACK)


def table(tilting: bool = True) -> list[ExternalAxis]:
    place = Pose((1.3, 0.0, 0.2))
    tilt = Joint("tilt", place, (1.0, 0.0, 0.0), -1.5, 1.5, 1.0, 2.0)
    turn = Joint("table", Pose((0.0, 0.0, 0.1)), (0.0, 0.0, 1.0), -6.0, 6.0, 1.0, 2.0)
    return [
        ExternalAxis(turn, ExternalRole.TABLE, carried_by="tilt"),
        ExternalAxis(tilt, ExternalRole.TABLE),
    ]


def arm(axes: Sequence[ExternalAxis] = (), base: Pose | None = None) -> Robot:
    """Three joints: a turn about z, a shoulder and an elbow; reach about 1.5 m."""
    joints = (
        joint(1, (0.0, 0.0, 0.3), (0.0, 0.0, 1.0)),
        joint(2, (0.1, 0.0, 0.2), (0.0, 1.0, 0.0)),
        joint(3, (0.0, 0.0, 0.7), (0.0, 1.0, 0.0)),
    )
    shapes = (
        LinkShape(0, Cylinder(0.15, 0.3), Pose((0.0, 0.0, 0.15))),
        LinkShape(1, Sphere(0.18), Pose((0.0, 0.0, 0.1))),
        LinkShape(2, Capsule(0.09, 0.7), Pose((0.0, 0.0, 0.35))),
        LinkShape(3, Capsule(0.07, 0.5), Pose((0.0, 0.0, 0.25))),
        LinkShape(3, Box((0.12, 0.1, 0.1)), Pose((0.0, 0.0, 0.55))),
    )
    robot = Robot(
        "acme/arm-3",
        joints,
        base=base or Pose(),
        flange=Pose((0.0, 0.0, 0.6)),
        shapes=shapes,
        external_axes=tuple(axes),
    )
    return robot


def configurations(robot: Robot, count: int, seed: int = 0) -> FloatArray:
    rng = np.random.default_rng(seed)
    return rng.uniform(robot.limits.lower, robot.limits.upper, (count, robot.size))


def touching_points(solid: Solid, count: int = 400) -> FloatArray:
    """Points (K, 3) of a convex solid's surface or inside, in its frame."""
    rng = np.random.default_rng(1)
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    match solid:
        case Sphere(radius):
            return radius * way
        case Capsule(radius, length):
            z = rng.uniform(-0.5, 0.5, (count, 1)) * length * [0.0, 0.0, 1.0]
            return np.asarray(z + radius * way)
        case Cylinder(radius, length):
            angle, z = rng.uniform(0, 2 * math.pi, count), rng.uniform(-0.5, 0.5, count) * length
            return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])
        case Box(size):
            return rng.uniform(-0.5, 0.5, (count, 3)) * size
    return solid.vertices


def cell_of(robot: Robot, **parts: object) -> Cell:
    return Cell(robot, "acme", **parts)  # type: ignore[arg-type]
