"""Driving whole programs: times, waits, degenerate input and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, MotionError, Span
from flyby.core.lint.check import check
from flyby.core.lint.finding import Severity
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.origin import MoveOrigin, Origin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_vendor
from flyby.core.spatial.pose import Pose

SPEED = Speed(tcp=0.2, reorientation=3.0)
SLOW = MotionModel(tcp_acceleration=1.0)


def lines(arm, *offsets, zone=FINE, speed=SPEED) -> tuple[MoveL, ...]:
    moves = [MoveL(arm.target(offset), speed, zone) for offset in offsets]
    return (*moves[:-1], replace(moves[-1], zone=FINE))


def drive(arm, *statements, model=None):
    return arm.controller(model).run(Program(statements, start=arm.start))


def check_duration(arm, run, ideal) -> None:
    """The acceleration is constant between samples: 1.5 % above the ideal, less with more."""
    assert ideal * (1 - 1e-9) <= run.duration <= 1.015 * ideal
    controller = arm.controller(run.path.model)
    controller.sampling = Sampling(step=5e-4, turn=2e-3, joint=2e-3, most=1000)
    assert controller.run(run.program).duration == pytest.approx(ideal, rel=1e-3)


# Times


def test_a_single_line_takes_the_time_of_its_trapezoid(arm) -> None:
    run = drive(arm, *lines(arm, (1, 0, 0)), model=SLOW)
    check_duration(arm, run, arm.leg / 0.2 + 0.2 / 1.0)


def test_a_single_joint_move_takes_the_time_of_its_leading_joint(arm) -> None:
    speed = Speed(joint=0.5, joint_acceleration=1.5)
    run = drive(arm, MoveJ(arm.joints([0.4, 0.1, -0.2, 0, 0, 0]), speed))
    check_duration(arm, run, 0.4 / 0.5 + 0.5 / 1.5)


def test_a_pure_reorientation_keeps_the_tcp_and_takes_its_time(abb) -> None:
    speed = Speed(tcp=0.2, reorientation=0.5, reorientation_acceleration=2.0)
    run = drive(abb, MoveL(abb.target((0, 0, 0), (0, 0.4, 0)), speed))
    still = run.trajectory.position - run.trajectory.position[0]
    assert np.abs(still).max() < 1e-8
    check_duration(abb, run, 0.4 / 0.5 + 0.5 / 2.0)


@settings(max_examples=5, deadline=None)
@given(duration=st.floats(1.0, 20.0))
def test_programmed_durations_are_met(arm, duration) -> None:
    timed = Speed(duration=duration)
    moves = (
        MoveL(arm.target((1, 0, 0)), SPEED, Radius(0.1 * arm.leg)),
        MoveL(arm.target((1, 1, 0)), timed, Radius(0.1 * arm.leg)),
        MoveJ(arm.target((0, 1, 0.3)), replace(timed, duration=0.7 * duration)),
    )
    run = drive(arm, *moves)
    spent = run.timing.segment_durations()
    assert spent[1:] == pytest.approx([duration, 0.7 * duration], rel=1e-4)
    assert not [n for n in run.notes if "programmed to take" in n.message]


def test_a_duration_too_short_is_said(abb) -> None:
    run = drive(abb, MoveL(abb.target((1, 0, 0)), Speed(duration=0.01)))
    assert "programmed to take 0.01 s" in run.notes[-1].message
    assert run.duration > 0.05


def test_waits_are_counted_and_make_stops(abb) -> None:
    first, second = lines(abb, (1, 0, 0), (1, 1, 0), zone=Radius(0.02))
    plain = drive(abb, replace(first, zone=FINE), second)
    waited = drive(abb, first, Wait(0.7), Wait(0.3), second, Wait(0.5))
    assert waited.duration == pytest.approx(plain.duration + 1.5, abs=1e-9)
    corner = np.array(abb.pose((1, 0, 0)).position)
    at = np.linalg.norm(waited.trajectory.position - corner, axis=1) < 1e-9
    assert np.ptp(waited.trajectory.t[at]) == pytest.approx(1.0, abs=0.01)
    assert np.abs(waited.trajectory.dq[at]).max() < 1e-9


def test_a_stopping_statement_makes_a_stop_and_another_one_does_not(abb) -> None:
    first, second = lines(abb, (1, 0, 0), (1, 1, 0), zone=Radius(0.02))
    stop = drive(abb, first, Opaque("WaitRob \\InPos;", stops=True), second)
    assert stop.path.corners.kind[0] == 0
    on = drive(abb, first, Opaque("! comment"), second)
    assert on.path.corners.kind[0] != 0
    assert on.duration < stop.duration


def test_zones_save_time(arm) -> None:
    offsets = [(1, 0, 0), (1, 1, 0), (0, 1, 0.5)]
    times = [
        drive(arm, *lines(arm, *offsets, zone=zone), model=SLOW).duration
        for zone in (FINE, Radius(0.05 * arm.leg), Radius(0.3 * arm.leg))
    ]
    assert times[0] > times[1] > times[2]


@settings(max_examples=6, deadline=None)
@given(factor=st.floats(0.3, 3.0))
def test_scaled_speeds_and_accelerations_scale_time(ur, factor) -> None:
    """Velocities by k and accelerations by k² divide every time by k."""
    speed = Speed(tcp=0.15, tcp_acceleration=0.8, reorientation=2.0)
    moves = (
        MoveL(ur.target((1, 0, 0)), speed, Radius(0.2 * ur.leg)),
        MoveL(ur.target((1, 1, 0)), speed, Radius(0.2 * ur.leg)),
        MoveC(ur.target((0, 1, 0.3)), speed, via=ur.target((0.5, 1.3, 0.2))),
    )

    def scaled(k):
        joints = tuple(
            replace(j, velocity=j.velocity * k, acceleration=j.acceleration * k * k)
            for j in ur.robot.joints
        )
        robot = replace(ur.robot, joints=joints)
        quick = replace(speed, tcp=0.15 * k, tcp_acceleration=0.8 * k * k, reorientation=2.0 * k)
        program = Program(tuple(replace(m, speed=quick) for m in moves), start=ur.start)
        return ur.controller(robot=robot).run(program).duration

    assert scaled(factor) * factor == pytest.approx(scaled(1.0), rel=1e-9)


def test_a_program_driven_backwards_takes_the_same_time(arm) -> None:
    offsets = [(1, 0, 0), (1, 1, 0), (0.2, 1, 0.4), (0, 0, 0.6)]
    zone = Radius(0.25 * arm.leg)
    there = drive(arm, *lines(arm, *offsets, zone=zone))
    back = lines(arm, *[*offsets[-2::-1], (0, 0, 0)], zone=zone)
    start = JointTarget(tuple(map(float, there.trajectory.q[-1])))
    returned = arm.controller().run(Program(back, start=start))
    np.testing.assert_allclose(returned.trajectory.q[-1], arm.home, atol=1e-7)
    # Sampling crowds alike from both sides; the two sweeps of the stamp differ by rounding.
    assert returned.timing.duration == pytest.approx(there.timing.duration, rel=2e-3)


# Degenerate input


def test_repeated_waypoints_and_moves_of_no_length_are_ordinary(arm) -> None:
    zone = Radius(0.1 * arm.leg)
    plain = lines(arm, (1, 0, 0), (1, 1, 0), zone=zone)
    here = MoveL(arm.target(), SPEED, zone)
    again = MoveL(arm.target((1, 0, 0)), SPEED, zone)
    run = drive(arm, here, plain[0], again, again, plain[1], replace(plain[1], zone=zone))
    assert run.duration == pytest.approx(drive(arm, *plain).duration, rel=1e-9)
    assert len([n for n in run.notes if "goes nowhere" in n.message]) == 4


def test_a_stop_among_repeated_waypoints_stays_a_stop(abb) -> None:
    first, second = lines(abb, (1, 0, 0), (1, 1, 0), zone=Radius(0.02))
    run = drive(abb, first, replace(first, zone=FINE), Wait(0.4), second)
    assert run.path.corners.kind[0] == 0
    stop = drive(abb, replace(first, zone=FINE), second)
    assert run.duration == pytest.approx(stop.duration + 0.4)


def test_a_program_without_a_start_begins_at_its_first_target(arm) -> None:
    moves = (MoveJ(arm.start, SPEED), *lines(arm, (1, 0, 0)))
    run = arm.controller().run(Program(moves))
    np.testing.assert_allclose(run.trajectory.q[0], arm.home)
    assert "no start is known" in run.notes[0].message


def test_a_program_of_one_point_goes_nowhere(arm) -> None:
    span = Span("a.mod", 4, 5, 30, 40)
    place = MoveOrigin(span, *[Origin(Ownership.DERIVED, span)] * 3)
    with pytest.raises(MotionError, match=r"^a\.mod:4:5: move 1: the program goes nowhere"):
        drive(arm, MoveL(arm.target(), SPEED, origin=place))


def test_left_out_waypoints_are_named_if_nothing_else_moves() -> None:
    ur = find_vendor("ur")
    robot = ur.robot("ur5e")
    home, turned = "[0, -1.5, 1.5, 0, 1.5, 0]", "[0, -1.5, 1.5, 0, 1.5, 0.3]"
    text = (
        f"set_tcp(p[0, 0, 0.1, 0, 0, 0])\nmovej({home})\nmovej({turned}, r=0.01)\nmovej({home})\n"
    )
    with pytest.raises(MotionError, match=r"^a\.script:3:1: move 2: its blend overlaps"):
        Controller(ur, robot).run(ur.read(text, "a.script", robot=robot))


def test_an_empty_program_is_refused(abb) -> None:
    with pytest.raises(MotionError, match=r"^program .main. has no move: nothing in it moves"):
        abb.controller().run(Program((), start=abb.start))


def test_a_text_without_moves_is_refused_with_its_name() -> None:
    abb = find_vendor("abb")
    robot = abb.robot("irb6640-180-255")
    program = abb.read("MODULE m\nPROC main()\nENDPROC\nENDMODULE\n", "m.mod")
    with pytest.raises(MotionError, match=r"^m\.mod:1:1: program 'm' has no move"):
        Controller(abb, robot).run(program)


def test_a_zone_at_the_last_point_is_a_stop(abb) -> None:
    zoned = drive(abb, MoveL(abb.target((1, 0, 0)), SPEED, Radius(0.05)))
    assert zoned.duration == pytest.approx(drive(abb, *lines(abb, (1, 0, 0))).duration)
    assert np.abs(zoned.trajectory.dq[-1]).max() < 1e-9


def test_the_move_of_every_sample_is_known(abb) -> None:
    run = drive(abb, *lines(abb, (1, 0, 0), (1, 1, 0), (0, 1, 0), zone=Radius(0.05)))
    assert np.unique(run.trajectory.move).tolist() == [0, 1, 2]
    assert (np.diff(run.trajectory.move) >= 0).all()


# What is refused


ARCS = {
    "lie on a line, and the auxiliary point not between": ((2, 0, 0), (1, 0, 0)),
    "are the same": ((0, 0, 0), (1, 0, 0)),
    "the same": ((1, 0, 0), (1, 0, 0)),
    "three different points": ((0.5, 0.5, 0), (0, 0, 0)),
}


@pytest.mark.parametrize("message", ARCS)
def test_three_points_that_make_no_arc_are_refused(abb, message) -> None:
    via, end = (abb.target(offset) for offset in ARCS[message])
    with pytest.raises(MotionError, match=message) as caught:
        drive(abb, *lines(abb, (0, 0, 0.3), (0, 0, 0)), MoveC(end, SPEED, via=via))
    assert "move 3" in str(caught.value)


def on_circle(arm, degrees):
    angle = np.radians(degrees)
    return arm.target((0.5 * np.sin(angle), 0, 0.5 - 0.5 * np.cos(angle)))


def test_an_arc_of_three_points_on_a_line_is_driven_as_the_line(arm) -> None:
    via, end = arm.target((0.3, 0, 0)), arm.target((1, 0, 0))
    before = lines(arm, (0, 0, 0))
    arc = drive(arm, *before, MoveC(end, SPEED, via=via), model=SLOW)
    line = drive(arm, *before, MoveL(end, SPEED), model=SLOW)
    assert arc.duration == line.duration
    assert np.array_equal(arc.trajectory.q, line.trajectory.q)
    (note,) = [n for n in arc.notes if "lie on a line" in n.message]
    assert note.move == 1


def test_arcs_beyond_what_the_controller_drives_are_refused(arm) -> None:
    """RAPID takes 240°; KRL and URScript know no such limit."""
    start = lines(arm, (0, 0, 0))
    for sweep in (239.0, 241.0, 330.0):
        arc = MoveC(on_circle(arm, sweep), SPEED, via=on_circle(arm, sweep / 2))
        if arm.robot.name.startswith("abb/") and sweep > 240:
            with pytest.raises(MotionError, match=f"an arc of {sweep:.0f}° is above the 240°"):
                drive(arm, *start, arc)
        else:
            path = drive(arm, *start, arc).path
            assert path.segments.angle[-1] == pytest.approx(np.radians(sweep))


def test_a_check_says_what_the_controller_would_stop_at(abb) -> None:
    arc = MoveC(on_circle(abb, 300), SPEED, via=on_circle(abb, 150))
    straight = MoveC(abb.target((1, 0, 0)), SPEED, via=abb.target((0.5, 0, 0)))
    program = Program((*lines(abb, (0, 0, 0)), arc), start=abb.start)
    (error,) = [
        f for f in check(program, find_vendor("abb"), abb.robot) if f.severity is Severity.ERROR
    ]
    assert (error.rule, error.move) == ("cannot-drive", 1) and "300°" in error.message
    program = Program((*lines(abb, (0, 0, 0)), straight), start=abb.start)
    found = [f for f in check(program, find_vendor("abb"), abb.robot) if "on a line" in f.message]
    assert [f.severity for f in found] == [Severity.WARNING] and found[0].move == 1


def test_an_unreachable_target_says_which_move_and_how_far(arm) -> None:
    far = PoseTarget(Pose((9.0, 0.0, 0.5), arm.pose().quaternion))
    for kind in (MoveJ, MoveL):
        with pytest.raises(MotionError, match=r"move 2: target cannot be reached: .* by \d.* m;"):
            drive(arm, *lines(arm, (1, 0, 0)), kind(far, SPEED))


def test_the_message_stands_at_the_statement_of_the_source(abb) -> None:
    span = Span("main.mod", 12, 3, 12, 40)
    far = PoseTarget(Pose((9.0, 0.0, 0.5)))
    with pytest.raises(MotionError, match=r"main\.mod:12:3"):
        drive(abb, MoveL(far, SPEED, origin=MoveOrigin(span, *[Origin(Ownership.OWNED, span)] * 3)))


def test_a_joint_limit_is_named(arm) -> None:
    change = np.zeros(6)
    change[0] = arm.robot.limits.upper[0] - arm.home[0] + 0.1
    name = arm.robot.axis_names[0]
    with pytest.raises(MotionError, match=rf"move 1.*joint {name} would .* limit of [-\d.]+ °"):
        drive(arm, MoveJ(arm.joints(change), SPEED))


def test_a_joint_limit_passed_inside_a_blend_alone_is_found(abb) -> None:
    """β < −4 carries the blend beyond the waypoint, which lies at the limit itself."""
    edge = abb.robot.limits.upper[0] - abb.home[0]
    moves = (
        MoveJ(abb.joints([edge, 0, 0, 0, 0, 0]), SPEED, Radius(0.2)),
        MoveJ(abb.joints([edge - 0.5, 0.4, 0, 0, 0, 0]), SPEED),
    )
    drive(abb, *moves)
    with pytest.raises(MotionError, match=r"joint J1 would .* limit of"):
        drive(abb, *moves, model=MotionModel(joint=Blend(beta=(-12.0,))))


def test_a_path_through_a_singular_posture_is_refused_and_one_nearby_noted(abb) -> None:
    home = np.array([0.1, 0.2, 0.3, 0.2, 0.4, 0.1])
    start = JointTarget(tuple(home))

    def target(j5, aside=0.0):
        q = home.copy()
        q[4] = j5
        q[0] += aside
        return PoseTarget(abb.robot.flange_pose(q))

    # To the side, the wrist would have to turn over at its straight posture.
    moves = MoveL(target(0.0), SPEED), MoveL(target(0.4, 0.3), SPEED)
    with pytest.raises(MotionError, match="singular"):
        abb.controller().run(Program(moves, start=start))
    near = abb.controller(MotionModel()).run(Program((MoveL(target(5e-4), SPEED),), start=start))
    assert any("near a singular configuration" in note.message for note in near.notes)


@pytest.mark.parametrize("broken", [float("nan"), float("inf")])
def test_numbers_that_are_not_finite_are_refused_where_they_enter(abb, broken) -> None:
    for make in (
        lambda: Pose((broken, 0.0, 0.0)),
        lambda: JointTarget((broken, 0.0, 0.0, 0.0, 0.0, 0.0)),
        lambda: Radius(broken),
        lambda: Speed(tcp=broken),
        lambda: Wait(broken),
    ):
        with pytest.raises(InputError, match=str(broken)):
            make()


def test_a_joint_target_of_another_robot_is_refused(abb) -> None:
    with pytest.raises(FlybyError, match=r"7 values.*6"):
        drive(abb, MoveJ(JointTarget((0.0,) * 7), SPEED))
    with pytest.raises(FlybyError, match="external axes"):
        drive(abb, MoveJ(JointTarget(tuple(abb.home), (0.1,)), SPEED))


def test_the_period_is_the_controllers_own_or_the_one_asked_for(abb) -> None:
    program = Program(lines(abb, (1, 0, 0)), start=abb.start)
    controller = abb.controller(MotionModel(period=0.01))
    own = controller.run(program).trajectory
    np.testing.assert_allclose(np.diff(own.t)[:-1], 0.01)
    asked = controller.run(program, period=0.003).trajectory
    np.testing.assert_allclose(np.diff(asked.t)[:-1], 0.003)
    assert own.duration == pytest.approx(asked.duration)
