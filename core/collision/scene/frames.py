"""The frames that bodies ride on: the world, and one behind every axis of the robot.

Frame 0 is the world; frame 1 + j lies behind the axis with value j of a configuration, so frame
k is the one behind the arm's joint k, as in `flyby.core.robot.shape.LinkShape`. Of a joint with
followers that is the frame behind the last of them; those before it come after all others.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...robot.assembly import Stage
from ...robot.joint import Follower, Joint, JointKind
from ...robot.kinematics.vectors import (
    Rotation,
    Vector,
    add,
    compose,
    cross,
    dot,
    load_rotation,
    load_row,
    rotation_about,
    scale,
    subtract,
    turn,
)
from ...robot.model import Robot
from ...spatial.pose import IDENTITY, Pose

WORLD = 0
"""The frame that does not move."""


class FrameTree(NamedTuple):
    """Frames as arrays; F = 1 + N and one for each follower of a joint. Row 0 (the world) of the
    joints' arrays is not used.

    Args:
        parent: (F,) int64, the frame that each stands on.
        order: (F - 1,) int64, the moving frames, each after its parent.
        value: (F,) int64, which value of a configuration moves it against its parent.
        rotation: (F, 3, 3), of the joint's placement in the parent's frame.
        translation: (F, 3) m, of the same.
        axis: (F, 3), unit axis in the joint's frame.
        prismatic: (F,) bool, whether the joint slides.
        rides: (F, F) bool, whether the first frame is the second or stands on it, directly or not.
    """

    parent: NDArray[np.int64]
    order: NDArray[np.int64]
    value: NDArray[np.int64]
    rotation: FloatArray
    translation: FloatArray
    axis: FloatArray
    prismatic: NDArray[np.bool_]
    rides: NDArray[np.bool_]


class BasePlace(NamedTuple):
    """Where the robot's base is: a frame, and its fixed place there."""

    frame: int
    placement: Pose


def base_place(robot: Robot) -> BasePlace:
    """The track that carries the base, or the world, and the base's place on it."""
    frame, placement = WORLD, IDENTITY
    for stage in robot.base_stages():
        if isinstance(stage, Pose):
            placement = placement @ stage
        else:
            frame, placement = stage[1] + 1, IDENTITY
    return BasePlace(frame, placement)


def frame_of_axis(robot: Robot, name: str) -> int:
    """The frame behind the axis called ``name``."""
    return robot.axis_names.index(name) + 1


def frame_tree(robot: Robot) -> FrameTree:
    """All frames of a robot with its external axes."""
    count = robot.size + 1 + sum(len(joint.followers) for joint in robot.joints)
    parent, value = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    rotation, translation = np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3))
    axis, prismatic = np.zeros((count, 3)), np.zeros(count, dtype=np.bool_)
    rides = np.eye(count, dtype=np.bool_)
    rides[:, WORLD] = True
    order: list[int] = []
    for move in _turns(robot):
        frame, joint = move.frame, move.joint
        if frame in order:
            continue
        order.append(frame)
        placement = move.step.matrix() @ joint.placement.matrix()
        parent[frame], value[frame] = move.below, move.value
        rotation[frame], translation[frame] = placement[:3, :3], placement[:3, 3]
        axis[frame] = np.array(joint.axis) / np.linalg.norm(joint.axis)
        prismatic[frame] = joint.kind is JointKind.PRISMATIC
        rides[frame] |= rides[move.below]
    places = np.array(order, dtype=np.int64)
    return FrameTree(parent, places, value, rotation, translation, axis, prismatic, rides)


class _Turn(NamedTuple):
    """A joint, or what follows one, between two frames.

    Args:
        below, step: the frame that it stands on, and its fixed place there.
        joint: what turns or slides.
        frame: the frame behind it.
        value: which value of a configuration moves it.
    """

    below: int
    step: Pose
    joint: Joint | Follower
    frame: int
    value: int


def _turns(robot: Robot) -> Iterator[_Turn]:
    """What moves the frames, carriers first."""
    for axis in robot.external_axes:
        yield from _walk(robot.frame_stages(axis.name), BasePlace(WORLD, IDENTITY))
    yield from _walk(robot.base_stages(), BasePlace(WORLD, IDENTITY))
    below, step = base_place(robot)
    between = robot.size + 1
    for index in robot.along:
        stages = robot.joint_stages(index)
        frames = [*range(between, between + len(stages) - 1), index + 1]
        between += len(stages) - 1
        for stage, frame in zip(stages, frames, strict=True):
            yield _Turn(below, step, stage[0], frame, stage[1])
            below, step = frame, IDENTITY


