"""Collision queries beside Pinocchio and trimesh: time a configuration.

    python benchmarks/collision.py [--json] [--case boxes] [--samples 200]

A UR10e with a capsule for a tool, at random configurations that do not collide: among six boxes
(``boxes``), beside one bumpy mesh of 10k triangles (``mesh``) and among 24 of them
(``clutter``). All figures are µs of process CPU time a configuration.

- ``collides``: whether anything touches; the peer is trimesh's CollisionManager (python-fcl with
  a broad phase), which looks at robot against obstacles only.
- ``clearance``: the least distance over all pairs, asked within 5 cm; the peer is the same
  manager's least distance, which has no range.
- ``distances``: all distances within 5 cm with their witness points; the peer is Pinocchio's
  computeDistances (coal) over the same pairs and shapes, which has no range.
- ``all_distances``: the same without a range.
- ``gradients``: of all distances found within 5 cm, or of one where there is none.

The peers come with flyby.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import coal
import numpy as np
import pinocchio as pin
import trimesh
from report import Figure, cpu_seconds, main
from trimesh.collision import CollisionManager

from flyby.core.arrays import FloatArray
from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry, Mesh
from flyby.core.collision.distance.solid import Polytope, Solid, TriangleMesh
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.program.tool import Tool
from flyby.core.registry import installed
from flyby.core.robot.shape import Box, Capsule, Cylinder, Sphere
from flyby.core.spatial.pose import Pose

PIN_NAME = f"pinocchio {version('pin')}"
TRIMESH_NAME = f"trimesh {version('trimesh')}"
CASES = ("boxes", "mesh", "clutter")
WITHIN = 0.05
FEW = 16
"""Configurations that the peers are timed at."""
TOOL = Tool("tool")


def bumpy(seed: int, folder: Path) -> Mesh:
    """A closed mesh of 11 520 triangles with dents, 0.6 m across."""
    rng = np.random.default_rng(seed)
    ball = trimesh.creation.uv_sphere(radius=0.3, count=[60, 97])
    waves = 20.0 * rng.normal(size=(6, 3))
    swell = 1.0 + 0.03 * np.sin(ball.vertices @ waves.T).sum(axis=1)
    file = folder / f"bumpy{seed}.stl"
    trimesh.Trimesh(ball.vertices * swell[:, None], ball.faces, process=False).export(file)
    return Mesh(file, "m")


def obstacles(case: str, folder: Path) -> Iterator[Obstacle]:
    """The case's obstacles round the robot, always the same."""
    rng = np.random.default_rng(3)
    for number in range({"boxes": 6, "mesh": 1, "clutter": 24}[case]):
        angle, radius = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.8, 1.4)
        place = Pose((radius * np.cos(angle), radius * np.sin(angle), rng.uniform(-0.3, 1.2)))
        x, y, z = rng.uniform(0.1, 0.5, 3)
        shape = Box((x, y, z)) if case == "boxes" else bumpy(number, folder)
        yield Obstacle(f"obstacle {number}", Geometry(shape, place))


def scene_of(case: str, folder: Path) -> CollisionScene:
    """The case's scene."""
    cell = Cell(
        installed().find_robot("ur/ur10e"),
        "ur",
        tools={TOOL.name: TOOL},
        tool_geometries={TOOL.name: Geometry(Capsule(0.03, 0.2), Pose((0.0, 0.0, 0.13)))},
        obstacles=tuple(obstacles(case, folder)),
    )
    return CollisionScene(cell, TOOL)


def free_configurations(scene: CollisionScene, count: int) -> FloatArray:
    """Random configurations that do not collide."""
    limits = scene.robot.limits
    drawn = np.random.default_rng(1).uniform(limits.lower, limits.upper, (8 * count, 6))
    return np.ascontiguousarray(drawn[~scene.collides(drawn)][:count])


class PinocchioPeer:
    """The same bodies and pairs as a geometry model of Pinocchio."""

    def __init__(self, scene: CollisionScene) -> None:
        self.model, self.geometry = pin.Model(), pin.GeometryModel()
        ids, base = [0], scene.robot.base.matrix()
        for joint in scene.robot.joints:
            axis = pin.JointModelRevoluteUnaligned(np.array(joint.axis))
            placement = pin.SE3(base @ joint.placement.matrix())
            ids.append(self.model.addJoint(ids[-1], axis, placement, joint.name))
            base = np.eye(4)
        for body in scene.bodies:
            shape, placement = _coal_shape(body.solid), pin.SE3(body.placement.matrix())
            parent = ids[body.frame]
            one = pin.GeometryObject(body.name, parent, 0, placement, shape)
            self.geometry.addGeometryObject(one)
        for a, b in scene.pairs:
            self.geometry.addCollisionPair(pin.CollisionPair(int(a), int(b)))
        self.data, self.state = self.model.createData(), self.geometry.createData()

    def distances(self, q: FloatArray) -> FloatArray:
        """All distances (M, P)."""
        found = np.empty((len(q), len(self.geometry.collisionPairs)))
        for m, row in enumerate(q):
            pin.computeDistances(self.model, self.data, self.geometry, self.state, row)
            found[m] = [result.min_distance for result in self.state.distanceResults]
        return found


