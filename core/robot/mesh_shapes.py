"""Boxes, cylinders and spheres in the place of meshes of links.

A mesh is enclosed by the smallest one round its convex hull; one that is far from convex is split
into convex parts first, each of which gets its own.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..convex.split import HOLLOW, split
from ..errors import InputError
from ..files.mesh_file import check_extent, read_scene
from ..spatial.pose import Pose
from .shape import Box, Cylinder, Shape, Sphere

_LEAST = 1e-4
"""m; a flat mesh gets so thick a box."""
_GROWN = 1e-6
"""m by which enclosing bodies are larger than computed, for the rounding of their placement."""

Placed = tuple[Shape, Pose]
"""A shape and its frame."""


def mesh_bodies(file: Path, scale: FloatArray | float) -> tuple[list[Placed], str | None]:
    """The bodies that enclose a mesh together, in its own frame.

    Args:
        file: of the mesh.
        scale: metres in one of its units, (3,) or one for all axes.

    Returns:
        The bodies; and why a mesh that is far from convex is one, with what helps, else None.

    Raises:
        InputError: it cannot be read, or has no corner points.
    """
    mesh = read_scene(file).to_geometry()
    corners = np.asarray(mesh.vertices, dtype=float) * scale
    if not len(corners):
        raise InputError(f"{file}: the mesh has no corner points")
    check_extent(file, corners)
    whole = enclosing(corners)
    made = split(corners, _faces(mesh))
    parts = [enclosing(part) for part in made.parts]
    if len(parts) > 1 and sum(map(_volume, parts)) <= (1.0 - HOLLOW) * _volume(whole):
        return parts, None
    return [whole], made.lacks


def _faces(mesh: Any) -> Any:
    """Triangles (F, 3); none of a cloud of points."""
    return np.asarray(getattr(mesh, "faces", np.zeros((0, 3))), dtype=np.int64).reshape(-1, 3)


def _volume(body: Placed) -> float:
    """m³."""
    match body[0]:
        case Box((x, y, z)):
            return x * y * z
        case Cylinder(radius, length):
            return float(np.pi * radius**2 * length)
        case Sphere(radius):
            return float(4 / 3 * np.pi * radius**3)
    raise AssertionError("no mesh is enclosed by a capsule")


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
