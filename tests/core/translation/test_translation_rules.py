"""Each rule of docs/guides/translation.md by a small program."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.dialect import Orientation
from flyby.core.errors import InputError, MotionError, Span
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.segments import make_segments
from flyby.core.motion.model.blend import TANGENT_ARC, Blend
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.event import Event
from flyby.core.program.move import Move, MoveC, MoveJ, Opaque, Wait
from flyby.core.program.origin import MoveOrigin, Origin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Angle, ContourFraction, Fine, Radius, VendorZone, ZoneKind
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint
from flyby.core.robot.posture import posture
from flyby.core.source.lines.positions import PositionForm
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.core.translation.corners import corners_of
from flyby.core.translation.emulation import Party
from flyby.core.translation.half_turns import decided
from flyby.core.translation.losses import Losses
from flyby.core.translation.resolution import Resolution
from flyby.core.translation.translate import translate
from flyby.vendors.kuka.zone_kinds import C_VEL


def side(name):
    return find_vendor(name.split("/")[0]), find_robot(name)


ASIDE, AHEAD, UP = (0.0, 0.12, 0.0), (0.12, 0.12, 0.0), (0.0, 0.0, 0.12)


def corner(pair, zone, kind="line"):
    """Two legs at a right angle with a zone between them."""
    move = getattr(pair, kind)
    return Program((pair.joint(), move(ASIDE, zone), move(AHEAD)))


def messages(made) -> str:
    return "\n".join(map(str, made.losses))


# ------------------------------------------------------------------------------------ zones


def cut_share(name: str) -> float:
    """How far a vendor's blend of the TCP cuts a corner, as a share of the parabola's cut."""
    (coefficient,) = find_vendor(name).motion().tcp.beta or (0.0,)
    return 1.0 + coefficient / 4.0


def test_equal_laws_keep_the_radius_of_a_line(between) -> None:
    pair = between("abb", "kuka")
    abb = find_vendor("abb")
    made = translate(
        corner(pair, Radius(0.02, 0.02)),
        (abb, pair.robot(pair.old)),
        (replace(find_vendor("kuka"), motion=abb.motion), pair.robot(pair.new)),
    )
    assert made.program.moves[1].zone == Radius(0.02)
    assert not made.losses


def test_other_laws_get_the_radius_that_cuts_alike(between) -> None:
    pair = between("abb", "kuka")
    kuka = find_vendor("kuka")
    model = replace(kuka.motion(), tcp=Blend(beta=(-0.5,)))
    made = translate(
        corner(pair, Radius(0.02, 0.02)),
        (find_vendor("abb"), pair.robot(pair.old)),
        (replace(kuka, motion=lambda: model), pair.robot(pair.new)),
    )
    expected = 0.02 * cut_share("abb") / (1.0 - 0.5 / 4.0)
    assert made.program.moves[1].zone.tcp == pytest.approx(expected, rel=1e-3)


def test_a_tangent_arc_needs_a_smaller_radius_for_the_same_cut(between) -> None:
    pair = between("abb", "ur")
    program = corner(pair, Radius(0.02))
    slow = [replace(move, speed=replace(move.speed, tcp=0.1)) for move in program.moves]
    made = pair.translate(program.with_moves(tuple(slow)))
    deflection = np.pi / 2
    expected = 0.02 * cut_share("abb") * np.cos(deflection / 4) ** 2
    assert made.program.moves[1].zone.tcp == pytest.approx(expected, rel=1e-3)
    # At full speed the new robot brakes for it with what its maker allows, and cuts it less.
    fast = pair.translate(program)
    assert fast.program.moves[1].zone.tcp < expected and "passes the waypoint" in messages(fast)


@pytest.mark.parametrize(
    ("blend", "factor"),
    [(Blend(beta=(1.0,)), 0.5 + 2 / 16), (TANGENT_ARC, 1 / (2 * np.cos(np.pi / 8) ** 2))],
    ids=["polynomial", "arc"],
)
def test_the_cut_of_a_corner_is_the_published_formula(between, blend, factor) -> None:
    pair = between("abb", "kuka")
    vendor = find_vendor("abb")
    model = replace(vendor.motion(), tcp=blend)
    path = Controller(vendor, pair.robot(pair.old), model).plan(corner(pair, Radius(0.02)))
    assert corners_of(path)[-1].cut == pytest.approx(factor * 0.02 * np.sin(np.pi / 4), rel=1e-3)


def test_a_zone_that_is_cut_is_carried_over_as_it_is_driven(between) -> None:
    pair = between("abb", "kuka")
    made = pair.translate(corner(pair, Radius(0.2)))
    expected = 0.06 * cut_share("abb") / cut_share("kuka")
    assert made.program.moves[1].zone.tcp == pytest.approx(expected, rel=1e-3)


NEAR = ZoneKind("CNT", None, largest=1.0, unit=1e-3, step=1e-3)


@pytest.mark.parametrize(("radius", "kind", "size"), [(0.029, "line", 0.029), (0.3, "line", 0.06)])
def test_a_zone_of_a_kind_by_distance_is_as_large_as_it_acts(between, radius, kind, size) -> None:
    """Not half of the largest that there is, where the line ends before."""
    pair = between("kuka", "abb")
    vendor, own = find_vendor("abb"), find_vendor("kuka").motion
    words = replace(vendor.speaks.line, zones=(NEAR,))
    speaks = replace(vendor.speaks, line=words, joint=replace(vendor.speaks.joint, zones=(NEAR,)))
    made = translate(
        corner(pair, Radius(radius), kind),
        (find_vendor("kuka"), pair.robot(pair.old)),
        (replace(vendor, motion=own, robot_motion={}, speaks=speaks), pair.robot(pair.new)),
    )
    zone = made.program.moves[1].zone
    assert zone.kind == NEAR
    assert size - 1.5e-3 < zone.size <= size + 1e-9


def test_numbers_come_without_digits_that_arithmetic_has_added(between) -> None:
    """Quaternions of eight digits become the angles that they stand for."""
    pair = between("abb", "kuka")
    tenth = Pose((0.6, 0.1, 0.3), (0.96592583, 0.0, 0.0, 0.25881905))
    frame = WorkObject("table", user=tenth)
    (made,) = (
        Resolution(find_vendor("kuka").speaks, pair.robot(pair.new))
        .program(Program((replace(pair.line(ASIDE), work_object=frame),)))
        .moves
    )
    form = PositionForm(Orientation.EULER_ZYX)
    wanted = pytest.approx((600, 100, 300, 30, 0, 0), abs=1e-12)
    assert form.numbers(made.work_object.user) == wanted
    home = JointTarget(tuple(np.radians([0, -90, 90, 0, 20, 0]) + 6e-11))
    rounded = Resolution(find_vendor("kuka").speaks, pair.robot(pair.new)).joints(home)
    assert np.degrees(rounded.joints) == pytest.approx([0, -90, 90, 0, 20, 0], abs=1e-13)


def test_neighbouring_blends_do_not_touch_where_a_waypoint_would_be_left_out(between) -> None:
    pair = between("abb", "ur")
    moves = [pair.line((0.05 * k, 0.05 * (k % 2), 0), Radius(0.2)) for k in range(1, 6)]
    made = pair.translate(Program((pair.joint(), *moves[:-1], replace(moves[-1], zone=FINE))))
    run = pair.run_new(made)
    assert not run.path.route.left_out
    assert all(c.passed for c in list(pair.corners(run).values())[1:-1])


def test_a_waypoint_that_the_old_controller_leaves_out_is_left_out(between) -> None:
    pair = between("ur", "abb")
    program = Program(
        (
            pair.joint(),
            pair.line(ASIDE, Radius(0.08)),
            pair.line(AHEAD, Radius(0.08)),
            pair.line((0.12, 0.24, 0.0)),
        )
    )
    left_out = pair.run_old(program).path.route.left_out
    made = pair.translate(program)
    assert left_out
    assert len(made.program.moves) == len(program.moves) - len(left_out)
    assert [note.move for note in made.losses if "left out" in note.message] == list(left_out)


def test_shares_of_a_contour_become_radii_that_cut_alike(between) -> None:
    pair = between("kuka", "abb")
    program = corner(pair, ContourFraction(0.4), "joint")
    made = pair.translate(program)
    before = pair.corners(pair.run_old(program))[1]
    after = pair.corners(pair.run_new(made))[1]
    assert isinstance(made.program.moves[1].zone, Radius)
    assert after.cut == pytest.approx(before.cut, rel=0.01)


def test_angles_become_radii_that_cut_alike(between) -> None:
    pair = between("kuka", "abb")
    turned = (0.3, 0.0, 0.0)
    program = Program((pair.joint(), pair.line(ASIDE, Angle(0.05), turn=turned), pair.line(AHEAD)))
    made = pair.translate(program)
    before = pair.corners(pair.run_old(program))[1]
    assert before.passed
    assert pair.corners(pair.run_new(made))[1].cut == pytest.approx(before.cut, rel=0.01)


@pytest.mark.parametrize("new", ["abb", "ur"])
def test_zones_by_speed_are_cut_alike_or_told(between, new) -> None:
    pair = between("kuka", new)
    program = corner(pair, VendorZone(C_VEL, 0.5))
    made = pair.translate(program)
    before, after = (pair.corners(run)[1] for run in (pair.run_old(program), pair.run_new(made)))
    assert before.passed
    assert after.passed
    if "passes the waypoint at" not in messages(made):
        assert after.cut == pytest.approx(before.cut, rel=0.05)
    else:  # a UR cuts corners by their speed
        assert new == "ur"


def test_zones_by_orientation_beside_joint_moves_are_cut_alike(between) -> None:
    pair = between("kuka", "abb")
    turned = (0.3, 0.0, 0.0)
    program = Program((pair.joint(), pair.joint(ASIDE, Angle(0.05), turn=turned), pair.line(AHEAD)))
    made = pair.translate(program)
    before = pair.corners(pair.run_old(program))[1]
    assert before.passed
    assert pair.corners(pair.run_new(made))[1].cut == pytest.approx(before.cut, rel=0.05)


def test_a_straight_corner_keeps_its_reach(between) -> None:
    pair = between("abb", "ur")
    program = Program((pair.joint(), pair.line((0.1, 0, 0), Radius(0.02)), pair.line((0.2, 0, 0))))
    assert pair.translate(program).program.moves[1].zone.tcp == pytest.approx(0.02, rel=1e-4)


def test_pure_turns_are_passed_by_an_angle_or_stop(between) -> None:
    for new, zone in (("kuka", Angle), ("ur", Fine)):
        pair = between("abb", new)
        passing = Radius(0.01, 0.01, 0.01, angle=0.05)
        program = Program(
            (
                pair.joint(),
                pair.line(turn=(0.2, 0.0, 0.0), zone=passing),
                pair.line(turn=(0.2, 0.2, 0.0)),
            )
        )
        assert pair.corners(pair.run_old(program))[1].passed
        made = pair.translate(program)
        assert isinstance(made.program.moves[1].zone, zone)
        assert ("stops here" in messages(made)) == (zone is Fine)


def test_a_wider_zone_of_reorientation_is_told_where_the_tool_turns(between) -> None:
    pair = between("abb", "kuka")
    for turn, told in (((0.0, 0.0, 0.0), False), ((0.4, 0.0, 0.0), True)):
        zone = Radius(0.01, 0.03)
        program = Program((pair.joint(), pair.line(ASIDE, zone, turn=turn), pair.line(AHEAD)))
        assert ("zone of reorientation" in messages(pair.translate(program))) == told


def test_waits_and_stopping_statements_leave_stops(between) -> None:
    pair = between("abb", "kuka")
    first, second, third = corner(pair, Radius(0.02)).moves
    for stop in (Wait(0.5), Opaque("WaitDI di1,1;", stops=True)):
        made = pair.translate(Program((first, second, stop, third)))
        assert made.program.moves[1].zone == FINE


# -------------------------------------------------------------------------- configurations


def test_spherical_wrists_stand_alike(between) -> None:
    pair = between("abb", "kuka")
    poses = [((0.1, 0.5, -0.1, 0.4, 0.9, 0.1), 1), ((0.1, 0.5, -0.1, 0.4, -0.9, 0.1), -1)]
    for joints, wrist in poses:
        program = Program((MoveJ(JointTarget(joints), pair.speed(MoveJ)), pair.joint()))
        made = pair.translate(program)
        joints = np.array(made.program.moves[0].target.joints)
        found = posture(pair.robot(pair.new), joints)
        assert found.shoulder > 0
        assert np.sign(found.wrist) == wrist


def test_another_stance_is_told_where_the_alike_one_is_out_of_reach(between) -> None:
    pair = between("abb", "kuka")
    # So near its base the KR 30 cannot bend its elbow as far as the IRB 1600 does.
    near = JointTarget((0.1, 0.2, 0.3, 0.4, -0.9, 0.1))
    made = pair.translate(Program((MoveJ(near, pair.speed(MoveJ)), pair.joint())))
    assert "has its shoulder and elbow on the other side here" in messages(made)


def test_joint_targets_stay_joint_targets_at_the_same_pose(pair) -> None:
    pose = pair.down()
    old = pair.robot(pair.old)
    q = old.inverse(pose)[0].q
    target = JointTarget(tuple(map(float, q)), name="home")
    made = pair.translate(Program((MoveJ(target, pair.speed(MoveJ)), pair.joint(UP))))
    found = made.program.moves[0].target
    assert isinstance(found, JointTarget)
    assert found.name == "home"
    there = pair.robot(pair.new).flange_pose(np.array(found.joints))
    assert np.allclose(there.matrix(), pose.matrix(), atol=1e-8)


def test_a_program_that_comes_back_to_where_it_began_does_so_on_the_new_robot() -> None:
    home = "movej([0.2, -1.4, -1.8, -1.2, 1.5708, 0], a=1.4, v=1)"
    places = ("-0.35, -0.35, 0.4", "-0.45, 0.05, 0.42", "-0.35, 0.35, 0.4")
    first, *others = (f"p[{place}, 2.2, 2.2, 0], a=1.2, v=0.5)" for place in places)
    lines = (f"movel({other}" for other in others)
    text = "\n  ".join(("def there():", home, f"movej({first}", *lines, home)) + "\nend\n"
    ur, ur5e = side("ur/ur5e")
    made = translate(
        ur.read(text, "there.script", robot=ur5e), (ur, ur5e), side("abb/irb1600-6-145")
    )
    assert made.program.moves[0].target == made.program.moves[-1].target


def test_the_label_is_the_new_vendors(pair) -> None:
    made = pair.translate(corner(pair, FINE))
    joint, line, _ = made.program.moves
    vendor = pair.new.split("/")[0]
    assert (
        type(joint.target.configuration).__module__
        == f"flyby.vendors.{vendor}.motion.configuration"
    )
    assert (line.target.configuration is None) == (vendor != "abb")


def test_what_is_out_of_reach_is_an_error_with_move_and_line(between) -> None:
    pair = between("kuka", "ur")
    span = Span("job.src", 12, 3, 100, 120)
    origin = Origin(Ownership.OWNED, span)
    far = replace(pair.joint((0.7, 0, 0)), origin=MoveOrigin(span, origin, origin, origin))
    with pytest.raises(MotionError) as caught:
        pair.translate(Program((pair.joint(), far)))
    assert caught.value.move == 1
    assert "job.src:12:3: move 2: ur/ur10e cannot reach" in str(caught.value)
    assert "; base=X,Y,Z (mm, in the old robot's base) has it stand nearer" in str(caught.value)


def test_a_line_that_the_new_robot_cannot_follow_is_named(between) -> None:
    pair = between("kuka", "ur")
    with pytest.raises(MotionError, match=r"move 3: ur/ur10e cannot follow"):
        pair.translate(Program((pair.joint(), pair.line(UP), pair.line((0.7, 0, 0)))))


def test_a_program_that_begins_with_a_line(pair) -> None:
    made = pair.translate(Program((pair.line(), pair.line(ASIDE))))
    run = pair.run_new(made)
    assert run.path.route.moves == (1,)


def test_the_start_is_carried_over(pair) -> None:
    q = pair.robot(pair.old).inverse(pair.down(UP))[0].q
    start = JointTarget(tuple(map(float, q)))
    made = pair.translate(replace(corner(pair, FINE), start=start))
    here = pair.robot(pair.new).flange_pose(np.array(made.start.joints))
    assert np.allclose(here.position, pair.down(UP).position, atol=1e-8)


# ----------------------------------------------------------------------- tools and frames


FRAME = WorkObject("fixture", Pose((0.3, 0.1, 0.2)), Pose((0.0, 0.0, 0.05)))


def in_frame(pair, frame=FRAME, **parts):
    tool = Tool("gun", Pose((0.0, 0.0, 0.1)), Load(2.0))
    moves = []
    for offset in ((0.0, 0.0, 0.1), ASIDE, AHEAD):
        target = PoseTarget(frame.pose.inverse() @ pair.down(offset), name=f"p{len(moves)}")
        kind = pair.joint if not moves else pair.line
        move = replace(kind(), target=target, tool=tool, work_object=frame, **parts)
        moves.append(move)
    return Program(tuple(moves))


def world(move):
    return (move.work_object.pose @ move.target.pose).matrix()


def test_tools_loads_and_frames_are_carried_over(pair) -> None:
    program = in_frame(pair, load=Load(1.5))
    made = pair.translate(program)
    for old, new in zip(program.moves, made.program.moves, strict=True):
        assert (new.tool, new.load, new.target.name) == (old.tool, old.load, old.target.name)
        assert np.allclose(world(old), world(new))
    assert ("one frame" in messages(made)) == pair.new.startswith("kuka")
    assert ("no frames" in messages(made)) == pair.new.startswith("ur")


def test_a_base_moves_the_new_robot(pair) -> None:
    base = Pose((0.05, -0.1, 0.02), (np.cos(0.1), 0.0, 0.0, np.sin(0.1)))
    for program in (in_frame(pair), corner(pair, Radius(0.02))):
        made = pair.translate(program, base)
        for old, new in zip(program.moves, made.program.moves, strict=True):
            assert np.allclose(base.matrix() @ world(new), world(old))


def test_stationary_tools_are_refused_where_there_are_none(between) -> None:
    pair = between("kuka", "ur")
    tool = Tool("glue", pair.down(), robot_held=False)
    part = WorkObject("part", robot_held=True)
    moves = [
        replace(pair.joint(), target=PoseTarget(Pose(at)), tool=tool, work_object=part)
        for at in ((0.0, 0.0, 0.0), (0.05, 0.0, 0.0))
    ]
    with pytest.raises(MotionError, match="cannot say: let the robot hold the tool"):
        pair.translate(Program(tuple(moves)))


def test_work_objects_on_an_axis_that_the_new_robot_lacks_are_refused(between) -> None:
    pair = between("abb", "kuka")
    joint = Joint("table", Pose((0.9, 0.0, 0.3)), (0.0, 0.0, 1.0), -6.0, 6.0, 1.0, 1.0)
    robot = pair.robot(pair.old).with_external_axes((ExternalAxis(joint, ExternalRole.TABLE),))
    frame = WorkObject("plate", moved_by="table")
    moves = [
        replace(
            pair.joint(),
            target=PoseTarget(Pose((0.0, y, 0.4), pair.down().quaternion), None, (0.0,)),
            work_object=frame,
        )
        for y in (0.0, 0.1)
    ]
    abb, kuka = side(pair.old)[0], side(pair.new)
    with pytest.raises(MotionError, match=r"move 1: work object plate is moved by table, and"):
        translate(Program(tuple(moves)), (abb, robot), kuka)


def test_a_program_that_goes_nowhere_is_refused(pair) -> None:
    with pytest.raises(MotionError, match="goes nowhere"):
        pair.translate(Program((pair.joint(), pair.line())))


# ---------------------------------------------------------------------------------- speeds


def test_lines_keep_their_speed_and_say_what_must_be_said(pair) -> None:
    program = corner(pair, Radius(0.02))
    for old, new in zip(program.moves[1:], pair.translate(program).program.moves[1:], strict=True):
        assert new.speed.tcp == old.speed.tcp
        if pair.new.startswith("ur"):
            assert new.speed.tcp_acceleration is not None


@pytest.mark.parametrize("old", ["abb", "kuka"])
def test_accelerations_are_those_that_the_maker_allows(between, old: str) -> None:
    """Joint moves with 5 rad/s² at most, lines so that joints have no more, or movel's default."""
    pair = between(old, "ur")
    quick = {"tcp": 2.0, "joint_fraction": 1.0} if old == "kuka" else {"tcp": 2.0}
    strong = {"tcp_acceleration": 25.3} if old == "kuka" else {}
    moves = (
        pair.joint((0.0, -0.3, 0.0)),
        pair.joint((0.0, 0.3, 0.1), **quick),
        pair.line((0.0, -0.3, 0.1), **quick, **strong),
    )
    made = pair.translate(Program(moves))
    _, joint, line = made.program.moves
    assert joint.speed.joint_acceleration <= 5.0
    run = pair.run_new(made)
    rows = run.trajectory.move == 2
    fastest = np.abs(run.trajectory.ddq[rows]).max()
    assert fastest < 5.0 * 1.5
    assert line.speed.tcp_acceleration < 6.0
    told = messages(made)
    assert "instead of" in told and "its maker allows, or drives it with, no more" in told


