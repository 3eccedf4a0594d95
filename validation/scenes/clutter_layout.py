"""Where the things of the cluttered scene stand: raised from the bench towards the arm's way.

`arrange` takes seconds; what it gives for the scene's own seed is kept in `clutter_places`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.spatial import KDTree

from ...core.arrays import FloatArray
from ...core.cell.geometry import Mesh
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import matrix_from_quaternion
from .clutter_path import COLUMNS, ROWS
from .clutter_shapes import KINDS
from .swept import SweptArm

NEAREST, FARTHEST = 0.007, 0.011
"""m, the range of the gaps that are left between a thing and the arm's way."""
BETWEEN = 0.004
"""m between two things."""
LOWEST = 0.4
"""m, the height from which the middle of a thing is raised."""
BACK = (0.03, 0.03, 0.015, 0.008, 0.004)
"""m by which a thing is drawn back from what stops it, round by round."""
MOST_UP, MOST_ACROSS = 0.6, 0.15
"""m by which a thing moves at most."""
STRAY = 0.02
"""m by which a thing may stand beside the middle between its two stations."""
ENOUGH = 1e-3
"""m of room below which a thing stays where it is."""
COARSE = 3
"""Every how many-th point of a mesh is looked at while it is raised."""
COUNT = 24


def thing(index: int, seed: int) -> Mesh:
    """The shape of a thing; kinds take turns."""
    make = KINDS[index % len(KINDS)]
    return make(f"{make.__name__}{index}", np.random.default_rng((seed, index)))


def arrange(arm: SweptArm, seed: int) -> tuple[Pose, ...]:
    """The places of all things.

    Each is worked upwards from the bench and towards a station: so it ends in the corner between
    the way above the things and the way down to the station.

    Args:
        arm: with everything that the robot takes up on its ways.
        seed: of shapes, orientations and gaps.
    """
    rng = np.random.default_rng(seed)
    poses: list[Pose] = []
    clouds: list[FloatArray] = []
    for index, (x, y) in zip(range(COUNT), _spots(), strict=False):
        beside = rng.uniform(-STRAY, STRAY, 2)
        pose = Pose((x + float(beside[0]), y + float(beside[1]), LOWEST), _any_turn(rng))
        points = _moved(thing(index, seed).vertices[::COARSE], pose)
        gap, side = rng.uniform(NEAREST, FARTHEST), rng.choice([-1.0, 1.0])
        room = _Room(points, arm, KDTree(np.concatenate(clouds)) if clouds else None, gap)
        offset = _into_corner(room, side)
        poses.append(Pose((0.0, float(offset[1]), float(offset[2]))) @ pose)
        clouds.append(points + offset)
    return tuple(poses)


def _spots() -> Iterator[tuple[float, float]]:
    """x and y of the middles between neighbouring stations of a column, then of a row."""
    for x in COLUMNS:
        yield from ((x, 0.5 * (a + b)) for a, b in pairwise(ROWS))
    for y in ROWS[1:-1]:
        yield from ((0.5 * (a + b), y) for a, b in pairwise(COLUMNS))


@dataclass(frozen=True)
class _Room:
    """What a thing has round itself.

    Args:
        points: of the thing (P, 3), where it starts.
        arm: to be kept away from by ``gap``.
        others: points of the things that stand already.
        gap: m.
    """

    points: FloatArray
    arm: SweptArm
    others: KDTree | None
    gap: float

    def at(self, offset: FloatArray) -> float:
        """How far the thing, moved by an offset (3,), can move on in any direction, m."""
        here = self.points + offset
        room = self.arm.gap(here) - self.gap
        if self.others is None:
            return room
        near, _ = self.others.query(here, distance_upper_bound=max(room, 0.0) + BETWEEN)
        return min(room, float(np.min(near)) - BETWEEN)


def _into_corner(room: _Room, side: float) -> FloatArray:
    """The offset (3,) of a thing that is worked up and sidewards; a stop is left by a step back."""
    up, across = np.array([0.0, 0.0, 1.0]), np.array([0.0, side, 0.0])
    offset = np.zeros(3)
    for back in BACK:
        offset = _advanced(room, offset, up, MOST_UP)
        offset = _stepped(room, offset, -back * up)
        offset = _advanced(room, offset, across, MOST_ACROSS - side * float(offset[1]))
        offset = _stepped(room, offset, -back * across)
    offset = _advanced(room, offset, up, MOST_UP)
    return _advanced(room, offset, across, MOST_ACROSS - side * float(offset[1]))


def _stepped(room: _Room, offset: FloatArray, step: FloatArray) -> FloatArray:
    """The offset after a step, if there is room."""
    return offset + step if room.at(offset + step) > 0.0 else offset


def _advanced(room: _Room, offset: FloatArray, direction: FloatArray, most: float) -> FloatArray:
    """The offset as far on in a direction as there is room, at most so many m.

    Moved by h a thing comes nearer to anything by h at most, so it may move by the room that it
    has, again and again (conservative advancement).
    """
    moved = 0.0
    while moved < most and (free := room.at(offset + moved * direction)) > ENOUGH:
        moved += free
    return offset + min(moved, most) * direction


def _moved(points: FloatArray, pose: Pose) -> FloatArray:
    """Points (P, 3) of a frame that stands at a pose."""
    turned = points @ matrix_from_quaternion(np.array(pose.quaternion)).T
    return np.asarray(turned + np.array(pose.position))


def _any_turn(rng: np.random.Generator) -> tuple[float, float, float, float]:
    """A quaternion, all orientations being equally likely."""
    quaternion = rng.normal(size=4)
    w, x, y, z = (float(v) for v in quaternion / np.linalg.norm(quaternion))
    return w, x, y, z
