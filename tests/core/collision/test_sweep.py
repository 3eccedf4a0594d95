"""Lower bounds along an interval against sampled distances, each kind of bound for itself."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.cell.cell import Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.deviation.bounds import DeviationBounds, by_interval
from flyby.core.collision.proof.boxes import Boxes
from flyby.core.collision.proof.items import Items, Sweeps
from flyby.core.collision.proof.sweep import sweep
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.program.tool import Tool
from flyby.core.robot.shape import Box, Capsule, Sphere
from flyby.core.spatial.pose import Pose

from .conftest import arm, cell_of, table, track, with_rods

GUN = Tool("gun")
GUN_SHAPE = Geometry(Capsule(0.04, 0.3), Pose((0.05, 0.0, 0.1), (0.8, 0.6, 0.0, 0.0)))
THINGS = (
    Obstacle("wall", Geometry(Box((0.1, 4.0, 3.0)), Pose((1.3, 0.0, 0.5)))),
    Obstacle("shelf", Geometry(Box((3.0, 3.0, 0.05)), Pose((0.0, 0.0, 1.9)))),
    Obstacle("ball", Geometry(Sphere(0.15), Pose((-0.7, -0.5, 1.1)))),
    Obstacle("rail", Geometry(Capsule(0.05, 0.8), Pose((0.2, -0.9, 0.9), (0.8, 0.6, 0.0, 0.0)))),
)
CARRIED = (*THINGS, Obstacle("part", Geometry(Box((0.4, 0.3, 0.3)), Pose((0, 0, 0.1))), "table"))


def scene_of(robot, things) -> CollisionScene:
    cell = cell_of(robot, tools={"gun": GUN}, tool_geometries={"gun": GUN_SHAPE}, obstacles=things)
    return CollisionScene(cell, GUN)


SCENES = {
    "alone": scene_of(arm(), THINGS),
    "track": scene_of(arm([track()]), THINGS),
    "table": scene_of(arm(table()), CARRIED),
    "rods": scene_of(with_rods(arm()), THINGS),
}
T = np.linspace(-1.0, 1.0, 21)


@st.composite
def motions(draw, size: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Middle, rate and second derivative (N,) of a motion over t from −1 to 1."""
    values = st.floats(-1.5, 1.5)
    q = np.array([draw(values) for _ in range(size)])
    largest = draw(st.sampled_from([0.5, 0.1, 0.01]))
    rate = largest * np.array([draw(st.floats(-1.0, 1.0)) for _ in range(size)])
    bend = largest * np.array([draw(st.floats(-1.0, 1.0)) for _ in range(size)])
    still = np.array([draw(st.booleans()) for _ in range(size)])
    return q, np.where(still, 0.0, rate), np.where(still, 0.0, bend)


def boxed(q: FloatArray, rate: FloatArray, bend: FloatArray) -> Boxes:
    boxes = Boxes.empty(1, len(q))
    boxes.q[0], boxes.rate[0] = q, rate
    boxes.reach[0] = np.abs(rate) + 0.5 * np.abs(bend)
    boxes.first[0] = np.abs(rate) + np.abs(bend)
    boxes.second[0] = np.abs(bend)
    boxes.verified[0] = True
    return boxes


def asked(
    scene: CollisionScene, boxes: Boxes, items: Items, most_off: FloatArray, residual: float = 0.0
) -> Sweeps:
    return asked_within(scene, boxes, items, DeviationBounds.within(most_off), residual)


def asked_within(
    scene: CollisionScene,
    boxes: Boxes,
    items: Items,
    deviations: DeviationBounds,
    residual: float = 0.0,
) -> Sweeps:
    found = Sweeps(*(np.empty(len(items.pair)) for _ in Sweeps._fields))
    here = by_interval(deviations, np.zeros(1), np.zeros(1))
    sweep(
        scene.frames, scene.outlines, scene.pairs, boxes, deviations, here, residual, items, found
    )
    return found


@settings(max_examples=100)
@given(st.data(), st.sampled_from(sorted(SCENES)))
def test_no_bound_is_above_a_sampled_distance(data, name) -> None:
    scene = SCENES[name]
    q, rate, bend = data.draw(motions(scene.robot.size))
    least = scene.distances(q + np.outer(T, rate) + 0.5 * np.outer(T**2, bend)).distance.min(axis=0)
    at_middle = scene.distances(q[None])
    pairs = np.arange(len(scene.pairs))
    boxes, still = boxed(q, rate, bend), np.zeros(len(q))
    unknown = np.full(len(pairs), -np.inf)
    rows, none = np.zeros(len(pairs), np.int64), np.zeros((len(pairs), 3))
    from_boxes = asked(scene, boxes, Items(rows, pairs, none, unknown), still)
    assert (from_boxes.lower <= least + 1e-9).all()
    from_distance = asked(scene, boxes, Items(rows, pairs, none, at_middle.distance[0]), still)
    assert (from_distance.lower <= least + 1e-9).all()
    from_plane = asked(scene, boxes, Items(rows, pairs, at_middle.normal[0], unknown), still)
    apart = least > 0.0
    assert (from_plane.lower[apart] <= least[apart] + 1e-9).all()
    # Any other plane is no better.
    turned = np.roll(at_middle.normal[0], 1, axis=1)
    other = asked(scene, boxes, Items(rows, pairs, turned, unknown), still)
    assert (other.lower[apart] <= least[apart] + 1e-9).all()