def _walk(chain: list[Stage], start: BasePlace) -> Iterator[_Turn]:
    """What moves the frames behind external axes."""
    frame, step = start
    for stage in chain:
        if isinstance(stage, Pose):
            step = step @ stage
            continue
        joint, index = stage
        yield _Turn(frame, step, joint, index + 1, index)
        frame, step = index + 1, IDENTITY


@njit(cache=True, error_model="numpy")
def place_frames(tree: FrameTree, q: FloatArray, R: FloatArray, p: FloatArray) -> None:
    """World poses of all frames for one configuration.

    Args:
        tree: F frames.
        q: (N,) rad or m.
        R: (F, 3, 3), written: rotations.
        p: (F, 3) m, written: origins; that of a revolute axis lies on it.
    """
    p[0] = 0.0
    for i in range(3):
        for j in range(3):
            R[0, i, j] = 1.0 if i == j else 0.0
    for f in tree.order:
        below = load_rotation(R, tree.parent[f])
        at = add(load_row(p, tree.parent[f]), turn(below, load_row(tree.translation, f)))
        turned = compose(below, load_rotation(tree.rotation, f))
        axis = load_row(tree.axis, f)
        if tree.prismatic[f]:
            at = add(at, scale(q[tree.value[f]], turn(turned, axis)))
        else:
            turned = compose(turned, rotation_about(axis, q[tree.value[f]]))
        store(R, p, f, turned, at)


@njit(cache=True, error_model="numpy")
def store(R: FloatArray, p: FloatArray, k: int, turned: Rotation, at: Vector) -> None:
    """Write a pose into row k of rotations (K, 3, 3) and positions (K, 3)."""
    for i in range(3):
        p[k, i] = at[i]
        for j in range(3):
            R[k, i, j] = turned[3 * i + j]


@njit(cache=True, error_model="numpy")
def place_bodies(
    tree: FrameTree,
    frame: NDArray[np.int64],
    rotation: FloatArray,
    translation: FloatArray,
    q: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """World poses of bodies for many configurations.

    Args:
        tree: F frames.
        frame: (B,), the frame that each body rides on.
        rotation, translation: (B, 3, 3) and (B, 3) m, the body's place in that frame.
        q: (M, N) rad or m.

    Returns:
        rotations (M, B, 3, 3) and positions (M, B, 3) m.
    """
    count, bodies = q.shape[0], frame.size
    R, p = np.empty((count, bodies, 3, 3)), np.empty((count, bodies, 3))
    size = tree.parent.size
    frame_R, frame_p = np.empty((size, 3, 3)), np.empty((size, 3))
    for m in range(count):
        place_frames(tree, q[m], frame_R, frame_p)
        for b in range(bodies):
            below = load_rotation(frame_R, frame[b])
            at = add(load_row(frame_p, frame[b]), turn(below, load_row(translation, b)))
            store(R[m], p[m], b, compose(below, load_rotation(rotation, b)), at)
    return R, p


@njit(cache=True, error_model="numpy")
def distance_gradients(
    tree: FrameTree,
    q: FloatArray,
    frame_a: NDArray[np.int64],
    frame_b: NDArray[np.int64],
    point_a: FloatArray,
    point_b: FloatArray,
    normal: FloatArray,
) -> FloatArray:
    """Gradients n · (J_a - J_b) of distances between points fixed to frames.

    Args:
        tree: F frames.
        q: (K, N) rad or m.
        frame_a, frame_b: (K,), the frames that the points are fixed to.
        point_a, point_b: (K, 3) m, in the world.
        normal: (K, 3), the unit vector from b to a.

    Returns:
        (K, N), m per rad or m.
    """
    gradient = np.zeros(q.shape)
    size = tree.parent.size
    R, p = np.empty((size, 3, 3)), np.empty((size, 3))
    for k in range(q.shape[0]):
        place_frames(tree, q[k], R, p)
        n = load_row(normal, k)
        _add_rates(tree, R, p, frame_a[k], load_row(point_a, k), n, gradient[k])
        _add_rates(tree, R, p, frame_b[k], load_row(point_b, k), scale(-1.0, n), gradient[k])
    return gradient


@njit(cache=True, error_model="numpy")
def _add_rates(
    tree: FrameTree,
    R: FloatArray,
    p: FloatArray,
    frame: int,
    point: Vector,
    n: Vector,
    out: FloatArray,
) -> None:
    """Add (N,) the speeds along n of a point fixed to a frame, at unit speed of each axis."""
    f = frame
    while f > 0:
        rate = turn(load_rotation(R, f), load_row(tree.axis, f))
        if not tree.prismatic[f]:
            rate = cross(rate, subtract(point, load_row(p, f)))
        out[tree.value[f]] += dot(n, rate)
        f = tree.parent[f]
