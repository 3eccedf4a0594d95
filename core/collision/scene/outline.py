"""What proofs know of the bodies' shapes: their supports, and boxes and balls round them.

The support of a body in a direction is that of its corners, grown by a ball (spheres, capsules)
or a disc (cylinders): exact for convex bodies, that of the hull for others.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from ...robot.kinematics.vectors import Vector, load_row
from ...robot.shape import Box, Capsule, Cylinder, Sphere
from ..distance.convex import hull
from ..distance.solid import Polytope, Solid, extent
from .bodies import Body


class Outlines(NamedTuple):
    """B bodies in the frames that carry them.

    Args:
        frame: (B,) int64, rows of `flyby.core.collision.scene.frames.FrameTree`.
        first: (B + 1,) int64, first row of each body's corners.
        corners: (V, 3) m.
        ball: (B,) m, radius of the ball that corners are grown by.
        disc: (B,) m, radius of the disc.
        axis: (B, 3), unit normal of the disc.
        centre: (B, 3) m, of box and ball round the body.
        edges: (B, 3, 3) m, half edges of the box as rows.
        reach: (B,) m, radius of the ball round the body.
    """

    frame: IntArray
    first: IntArray
    corners: FloatArray
    ball: FloatArray
    disc: FloatArray
    axis: FloatArray
    centre: FloatArray
    edges: FloatArray
    reach: FloatArray


def outlines_of(bodies: Sequence[Body]) -> Outlines:
    """The outlines of a scene's bodies."""
    places = [body.placement.matrix() for body in bodies]
    corners = [
        _corners(body.solid) @ place[:3, :3].T + place[:3, 3]
        for body, place in zip(bodies, places, strict=True)
    ]
    boxes = [extent(body.solid) for body in bodies]
    turned = [place[:3, :3] for place in places]
    return Outlines(
        np.array([body.frame for body in bodies], dtype=np.int64),
        np.concatenate([[0], np.cumsum([len(points) for points in corners])]).astype(np.int64),
        np.ascontiguousarray(np.concatenate([np.empty((0, 3)), *corners])),
        np.array([_ball(body.solid) for body in bodies]),
        np.array([_disc(body.solid) for body in bodies]),
        np.array([R[:, 2] for R in turned]).reshape(-1, 3),
        np.array(
            [p[:3, :3] @ box.centre + p[:3, 3] for p, box in zip(places, boxes, strict=True)]
        ).reshape(-1, 3),
        np.array([(R * box.half).T for R, box in zip(turned, boxes, strict=True)]).reshape(
            -1, 3, 3
        ),
        np.array([box.radius for box in boxes]),
    )


def _corners(solid: Solid) -> FloatArray:
    match solid:
        case Sphere():
            return np.zeros((1, 3))
        case Capsule(_, length) | Cylinder(_, length):
            return np.array([[0.0, 0.0, -0.5 * length], [0.0, 0.0, 0.5 * length]])
        case Box(size):
            signs = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5])).reshape(3, 8).T
            return np.asarray(signs * np.array(size))
        case Polytope(vertices, _):
            return vertices
    return hull(solid.vertices).vertices


def _ball(solid: Solid) -> float:
    return solid.radius if isinstance(solid, Sphere | Capsule) else 0.0


def _disc(solid: Solid) -> float:
    return solid.radius if isinstance(solid, Cylinder) else 0.0


@lean
def support(outlines: Outlines, body: int, R: FloatArray, p: FloatArray, n: Vector) -> float:
    """Largest n · x (m) over the points x of a body whose frame is at R (3, 3), p (3,)."""
    x = R[0, 0] * n[0] + R[1, 0] * n[1] + R[2, 0] * n[2]
    y = R[0, 1] * n[0] + R[1, 1] * n[1] + R[2, 1] * n[2]
    z = R[0, 2] * n[0] + R[1, 2] * n[1] + R[2, 2] * n[2]
    most = -math.inf
    for k in range(outlines.first[body], outlines.first[body + 1]):
        corner = outlines.corners[k]
        most = max(most, x * corner[0] + y * corner[1] + z * corner[2])
    square = x * x + y * y + z * z
    most += outlines.ball[body] * math.sqrt(square)
    if outlines.disc[body] > 0.0:
        axis = outlines.axis[body]
        along = x * axis[0] + y * axis[1] + z * axis[2]
        most += outlines.disc[body] * math.sqrt(max(square - along * along, 0.0))
    return float(most + n[0] * p[0] + n[1] * p[1] + n[2] * p[2])


@lean
def lever(outlines: Outlines, body: int, axis: Vector, origin: Vector) -> float:
    """How far (m) a body gets from an axis through ``origin``, all in the frame of the body.

    The farthest corner of the box, or the far side of the ball if that is nearer.
    """
    c = load_row(outlines.centre, body)
    edges = outlines.edges[body]
    ball = math.sqrt(_square_off(c, axis, origin)) + outlines.reach[body]
    box = 0.0
    for k in range(8):
        i, j, h = 1.0 - 2.0 * (k & 1), 1.0 - (k & 2), 1.0 - 0.5 * (k & 4)
        x = c[0] + i * edges[0, 0] + j * edges[1, 0] + h * edges[2, 0]
        y = c[1] + i * edges[0, 1] + j * edges[1, 1] + h * edges[2, 1]
        z = c[2] + i * edges[0, 2] + j * edges[1, 2] + h * edges[2, 2]
        box = max(box, _square_off((x, y, z), axis, origin))
    return float(min(ball, math.sqrt(box)))


@lean
def _square_off(x: Vector, axis: Vector, origin: Vector) -> float:
    """Squared distance of a point from a line."""
    a, b, c = x[0] - origin[0], x[1] - origin[1], x[2] - origin[2]
    along = a * axis[0] + b * axis[1] + c * axis[2]
    return float(max(a * a + b * b + c * c - along * along, 0.0))
