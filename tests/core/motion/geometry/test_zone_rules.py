"""How zones of neighbouring waypoints share a segment, by vendor rule, with the reverse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import MotionError
from flyby.core.motion.geometry.corners import (
    JOINT_CORNER,
    POSITION,
    STOP,
    TCP_CORNER,
    TURNING,
    ZoneGradient,
)
from flyby.core.motion.geometry.segments import EndsGradient, SegmentsGradient, make_segments
from flyby.core.motion.geometry.zones import ZonePlanner
from flyby.core.motion.gradients.path_gradient import pull_corners
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import OrientationZone, Overlap
from flyby.core.motion.timing.timed_zones import TimedGradient
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius, VendorZone, ZoneKind
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import rotation_vector
from flyby.vendors.kuka.zone_kinds import C_VEL

SPEED = Speed(tcp=0.2, reorientation=3.0)
HALF, SHRINK, SKIP = (MotionModel(overlap=overlap) for overlap in Overlap)
OWN = MotionModel(orientation_zone=OrientationZone.OWN)
RADII = st.floats(0.05, 1.5)


def chain(arm, *radii) -> Program:
    """A square of lines one leg long with these zones (in legs) at its inner corners."""
    offsets = [(1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0.3), (0.8, 0.2, 0.5)][: len(radii) + 1]
    zones = [*(Radius(r * arm.leg) for r in radii), FINE]
    moves = (MoveL(arm.target(o), SPEED, z) for o, z in zip(offsets, zones, strict=True))
    return Program(tuple(moves), start=arm.start)


@settings(max_examples=15, deadline=None)
@given(first=RADII, second=RADII)
def test_half_way_is_as_far_as_a_zone_reaches(abb, first, second) -> None:
    path = abb.controller(HALF).plan(chain(abb, first, second))
    np.testing.assert_allclose(path.corners.reach[0, POSITION], min(first, 0.5), rtol=1e-9)
    np.testing.assert_allclose(path.corners.reach[1, POSITION], min(second, 0.5), rtol=1e-9)
    cut = [note for note in path.notes if "cut to" in note.message]
    assert len(cut) == (first > 0.5 + 1e-6) + (second > 0.5 + 1e-6)


@settings(max_examples=15, deadline=None)
@given(first=RADII.filter(lambda r: r <= 1), second=RADII.filter(lambda r: r <= 1))
def test_overlapping_blends_shrink_in_proportion_until_they_touch(ur, first, second) -> None:
    path = ur.controller(SHRINK).plan(chain(ur, first, second))
    reach = path.corners.reach[:, POSITION]
    factor = min(1.0, 1.0 / (first + second))
    np.testing.assert_allclose(reach[0], first * factor, rtol=1e-9)
    np.testing.assert_allclose(reach[1], second * factor, rtol=1e-9)
    assert bool([n for n in path.notes if "shrunk" in n.message]) == (factor < 1.0)


def test_touching_blends_leave_no_sliver_between_them(ur) -> None:
    path = ur.controller(SHRINK).plan(chain(ur, 0.8, 0.8))
    assert path.corners.reach[:, POSITION].sum(1)[0] == pytest.approx(1.0)
    assert np.diff(path.pieces.edge).min() > 1e-6 * ur.leg
    run = ur.controller(SHRINK).run(chain(ur, 0.5, 0.5))
    assert run.trajectory.position == pytest.approx(
        ur.controller(HALF).run(chain(ur, 0.5, 0.5)).trajectory.position, abs=1e-9
    )


def test_the_later_of_two_overlapping_waypoints_is_left_out(ur) -> None:
    controller = ur.controller(SKIP)
    path = controller.plan(chain(ur, 0.6, 0.6, 0.1))
    assert path.route.moves == (0, 2, 3)
    assert ["left out" in note.message for note in path.notes] == [True]
    assert path.notes[0].move == 1
    apart = controller.plan(chain(ur, 0.4, 0.5, 0.1))
    assert apart.route.moves == (0, 1, 2, 3)


def test_the_zone_of_orientation_is_cut_at_half_way_by_itself(abb) -> None:
    zone = Radius(0.1 * abb.leg, 0.9 * abb.leg, 0.9 * abb.leg, 0.1)
    moves = (
        MoveL(abb.target((1, 0, 0), (0, 0.3, 0)), SPEED, zone),
        MoveL(abb.target((1, 1, 0)), SPEED, FINE),
    )
    path = abb.controller(OWN).plan(Program(moves, start=abb.start))
    np.testing.assert_allclose(path.corners.reach[0, POSITION], 0.1)
    np.testing.assert_allclose(path.corners.reach[0, TURNING], 0.5)
    np.testing.assert_allclose(
        abb.controller(HALF).plan(Program(moves, start=abb.start)).corners.reach[0], 0.1
    )


def test_what_space_a_corner_is_blended_in(abb) -> None:
    zone, tool = Radius(0.1 * abb.leg), Tool("long", Pose((0.0, 0.0, 0.1)))
    moves = (
        MoveL(abb.target((1, 0, 0)), SPEED, zone),
        MoveC(abb.target((1, 1, 0)), SPEED, zone, via=abb.target((1.3, 0.5, 0))),
        MoveJ(abb.target((0, 1, 0)), SPEED, zone),
        MoveJ(abb.target((0, 0.5, 0.4)), SPEED, zone),
        MoveL(abb.target((0, 0, 0.4)), SPEED, zone),
        MoveL(abb.target((0.5, 0, 0.4)), SPEED, zone, tool),
        MoveL(abb.target((0.5, 0.5, 0.4)), SPEED, FINE, tool),
    )
    kind = abb.controller().plan(Program(moves, start=abb.start)).corners.kind
    J = JOINT_CORNER
    assert kind.tolist() == [TCP_CORNER, J, J, J, J, TCP_CORNER]


def test_a_pure_reorientation_blends_by_its_angle(abb) -> None:
    moves = (
        MoveL(abb.target((0, 0, 0), (0.4, 0, 0)), SPEED, Radius(0.02, 0.02, 0.02, angle=0.1)),
        MoveL(abb.target((0, 0, 0), (0.4, 0.4, 0)), SPEED, FINE),
    )
    path = abb.controller().plan(Program(moves, start=abb.start))
    turn = np.linalg.norm(path.segments.turn_b, axis=1)
    np.testing.assert_allclose(path.corners.reach[0, TURNING] * turn, 0.1)


def test_a_vendor_may_stop_between_a_move_and_a_pure_reorientation(abb) -> None:
    moves = (
        MoveL(abb.target((1, 0, 0)), SPEED, Radius(0.02, 0.02, 0.02, angle=0.1)),
        MoveL(abb.target((1, 0, 0), (0, 0.4, 0)), SPEED, FINE),
    )
    program = Program(moves, start=abb.start)
    assert abb.controller().plan(program).corners.kind[0] == TCP_CORNER
    stopping = abb.controller(MotionModel(stops_at_pure_reorientation=True)).plan(program)
    assert stopping.corners.kind[0] == STOP
    assert "stops here" in stopping.notes[0].message


def test_a_zone_by_speed_beside_nothing_that_brakes_names_the_move(abb) -> None:
    moves = (
        MoveL(abb.target((1, 0, 0)), Speed(), VendorZone(C_VEL, 0.5)),
        MoveL(abb.target((1, 1, 0)), SPEED, FINE),
    )
    with pytest.raises(MotionError, match=r"move 1.*use a distance"):
        abb.controller().plan(Program(moves, start=abb.start))
    moves = (MoveL(abb.target((1, 0, 0)), SPEED, VendorZone(C_VEL, 0.5)), *moves[1:])
    with pytest.raises(MotionError, match=r"move 1.*limit.tcp_acceleration"):
        abb.controller(MotionModel()).plan(Program(moves, start=abb.start))


def test_a_zone_by_speed_begins_where_braking_has_come_down_to_it(abb) -> None:
    """Stopping at the waypoint instead, the TCP passes the zone's edge at that speed."""
    speed, share = Speed(tcp=0.4, tcp_acceleration=2.0), 0.7
    controller = abb.controller(MotionModel(neighbour_fraction=0.5))
    first, second = abb.target((1, 0, 0)), abb.target((1, 1, 0))
    blended, stopped = (
        Program((MoveL(first, speed, zone), MoveL(second, speed, FINE)), start=abb.start)
        for zone in (VendorZone(C_VEL, share), FINE)
    )
    path = controller.plan(blended)
    before = float(path.corners.reach[0, POSITION, 0] * path.segments.length[0])
    assert before == pytest.approx((share * speed.tcp) ** 2 / (2 * speed.tcp_acceleration))
    run = controller.run(stopped, period=0.001)
    left = np.linalg.norm(run.trajectory.position - first.pose.position, axis=1)
    at = int(np.argmin(left))
    steps = np.linalg.norm(np.diff(run.trajectory.position, axis=0), axis=1)
    fast = np.append(steps / np.diff(run.trajectory.t), 0.0)
    there = float(np.interp(before, left[:at][::-1], fast[:at][::-1]))
    assert there == pytest.approx(share * speed.tcp, rel=0.02)