def test_what_stands_in_a_program_of_the_same_language_stays(between) -> None:
    robot, other = find_robot("ur/ur10e"), find_robot("ur/ur10")
    ur, pair = find_vendor("ur"), between("abb", "ur")
    strong = replace(corner(pair, Radius(0.02)), statements=())
    moves = [
        replace(move, speed=Speed(tcp=0.3, tcp_acceleration=9.0, joint=1.0, joint_acceleration=8.0))
        for move in corner(pair, Radius(0.02)).moves
    ]
    made = translate(replace(strong, statements=tuple(moves)), (ur, robot), (ur, other))
    assert {move.speed.tcp_acceleration for move in made.program.moves[1:]} == {9.0}


def test_krl_gets_no_more_than_its_machine_data_take(between) -> None:
    pair = between("abb", "kuka")
    line = pair.line(ASIDE, tcp=1.0, reorientation=20.0, tcp_acceleration=15.0)
    speed = pair.translate(Program((pair.joint(), line))).program.moves[1].speed
    assert speed.tcp_acceleration == 10.0 and speed.reorientation == np.radians(400)


def test_a_joint_speed_beyond_the_new_robot_is_told(between) -> None:
    pair = between("abb", "kuka")
    fast = pair.joint((0.1, 0.3, 0.1), tcp=7.0, reorientation=20.0, turn=(0.3, 0.2, 0.1))
    program = Program((pair.joint((0.0, -0.3, 0.0)), fast))
    made = pair.translate(program)
    assert made.program.moves[1].speed.joint_fraction == 1.0
    assert "the limits of kuka/kr30-3 hold it" in messages(made)