def _coal_shape(solid: Solid) -> Any:
    match solid:
        case Sphere(radius):
            return coal.Sphere(radius)
        case Capsule(radius, length):
            return coal.Capsule(radius, length)
        case Cylinder(radius, length):
            return coal.Cylinder(radius, length)
        case Box(size):
            return coal.Box(*size)
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(solid.faces), len(solid.vertices))
    model.addVertices(np.ascontiguousarray(solid.vertices))
    model.addTriangles(np.ascontiguousarray(solid.faces))
    model.endModel()
    return model


class TrimeshPeer:
    """Robot and obstacles as two managers of trimesh."""

    def __init__(self, scene: CollisionScene) -> None:
        self.scene = scene
        self.robot, self.world = CollisionManager(), CollisionManager()
        self.moving = [k for k, body in enumerate(scene.bodies) if body.frame > 0]
        for k, body in enumerate(scene.bodies):
            manager = self.robot if k in self.moving else self.world
            if body.name != "base":
                manager.add_object(str(k), _trimesh_shape(body.solid), body.placement.matrix())

    def _move(self, R: FloatArray, p: FloatArray) -> None:
        matrix = np.eye(4)
        for k in self.moving:
            matrix[:3, :3], matrix[:3, 3] = R[k], p[k]
            self.robot.set_transform(str(k), matrix)

    def collides(self, R: FloatArray, p: FloatArray) -> list[bool]:
        """Whether the robot touches an obstacle, at places (M, B, …) of the bodies."""
        found = []
        for m in range(len(R)):
            self._move(R[m], p[m])
            found.append(self.robot.in_collision_other(self.world))
        return found

    def clearance(self, R: FloatArray, p: FloatArray) -> list[float]:
        """The least distance between robot and obstacles."""
        found = []
        for m in range(len(R)):
            self._move(R[m], p[m])
            found.append(self.robot.min_distance_other(self.world))
        return found


def _trimesh_shape(solid: Solid) -> trimesh.Trimesh:
    match solid:
        case Sphere(radius):
            return trimesh.creation.icosphere(subdivisions=3, radius=radius)
        case Capsule(radius, length):
            shape = trimesh.creation.capsule(length, radius)
            shape.apply_translation([0.0, 0.0, -0.5 * length])
            return shape
        case Cylinder(radius, length):
            return trimesh.creation.cylinder(radius, length)
        case Box(size):
            return trimesh.creation.box(size)
        case Polytope(vertices, faces) | TriangleMesh(vertices, faces):
            return trimesh.Trimesh(vertices, faces, process=False)


def measure(case: str, samples: int) -> Iterator[Figure]:
    """The figures of a case."""
    with tempfile.TemporaryDirectory() as folder:
        scene = scene_of(case, Path(folder))
    q = free_configurations(scene, samples)
    R, p = scene._place(q)
    trimesh_peer, pin_peer = TrimeshPeer(scene), PinocchioPeer(scene)
    check(scene, pin_peer, q)
    found = scene.distances(q, WITHIN)
    near = np.nonzero(found.distance < WITHIN)
    near = near if len(near[0]) else (np.array([0]), np.array([0]))
    seconds = cpu_seconds(
        {
            "collides": lambda: scene.collides(q),
            "clearance": lambda: scene.clearance(q, WITHIN),
            "distances": lambda: scene._measure(q, WITHIN),
            "all_distances": lambda: scene._measure(q[:FEW], np.inf),
            "gradients": lambda: scene.gradients(q, found, near),
        }
    )
    few = slice(FEW)
    slow = cpu_seconds(
        {
            "trimesh collides": lambda: trimesh_peer.collides(R[few], p[few]),
            "trimesh clearance": lambda: trimesh_peer.clearance(R[few], p[few]),
            "pin": lambda: pin_peer.distances(q[few]),
        },
        budget=0.2,
    )
    micro = {name: 1e6 * value / len(q) for name, value in seconds.items()}
    micro["all_distances"] *= len(q) / len(q[few])
    micro |= {name: 1e6 * value / len(q[few]) for name, value in slow.items()}
    yield Figure(case, "collides", micro["collides"], "us", TRIMESH_NAME, micro["trimesh collides"])
    yield Figure(
        case, "clearance", micro["clearance"], "us", TRIMESH_NAME, micro["trimesh clearance"]
    )
    yield Figure(case, "distances", micro["distances"], "us", PIN_NAME, micro["pin"])
    yield Figure(case, "all_distances", micro["all_distances"], "us", PIN_NAME, micro["pin"])
    yield Figure(case, "gradients", micro["gradients"], "us")


def check(scene: CollisionScene, peer: PinocchioPeer, q: FloatArray) -> None:
    """Both have the same distances, or the figures mean nothing."""
    ours, theirs = scene.distances(q[:FEW]).distance, peer.distances(q[:FEW])
    np.testing.assert_allclose(ours, theirs, atol=1e-5)


if __name__ == "__main__":
    main(__doc__ or "", measure, CASES, samples=200)