@settings(max_examples=40)
@given(st.data(), st.sampled_from(sorted(SCENES)))
def test_deviations_take_off_what_joints_off_the_path_can_do(data, name) -> None:
    scene = SCENES[name]
    q, rate, bend = data.draw(motions(scene.robot.size))
    most_off = np.array([data.draw(st.floats(0.0, 0.02)) for _ in q])
    seed = data.draw(st.integers(0, 10**6))
    off = np.random.default_rng(seed).choice([-1.0, 1.0], (len(T), len(q))) * most_off
    q_off = q + np.outer(T, rate) + 0.5 * np.outer(T**2, bend) + off
    least = scene.distances(q_off).distance.min(axis=0)
    at_middle = scene.distances(q[None])
    pairs = np.arange(len(scene.pairs))
    rows = np.zeros(len(pairs), np.int64)
    items = Items(rows, pairs, at_middle.normal[0], at_middle.distance[0])
    found = asked(scene, boxed(q, rate, bend), items, most_off)
    apart = least > 0.0
    assert (found.lower[apart] <= least[apart] + 1e-9).all()


@settings(max_examples=60)
@given(st.data(), st.sampled_from(sorted(SCENES)))
def test_deviations_along_ways_take_off_what_they_can_do(data, name) -> None:
    """Each joint off the path along two ways, by shares of its own, and by what is left."""
    scene = SCENES[name]
    size = scene.robot.size
    q, rate, bend = data.draw(motions(size))
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    ways = data.draw(st.sampled_from([0.02, 0.002])) * rng.normal(size=(2, size))
    share = np.stack([-rng.uniform(0, 1, 2), rng.uniform(0, 1, 2)], -1)
    share[0, 0] *= rng.integers(0, 2)
    rest = rng.uniform(0, 1e-3, size)
    most = rest + np.abs(share).max(axis=1) @ np.abs(ways)
    deviations = DeviationBounds(
        np.array([-1.0, 1.0]), ways[None], share[None], rest[None], most[None]
    )
    factor = np.where(rng.integers(0, 2, (len(T), 2)), share[:, 0], share[:, 1])
    off = factor @ ways + rng.choice([-1.0, 1.0], (len(T), size)) * rest
    q_off = q + np.outer(T, rate) + 0.5 * np.outer(T**2, bend) + off
    least = scene.distances(q_off).distance.min(axis=0)
    at_middle = scene.distances(q[None])
    pairs = np.arange(len(scene.pairs))
    items = Items(np.zeros(len(pairs), np.int64), pairs, at_middle.normal[0], at_middle.distance[0])
    found = asked_within(scene, boxed(q, rate, bend), items, deviations)
    apart = least > 0.0
    assert (found.lower[apart] <= least[apart] + 1e-9).all()
    boxes = asked(scene, boxed(q, rate, bend), items, most)
    assert (found.lower >= boxes.lower - 1e-12).all()
    assert (found.deviation <= boxes.deviation + 1e-12).all()


def test_a_plane_is_second_order_near_a_grazing_contact() -> None:
    scene = SCENES["alone"]
    # The forearm hangs down, and joint 1 swings it past the wall at its nearest.
    q = np.array([0.0, 0.5, 2.3])
    at_middle = scene.distances(q[None])
    names = [set(scene.pair_names(k)) for k in range(len(scene.pairs))]
    wall = names.index({"J3 (1)", "wall"})
    distance, normal = at_middle.distance[0, wall], at_middle.normal[0, wall]
    assert 0.0 < distance < 1.0
    lost = []
    for width in (0.02, 0.01):
        boxes = boxed(q, np.array([width, 0.0, 0.0]), np.zeros(3))
        row = np.zeros(1, np.int64)
        plane = Items(row, np.array([wall]), normal[None], np.array([-np.inf]))
        lost.append(distance - asked(scene, boxes, plane, np.zeros(3)).lower[0])
        first = Items(row, np.array([wall]), np.zeros((1, 3)), np.array([distance]))
        assert distance - asked(scene, boxes, first, np.zeros(3)).lower[0] > 4 * lost[-1]
    assert lost[0] == pytest.approx(4 * lost[1], rel=0.1)


def test_a_residual_counts_once_for_each_body_that_moves() -> None:
    scene = SCENES["alone"]
    q = np.array([0.3, 0.2, 0.4])
    pairs = np.arange(len(scene.pairs))
    rows = np.zeros(len(pairs), np.int64)
    distance = scene.distances(q[None]).distance[0]
    items = Items(rows, pairs, np.zeros((len(pairs), 3)), distance)
    found = asked(scene, Boxes.at(q), items, np.zeros(3), residual=0.001)
    for k in pairs:
        frames = [scene.bodies[b].frame for b in scene.pairs[k]]
        shared = scene.frames.rides[frames[0]] & scene.frames.rides[frames[1]]
        moving = sum(bool((scene.frames.rides[f] & ~shared).any()) for f in frames)
        assert found.deviation[k] == pytest.approx(0.001 * moving)