def test_durations_are_kept_or_become_speeds(between) -> None:
    for new in ("ur", "kuka"):
        pair = between("abb", new)
        program = Program((pair.joint(), pair.line(ASIDE, duration=1.3)))
        made = pair.translate(program)
        stated = made.program.moves[1].speed.duration
        assert stated == (1.3 if new == "ur" else None)
        assert pair.run_new(made).duration == pytest.approx(1.3, rel=0.01)


def test_a_share_of_acceleration_is_said_in_each_languages_terms(between) -> None:
    reduced = {"joint_acceleration_fraction": 0.4, "tcp": 0.05}
    for new, name in (("kuka", "joint_acceleration_fraction"), ("ur", "joint_acceleration")):
        pair = between("abb", new)
        program = Program((pair.joint(), pair.joint(ASIDE, **reduced), pair.line(UP, **reduced)))
        joint, line = pair.translate(program).program.moves[1:]
        robot = pair.robot(pair.new)
        value = getattr(joint.speed, name)
        limits = robot.limits.acceleration if name == "joint_acceleration" else np.ones(6)
        assert np.isclose(value, 0.4 * limits, rtol=1e-3).any()
        assert line.speed.tcp_acceleration > 0


def test_a_share_of_acceleration_grows_where_the_move_would_be_late(between) -> None:
    pair = between("ur", "abb")
    program = Program((pair.joint(), pair.joint(ASIDE, joint_acceleration=3.0, joint=3.0)))
    made = pair.translate(program)
    share = made.program.moves[1].speed.joint_acceleration_fraction
    # The share by which its first axis has the old acceleration is not enough.
    assert 3.0 / pair.robot(pair.new).limits.acceleration[0] < share < 1.0
    runs = pair.run_old(program), pair.run_new(made)
    wanted, spent = (run.timing.stamp.duration for run in runs)
    assert spent < 1.06 * wanted


