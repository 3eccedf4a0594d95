"""Compiled batches of distances: closed forms where there are any, lower bounds elsewhere.

Closed forms cover spheres and capsules against each other and against boxes. Of every other pair
a lower bound is found, from the box and the segment that hold the bodies, so that only near ones
need an engine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...robot.kinematics.vectors import Vector, add, load_row, scale, subtract
from ...robot.shape import Box, Capsule, Cylinder, Sphere
from .segments import segment_box, segment_segment
from .solid import Solid, extent

GROWN_SEGMENT, BOX, OTHER = 0, 1, 2
"""What a solid is to the kernels: a sphere or capsule, a box, anything else."""


class Hulls(NamedTuple):
    """What holds each of B solids; of spheres, capsules and boxes it is the solid itself.

    Args:
        kind: (B,) int64, GROWN_SEGMENT, BOX or OTHER.
        centre: (B, 3) m, centre of the box and of the segment in the solid's frame.
        half: (B, 3) m, half edges of the box.
        length: (B,) m, half the segment, which lies along z.
        radius: (B,) m, by which the segment is grown.
        reach: (B,) m, radius of the sphere about ``centre``.
    """

    kind: NDArray[np.int64]
    centre: FloatArray
    half: FloatArray
    length: FloatArray
    radius: FloatArray
    reach: FloatArray


def hulls_of(solids: Sequence[Solid]) -> Hulls:
    """The hulls of solids."""
    extents = [extent(solid) for solid in solids]
    segments = [_segment(solid, box.radius) for solid, box in zip(solids, extents, strict=True)]
    return Hulls(
        np.array([_kind(solid) for solid in solids], dtype=np.int64),
        np.array([box.centre for box in extents]).reshape(-1, 3),
        np.array([box.half for box in extents]).reshape(-1, 3),
        np.array([length for length, _ in segments], dtype=float),
        np.array([radius for _, radius in segments], dtype=float),
        np.array([box.radius for box in extents], dtype=float),
    )


def _kind(solid: Solid) -> int:
    match solid:
        case Sphere() | Capsule():
            return GROWN_SEGMENT
        case Box():
            return BOX
    return OTHER


def _segment(solid: Solid, reach: float) -> tuple[float, float]:
    """Half length and radius of a grown segment that holds the solid."""
    match solid:
        case Capsule(radius, length) | Cylinder(radius, length):
            return 0.5 * length, radius
    return 0.0, reach


class Measured(NamedTuple):
    """Distances of P pairs at M configurations, to be filled in.

    Args:
        distance: (M, P) m.
        point_a, point_b, normal: (M, P, 3).
    """

    distance: FloatArray
    point_a: FloatArray
    point_b: FloatArray
    normal: FloatArray


@njit(cache=True, error_model="numpy")
def measure(
    hulls: Hulls,
    pairs: NDArray[np.int64],
    R: FloatArray,
    p: FloatArray,
    within: float,
    found: Measured,
) -> FloatArray:
    """Fill in the distances that have a closed form and are below ``within``.

    Args:
        hulls: of B bodies.
        pairs: (P, 2), indices of bodies.
        R, p: (M, B, 3, 3) and (M, B, 3) m, places of the bodies.
        within: m.
        found: written; untouched where the pair is farther or has no closed form.

    Returns:
        (M, P), lower bounds of the distances that were not filled in and may be below
        ``within``, else infinity.
    """
    open_bound = np.full((R.shape[0], pairs.shape[0]), math.inf)
    middle, along = np.empty((R.shape[1], 3)), np.empty((R.shape[1], 3))
    for m in range(R.shape[0]):
        _place(hulls, R[m], p[m], middle, along)
        for k in range(pairs.shape[0]):
            a, b = pairs[k, 0], pairs[k, 1]
            if _apart(middle, hulls.reach, a, b, within):
                continue
            if hulls.kind[a] + hulls.kind[b] > 1:
                bound = max(
                    _to_box(hulls, R[m], middle, along, a, b)[0],
                    _to_box(hulls, R[m], middle, along, b, a)[0],
                )
                if bound < within:
                    open_bound[m, k] = bound
                continue
            if hulls.kind[a] == BOX:
                distance, on_b, on_a, normal = _to_box(hulls, R[m], middle, along, b, a)
                normal = scale(-1.0, normal)
            elif hulls.kind[b] == BOX:
                distance, on_a, on_b, normal = _to_box(hulls, R[m], middle, along, a, b)
            else:
                distance, on_a, on_b, normal = _to_segment(hulls, middle, along, a, b)
            if distance < within:
                found.distance[m, k] = distance
                for i in range(3):
                    found.point_a[m, k, i] = on_a[i]
                    found.point_b[m, k, i] = on_b[i]
                    found.normal[m, k, i] = normal[i]
    return open_bound


@njit(cache=True, error_model="numpy")
def _place(
    hulls: Hulls, R: FloatArray, p: FloatArray, middle: FloatArray, along: FloatArray
) -> None:
    """Write world centres and segment directions (B, 3)."""
    for b in range(R.shape[0]):
        for i in range(3):
            along[b, i] = R[b, i, 2]
            middle[b, i] = p[b, i]
            for j in range(3):
                middle[b, i] += R[b, i, j] * hulls.centre[b, j]


@njit(cache=True, error_model="numpy")
def _apart(middle: FloatArray, reach: FloatArray, a: int, b: int, within: float) -> bool:
    """Whether the spheres round two bodies are ``within`` m or more apart."""
    x, y, z = subtract(load_row(middle, a), load_row(middle, b))
    least = within + reach[a] + reach[b]
    far: bool = least <= 0.0 or x * x + y * y + z * z >= least * least
    return far


@njit(cache=True, error_model="numpy")
def _to_segment(
    hulls: Hulls, middle: FloatArray, along: FloatArray, a: int, b: int
) -> tuple[float, Vector, Vector, Vector]:
    """Grown segment a against grown segment b."""
    distance, on_a, on_b, normal = segment_segment(
        load_row(middle, a),
        load_row(along, a),
        hulls.length[a],
        load_row(middle, b),
        load_row(along, b),
        hulls.length[b],
    )
    return (
        distance - hulls.radius[a] - hulls.radius[b],
        subtract(on_a, scale(hulls.radius[a], normal)),
        add(on_b, scale(hulls.radius[b], normal)),
        normal,
    )


@njit(cache=True, error_model="numpy")
def _to_box(
    hulls: Hulls, R: FloatArray, middle: FloatArray, along: FloatArray, a: int, b: int
) -> tuple[float, Vector, Vector, Vector]:
    """Grown segment a against box b, worked out in the box's frame."""
    step = subtract(load_row(middle, a), load_row(middle, b))
    distance, on_a, on_b, normal = segment_box(
        _into(R, b, step),
        _into(R, b, load_row(along, a)),
        hulls.length[a],
        load_row(hulls.half, b),
    )
    normal = _out_of(R, b, normal)
    centre = load_row(middle, b)
    return (
        distance - hulls.radius[a],
        subtract(add(centre, _out_of(R, b, on_a)), scale(hulls.radius[a], normal)),
        add(centre, _out_of(R, b, on_b)),
        normal,
    )


@njit(cache=True, error_model="numpy")
def _into(R: FloatArray, b: int, x: Vector) -> Vector:
    """A world vector in the axes of body b."""
    return (
        R[b, 0, 0] * x[0] + R[b, 1, 0] * x[1] + R[b, 2, 0] * x[2],
        R[b, 0, 1] * x[0] + R[b, 1, 1] * x[1] + R[b, 2, 1] * x[2],
        R[b, 0, 2] * x[0] + R[b, 1, 2] * x[1] + R[b, 2, 2] * x[2],
    )


@njit(cache=True, error_model="numpy")
def _out_of(R: FloatArray, b: int, x: Vector) -> Vector:
    """A vector in the axes of body b in the world's."""
    return (
        R[b, 0, 0] * x[0] + R[b, 0, 1] * x[1] + R[b, 0, 2] * x[2],
        R[b, 1, 0] * x[0] + R[b, 1, 1] * x[1] + R[b, 1, 2] * x[2],
        R[b, 2, 0] * x[0] + R[b, 2, 1] * x[1] + R[b, 2, 2] * x[2],
    )
