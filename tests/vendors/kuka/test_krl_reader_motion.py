"""KRL motions as moves: targets, speeds, zones, tools, frames."""

# ruff: noqa: E501 - lines of programs are as long as programs have them

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, SourceError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.event import EventAnchor
from flyby.core.program.move import MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.question import QuestionKind
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, WORLD
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius, VendorZone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.source.execution.answers import Answers
from flyby.core.spatial.pose import IDENTITY, Pose
from flyby.vendors.kuka.motion.arcs import beyond
from flyby.vendors.kuka.motion.configuration import KukaConfiguration
from flyby.vendors.kuka.values.angles import quaternion
from flyby.vendors.kuka.zone_kinds import C_VEL

SET = """$VEL_AXIS[1]=50
FOR i=1 TO 6
$VEL_AXIS[i]=50
$ACC_AXIS[i]=80
ENDFOR
$VEL={CP 0.25,ORI1 90,ORI2 120}
$ACC={CP 2,ORI1 300,ORI2 200}
$APO={CPTP 40,CDIS 12.5,CORI 6,CVEL 30}
$TOOL=gun
$BASE=table
"""
DATA_LIST = """DECL FRAME gun={X 10,Y 0,Z 200,A 0,B 90,C 0}
DECL FRAME table={X 800,Y -100,Z 50,A 30,B 0,C 0}
DECL E6POS XP1={X 100.5,Y 20,Z 30,A 10,B 20,C 30,S 2,T 35,E1 0,E2 0}
DECL E6POS XP2={X 200,Y 0,Z 30,A 10,B 20,C 30,S 2,T 35}
DECL E6AXIS XA={A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
INT i,h
"""


@pytest.fixture(scope="module")
def robot():

    return find_robot("kuka/kr30-3")


def one(krl, line, data=DATA_LIST, **options):
    (move,) = krl(SET + line, data, **options).moves
    return move


def test_ptp_to_a_position(krl):
    move = one(krl, "PTP XP1")
    assert isinstance(move, MoveJ)
    pose = Pose((100.5 / 1000, 0.02, 0.03), quaternion(10, 20, 30))
    assert move.target == PoseTarget(pose, KukaConfiguration(2, 35), (), "XP1")
    assert move.zone == FINE
    assert move.speed.joint_fraction == 0.5
    assert move.speed.joint_acceleration_fraction == 0.8
    assert move.speed.tcp is None
    assert move.tool.name == "gun" and move.tool.tcp == Pose((0.01, 0, 0.2), quaternion(0, 90, 0))
    assert move.work_object.name == "table"
    assert move.work_object.pose == Pose((0.8, -0.1, 0.05), quaternion(30, 0, 0))


def test_ptp_to_axis_values(krl):
    move = one(krl, "PTP XA C_PTP")
    degrees = (0, -90, 90, 0, 45, 0)
    assert move.target == JointTarget(tuple(map(math.radians, degrees)), (), "XA")
    assert move.zone == ContourFraction(0.4)


def test_lin_has_no_configuration_and_its_own_speeds(krl):
    move = one(krl, "LIN XP1 C_DIS")
    assert isinstance(move, MoveL)
    assert move.target.configuration is None
    speed = move.speed
    assert speed.tcp == 0.25 and speed.reorientation == math.radians(90)
    assert speed.tcp_acceleration == 2.0 and speed.reorientation_acceleration == math.radians(200)
    assert speed.joint_fraction == 1.0
    assert move.zone == Radius(0.0125, 0.0125, 0.0125)


@pytest.mark.parametrize(
    ("words", "zone"),
    [
        ("LIN XP1 C_ORI", Angle(math.radians(6))),
        ("LIN XP1 C_VEL", VendorZone(C_VEL, 0.3)),
        ("LIN XP1 C_DIS C_DIS", Radius(0.0125, 0.0125, 0.0125)),
        ("SLIN XP1 C_SPL", Radius(0.0125, 0.0125, 0.0125)),
        ("PTP XP1 C_PTP C_DIS", ContourFraction(0.4)),
        ("PTP XP1 C_DIS", Radius(0.0125, 0.0125, 0.0125)),
        ("SPTP XP1 C_DIS", Radius(0.0125, 0.0125, 0.0125)),
        ("LIN XP1", FINE),
        ("$APO.CDIS=0\nLIN XP1 C_DIS", Radius(0.0, 0.0, 0.0)),
        ("$APO.CPTP=150\nPTP XP1 C_PTP", ContourFraction(1.0)),
    ],
)
def test_approximation(krl, words, zone):
    assert one(krl, words).zone == zone