def spoken(pair, joint, line, **others):
    """The new side with a language that says these numbers of joint moves and of lines."""
    vendor, robot = side(pair.new)
    words = {"needs": frozenset(), "exclusive": frozenset()}
    kinds = {
        kind: replace(getattr(vendor.speaks, kind), speeds=frozenset(names), **words)
        for kind, names in (("joint", joint), ("line", line), ("arc", line))
    }
    return replace(vendor, speaks=replace(vendor.speaks, **kinds, **others)), robot


def short_lines(pair, **speed):
    ends = ((0.0, 0.04, 0.0), (0.0, 0.0, 0.0)) * 2
    return Program((pair.joint(), *(pair.line(end, tcp=0.8, **speed) for end in ends)))


@pytest.mark.parametrize("share", ["acceleration_override", "joint_acceleration_fraction"])
def test_a_share_of_acceleration_becomes_what_the_language_has(between, share) -> None:
    pair = between("abb", "kuka")
    program = short_lines(pair, joint_acceleration_fraction=0.1)
    new = spoken(pair, ("joint_fraction", share), ("tcp", share))
    made = translate(program, side(pair.old), new)
    times = pair.run_old(program).duration, Controller(*new).run(made.program, made.start).duration
    assert times[1] == pytest.approx(times[0], rel=0.03) or "takes" in messages(made)
    assert all(getattr(move.speed, share) < 0.5 for move in made.program.moves[1:])