def test_a_zone_by_orientation_beside_a_joint_move(abb) -> None:
    angle = 0.05
    turned = abb.target((1, 0, 0), (0, 0.4, 0))
    moves = (
        MoveL(turned, SPEED, Angle(angle)),
        MoveJ(abb.target((1, 1, 0), (0.5, 0.4, 0)), SPEED, FINE),
    )
    path = abb.controller().plan(Program(moves, start=abb.start))
    assert path.corners.kind[0] == JOINT_CORNER
    q = path.segments.ends.q[1]
    share = path.corners.reach[0, POSITION, 1]
    here, there = (
        abb.robot.flange_pose(x).matrix()[:3, :3] for x in (q[0], q[0] + share * (q[1] - q[0]))
    )
    assert np.linalg.norm(rotation_vector(there @ here.T)) == pytest.approx(angle)


ZONES = [Radius(0.04, 0.06, 0.05, 0.1), ContourFraction(0.6), Angle(0.05), Radius(0.07, 0.2)]


BRAKED = Speed(tcp=0.4, tcp_acceleration=2.5)
OTHERS = [VendorZone(C_VEL, 0.7), VendorZone(C_VEL, 0.3), Angle(0.04), Angle(0.05)]


@pytest.mark.parametrize("model", [HALF, SHRINK, OWN])
def test_the_reverse_of_zones_by_speed_and_by_orientation(abb, model) -> None:
    """Over shares, angles, speeds, accelerations and joints."""
    t = abb.target
    moves = (
        MoveL(t((1, 0, 0), (0, 0.2, 0)), BRAKED, OTHERS[0]),
        MoveL(t((1, 1, 0)), BRAKED, OTHERS[1]),
        MoveL(t((0.4, 1, 0.2), (0.3, 0, 0)), BRAKED, OTHERS[2]),
        MoveJ(t((0, 0, 0.6), (0, 0.5, 0)), BRAKED, OTHERS[3]),
        MoveJ(t((0.6, 0, 0.2)), BRAKED, FINE),
    )
    route = abb.controller(model).plan(Program(moves, start=abb.start)).route
    ends, zones = route.ends, list(route.zones)
    weights = np.random.default_rng(0).normal(size=(4, 3, 2))

    def total(zones) -> float:
        planner = ZonePlanner(
            make_segments(ends), route.chains, model, route.moves, route.robot.limits
        )
        return float(np.sum(weights * planner.corners(zones).reach))

    segments = make_segments(ends)
    corners = ZonePlanner(segments, route.chains, model, route.moves, route.robot.limits).corners(
        zones
    )
    bar, out = SegmentsGradient.zeros(segments), EndsGradient.zeros(ends)
    by_zone = ZoneGradient.zeros(4)
    pull_corners(corners, weights, np.zeros(4), TimedGradient.zeros(0, 4), bar, out, by_zone)
    h = 1e-6
    for i, field, name in (
        (0, "size", "tcp"),
        (1, "size", "tcp"),
        (2, "angle", "angle"),
        (3, "angle", "angle"),
    ):
        at = getattr(zones[i], field)
        above, below = (
            total([*zones[:i], replace(zones[i], **{field: at + step}), *zones[i + 1 :]])
            for step in (h, -h)
        )
        numeric = (above - below) / (2 * h)
        assert getattr(by_zone, name)[i] == pytest.approx(numeric, rel=1e-5, abs=1e-6), (i, name)
    of = {"speed": (0, 1), "acceleration": (0, 1)}
    for name, rows in of.items():
        for row in rows:
            assert getattr(out, name)[row] == pytest.approx(
                _slope(getattr(ends, name), row, lambda: total(zones)), rel=1e-5, abs=1e-7
            ), (name, row)
    for k in (3, 4):
        for i in np.ndindex(2, 6):
            numeric = _slope(ends.q[k], i, lambda: total(zones))
            assert out.q[k][i] == pytest.approx(numeric, rel=1e-4, abs=1e-5), (k, i)
    assert np.abs(out.speed[:2]).min() > 0.01


