"""Shapes of an arm's links from the collision geometry of a URDF.

Boxes, cylinders and spheres are taken as they are. In the place of a mesh comes the smallest box,
cylinder or sphere that encloses its convex hull: what is proven of the shape holds for the mesh.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError
from ...files.mesh_file import check_extent, read_scene
from ...spatial.pose import IDENTITY, Pose
from ..shape import Box, Cylinder, LinkShape, Shape, Sphere

_PACKAGE = "package://"
_FILE = "file://"
_LEAST = 1e-4
"""m; a flat mesh gets so thick a box."""
_GROWN = 1e-6
"""m by which enclosing bodies are larger than computed, for the rounding of their placement."""
_ABOVE = 6
"""Folders above the file in which the packages of ROS are looked for."""


@dataclass
class UrdfShapes:
    """What is known of the shapes of an arm.

    Args:
        file: the URDF, for the places of meshes.
        shapes: found so far.
        missing: links without collision geometry.
        unread: why meshes cannot be read.
    """

    file: Path
    shapes: list[LinkShape] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    unread: list[str] = field(default_factory=list)

    def add(self, index: int, name: str, collisions: Iterable[tuple[Any, Pose]]) -> None:
        """The geometry of a link and of all that is fixed to it.

        Args:
            index: of the link, 0 the base.
            name: of the link.
            collisions: elements, each with the frame of its link in that of the arm's link.
        """
        found = False
        for element, frame in collisions:
            try:
                for shape, placement in self._bodies(element.geometry):
                    place = frame @ _pose(element.origin) @ placement
                    self.shapes.append(LinkShape(index, shape, place))
                    found = True
            except InputError as error:
                self.unread.append(str(error))
        if not found:
            self.missing.append(name)

    @property
    def stated(self) -> bool:
        """Whether the file has any geometry."""
        return bool(self.shapes or self.unread)

    @property
    def origin(self) -> str:
        """What the shapes rest on."""
        if self.unread:
            return f"unknown: {self.unread[0]}"
        told = f"computed: bodies that enclose the collision geometry of {self.file.name}"
        if self.missing and self.shapes:
            told += f"; none of {', '.join(self.missing)}"
        return told

    def _bodies(self, geometry: Any) -> Iterator[tuple[Shape, Pose]]:
        if geometry is None:
            return
        if geometry.box is not None:
            x, y, z = (float(edge) for edge in geometry.box.size)
            yield Box((x, y, z)), IDENTITY
        elif geometry.cylinder is not None:
            body = geometry.cylinder
            yield Cylinder(float(body.radius), float(body.length)), IDENTITY
        elif geometry.sphere is not None:
            yield Sphere(float(geometry.sphere.radius)), IDENTITY
        elif geometry.mesh is not None:
            yield enclosing(self._corners(geometry.mesh))

    def _corners(self, mesh: Any) -> FloatArray:
        """Corner points (V, 3) m of a mesh in its own frame."""
        file = self._found(mesh.filename)
        scene = read_scene(file)
        corners = np.asarray(scene.to_geometry().vertices, dtype=float)
        if not len(corners):
            raise InputError(f"{file}: the mesh has no corner points")
        scale = 1.0 if mesh.scale is None else np.asarray(mesh.scale, dtype=float)
        check_extent(file, corners * scale)
        return np.asarray(corners * scale)

    def _found(self, name: str) -> Path:
        """A mesh by its name: beside the file, or in a package in a folder above it."""
        own = self.file.parent
        if name.startswith(_PACKAGE):
            package, _, rest = name.removeprefix(_PACKAGE).partition("/")
            above = [own, *Path(os.path.abspath(own)).parents][: _ABOVE + 1]
            tried = [path for one in above for path in (one / package / rest, one / rest)]
        else:
            tried = [own / name.removeprefix(_FILE)]
        for path in tried:
            if path.is_file():
                return path
        raise InputError(f"{self.file}: mesh {name} is not beside it, nor in a folder above")


def enclosing(corners: FloatArray) -> tuple[Shape, Pose]:
    """The smallest box, cylinder or sphere round points (V, 3) m, with its frame."""
    import trimesh

    spread = np.ptp(corners, axis=0)
    if spread.min() < _LEAST:
        return _upright_box(corners)
    try:
        hull = trimesh.convex.convex_hull(corners)
        box = hull.bounding_box_oriented.primitive
        bodies: list[tuple[float, Shape, FloatArray]] = []
        x, y, z = (float(edge) + _GROWN for edge in box.extents)
        bodies.append((x * y * z, Box((x, y, z)), box.transform))
        tube = hull.bounding_cylinder.primitive
        radius, height = float(tube.radius) + _GROWN, float(tube.height) + _GROWN
        bodies.append((np.pi * radius**2 * height, Cylinder(radius, height), tube.transform))
        ball = hull.bounding_sphere.primitive
        radius = float(ball.radius) + _GROWN
        bodies.append((4 / 3 * np.pi * radius**3, Sphere(radius), ball.transform))
    except Exception:  # qhull refuses what is flat within rounding
        return _upright_box(corners)
    for _, shape, transform in sorted(bodies, key=lambda body: body[0]):
        placement = Pose.from_matrix(np.asarray(transform, dtype=float))
        if _encloses(shape, placement, corners):
            return shape, placement
    return _upright_box(corners)


def _upright_box(corners: FloatArray) -> tuple[Shape, Pose]:
    low, high = corners.min(axis=0), corners.max(axis=0)
    x, y, z = (max(float(edge), _LEAST) + _GROWN for edge in high - low)
    a, b, c = (float(value) for value in 0.5 * (low + high))
    return Box((x, y, z)), Pose((a, b, c))


def _encloses(shape: Shape, placement: Pose, corners: FloatArray) -> bool:
    """Whether a body holds all points, as a check of how it was computed."""
    matrix = placement.matrix()
    local = (corners - matrix[:3, 3]) @ matrix[:3, :3]
    if isinstance(shape, Box):
        return bool((np.abs(local) <= 0.5 * np.array(shape.size)).all())
    if isinstance(shape, Sphere):
        return bool((np.linalg.norm(local, axis=1) <= shape.radius).all())
    assert isinstance(shape, Cylinder)
    within = np.linalg.norm(local[:, :2], axis=1) <= shape.radius
    return bool((within & (np.abs(local[:, 2]) <= 0.5 * shape.length)).all())


def _pose(origin: Any) -> Pose:
    return IDENTITY if origin is None else Pose.from_matrix(np.asarray(origin, dtype=float))