def test_without_advance_nothing_is_approximated(krl):
    program = krl(SET + "$ADVANCE=0\nLIN XP1 C_DIS", DATA_LIST)
    assert program.moves[0].zone == FINE
    assert any("$ADVANCE=0" in note.message for note in program.notes)


def test_approximation_that_the_motion_has_not(krl):
    with pytest.raises(SourceError, match=r"C_VEL is no approximation of a PTP"):
        one(krl, "PTP XP1 C_VEL")
    with pytest.raises(SourceError, match=r"C_PTP is no approximation of LIN"):
        one(krl, "LIN XP1 C_PTP")


def test_circ(krl):
    move = one(krl, "CIRC XP1,XP2 C_DIS")
    assert isinstance(move, MoveC)
    assert move.via.pose.position == (100.5 / 1000, 0.02, 0.03)
    assert move.target.name == "XP2"
    assert move.orientation is ArcOrientation.FIXED_FRAME
    assert one(krl, "$CIRC_TYPE=#PATH\nSCIRC XP1,XP2").orientation is ArcOrientation.FOLLOWS_ARC


def test_circ_by_angle(krl):
    body = "LIN {X 100,Y 0,Z 0,A 0,B 0,C 0}\nCIRC {X 0,Y 100,Z 0,A 0,B 0,C 0},{X -100,Y 0,Z 0,A 90,B 0,C 0}"
    whole = krl(SET + body, DATA_LIST).moves[1]
    part = krl(SET + body + ", CA 90", DATA_LIST).moves[1]
    assert whole.target.pose.position == (-0.1, 0, 0)
    assert part.target.pose.position == pytest.approx((0, 0.1, 0))
    assert part.via.pose.position == pytest.approx((0.1 * math.sqrt(0.5), 0.1 * math.sqrt(0.5), 0))
    assert part.target.pose.quaternion == whole.target.pose.quaternion
    _, *turn = krl(SET + body + ", CA 450", DATA_LIST).moves
    assert [move.zone == FINE for move in turn] == [False, True]
    assert turn[0].target.pose.position == pytest.approx(
        (0.1 * math.cos(math.radians(225)), 0.1 * math.sin(math.radians(225)), 0)
    )
    assert turn[-1].target.pose.position == pytest.approx((0, 0.1, 0))
    assert turn[-1].target.pose.quaternion == whole.target.pose.quaternion
    with pytest.raises(SourceError, match="at most 3600"):
        krl(SET + body + ", CA 4000", DATA_LIST)
    with pytest.raises(SourceError, match="CA depends on where the robot stands"):
        krl(SET + body.split("\n")[1] + ", CA 90", DATA_LIST)


@given(
    st.floats(0.05, 2.0),
    st.floats(0.2, 2.5),
    st.floats(0.2, 2.5),
    st.floats(1, 1000),
    st.booleans(),
    st.booleans(),
)
def test_arcs_stay_on_their_circle(radius, first, second, degrees, backwards, follows):
    points = [
        Pose((radius * math.cos(a), radius * math.sin(a), 0.3)) for a in (0, first, first + second)
    ]
    arcs, of_circle = beyond(*points, -degrees if backwards else degrees, follows)
    assert of_circle == pytest.approx(radius)
    for k, (middle, end) in enumerate(arcs):
        one = degrees / len(arcs)
        assert one < 360
        for pose, angle in ((middle, one * (k + 0.5)), (end, one * (k + 1))):
            turned = math.radians(-angle if backwards else angle)
            expected = (radius * math.cos(turned), radius * math.sin(turned), 0.3)
            np.testing.assert_allclose(pose.position, expected, atol=1e-6)


@pytest.mark.parametrize("radius", [100, 300])
def test_a_full_turn_is_driven_on_its_circle(krl, robot, radius):
    body = (
        "LIN {X 1500,Y 0,Z 1200,A 0,B 90,C 0}\n"
        f"CIRC {{X {1500 - radius},Y {radius}}},{{X {1500 - 2 * radius},Y 0}}, CA 360"
    )
    program = krl(f"$VEL.CP=0.1\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n{body}", "", robot=robot)
    driven = Controller(find_vendor("kuka"), robot).run(program).trajectory.position
    x, y, z = (driven - [1.5 - radius / 1000, 0, 1.2]).T
    assert np.hypot(np.hypot(x, y) - radius / 1000, z).max() < 2e-3 * radius / 1000
    length = np.linalg.norm(np.diff(driven, axis=0), axis=1).sum()
    assert length == pytest.approx(2 * math.pi * radius / 1000, rel=2e-3)