@pytest.mark.parametrize("longer", [0, 1])
def test_the_reverse_of_shares_of_the_contour(abb, longer) -> None:
    """Of two joint moves, over the share and over both moves' ends."""
    way = np.array([0.3, -0.1, 0.2, 0.0, 0.1, 0.05])
    q = np.array(abb.start.joints) + np.cumsum([way, (3.0 - 2.5 * longer) * way[::-1]], axis=0)
    zone = ContourFraction(0.6)
    moves = (MoveJ(JointTarget(tuple(q[0])), SPEED, zone), MoveJ(JointTarget(tuple(q[1])), SPEED))
    route = abb.controller(HALF).plan(Program(moves, start=abb.start)).route
    ends, weights = route.ends, np.random.default_rng(0).normal(size=(1, 3, 2))

    def total(zone) -> float:
        planner = ZonePlanner(
            make_segments(ends), route.chains, HALF, route.moves, route.robot.limits
        )
        return float(np.sum(weights * planner.corners([zone]).reach))

    segments = make_segments(ends)
    corners = ZonePlanner(segments, route.chains, HALF, route.moves, route.robot.limits).corners(
        [zone]
    )
    bar, out = SegmentsGradient.zeros(segments), EndsGradient.zeros(ends)
    by_zone = ZoneGradient.zeros(1)
    pull_corners(corners, weights, np.zeros(1), TimedGradient.zeros(0, 1), bar, out, by_zone)
    h = 1e-6
    numeric = (total(ContourFraction(0.6 + h)) - total(ContourFraction(0.6 - h))) / (2 * h)
    assert by_zone.tcp[0] == pytest.approx(numeric, rel=1e-6)
    for k in (0, 1):
        for i in np.ndindex(2, 6):
            numeric = _slope(ends.q[k], i, lambda: total(zone))
            assert out.q[k][i] == pytest.approx(numeric, rel=1e-5, abs=1e-8), (k, i)
    assert np.abs(out.q).max() > 0.01


