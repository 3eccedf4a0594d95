"""Solids of a page: simple ones by their sizes, meshes thinned and in steps of their size."""

from __future__ import annotations

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.cell.geometry import Mesh
from ...core.robot.shape import Box, Capsule, Cylinder, Shape, Sphere
from ..thinning import clustered
from .arm_content import (
    PageMesh,
    PageSolid,
)
from .packing import Quantised, whole

MOST = 30_000
"""Triangles of a mesh above which points near to each other are drawn as one."""
_STEPS = 20_000
"""Into so many steps the longest side of a mesh is cut."""


def page_shape(shape: Mesh | Shape) -> PageSolid | PageMesh:
    """A shape in its own frame.

    Raises:
        InputError: the mesh cannot be used.
    """
    match shape:
        case Mesh():
            return page_mesh(*thinned(shape.vertices, shape.faces, MOST))
        case Box(size):
            return PageSolid("box", size)
        case Sphere(radius):
            return PageSolid("sphere", (radius,))
        case Cylinder(radius, length):
            return PageSolid("cylinder", (radius, length))
        case Capsule(radius, length):
            return PageSolid("capsule", (radius, length))


def page_mesh(vertices: FloatArray, faces: IntArray) -> PageMesh:
    """Triangles as the page takes them; see `PageMesh`."""
    extent = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 1.0
    return PageMesh(Quantised(vertices, max(extent, 1e-6) / _STEPS), whole(faces))


def thinned(vertices: FloatArray, faces: IntArray, most: int) -> tuple[FloatArray, IntArray]:
    """A mesh of at most so many triangles, on as fine a grid as that allows.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        most: triangles.
    """
    cells = 256
    made = vertices, faces
    while len(made[1]) > most and cells >= 8:
        made = clustered(vertices, faces, cells)
        cells = int(cells / 1.4)
    return made