def test_missing_components_keep_the_present_value(krl):
    program = krl(SET + "PTP XP1\nLIN {Z 80}\nLIN {A 45}", DATA_LIST)
    _, up, turned = program.moves
    assert up.target.pose == Pose((100.5 / 1000, 0.02, 0.08), quaternion(10, 20, 30))
    assert turned.target.pose == Pose((100.5 / 1000, 0.02, 0.08), quaternion(45, 20, 30))
    program = krl(SET + "PTP XA\nPTP {A6 90}", DATA_LIST)
    assert program.moves[1].target.joints[4:] == (math.radians(45), math.radians(90))


def test_missing_components_need_a_known_place(krl):
    with pytest.raises(SourceError, match=r"leaves out Y, Z, A, B, C.*name the robot"):
        krl(SET + "PTP XA\nLIN {X 10}", DATA_LIST)
    with pytest.raises(SourceError, match="leaves out A2"):
        krl(SET + "PTP {A1 10}", DATA_LIST)


def test_the_robot_knows_where_it_stands(krl, robot):
    program = krl(
        "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nPTP XA\nLIN {Z 1500}\nh=$POS_ACT\nLIN h",
        (DATA_LIST.replace(",h", "") + "DECL E6POS h"),
        robot=robot,
    )
    flange = robot.flange_pose(np.radians([0, -90, 90, 0, 45, 0]))
    x, y, _ = flange.position
    np.testing.assert_allclose(program.moves[1].target.pose.position, (x, y, 1.5), atol=1e-9)
    assert program.moves[2].target.pose == program.moves[1].target.pose


def test_behind_a_move_that_cannot_be_driven_the_position_is_that_before_it(krl, robot):
    body = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nPTP XA\nLIN {X 9000}\nx=$AXIS_ACT\nPTP x"
    first, _, last = krl(body, DATA_LIST + "\nDECL E6AXIS x", robot=robot).moves
    assert last.target.joints == pytest.approx(first.target.joints)


def test_another_tool_changes_where_the_tool_is(krl, robot):
    body = (
        "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n"
        "PTP {X 1300,Y 100,Z 1500,A 0,B 90,C 0,S 2,T 35}\n$TOOL=gun\nLIN_REL {X 50}"
    )
    program = krl(body, DATA_LIST, robot=robot)
    start = program.moves[0].target.pose @ program.moves[1].tool.tcp
    moved = program.moves[1].target.pose
    np.testing.assert_allclose(moved.position, np.add(start.position, (0.05, 0, 0)), atol=1e-6)
    np.testing.assert_allclose(moved.quaternion, start.quaternion, atol=1e-7)
    unnamed = krl(body, DATA_LIST).moves[1].target.pose  # the frames stand still: no kinematics
    np.testing.assert_allclose(unnamed.position, moved.position, atol=1e-12)
    joints = body.replace(
        "X 1300,Y 100,Z 1500,A 0,B 90,C 0,S 2,T 35", "A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0"
    )
    with pytest.raises(SourceError, match="name the robot"):
        krl(joints, DATA_LIST)


def test_relative_motions(krl):
    program = krl(SET + "PTP XP1\nLIN_REL {X 10,Z -5} C_DIS\nPTP_REL {Y 7}", DATA_LIST)
    first, second, third = program.moves
    x, y, z = first.target.pose.position
    np.testing.assert_allclose(second.target.pose.position, (x + 0.01, y, z - 0.005), atol=1e-12)
    np.testing.assert_allclose(third.target.pose.position, (x + 0.01, y + 0.007, z - 0.005))
    assert isinstance(third, MoveJ) and third.target.configuration is None
    program = krl(SET + "PTP XA\nPTP_REL {A1 15,A6 -30}", DATA_LIST)
    assert program.moves[1].target.joints[0] == math.radians(15)
    assert program.moves[1].target.joints[5] == math.radians(-30)