def _slope(array, index, value, h: float = 1e-6) -> float:
    old = array[index]
    array[index] = old + h
    above = value()
    array[index] = old - h
    below = value()
    array[index] = old
    return (above - below) / (2 * h)


@pytest.mark.parametrize("model", [HALF, SHRINK, OWN])
def test_the_reverse_of_the_reaches_is_the_gradient(abb, model) -> None:
    """Over radii, and over everything that the segments are made of."""
    controller = abb.controller(model)
    t = abb.target
    moves = (
        MoveL(t((1, 0, 0), (0, 0.2, 0)), SPEED, ZONES[0]),
        MoveC(t((1, 1, 0)), SPEED, ZONES[1], via=t((1.3, 0.5, 0))),
        MoveL(t((0.4, 1, 0.2), (0.3, 0, 0)), SPEED, ZONES[2]),
        MoveL(t((0.2, 0.5, 0.4)), SPEED, ZONES[3]),
        MoveJ(t((0, 0, 0.6)), SPEED, ZONES[0]),
        MoveJ(t((0.6, 0, 0.2)), SPEED, FINE),
    )
    route = controller.plan(Program(moves, start=abb.start)).route
    ends = route.ends
    weights = np.random.default_rng(0).normal(size=(5, 3, 2))

    def reaches(zones):
        segments = make_segments(ends)
        planner = ZonePlanner(segments, route.chains, model, route.moves, route.robot.limits)
        return segments, planner.corners(zones)

    def total(zones) -> float:
        return float(np.sum(weights * reaches(zones)[1].reach))

    segments, corners = reaches(route.zones)
    bar, out, by_zone = (
        SegmentsGradient.zeros(segments),
        EndsGradient.zeros(ends),
        ZoneGradient.zeros(5),
    )
    pull_corners(corners, weights, np.zeros(5), TimedGradient.zeros(0, 5), bar, out, by_zone)
    h = 1e-6
    zones = list(route.zones)
    for i, name in ((0, "tcp"), (3, "tcp"), (4, "tcp"), (0, "reorientation"), (2, "angle")):
        values = []
        for step in (h, -h):
            changed = {
                field: getattr(zones[i], field) for field in type(zones[i]).__dataclass_fields__
            }
            changed[name] += step
            values.append(total([*zones[:i], type(zones[i])(**changed), *zones[i + 1 :]]))
        numeric = (values[0] - values[1]) / (2 * h)
        assert getattr(by_zone, name)[i] == pytest.approx(numeric, rel=1e-5, abs=1e-6), (i, name)
    # Joint moves' ends, through the first exit from the sphere.
    for k in (4, 5):
        for i in np.ndindex(2, 6):
            old = ends.q[k][i]
            ends.q[k][i] = old + h
            above = total(zones)
            ends.q[k][i] = old - h
            below = total(zones)
            ends.q[k][i] = old
            numeric = (above - below) / (2 * h)
            assert out.q[k][i] == pytest.approx(numeric, rel=1e-4, abs=1e-5)
    assert np.abs(out.q[4:]).max() > 0.01