@pytest.mark.parametrize("override", [True, False])
def test_an_acceleration_of_the_tcp_becomes_an_override_where_there_is_one(
    between, override
) -> None:
    pair = between("ur", "kuka")
    program = short_lines(pair, tcp_acceleration=0.4)
    line = ("tcp", *(("acceleration_override",) if override else ()))
    made = translate(program, side(pair.old), spoken(pair, ("joint_fraction",), line))
    lost = "the acceleration of the TCP (0.4 m/s²) has no words"
    assert (lost in messages(made)) is not override
    times = pair.run_old(program).duration, pair.run_new(made).duration
    if override:
        assert times[1] == pytest.approx(times[0], rel=0.03)
        assert all(0.0 < m.speed.acceleration_override < 0.5 for m in made.program.moves[1:])
    else:
        assert times[1] < 0.9 * times[0]


def test_a_share_of_acceleration_without_words_is_told(between) -> None:
    pair = between("abb", "kuka")
    program = short_lines(pair, joint_acceleration_fraction=0.1)
    made = translate(program, side(pair.old), spoken(pair, ("joint_fraction",), ("tcp",)))
    assert len(made.losses) == 4
    assert "a reduced acceleration (10%) has no words" in messages(made)
    full = translate(short_lines(pair), side(pair.old), spoken(pair, ("joint_fraction",), ("tcp",)))
    assert "has no words" not in messages(full)