def test_relative_in_tool_and_base(krl):
    body = "LIN {X 0,Y 0,Z 0,A 90,B 0,C 0}\nLIN_REL {X 10,B 20} %s"
    in_tool = krl(SET + body % "#TOOL", DATA_LIST).moves[1].target.pose
    in_base = krl(SET + body % "#BASE", DATA_LIST).moves[1].target.pose
    start = Pose((0, 0, 0), quaternion(90, 0, 0))
    step = Pose((0.01, 0, 0), quaternion(0, 20, 0))
    tool = start @ step
    np.testing.assert_allclose(in_tool.position, tool.position, atol=1e-12)
    np.testing.assert_allclose(in_tool.quaternion, tool.quaternion, atol=1e-12)
    np.testing.assert_allclose(in_base.position, (0.01, 0, 0), atol=1e-12)
    turned = Pose((0, 0, 0), quaternion(0, 20, 0)) @ start
    np.testing.assert_allclose(in_base.quaternion, turned.quaternion, atol=1e-12)


def test_constant_orientation(krl):
    program = krl(SET + "LIN XP1\n$ORI_TYPE=#CONSTANT\nLIN {X 0,Y 0,Z 0,A 77,B 0,C 0}", DATA_LIST)
    first, second = program.moves
    np.testing.assert_allclose(
        second.target.pose.quaternion, first.target.pose.quaternion, atol=1e-12
    )
    assert second.target.pose.position == (0, 0, 0)
    program = krl(SET + "$ORI_TYPE=#JOINT\nLIN XP1", DATA_LIST)
    assert any("#JOINT" in note.message for note in program.notes)


def test_geometric_operator(krl):
    offset = "{FRAME: X 0,Y 0,Z 100,A 0,B 0,C 0}"
    move = one(krl, f"PTP XP1:{offset}")
    expected = Pose((100.5 / 1000, 0.02, 0.03), quaternion(10, 20, 30)) @ Pose((0, 0, 0.1))
    np.testing.assert_allclose(move.target.pose.position, expected.position, atol=1e-12)
    np.testing.assert_allclose(move.target.pose.quaternion, expected.quaternion, atol=1e-12)


@given(st.lists(st.floats(-180, 180), min_size=12, max_size=12))
def test_geometric_operator_chains_frames(numbers):
    from flyby.vendors.kuka.values.frames import frame_of, pose_of
    from flyby.vendors.kuka.values.operators import apply
    from flyby.vendors.kuka.values.values import Struct

    first, second = (
        Struct("frame", dict(zip("xyzabc", n, strict=True))) for n in (numbers[:6], numbers[6:])
    )
    chained = apply(":", first, second)
    expected = pose_of(first.fields) @ pose_of(second.fields)
    np.testing.assert_allclose(
        pose_of(chained.fields).matrix(), expected.matrix(), rtol=0, atol=1e-9
    )
    back = apply(":", chained, frame_of(pose_of(second.fields).inverse()))
    np.testing.assert_allclose(
        pose_of(back.fields).matrix(), pose_of(first.fields).matrix(), rtol=0, atol=1e-9
    )


def test_stationary_tool(krl):
    move = one(krl, "$IPO_MODE=#TCP\nLIN XP1")
    assert not move.tool.robot_held and move.tool.name == "table"
    assert move.work_object.robot_held and move.work_object.name == "gun"
    assert move.tool.tcp == Pose((0.8, -0.1, 0.05), quaternion(30, 0, 0))


def test_null_frames_are_flange_and_world(krl):
    move = one(krl, "$TOOL=$NULLFRAME\n$BASE=$WORLD\nLIN XP1")
    assert move.tool == FLANGE and move.work_object == WORLD


def test_load(krl):
    load = "{M 12.5,CM {X 10,Y 0,Z 100,A 0,B 0,C 90},J {X 0.1,Y 0.2,Z 0.3}}"
    move = one(krl, f"$LOAD={load}\nLIN XP1")
    assert move.tool.load.mass == 12.5 and move.tool.load.centre == (0.01, 0, 0.1)
    assert move.tool.load.inertia == (0.1, 0.2, 0.3)
    assert move.tool.load.axes == pytest.approx(quaternion(0, 0, 90))
    assert move.load is None
    assert one(krl, "$LOAD={M -1,CM {X 0},J {X 0}}\nLIN XP1").tool.load is None


