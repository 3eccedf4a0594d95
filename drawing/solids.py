"""Triangles of what stands in a cell, few enough to be drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import FloatArray
from ..core.cell.cell import Cell
from ..core.cell.floor import FLOOR
from ..core.cell.geometry import Geometry, Mesh
from ..core.robot.assembly import Stage, assemble
from ..core.robot.kinematics.chain_kernels import poses
from ..core.robot.model import Robot
from ..core.robot.shape import Box, Capsule, Cylinder, Shape, Sphere
from ..core.spatial.pose import Pose
from .thinning import clustered

MOST = 4000
"""Triangles of a mesh above which points near to each other are drawn as one."""
CELLS = 24
"""Into so many cubes the longest side of such a mesh is cut."""
PIECES = 8
"""Into so many pieces the longest edge of a box is cut."""
AROUND = 24
"""Corners of what is round."""


def obstacle_triangles(cell: Cell, q: FloatArray) -> dict[str, FloatArray]:
    """Corners (F, 3, 3) m in the world of each obstacle's triangles.

    Args:
        cell: the cell.
        q: (N,), for what external axes carry.
    """
    found = {}
    for obstacle in cell.obstacles:
        if obstacle.name == FLOOR:
            continue  # It would hide all else.
        stages: list[Stage] = [*cell.robot.frame_stages(obstacle.carried_by)]
        found[obstacle.name] = _placed(obstacle.geometry, stages, q[None])[0]
    return found


def robot_triangles(cell: Cell, tool: str, q: FloatArray) -> FloatArray:
    """Corners (F, 3, 3) m in the world of the robot's shapes and its tool's at q (N,)."""
    robot = cell.robot
    base, flange = robot.base_stages(), robot.flange_stages()
    parts = [
        _placed(Geometry(s.shape, s.placement), [*base, *robot.link_stages(s.link)], q[None])[0]
        for s in robot.shapes
    ]
    held = tool in cell.tool_geometries and cell.tools[tool].robot_held
    if held:
        parts.append(_placed(cell.tool_geometries[tool], flange, q[None])[0])
    return np.concatenate(parts) if parts else np.zeros((0, 3, 3))


def skeleton(robot: Robot, tip: Pose, q: FloatArray) -> FloatArray:
    """Base, joints' origins, flange and the tool's tip (M, n + 3, 3) m at q (M, N)."""
    base, flange = robot.base_stages(), robot.flange_stages()
    ends = [base, *([*base, *robot.arm_stages(index)] for index in robot.along)]
    ends += [flange, [*flange, tip]]
    q = np.ascontiguousarray(q)
    return np.stack([poses(assemble(stages), q)[1] for stages in ends], axis=1)


def _placed(geometry: Geometry, stages: list[Stage], q: FloatArray) -> FloatArray:
    """Triangles (M, F, 3, 3) of a shape in the frame behind stages, at q (M, N)."""
    R, p = poses(assemble([*stages, geometry.placement]), np.ascontiguousarray(q))
    turned = np.einsum("mij,fcj->mfci", R, triangles(geometry.shape))
    return np.asarray(turned + p[:, None, None])


def triangles(shape: Mesh | Shape) -> FloatArray:
    """Corners (F, 3, 3) m of a shape's triangles in its own frame."""
    if isinstance(shape, Mesh):
        return _thinned(shape.vertices, shape.faces)
    made = _primitive(shape)
    corners: FloatArray = np.asarray(made.vertices, dtype=float)[np.asarray(made.faces)]
    return corners


def _primitive(shape: Shape) -> Any:
    from trimesh import creation

    match shape:
        case Box(size):
            # In pieces, since triangles are painted in the order of their middles.
            return creation.box(extents=size).subdivide_to_size(max(size) / PIECES)
        case Sphere(radius):
            return creation.icosphere(subdivisions=2, radius=radius)
        case Cylinder(radius, length):
            return creation.cylinder(radius, length, sections=AROUND)
        case Capsule(radius, length):
            made = creation.capsule(length, radius, count=(AROUND // 2, AROUND))
            return made.apply_translation(-made.bounds.mean(axis=0))


def _thinned(vertices: FloatArray, faces: NDArray[np.int64]) -> FloatArray:
    """Triangles (F, 3, 3); of a large mesh those that are left when it is drawn on a grid."""
    if len(faces) > MOST:
        vertices, faces = clustered(vertices, faces, CELLS)
    return np.asarray(vertices[faces])