CNT = ZoneKind("CNT")
SLOW = Speed(joint_fraction=0.3, joint_acceleration_fraction=0.5)


def test_along_joint_moves_a_zone_by_speed_takes_the_time_of_the_braking(abb) -> None:
    """Both moves' joints come as far from rest, or to it, in that time."""
    way = np.array([0.6, -0.2, 0.3, 0.0, 0.1, 0.05])
    q = np.array(abb.start.joints) + np.cumsum([way, way[::-1]], axis=0)
    first, second = (JointTarget(tuple(one)) for one in q)
    moves = (MoveJ(first, SLOW, VendorZone(CNT, 0.8)), MoveJ(second, SLOW))
    path = abb.controller(HALF).plan(Program(moves, start=abb.start))
    limits = abb.robot.limits
    v = np.min(0.3 * limits.velocity[way != 0] / np.abs(way[way != 0]))
    a, b = (
        np.min(0.5 * limits.acceleration[step != 0] / np.abs(step[step != 0]))
        for step in (way, way[::-1])
    )
    time = 0.8 * v / a
    np.testing.assert_allclose(
        path.corners.reach[0, POSITION], [0.5 * a * time**2, 0.5 * b * time**2]
    )


def test_two_distances_are_those_before_and_behind(abb) -> None:
    kind = ZoneKind("CR", None, largest=1.0, unit=1e-3, step=1e-3)
    moves = (
        MoveL(abb.target((1, 0, 0)), SPEED, VendorZone(kind, 0.005, 2.0)),
        MoveL(abb.target((1, 1, 0)), SPEED, FINE),
    )
    path = abb.controller(HALF).plan(Program(moves, start=abb.start))
    ways = path.corners.reach[0, POSITION] * path.segments.length
    np.testing.assert_allclose(ways, [0.005, 0.01])


