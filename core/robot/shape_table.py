"""Shapes of links in the tables of catalogue and cell files."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError
from ..files.mesh_file import MESH_UNITS
from ..files.tables import LENGTH, TomlTable
from ..spatial.pose import Pose
from .mesh_shapes import Placed, mesh_bodies
from .pose_table import read_pose
from .shape import Box, Capsule, Cylinder, Shape, Sphere, pose_along


@dataclass(frozen=True)
class TableShapes:
    """What a table of a shape says.

    Args:
        bodies: convex shapes, each with its frame in the one that the table's lengths are given in.
        doubts: what speaks against them.
    """

    bodies: list[Placed]
    doubts: list[str] = field(default_factory=list)


def read_shapes(row: TomlTable) -> TableShapes:
    """A shape by ``kind`` with its lengths; of a mesh, the bodies that enclose it together.

    Raises:
        InputError: naming file and key.
    """
    try:
        if row.choice("kind", ("sphere", "capsule", "cylinder", "box", "mesh")) == "mesh":
            return _mesh(row)
        return TableShapes([_shape(row)])
    except InputError as error:
        if str(error).startswith(str(row.file)):
            raise
        raise row.error("kind", str(error)) from None


def _mesh(row: TomlTable) -> TableShapes:
    file = row.existing_file("mesh")
    scale = MESH_UNITS[row.choice("units", MESH_UNITS)]
    placement = read_pose(row)
    try:
        bodies, lacks = mesh_bodies(file, scale)
    except InputError as error:
        raise row.error("mesh", str(error)) from None
    placed = [(shape, placement @ own) for shape, own in bodies]
    return TableShapes(placed, [] if lacks is None else [f"{file}: {lacks}"])


def _shape(row: TomlTable) -> tuple[Shape, Pose]:
    kind = row.text("kind")
    if kind == "box":
        x, y, z = row.quantities("size", LENGTH, 3)
        return Box((x, y, z)), read_pose(row)
    radius = row.quantity("radius", LENGTH)
    if kind == "sphere":
        x, y, z = row.quantities("centre", LENGTH, 3)
        return Sphere(radius), Pose((x, y, z))
    start = np.array(row.quantities("from", LENGTH, 3))
    end = np.array(row.quantities("to", LENGTH, 3))
    length = float(np.linalg.norm(end - start))
    solid = Capsule(radius, length) if kind == "capsule" else Cylinder(radius, length)
    return solid, pose_along(start, end)
