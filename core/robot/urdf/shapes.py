"""Shapes of an arm's links from the collision geometry of a URDF.

Boxes, cylinders and spheres are taken as they are. In the place of a mesh come the smallest
boxes, cylinders or spheres that enclose it (`mesh_shapes`): what is proven of them holds for it.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...spatial.pose import IDENTITY, Pose
from ..mesh_shapes import mesh_bodies
from ..shape import Box, Cylinder, LinkShape, Shape, Sphere

_PACKAGE = "package://"
_FILE = "file://"
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
        hollow: by file, why meshes that are far from convex are not split.
    """

    file: Path
    shapes: list[LinkShape] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    unread: list[str] = field(default_factory=list)
    hollow: dict[str, str] = field(default_factory=dict)

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
        for name, lacks in self.hollow.items():
            told += f"; {name}: {lacks}"
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
            file = self._found(geometry.mesh.filename)
            scale = 1.0 if geometry.mesh.scale is None else np.asarray(geometry.mesh.scale, float)
            bodies, lacks = mesh_bodies(file, scale)
            if lacks is not None:
                self.hollow[file.name] = lacks
            yield from bodies

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


def _pose(origin: Any) -> Pose:
    return IDENTITY if origin is None else Pose.from_matrix(np.asarray(origin, dtype=float))
