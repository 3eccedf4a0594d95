"""Loads and shapes in the tables of a cell file."""

from __future__ import annotations

from collections.abc import Callable

from ..errors import InputError
from ..files.mesh_file import MESH_UNITS
from ..files.tables import LENGTH, TomlTable
from ..program.tool import Load
from ..robot.pose_table import pose_at, read_vector
from ..robot.shape import Box, Capsule, Cylinder, Shape, Sphere
from ..spatial.pose import Pose
from .geometry import Geometry, Mesh

SHAPES: dict[str, tuple[int, Callable[[tuple[float, ...]], Shape]]] = {
    "box": (3, lambda edges: Box((edges[0], edges[1], edges[2]))),
    "sphere": (1, lambda sizes: Sphere(sizes[0])),
    "cylinder": (2, lambda sizes: Cylinder(sizes[0], sizes[1])),
    "capsule": (2, lambda sizes: Capsule(sizes[0], sizes[1])),
}
"""How many lengths a simple shape has, and what makes it."""


def read_load(table: TomlTable) -> Load | None:
    """A load: ``mass_kg``, ``centre_mm``, ``inertia_kgm2`` (principal moments) about
    ``inertia_axes``.
    """
    if not table.has("mass_kg"):
        for key in ("centre_mm", "centre_m", "inertia_kgm2", "inertia_axes"):
            if table.has(key):
                raise table.error(key, "means nothing without mass_kg")
        return None
    inertia = table.numbers("inertia_kgm2", 3) if table.has("inertia_kgm2") else (0.0, 0.0, 0.0)
    axes = pose_at(table, "inertia_axes")
    if any(axes.position):
        raise table.error("inertia_axes", "has an orientation alone; where they meet is 'centre'")
    try:
        return Load(
            table.number("mass_kg"),
            read_vector(table, "centre", (0.0, 0.0, 0.0)),
            (inertia[0], inertia[1], inertia[2]),
            axes.quaternion,
        )
    except InputError as error:
        raise table.error("mass_kg", str(error)) from None


def read_geometry(table: TomlTable, placement: Pose) -> Geometry | None:
    """A shape: ``mesh`` with ``units``, ``box_mm`` (edges), ``sphere_mm`` (radius), or
    ``cylinder_mm`` / ``capsule_mm`` (radius and length along z); None if none is given.
    """
    shapes = {name: table.unit_key(name, LENGTH) for name in SHAPES}
    given = [name for name, key in shapes.items() if key is not None]
    if table.has("mesh"):
        given.append("mesh")
    if len(given) > 1:
        raise table.error(given[1], f"the shape is given by {given[0]!r} already")
    if given == ["mesh"]:
        units = table.choice("units", MESH_UNITS)
        return Geometry(Mesh(table.existing_file("mesh"), units), placement)
    if table.has("units"):
        raise table.error("units", "belongs to a mesh, but there is none")
    if not given:
        return None
    count, make = SHAPES[given[0]]
    sizes = table.quantities(given[0], LENGTH, count)
    try:
        return Geometry(make(sizes), placement)
    except InputError as error:
        raise table.error(str(shapes[given[0]]), str(error)) from None