@pytest.mark.parametrize(
    ("programmed", "weakness", "why"),
    [
        (0.2, 0.3, "its share of acceleration (0.2) is kept, and kuka/kr30-3 takes longer"),
        (1.0, 0.03, "the limits of kuka/kr30-3 hold it"),
    ],
)
def test_what_makes_a_move_longer_is_named(between, programmed, weakness, why) -> None:
    pair, share = between("kuka", "kuka"), "joint_acceleration_fraction"
    vendor, robot = spoken(pair, ("joint_fraction", share), ("tcp", share))
    joints = (replace(one, acceleration=weakness * one.acceleration) for one in robot.joints)
    weak = replace(robot, joints=tuple(joints))
    program = short_lines(pair, joint_acceleration_fraction=programmed)
    assert why in messages(translate(program, (vendor, robot), (vendor, weak)))


def test_steps_of_shares_are_named_where_they_make_moves_longer(between) -> None:
    pair, speeds = between("ur", "kuka"), ("joint_fraction", "joint_acceleration_fraction")
    old, arm = side(pair.old)
    ways = [pair.joint(end, joint=0.12 * 2.094) for end in (ASIDE, (0.0, 0.0, 0.0))]
    program = Program((pair.joint(), *ways))
    coarse, fine = (
        translate(program, (old, arm), (spoken(pair, speeds, ("tcp",), share_step=step)[0], arm))
        for step in (0.1, 0.0)
    )
    assert "shares of speed and acceleration are said in steps of 0.1" in messages(coarse)
    assert not fine.losses


