"""Supports of bodies, and boxes and levers round them, against points of the bodies."""

from __future__ import annotations

from itertools import product

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.collision.distance.solid import Solid
from flyby.core.collision.scene.bodies import Body, BodyKind
from flyby.core.collision.scene.outline import lever, outlines_of, support
from flyby.core.robot.shape import Box, Capsule, Cylinder
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

from .conftest import (
    boxes,
    capsules,
    cylinders,
    polytopes,
    positions,
    spheres,
    surface,
    touching_points,
    turns,
    u_profile,
)

solids = st.one_of(spheres, capsules, cylinders, boxes, polytopes(), st.just(surface(u_profile())))


def extremes(solid: Solid) -> np.ndarray:
    """Corners of boxes, rims of cylinders, poles of capsules."""
    match solid:
        case Box(size):
            return 0.5 * np.array(list(product((-1, 1), repeat=3))) * size
        case Cylinder(radius, length):
            angle = np.linspace(0.0, 2 * np.pi, 720)
            rim = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
            half = np.full((720, 1), 0.5 * length)
            return np.concatenate([np.hstack([rim, half]), np.hstack([rim, -half])])
        case Capsule(radius, length):
            way = np.random.default_rng(2).normal(size=(4000, 3))
            way *= radius / np.linalg.norm(way, axis=1, keepdims=True)
            return way + np.sign(way[:, 2:]) * [0.0, 0.0, 0.5 * length]
    return np.empty((0, 3))


def placed(solid: Solid, turn: np.ndarray, at: np.ndarray) -> tuple[Body, np.ndarray]:
    """A body of a frame, and points of it in the frame."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = matrix_from_rotation_vector(turn), at
    body = Body("thing", "thing", "thing", BodyKind.OBSTACLE, 0, solid, Pose.from_matrix(matrix))
    points = np.concatenate([touching_points(solid, 4000), extremes(solid)])
    return body, points @ matrix[:3, :3].T + at


@given(solids, turns, positions, turns, positions, turns)
def test_support_is_the_farthest_point(solid, turn, at, frame_turn, frame_at, way) -> None:
    body, points = placed(solid, turn, at)
    R = matrix_from_rotation_vector(frame_turn)
    outlines = outlines_of([body])
    farthest = ((points @ R.T + frame_at) @ way).max()
    found = support(outlines, 0, R, frame_at, tuple(way))
    size = np.ptp(points, axis=0).max() * np.linalg.norm(way)
    assert farthest <= found + 1e-9
    assert found <= farthest + 0.005 * size + 1e-9


@given(solids, turns, positions, turns, positions)
def test_no_point_is_farther_from_an_axis_than_the_lever(solid, turn, at, way, origin) -> None:
    if not np.linalg.norm(way) > 1e-3:
        way = np.array([0.0, 0.0, 1.0])
    axis = way / np.linalg.norm(way)
    body, points = placed(solid, turn, at)
    found = lever(outlines_of([body]), 0, tuple(axis), tuple(origin))
    off = np.linalg.norm(np.cross(points - origin, axis), axis=1)
    assert off.max() <= found + 1e-9
    assert found <= off.max() + np.ptp(points, axis=0).max()