def test_override_scales_speeds_only(krl):
    program = krl(SET + "$OV_PRO=50\nPTP XP1\nLIN XP2", DATA_LIST)
    joint, line = program.moves
    assert joint.speed.joint_fraction == 0.25 and joint.speed.joint_acceleration_fraction == 0.8
    assert line.speed.tcp == 0.125 and line.speed.tcp_acceleration == 2.0


def test_the_slowest_axis_counts(krl):
    program = krl(SET + "$VEL_AXIS[3]=20\nPTP XP1", DATA_LIST)
    assert program.moves[0].speed.joint_fraction == 0.2
    assert any("differs between axes" in note.message for note in program.notes)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("$VEL.CP=0\nLIN XP1", r"\$VEL.CP is 0"),
        ("$VEL_AXIS[2]=-5\nPTP XP1", r"\$VEL_AXIS\[2\] is -5"),
        ("$OV_PRO=0\nPTP XP1", r"\$OV_PRO is 0"),
        ("$APO.CDIS=-1\nLIN XP1 C_DIS", r"\$APO.CDIS is -1"),
        ("LIN XA", "takes a position, not axis values"),
        ("PTP XP7", "unknown point 'XP7'"),
        ("PTP h", "depends on the value of h"),
        ("i=1\nPTP i", "is a position or axis values, not 1"),
        ("PTP {X 1,Y 1,Z 1,A 0,B 0,C 0,S 99}", "Status lies between"),
        ("PTP {X 1,Q 2}", "has no component Q"),
        ("PTP {X 1,Y 1,Z 1,A 0,B 0,C 0,E1 5}", "E1 is sent to 5.*name the robot"),
        ("SPLINE\nLIN XP1\nENDSPLINE", "LIN stands where SPL, SLIN, SCIRC"),
        ("PTP ?", "has no target"),
        ("LIN", "has no target"),
    ],
)
def test_refusals_name_line_and_reason(krl, line, message):
    with pytest.raises(SourceError, match=message) as caught:
        one(krl, line)
    assert caught.value.span.file == "demo.src"
    assert caught.value.span.line >= 10


def test_external_axes(krl, robot):
    slide = Joint("E1", IDENTITY, (1, 0, 0), -1, 9, 1, 1, kind=JointKind.PRISMATIC)
    turn = Joint("E2", IDENTITY, (0, 0, 1), -9, 9, 1, 1)
    axes = [ExternalAxis(slide, ExternalRole.TRACK), ExternalAxis(turn, ExternalRole.TABLE)]
    moved = robot.with_external_axes(axes)
    body = SET + "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0,E1 1500,E2 45}\nPTP {A1 5,E2 90}"
    first, second = krl(body, DATA_LIST, robot=moved).moves
    assert first.target.external == (1.5, math.radians(45))
    assert second.target.external == (1.5, math.radians(90))
    program = krl(SET + "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0,E3 1}", DATA_LIST, robot=moved)
    assert any(
        "E3 is sent to 1 here, but the robot has E1 and E2 alone" in n.message
        for n in program.notes
    )
    coupled = krl(
        SET + "$BASE=EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,table)\nLIN XP2",
        DATA_LIST,
        robot=moved,
    ).moves[0]
    assert coupled.work_object.moved_by == "E2"
    assert coupled.work_object.user.position == (0.8, -0.1, 0.05)


@pytest.mark.parametrize(("name", "number"), [("rail", 3), ("E3", None)])
def test_an_external_axis_is_the_one_of_its_number(krl, robot, name, number):
    slide = Joint(name, IDENTITY, (1, 0, 0), -1, 9, 1, 1, kind=JointKind.PRISMATIC)
    moved = robot.with_external_axes([ExternalAxis(slide, ExternalRole.TRACK, number=number)])
    body = SET + "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0,E1 9,E3 1500}\nPTP {A1 5}\nPTP $AXIS_ACT"
    program = krl(body, DATA_LIST, robot=moved)
    assert program.moves[0].target.external == (1.5,)
    assert any(
        "E1 is sent to 9 here, but the robot has E3 alone" in n.message for n in program.notes
    )
    text = "".join(find_vendor("kuka").write(program, moved).values())
    assert "E3 1500" in text and "E1" not in text
    home = program.moves[0]
    shifted = replace(home, target=replace(home.target, external=(1.25,)))
    changed = program.with_moves((shifted, *program.moves[1:]))
    (file,) = find_vendor("kuka").patch(changed, moved).values()
    assert "E1 9,E3 1250" in file.text