def test_a_speed_of_turning_without_words_is_told_if_it_holds(between) -> None:
    pair = between("abb", "ur")
    for rate, told in ((0.1, True), (8.0, False)):
        program = Program(
            (pair.joint(), pair.line(ASIDE, turn=(0.5, 0.0, 0.0), reorientation=rate))
        )
        assert ("speed of reorientation" in messages(pair.translate(program))) == told


# ------------------------------------------------------------------------------ half turns


def test_half_turns_go_the_way_of_the_old_robot_whatever_is_rounded(pair) -> None:
    half = (0.0, 0.0, np.pi)
    program = Program(
        (pair.joint(), pair.line((0.05, 0, 0), turn=half), pair.line(), pair.line(UP, turn=half))
    )
    made = pair.translate(program)
    assert messages(made).count("half a turn") >= 2
    before, after = pair.run_old(program), pair.run_new(made)
    for old, new in zip(program.moves, made.program.moves, strict=True):
        assert np.allclose(old.target.pose.matrix(), new.target.pose.matrix(), atol=1e-4)
    halfway = []
    for run in (before, after):
        s = run.path.segments
        turns = matrix_from_rotation_vector(0.5 * np.stack([s.turn_a, s.turn_b]))
        halfway.append((turns[0] @ turns[1])[1:])
    assert np.allclose(*halfway, atol=1e-4)


def test_half_turns_about_the_tools_axis_go_that_way_too(between) -> None:
    """A KUKA's rotation by half a turn, beside a swivel: rounding decides the sign of each."""
    pair = between("kuka", "abb")
    # The tool's x axis is the flange's z axis.
    tool = Tool("torch", Pose((0.0, 0.0, 0.1), (np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0)))
    turned = tool.tcp.matrix()[:3, :3]

    def at(move: Move, swivel: np.ndarray, rotation: float) -> Move:
        matrix = move.target.pose.matrix()
        part = matrix_from_rotation_vector(swivel) @ matrix_from_rotation_vector(
            np.array([rotation, 0.0, 0.0])
        )
        matrix[:3, :3] = matrix[:3, :3] @ turned @ part
        return replace(move, tool=tool, target=PoseTarget(Pose.from_matrix(matrix)))

    party = Party(*side(pair.old))
    # None of them in the arm's plane, where the wrist would pass its straight posture.
    for angle in 0.05 + np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False):
        swivel = 0.8 * np.array([0.0, np.cos(angle), np.sin(angle)])
        program = Program(
            (at(pair.joint(), 0.0 * swivel, 0.0), at(pair.line((0.05, 0.0, 0.0)), swivel, np.pi))
        )
        route = party.route(program)
        made = decided(program, route, Losses(program).through(range(2)))
        old, new = (make_segments(one.ends).turn_b[-1] for one in (route, party.route(made)))
        np.testing.assert_allclose(new, old, atol=1e-4)


