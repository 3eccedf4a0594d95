"""Places on a path, and how configurations there change, against difference quotients."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.corners import Room
from flyby.core.motion.geometry.zones import ZonePlanner
from flyby.core.motion.gradients.segment_tangents import Directions
from flyby.core.motion.gradients.sensitivity import (
    PathPlaces,
    Sensitivity,
    configurations,
    sigma_of,
)
from flyby.core.motion.model.blend import PARABOLA, Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import Overlap
from flyby.core.motion.path.path import Path
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, WORLD
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

ROBOT = find_robot("abb/irb6640-180-255")
SECOND_ORDER = Blend(alpha=(0.0, 0.0, 0.0, 10.0, -15.0, 6.0))
QUINTIC = Blend(kind="quintic")
SAID = Speed(tcp=1.0, joint=0.8, joint_acceleration=1.5)
WAYPOINTS = 4
STEP = 1e-6

angles = st.lists(
    st.lists(st.floats(-0.8, 0.8), min_size=6, max_size=6), min_size=WAYPOINTS, max_size=WAYPOINTS
)
radii = st.lists(st.floats(0.01, 0.4), min_size=WAYPOINTS - 2, max_size=WAYPOINTS - 2)
overlaps = st.sampled_from([Overlap.HALF, Overlap.SHRINK])


def program(q: FloatArray, zones: FloatArray) -> Program:
    """Joint moves through the rows of q (W, 6), with zones at the inner ones."""
    targets = [JointTarget(tuple(map(float, row))) for row in q]
    moves = [
        MoveJ(
            target=target,
            speed=SAID,
            zone=FINE if k == len(targets) - 2 else Radius(float(zones[k])),
        )
        for k, target in enumerate(targets[1:])
    ]
    return Program(tuple(moves), start=targets[0])


def controller(blend: Blend, overlap: Overlap = Overlap.HALF) -> Controller:
    tcp = PARABOLA if blend == QUINTIC else blend
    model = MotionModel(tcp=tcp, joint=blend, orientation=tcp, overlap=overlap)
    return Controller(find_vendor("abb"), ROBOT, model)


def everywhere(path: Path, each: int = 7) -> PathPlaces:
    count = 2 * len(path.segments.scale) - 1
    return PathPlaces(
        np.repeat(np.arange(count), each), np.tile(np.linspace(0.0, 1.0, each), count)
    )


def rooms(path: Path) -> list[Room]:
    planner = ZonePlanner(
        path.segments, path.route.chains, path.model, path.route.moves, path.route.robot.limits
    )
    return planner.rooms(path.route.zones)


def spread_out(q: FloatArray) -> bool:
    return bool((np.abs(np.diff(q, axis=0)).max(axis=1) > 0.2).all())


@pytest.mark.parametrize("blend", [PARABOLA, SECOND_ORDER, QUINTIC])
@given(angles=angles, radii=radii, overlap=overlaps, seed=st.integers(0, 2**32 - 1))
@settings(max_examples=25, deadline=None)
def test_tangents_are_difference_quotients(
    blend: Blend, angles: list[list[float]], radii: list[float], overlap: Overlap, seed: int
) -> None:
    q, zones = np.array(angles), np.array(radii)
    assume(spread_out(q))
    driver = controller(blend, overlap)
    random = np.random.default_rng(seed)
    q_dot, zone_dot = random.uniform(-1, 1, q.shape), random.uniform(-1, 1, zones.shape)
    q_dot[0] = 0.0

    def at(step: float) -> Path:
        return driver.plan(program(q + step * q_dot, zones + step * zone_dot))

    path, before, after = at(0.0), at(-STEP), at(STEP)
    places = everywhere(path)
    # Away from ties: where the clipping rule of a zone changes, derivatives are one-sided.
    slopes = [
        [(b.left.value - a.left.value) / STEP for a, b in zip(rooms(one), rooms(two), strict=True)]
        for one, two in ((before, path), (path, after))
    ]
    assume(np.allclose(*slopes, atol=1e-3))
    assume(all(abs(room.left.value) > 1e-3 for room in rooms(path)))
    made = Sensitivity(path, Directions(q_dot[:, :, None], {"tcp": zone_dot[:, None]}))
    q0, q1, q2 = (configurations(one, places) for one in (before, path, after))
    assume(np.allclose(q1 - q0, q2 - q1, rtol=0.0, atol=1e-4 * STEP))
    wanted = (q2 - q0) / (2 * STEP)
    assert made.configurations(places, q1)[:, :, 0] == pytest.approx(wanted, abs=2e-5, rel=1e-5)
    found = [float(made.reach(room.left)[0]) for room in rooms(path)]
    assert found == pytest.approx(np.mean(slopes, axis=0), abs=1e-5, rel=1e-4)


@given(angles=angles, radii=radii)
@settings(max_examples=25, deadline=None)
def test_places_begin_and_end_where_zones_do(angles: list[list[float]], radii: list[float]) -> None:
    q = np.array(angles)
    assume(spread_out(q))
    path = controller(PARABOLA).plan(program(q, np.array(radii)))
    count = len(path.segments.scale)
    ends = PathPlaces(np.repeat(np.arange(2 * count - 1), 2), np.tile([0.0, 1.0], 2 * count - 1))
    sigma, found = sigma_of(path, ends), configurations(path, ends)
    # In order along the path, each part begins where the one before ends.
    order = [k for i in range(count - 1) for k in (i, count + i)] + [count - 1]
    for one, other in itertools.pairwise(order):
        assert sigma[2 * one + 1] == pytest.approx(sigma[2 * other], abs=1e-12)
        assert found[2 * one + 1] == pytest.approx(found[2 * other], abs=1e-9)
    assert found[0] == pytest.approx(q[0])
    assert found[2 * count - 1] == pytest.approx(q[-1])


@given(angles=angles, radii=radii)
@settings(max_examples=25, deadline=None)
def test_no_room_below_zero_means_no_zone_is_cut(
    angles: list[list[float]], radii: list[float]
) -> None:
    q = np.array(angles)
    assume(spread_out(q))
    path = controller(PARABOLA).plan(program(q, np.array(radii)))
    cut = any("cut" in note.message for note in path.notes)
    least = min(room.left.value for room in rooms(path))
    assume(abs(least) > 1e-6)
    assert cut == (least < 0.0)


def test_paths_of_the_tcp_have_places() -> None:
    start = JointTarget((0.0, 0.3, 0.2, 0.0, 0.9, 0.0))
    driver = controller(PARABOLA)
    here = driver.plan(
        Program(
            (MoveJ(target=start, speed=Speed(tcp=1.0)),),
            start=JointTarget((0.1, 0.3, 0.2, 0.0, 0.9, 0.0)),
        )
    )
    position = here.segments.ends.position[0, 1]
    matrix = here.segments.ends.rotation[0, 1]
    from flyby.core.spatial.rotation import quaternion_from_matrix

    w, i, j, k = map(float, quaternion_from_matrix(matrix))
    goals = [position + np.array(step) for step in ((0.0, 0.2, 0.0), (0.0, 0.2, 0.2))]
    moves = [
        MoveL(
            target=PoseTarget(Pose((float(p[0]), float(p[1]), float(p[2])), (w, i, j, k))),
            speed=Speed(tcp=0.5),
            zone=Radius(0.05) if n == 0 else FINE,
            tool=FLANGE,
            work_object=WORLD,
        )
        for n, p in enumerate(goals)
    ]
    path = driver.plan(Program(tuple(moves), start=start))
    places = everywhere(path)
    found = configurations(path, places)
    # Samples of the path itself come back exactly.
    at = np.searchsorted(path.sigma, sigma_of(path, places)[0])
    assert found[0] == pytest.approx(path.q[at])