def test_where_an_axis_stands_that_the_robot_lacks_counts_for_nothing(krl, robot):
    body = SET + "PTP XHOME\nhome=XHOME\nhome.E2=$AXIS_ACT.E2\nPTP home"
    program = krl(body, DATA_LIST + "DECL E6AXIS home\n", robot=robot)
    assert [m.target.external for m in program.moves] == [(), ()]


def test_two_external_axes_of_one_number_are_refused(krl, robot):
    slides = [Joint(n, IDENTITY, (1, 0, 0), -1, 9, 1, 1) for n in ("a", "b")]
    axes = [ExternalAxis(slide, ExternalRole.TABLE, number=2) for slide in slides]
    with pytest.raises(InputError, match=r"axis b is E2 of positions, as another one is"):
        krl("PTP XHOME", DATA_LIST, robot=robot.with_external_axes(axes))


def test_kinematics_functions(krl, robot):
    body = (
        "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nPTP XA\np=FORWARD(XA,err)\np.Z=p.Z-50\n"
        "q=INVERSE(p,XA,err)\nIF err==0 THEN\nPTP q\nENDIF\nLIN p"
    )
    data = DATA_LIST + "DECL E6POS p\nDECL E6AXIS q\nINT err"
    program = krl(body, data, robot=robot)
    joint, line = program.moves[1], program.moves[2]
    flange = robot.flange_pose(np.array(joint.target.joints))
    np.testing.assert_allclose(flange.position, line.target.pose.position, atol=1e-7)
    with pytest.raises(SourceError, match="name the robot"):
        krl(body, data)


def test_inverse_tells_the_program_of_a_pose_that_it_finds_no_axes_for(krl, robot):
    body = (
        "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nPTP XA\np=FORWARD(XA,err)\np.X=p.X+9000\n"
        "q=INVERSE(p,XA,err)\nIF err==0 THEN\nPTP q\nELSE\nPTP {A1 5}\nENDIF"
    )
    data = DATA_LIST + "DECL E6POS p\nDECL E6AXIS q\nINT err"
    program = krl(body, data, robot=robot)
    assert [m.target.joints[0] for m in program.moves][1] == pytest.approx(math.radians(5))
    assert any("INVERSE" in n.message and "cannot be reached" in n.message for n in program.notes)
    with pytest.raises(SourceError, match="cannot be reached"):
        krl(body.replace("q=INVERSE(p,XA,err)", "q=INVERSE(p,XA)"), data, robot=robot)


@pytest.mark.parametrize(
    "call", ["q=INVERSE(p,XA,err)", "q=INVERSE(p,XA)", "p=FORWARD(q,err)", "p=FORWARD(q)"]
)
def test_kinematics_of_a_place_that_nobody_knows_leave_the_rest_of_the_program(krl, robot, call):
    """Neither what they give nor whether they fail is known; the program goes on."""
    body = f"PTP XA\np.X=seen\nq.A1=seen\n{call}\nIF err==0 THEN\nn=1\nENDIF\nLIN p\nPTP XA"
    data = DATA_LIST + "DECL E6POS p\nDECL E6AXIS q\nINT err=0,n\nREAL seen"
    body = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n" + body
    program = krl(body, data, robot=robot, answers=Answers(goes_on=True))
    assert [bool(move.open) for move in program.moves] == [False, True, False]
    assert "seen" in program.moves[1].open
    asked = "err" in call
    assert any(q.kind is QuestionKind.BRANCH for q in program.questions) == asked


def test_with_holds_for_one_motion(krl):
    body = "SLIN XP1 WITH $VEL.CP=0.1, $APO.CDIS=3, $TOOL=$NULLFRAME C_DIS\nSLIN XP2 C_DIS"
    first, second = krl(SET + body, DATA_LIST).moves
    assert first.speed.tcp == 0.1 and second.speed.tcp == 0.25
    assert first.zone.tcp == 0.003 and second.zone.tcp == 0.0125
    assert first.tool == FLANGE and second.tool.name == "gun"
    assert first.speed.reorientation == math.radians(90)