# ------------------------------------------------------------------------------ statements


def test_statements_become_comments_with_their_line(between) -> None:
    pair = between("abb", "kuka")
    first, second, third = corner(pair, FINE).moves
    span = Span("job.mod", 7, 5, 70, 80)
    event = Event("SetDO doGlue,1;", span=Span("job.mod", 8, 5, 90, 99))
    program = Program(
        (first, Opaque("Set doGrün;\nReset b;", span=span), replace(second, events=(event,)), third)
    )
    made = pair.translate(program)
    texts = [s.text for s in made.program.statements if isinstance(s, Opaque)]
    assert texts == ["; Set doGr?n;", "; Reset b;", "; SetDO doGlue,1;"]
    # Beside what a short move takes longer on a controller that settles longer.
    assert [note.span.line for note in made.losses if note.span is not None] == [7, 8]
    assert not any(move.events for move in made.program.moves)


def test_arcs_that_the_tool_does_not_follow_rigidly_turn_from_pose_to_pose(between) -> None:
    pair = between("abb", "ur")
    arc = MoveC(
        pair.target(AHEAD, (0.3, 0.0, 0.0)),
        pair.speed(MoveC),
        via=pair.target((0.03, 0.09, 0.0)),
    )
    made = pair.translate(Program((pair.joint(), arc)))
    assert made.program.moves[1].orientation is ArcOrientation.FIXED_FRAME
    assert "the tool turns evenly" in messages(made)


def test_a_vendor_without_a_dialect_gets_everything_as_it_is(between) -> None:
    pair = between("abb", "kuka")
    plain = replace(find_vendor("kuka"), speaks=None)
    program = corner(pair, Radius(0.02, 0.03, name="z20"))
    made = translate(
        program,
        (find_vendor("abb"), pair.robot(pair.old)),
        (plain, pair.robot(pair.new)),
    )
    assert [m.speed for m in made.program.moves] == [m.speed for m in program.moves]
    expected = 0.03 * cut_share("abb") / cut_share("kuka")
    assert made.program.moves[1].zone.reorientation == pytest.approx(expected, rel=1e-3)


def test_dialects_refuse_what_no_speed_has() -> None:
    from flyby.core.dialect import Dialect, MoveWords

    with pytest.raises(InputError, match="colour"):
        MoveWords((Radius,), frozenset({"colour"}))
    with pytest.raises(InputError, match="'tcp' is not among"):
        MoveWords((Radius,), frozenset(), frozenset({"tcp"}))
    words = MoveWords((Radius,), frozenset({"tcp"}))
    with pytest.raises(InputError, match="pace"):
        Dialect(words, words, words, "joint", "# ")
    assert Speed(tcp=1.0).tcp == 1.0


@pytest.mark.parametrize("back", [False, True])
def test_times_of_joint_moves_count_how_controllers_settle(back) -> None:
    """Both settle for 0.1 s at every stop, each for a time of its own."""
    names = ["abb/irb6640-180-255", "kuka/kr30-3"]
    old, new = map(side, reversed(names) if back else names)
    speed = Speed(joint_fraction=0.3) if back else Speed(tcp=1.2, reorientation=8.0)
    home = (0.0, -1.4, 1.6, 0.0, 0.9, 0.0) if back else (0.0, 0.2, 0.2, 0.0, 1.0, 0.0)
    turns = (home[0], 0.6, -0.4, 0.3)
    moves = tuple(MoveJ(JointTarget((turn, *home[1:])), speed, FINE) for turn in turns)
    program = Program(moves, start=JointTarget(home))
    made = translate(program, old, new)
    before = Controller(*old).run(program).timing.settled_durations()
    after = Controller(*new).run(made.program).timing.settled_durations()
    # KRL states speeds in whole percent.
    np.testing.assert_allclose(after, before, rtol=0.06)
    assert after.sum() == pytest.approx(before.sum(), rel=0.02)
    assert "instead of" not in messages(made)