def test_the_reverse_of_zones_by_speed_along_joint_moves(abb) -> None:
    """Over shares of speed and acceleration, sizes and joints; beside a line as well."""
    way = np.array([0.6, -0.2, 0.3, 0.0, 0.1, 0.05])
    q = np.array(abb.start.joints) + np.cumsum([way, way[::-1]], axis=0)
    moves = (
        MoveJ(JointTarget(tuple(q[0])), SLOW, VendorZone(CNT, 0.7)),
        MoveJ(JointTarget(tuple(q[1])), SLOW, VendorZone(CNT, 0.4)),
        MoveL(abb.target((1, 1, 0)), BRAKED),
    )
    route = abb.controller(HALF).plan(Program(moves, start=abb.start)).route
    ends, zones = route.ends, list(route.zones)
    weights = np.random.default_rng(0).normal(size=(2, 3, 2))

    def total(zones) -> float:
        segments = make_segments(ends)
        planner = ZonePlanner(segments, route.chains, HALF, route.moves, route.robot.limits)
        return float(np.sum(weights * planner.corners(zones).reach))

    segments = make_segments(ends)
    planner = ZonePlanner(segments, route.chains, HALF, route.moves, route.robot.limits)
    bar, out = SegmentsGradient.zeros(segments), EndsGradient.zeros(ends)
    by_zone = ZoneGradient.zeros(2)
    timed = TimedGradient.zeros(0, 2)
    pull_corners(planner.corners(zones), weights, np.zeros(2), timed, bar, out, by_zone)
    for name in ("joint_fraction", "joint_acceleration_fraction"):
        for row in (0, 1):
            numeric = _slope(getattr(ends, name), row, lambda: total(zones))
            assert getattr(out, name)[row] == pytest.approx(numeric, rel=1e-5), (name, row)
    for i, zone in enumerate(zones):
        above, below = (
            total([*zones[:i], replace(zone, size=zone.size + h), *zones[i + 1 :]])
            for h in (1e-6, -1e-6)
        )
        assert by_zone.tcp[i] == pytest.approx((above - below) / 2e-6, rel=1e-5)
    for i in np.ndindex(2, 6):
        numeric = _slope(ends.q[0], i, lambda: total(zones))
        assert out.q[0][i] == pytest.approx(numeric, rel=1e-4, abs=1e-6)


def test_an_override_of_accelerations_counts_for_joints_and_tcp(abb) -> None:
    """ACC200 halves the way of braking, and the time of a move that only accelerates."""
    model = MotionModel(tcp_acceleration=2.0)
    found = []
    for override in (1.0, 2.0):
        speed = Speed(tcp=0.3, acceleration_override=override)
        moves = (
            MoveL(abb.target((1, 0, 0)), speed, VendorZone(CNT, 0.5)),
            MoveL(abb.target((1, 1, 0)), speed),
        )
        path = abb.controller(model).plan(Program(moves, start=abb.start))
        found.append(float(path.corners.reach[0, POSITION, 0]))
    assert found[0] == pytest.approx(2 * found[1])
    far = JointTarget(tuple(q + 0.05 for q in abb.start.joints))
    times = [
        abb.controller(MotionModel())
        .run(Program((MoveJ(far, Speed(acceleration_override=o)),), start=abb.start))
        .duration
        for o in (1.0, 1.5)
    ]
    assert times[0] / times[1] == pytest.approx(np.sqrt(1.5), rel=1e-3)


def test_a_zone_by_speed_before_a_timed_line_is_that_of_its_mean_speed(abb) -> None:
    model = MotionModel(tcp_acceleration=2.0)
    found = []
    for said in (Speed(duration=2.0), Speed(tcp=0.5 * abb.leg)):
        moves = (
            MoveL(abb.target((1, 0, 0)), said, VendorZone(CNT, 0.5)),
            MoveL(abb.target((1, 1, 0)), Speed(tcp=0.1)),
        )
        path = abb.controller(model).plan(Program(moves, start=abb.start))
        found.append(path.corners.reach[0, POSITION])
    assert found[0].min() > 0.0
    np.testing.assert_allclose(found[0], found[1])