def test_moves_to_where_the_robot_is(krl):
    program = krl(
        SET + "here=$AXIS_ACT\nPTP $AXIS_ACT\nPTP here C_PTP\nPTP XA",
        (DATA_LIST + "DECL E6AXIS here"),
    )
    assert len(program.moves) == 1
    kept = [s for s in program.statements if isinstance(s, Opaque)]
    assert [s.text for s in kept] == ["PTP $AXIS_ACT", "PTP $AXIS_ACT C_PTP"]
    assert [s.stops for s in kept] == [True, False]


def test_position_of_the_last_target(krl):
    body = "LIN XP1\np=$POS_ACT\np.X=p.X+10\nLIN p"
    program = krl(SET + body, DATA_LIST + "DECL E6POS p")
    moves = program.moves
    assert moves[1].target.pose.position[0] == pytest.approx(0.1105)
    between = program.statements[program.statements.index(moves[0]) + 1]
    assert between == Wait(0.0)


def test_triggers(krl):
    body = (
        "TRIGGER WHEN DISTANCE=0 DELAY=20 DO $OUT[1]=TRUE\n"
        "TRIGGER WHEN PATH=-15 DELAY=-50 DO glue(1,2) PRIO=-1\n"
        "LIN XP1\nLIN XP2\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[2]=TRUE"
    )
    program = krl(SET + body, DATA_LIST)
    start, end = program.moves[0].events
    assert (start.anchor, start.distance, start.time) == (EventAnchor.START, 0.0, -0.02)
    assert start.text == "$OUT[1]=TRUE"
    assert (end.anchor, end.distance, end.time) == (EventAnchor.END, 0.015, 0.05)
    assert end.text == "glue(1,2) PRIO=-1"
    assert program.moves[1].events == ()
    assert program.statements[-1] == Opaque("$OUT[2]=TRUE")


def test_speeds_never_set_are_assumed_and_said(krl):
    program = krl("$TOOL=$NULLFRAME\nLIN XP1\nPTP XP2 C_PTP", DATA_LIST)
    assert program.moves[0].speed.tcp == 2.0
    said = " ".join(note.message for note in program.notes)
    assert "DEF_VEL_CP=2 is assumed" in said and "$VEL_AXIS is never set" in said


@given(st.lists(st.floats(-3000, 3000, allow_nan=False), min_size=6, max_size=6))
def test_any_position_is_read_as_it_stands(krl, numbers):
    x, y, z, a, b, c = (float(f"{n:.6f}") for n in numbers)
    line = f"LIN {{X {x:.6f},Y {y:.6f},Z {z:.6f},A {a:.6f},B {b:.6f},C {c:.6f}}}"
    pose = krl(SET + line, DATA_LIST).moves[0].target.pose
    assert pose.position == (x / 1000, y / 1000, z / 1000)
    np.testing.assert_allclose(pose.quaternion, quaternion(a, b, c), atol=1e-12)


def test_errors_are_of_the_project(krl):
    with pytest.raises(FlybyError):
        krl("LIN XP1")


def test_the_present_position_is_one_in_its_own_base_only(krl):
    """What was read in one base is another place in the next: that is not where the robot is."""
    data = DATA_LIST + "DECL E6POS here"
    program = krl(SET + "here=$POS_ACT\nPTP here\nPTP XA", data)
    assert [s.text for s in program.statements if isinstance(s, Opaque)] == ["PTP $AXIS_ACT"]
    with pytest.raises(SourceError, match="where the robot stands"):
        krl(SET + "here=$POS_ACT\n$BASE.X=100\nPTP here\nPTP XA", data)


UNSET = re.compile(r"(\$\w+) is set nowhere before this motion: .*; set it, as by BAS\(#")


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN {X 2}", ["$TOOL", "$BASE"]),
        ("PTP {X 1,Y 2,Z 3,A 0,B 0,C 0}", ["$TOOL", "$BASE"]),
        ("$BASE=$NULLFRAME\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}", ["$TOOL"]),
        ("$TOOL={X 0,Y 0,Z 90,A 0,B 0,C 0}\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}", ["$BASE"]),
        ("BAS(#TOOL,0)\nBAS(#BASE,0)\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}", []),
        ("BAS(#INITMOV,0)\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}", []),
        ("$TOOL.Z=90\n$BASE.X=1\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}", []),
        # Axis values mean the same with every tool.
        ("PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}", []),
    ],
)
def test_frames_that_nobody_sets_are_told_once(krl, body, told) -> None:
    notes = [found for n in krl(body).notes if (found := UNSET.match(n.message))]
    assert [found[1] for found in notes] == told
