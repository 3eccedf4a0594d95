"""How near points come to a robot on its way: a cloud of points along the axes of its capsules."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby

import numpy as np
from scipy.spatial import KDTree

from ...core.arrays import FloatArray
from ...core.cell.geometry import Geometry
from ...core.errors import InputError
from ...core.robot.assembly import assemble
from ...core.robot.kinematics.chain_kernels import poses
from ...core.robot.model import Robot
from ...core.robot.shape import Capsule, Cylinder, Sphere

SPACING = 0.02
"""m between points along an axis."""
GRID = 0.005
"""m, edge of the cubes of which each gives at most one point to the cloud."""


class SweptArm:
    """All places that a robot and its tool take up on the way, as capsules of sampled places.

    Cylinders count as the capsules round them.

    Args:
        robot: without external axes.
        tool: its shape in the flange's frame.
        q: configurations (M, N) along the way.

    Raises:
        InputError: a shape is neither sphere, capsule nor cylinder.
    """

    def __init__(self, robot: Robot, tool: Geometry, q: FloatArray) -> None:
        axes = sorted(_axes(robot, tool, np.ascontiguousarray(q)), key=lambda axis: axis[0])
        self._trees = [
            (radius, KDTree(_thinned(np.concatenate([points for _, points in same]))))
            for radius, same in groupby(axes, key=lambda axis: axis[0])
        ]

    def gap(self, points: FloatArray) -> float:
        """The least distance of points (P, 3) m to the robot anywhere on its way, m."""
        nearest = np.inf
        middle = points.mean(axis=0)
        reach = float(np.linalg.norm(points - middle, axis=1).max())
        for radius, tree in self._trees:
            # What is farther than the nearest so far need not be found.
            bound = nearest + radius
            if tree.query(middle)[0] - reach < bound:
                found, _ = tree.query(points, distance_upper_bound=bound)
                nearest = min(nearest, float(np.min(found)) - radius)
        return nearest


def _axes(robot: Robot, tool: Geometry, q: FloatArray) -> Iterable[tuple[float, FloatArray]]:
    """The radius and the points (P, 3) of each shape's axis over all configurations."""
    stages = robot.flange_stages()
    base = robot.base_stages()
    shapes = [([*base, *robot.link_stages(s.link)], s.shape, s.placement) for s in robot.shapes]
    for carried, shape, placement in [*shapes, (stages, tool.shape, tool.placement)]:
        if not isinstance(shape, Sphere | Capsule | Cylinder):
            raise InputError(f"a swept arm is made of spheres, capsules and cylinders, not {shape}")
        length = 0.0 if isinstance(shape, Sphere) else shape.length
        steps = int(np.ceil(length / SPACING)) + 1
        line = np.zeros((steps, 3))
        line[:, 2] = np.linspace(-0.5, 0.5, steps) * length if steps > 1 else 0.0
        R, p = poses(assemble([*carried, placement]), q)
        yield shape.radius, (np.einsum("mij,sj->msi", R, line) + p[:, None]).reshape(-1, 3)


def _thinned(points: FloatArray) -> FloatArray:
    """One of the points (P, 3) in each cube: the arm stands in the same places again and again."""
    x, y, z = np.round(points / GRID).astype(np.int64).T & 0xFFFFF
    _, first = np.unique((x << 40) | (y << 20) | z, return_index=True)
    return np.asarray(points[first])
