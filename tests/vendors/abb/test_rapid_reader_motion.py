"""Moves, their speeds, zones, tools and frames, and the settings that hold for them."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from flyby.core.errors import SourceError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import MoveC, MoveJ, MoveL, Wait
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Radius
from flyby.core.spatial.pose import Pose
from flyby.vendors.abb.motion.configuration import AbbConfiguration
from flyby.vendors.abb.run.reader import read
from flyby.vendors.abb.values import predefined

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
P = f"[[500,-100,600],[0,0,1,0],[-1,0,1,2],{UNUSED}]"
Q = f"[[400,0,600],[0,1,0,0],[0,0,0,0],{UNUSED}]"
J = f"[[0,90,-45,0,30,180],{UNUSED}]"
DATA = f"""
  CONST robtarget p:={P};
  CONST robtarget q:={Q};
  CONST jointtarget home:={J};
  CONST speeddata vFast:=[1234,90,10,20];
  CONST zonedata zOwn:=[FALSE,20,10,40,5,6,7];
  PERS tooldata tGun:=[TRUE,[[0,0,100],[0,0,1,0]],[5,[0,0,50],[1,0,0,0],0.1,0.2,0.3]];
  PERS tooldata tFixed:=[FALSE,[[1000,0,500],[1,0,0,0]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[1000,0,0],[1,0,0,0]],[[0,50,0],[0,0,0,1]]];
  PERS wobjdata wTurn:=[FALSE,FALSE,"STN1",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS wobjdata wHeld:=[TRUE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,10],[1,0,0,0]]];
  PERS loaddata part:=[3,[0,0,20],[1,0,0,0],0,0,0];
"""


def program(body, data=DATA, **options):
    text = f"MODULE M\n{data}\nPROC main()\n{body}\nENDPROC\nENDMODULE"
    return read(text, "a.mod", **options)


def move(body, data=DATA, **options):
    return program(body, data, **options).moves[-1]


def refusal(body, data=DATA, **options):
    with pytest.raises(SourceError) as caught:
        program(body, data, **options)
    assert caught.value.span is not None
    return str(caught.value)


def test_kinds_units_and_names():
    at_p = PoseTarget(
        Pose((0.5, -0.1, 0.6), (0, 0, 1, 0)), AbbConfiguration(-1, 0, 1, 2), (), name="p"
    )
    at_q = PoseTarget(Pose((0.4, 0, 0.6), (0, 1, 0, 0)), AbbConfiguration(0, 0, 0, 0), (), "q")
    v100, z10 = predefined.speed("v100"), predefined.zone("z10")
    home = JointTarget(tuple(map(math.radians, (0, 90, -45, 0, 30, 180))), (), "home")
    assert program(
        "MoveAbsJ home\\NoEOffs,v100,z10,tool0;\nMoveJ p,v100,fine,tool0;\n"
        "MoveL \\Conc,q,v100,z10,tool0\\WObj:=wobj0;\nMoveC p,q,V100,Z10,tool0;"
    ).moves == (
        MoveJ(home, v100, z10),
        MoveJ(at_p, v100, FINE),
        MoveL(at_q, v100, z10),
        MoveC(at_q, v100, z10, via=at_p),
    )


def test_inline_literals_have_no_name():
    at = move(f"MoveL {P},[100,45,0,0],[FALSE,7,8,16,1,2,3],tool0;")
    assert at.target.name is None and at.speed.name is None
    assert at.speed.tcp == pytest.approx(0.1)
    assert at.speed.reorientation == pytest.approx(math.radians(45))
    assert (at.speed.external_linear, at.speed.external_angular) == (None, None)
    assert at.zone == Radius(0.007, 0.008, 0.016, math.radians(1), 0.002, math.radians(3))


def test_declared_speeds_and_zones_keep_their_names():
    at = move("MoveL p,vFast,zOwn,tool0;")
    assert at.speed.name == "vFast" and at.speed.tcp == pytest.approx(1.234)
    # The reorientation zone is at least as large as the TCP's.
    assert at.zone == Radius(0.02, 0.02, 0.04, math.radians(5), 0.006, math.radians(7), name="zOwn")


def test_options_override_speed_and_zone():
    at = move("MoveL p,v1000\\V:=250,z50\\Z:=80,tool0;")
    assert at.speed.tcp == pytest.approx(0.25) and at.speed.name is None
    assert (at.zone.tcp, at.zone.reorientation, at.zone.name) == (0.08, 0.08, None)
    timed = move("MoveL p,v1000\\T:=2.5,z50\\Inpos:=inpos50,tool0;")
    assert timed.speed.duration == 2.5 and timed.zone == FINE
    assert move("MoveL p,v1000\\V:=1000,z50\\Z:=50,tool0;").speed.name == "v1000"


@pytest.mark.parametrize(
    ("point", "seconds"),
    [
        ("inpos50", []),
        ("stoptime0_5", [0.5]),
        ("fllwtime1_5", [1.5]),
        ('[stoptime,FALSE,[0,0,0,0],0.8,0,"",0,0]', [0.8]),
        ('[inpos,TRUE,[25,40,0.1,5],0,0,"",0,0]', [0.1]),
    ],
)
def test_the_robot_stands_at_a_stop_point(point, seconds):
    read = program(f"MoveL p,v100,z50\\Inpos:={point},tool0;\nMoveL q,v100,fine,tool0;")
    assert [s.duration for s in read.statements if isinstance(s, Wait)] == seconds
    assert isinstance(read.statements[0], MoveL) and read.moves[0].zone == FINE
    assert not read.questions


def test_tools_and_work_objects():
    at = move("MoveL p,v100,z10,tGun\\WObj:=wTable;")
    load = Load(5, (0, 0, 0.05), (0.1, 0.2, 0.3))
    assert at.tool == Tool("tGun", Pose((0, 0, 0.1), (0, 0, 1, 0)), load)
    user, frame = Pose((1, 0, 0)), Pose((0, 0.05, 0), (0, 0, 0, 1))
    assert at.work_object == WorkObject("wTable", user, frame)
    assert move("MoveL p,v100,z10,tool0;").tool == FLANGE
    assert move("MoveL p,v100,z10,tool0;").work_object == WORLD
    assert move("MoveL p,v100,z10,tGun\\WObj:=wTurn;").work_object.moved_by == "STN1"
    held = move("MoveL p,v100,z10,tFixed\\WObj:=wHeld;")
    assert not held.tool.robot_held and held.work_object.robot_held and held.tool.load is None


def test_tool_and_work_object_must_not_both_be_held_or_both_stand():
    assert "robhold" in refusal("MoveL p,v100,z10,tFixed;")
    assert "robhold" in refusal("MoveL p,v100,z10,tGun\\WObj:=wHeld;")


def test_loads():
    part = Load(3, (0, 0, 0.02), name="part")
    assert move("GripLoad part;\nMoveL p,v100,z10,tGun;").load == part
    assert move("GripLoad part;\nGripLoad load0;\nMoveL p,v100,z10,tGun;").load is None
    total = move("GripLoad part;\nMoveL p,v100,z10,tGun\\TLoad:=part;")
    assert total.load is None and total.tool == replace(
        move("MoveL p,v100,z10,tGun;").tool, load=part
    )


@pytest.mark.parametrize(
    ("setting", "joint", "linear"),
    [
        *[("", True, True), ("ConfJ\\Off;", False, True), ("ConfL\\Off;", True, False)],
        *[("ConfJ\\Off;\nConfJ;", True, True), ("ConfL\\Off;\nConfL \\On;", True, True)],
    ],
)
def test_configurations_count_unless_switched_off(setting, joint, linear):
    moves = program(f"{setting}\nMoveJ p,v100,z10,tool0;\nMoveL p,v100,z10,tool0;").moves
    assert [m.target.configuration is not None for m in moves] == [joint, linear]


def test_velocity_settings():
    at = move("VelSet 50,800;\nMoveL p,vFast,z10,tool0;\nMoveL p,v2000,z10,tool0;")
    assert at.speed.tcp == pytest.approx(0.8) and at.speed.name is None
    assert at.speed.reorientation == pytest.approx(math.radians(250))
    slow = move("VelSet 50,800;\nMoveL p,v100\\T:=3,z10,tool0;")
    assert slow.speed.duration == 6 and slow.speed.tcp == pytest.approx(0.05)
    assert move("VelSet 50,800;\nVelSet 100,5000;\nMoveL p,v100,z10,tool0;").speed.name == "v100"


def test_acceleration_settings():
    assert move("AccSet 40,100;\nMoveL p,v100,z10,tool0;").speed.joint_acceleration_fraction == 0.4
    assert move("AccSet 50,30;\nMoveL p,v100,z10,tool0;").speed.jerk_fraction == 0.3
    assert move("AccSet 50,5;\nMoveL p,v100,z10,tool0;").speed.jerk_fraction == 0.1
    assert move("AccSet 5,100;\nMoveL p,v100,z10,tool0;").speed.joint_acceleration_fraction == 0.2
    limited = program("PathAccLim TRUE\\AccMax:=4,TRUE\\DecelMax:=3;\nMoveL p,v100,z10,tool0;")
    assert limited.moves[0].speed.tcp_acceleration == 3
    assert "smaller limit" in limited.notes[0].message
    off = "PathAccLim TRUE\\AccMax:=4,FALSE;\nPathAccLim FALSE,FALSE;\nMoveL p,v100,z10,tool0;"
    assert move(off).speed.tcp_acceleration is None


def test_arcs_and_singularities():
    arc = "MoveC p,q,v100,z10,tool0;"
    assert move(arc).orientation is ArcOrientation.FOLLOWS_ARC
    fixed = move(f"CirPathMode \\ObjectFrame;\n{arc}")
    assert fixed.orientation is ArcOrientation.FIXED_FRAME
    other = program(f"CirPathMode \\CirPointOri;\n{arc}")
    assert "as with \\PathFrame" in other.notes[0].message
    notes = program("SingArea \\Wrist;\nMoveL p,v100,z10,tool0;").notes
    assert "emulated as \\Off" in notes[-1].message
    assert "LockAxis4" in program(f"SingArea \\LockAxis4;\n{arc}").notes[0].message
    body = "SingArea\\Wrist;\nMoveJ p,v100,z10,tool0;\nSingArea\\Off;\nMoveL p,v100,z10,tool0;"
    assert len(program(body).moves) == 2


def test_program_displacement():
    shift = "PDispSet [[10,20,30],[0,0,0,1]];\n"
    at = move(shift + "MoveL p,v100,z10,tool0;")
    # A half turn about z, then the shift.
    assert at.target.pose.position == pytest.approx((-0.49, 0.12, 0.63))
    assert move(shift + "MoveAbsJ home,v100,z10,tool0;").target.name == "home"
    assert move(shift + "PDispOff;\nMoveL p,v100,z10,tool0;") == move("MoveL p,v100,z10,tool0;")


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("AccSet 50,0;", "ramp"),
        ("AccSet 120,100;", "percentage"),
        ("VelSet 0,100;", "percentage"),
        ("WorldAccLim\\On:=0;", "above zero"),
        ("SpeedRefresh 150;", "0 to 100 percent"),
        ("PathAccLim TRUE,FALSE;", "\\accmax needs a value"),
        ("PathAccLim TRUE\\AccMax:=0,FALSE;", "above zero"),
        ("PDispOn p,tool0;", "present position, which is not known"),
        ("MoveExtJ home,v100,z10;", "leaves the arm where it is"),
        ("MoveL p,v100,z10;", "MoveL takes 4 arguments (ToPoint, Speed, Zone, Tool), not 3"),
        ("MoveL p,v100,z10,tool0\\WObjj:=wTable;", "did you mean wobj?"),
        ("MoveL p,v100,z10,tGunn;", "unknown tool 'tGunn': did you mean tGun?"),
        ("MoveL pp1,v100,z10,tool0;", "unknown target 'pp1'"),
        ("MoveL *,v100,z10,tool0;", "not in the text"),
        (
            "MoveL home,v100,z10,tool0;",
            "the target of MoveL: home is a jointtarget, a robtarget is wanted",
        ),
        ("MoveJ v100,p,z10,tool0;", "the target of MoveJ: v100 is a speeddata, a robtarget"),
        ("MoveL p.trans,v100,z10,tool0;", "MoveL: p.trans is a pos, a robtarget is wanted"),
        ("MoveL [1,2],v100,z10,tool0;", "the target of MoveL: a robtarget has 4 components"),
        ("MoveL p,z10,v100,tool0;", "the speed of MoveL: z10 is a zonedata, a speeddata is"),
        ("MoveL p,[0,500,100,100],z10,tool0;", "v_tcp must be above zero, not 0 mm/s"),
        ("MoveL p,[-5,500,100,100],z10,tool0;", "v_tcp must be above zero, not -5 mm/s"),
        ("MoveL p,v9,[FALSE,-5,5,5,1,5,1],tool0;", "pzone_tcp must be zero or more, not -5"),
        ("MoveL p,v100\\V:=0,z10,tool0;", "\\V must be above zero, not 0 mm/s"),
        ("MoveL p,v100\\T:=-1,z10,tool0;", "\\T must be above zero, not -1 s"),
        ("MoveL p,v100,z10\\Z:=-1,tool0;", "zero or more"),
        (f"MoveL [[0,0,0],[1,0,0,0.5],[0,0,0,0],{UNUSED}],v100,z10,tool0;", "length 1"),
        (f"MoveL [[0,0,0],[0,0,0,0],[0,0,0,0],{UNUSED}],v100,z10,tool0;", "length 1"),
        (f"MoveL [[0,0,0],[1,0,0,0],[0,0,0,9],{UNUSED}],v100,z10,tool0;", "cfx"),
        (f"MoveL [[0,0,0],[1,0,0,0],[0,0.5,0,0],{UNUSED}],v100,z10,tool0;", "whole numbers"),
        (f"MoveAbsJ [[0,0,9E9,0,0,0],{UNUSED}],v100,z10,tool0;", "axis 3 of the arm"),
    ],
)
def test_refusals(body, words):
    assert words in refusal(body)


@pytest.mark.parametrize(
    ("text", "as_if", "words"),
    [
        ("MoveL p,v100,z10,tPaint;", "MoveL p,v100,z10,tool0;", "unknown tool 'tPaint': declare"),
        ("MoveL p,v100,z10,tool1;", "MoveL p,v100,z10,tool0;", "did you mean tool0? If not:"),
        ("MoveL p,v100,z10,tool0\\WObj:=wJig;", "MoveL p,v100,z10,tool0;", "object 'wJig'"),
        ("MoveL p,v101,z10,tool0;", "MoveL p,v100\\V:=101,z10,tool0;", "unknown speed 'v101'"),
        ("MoveL p,v100,z12,tool0;", "MoveL p,v100,[FALSE,12,18,18,1.8,18,1.8],tool0;", "'z12'"),
        ("MoveL p,vQuick,z10,tool0;", "MoveL p,[1000,500,1,1],z10,tool0;", "speed 'vQuick'"),
        ("MoveL p\\ID:=10,v100,z10,tool0;", "MoveL p,v100,z10,tool0;", "MultiMove"),
        ("MoveL p,v100,z10,tool0\\Corr;", "MoveL p,v100,z10,tool0;", "\\CORR"),
        ("StorePath;\nMoveL p,v100,z10,tool0;", "MoveL p,v100,z10,tool0;", "StorePath"),
        ("SyncMoveOn s,all;\nMoveL p,v100,z10,tool0;", "MoveL p,v100,z10,tool0;", "drives alone"),
        ("IndAMove M7,1\\ToAbsNum:=9,20;\nMoveL p,v9,z1,tool0;", "MoveL p,v9,z1,tool0;", "IndA"),
        ("SpeedRefresh 50;\nMoveL p,v100,z10,tool0;", "MoveL p,v100\\V:=50,z10,tool0;", ""),
        ("WorldAccLim\\On:=3;\nMoveL p,v9,z1,tool0;",
         "PathAccLim TRUE\\AccMax:=3,TRUE\\DecelMax:=3;\nMoveL p,v9,z1,tool0;", "in the world"),
        ("EGMMoveL e,p,v100,z10,tool0;", "MoveL p,v100,z10,tool0;", "what a sensor changes"),
        ("ContactL p,v100,tool0;", "MoveL p,v100,fine,tool0;", "what a sensor changes"),
        ("FCPressL p,v100,20,z10,tool0;", "MoveL p,v100,z10,tool0;", "process data"),
        ("DaProcML p,v100,d1,d2\\Any,tool0;", "MoveL p,v100,fine,tool0;", "process data"),
    ],
)  # fmt: skip
def test_what_is_not_known_or_not_emulated_is_driven_otherwise_and_noted(text, as_if, words):
    found, wanted = program(text), move(as_if)
    (driven,) = found.moves
    assert (driven.target, driven.zone) == (wanted.target, wanted.zone)
    assert driven.tool.tcp == wanted.tool.tcp
    assert driven.work_object.pose == wanted.work_object.pose
    assert driven.speed.tcp == pytest.approx(wanted.speed.tcp)
    assert driven.speed.tcp_acceleration == wanted.speed.tcp_acceleration
    assert words in " ".join(note.message for note in found.notes)


def test_a_datum_that_nothing_sets_is_named_at_its_declaration():
    data = DATA + "VAR robtarget pNew;\nVAR speeddata vNew;\nPERS tooldata tNew;\n"
    line = data.count("\n") + 1
    for body, name in (
        ("MoveL p,v100,fine,tool0;\nMoveL pNew,v100,fine,tool0;", "orientation of 'pNew'"),
        ("MoveL p,vNew,fine,tool0;", "the speed of 'vNew'"),
        ("MoveL p,v100,fine,tNew;", "robhold of 'tNew'"),
    ):
        found = program(body, data)
        assert len(found.moves) == 1
        (said,) = [n.message for n in found.notes if name in n.message]
        assert (
            "which nothing sets: line " in said and "of a.mod declares it without a value" in said
        )
        declared = next(k for k in range(line) if name.split("'")[1] in data.split("\n")[k])
        assert f"line {declared + 2} of a.mod" in said
    whole = "pNew.trans:=[1,2,3];\npNew.rot:=[1,0,0,0];\nMoveL pNew,v100,fine,tool0;"
    assert move(whole, data).target.pose.position == pytest.approx((1e-3, 2e-3, 3e-3))


def test_an_error_names_the_argument():
    with pytest.raises(SourceError) as caught:
        read("MODULE M\nPROC main()\n  MoveL [1,2], v100, z10, tool0;\nENDPROC\nENDMODULE", "a.mod")
    span = caught.value.span
    assert (span.line, span.column, span.end - span.start) == (3, 9, 5)


def test_quaternions_are_scaled_within_a_tolerance():
    rounded = f"[[0,0,0],[0.70711,0,0.70711,0],[0,0,0,0],{UNUSED}]"
    assert program(f"MoveL {rounded},v100,z10,tool0;").notes == ()
    rough = f"[[0,0,0],[0.7067,0,0.7071,0],[0,0,0,0],{UNUSED}]"
    result = program(f"MoveL {rough},v100,z10,tool0;\nMoveL {rough},v100,z10,tool0;")
    assert "2 quaternions are not of unit length" in result.notes[0].message
    norm = math.hypot(*result.moves[0].target.pose.quaternion)
    assert norm == pytest.approx(1, abs=1e-12)


def test_external_axes():
    def target(eax):
        return f"MoveL [[0,0,0],[1,0,0,0],[0,0,0,0],[{eax}]],v100,z10,tool0;"

    two = "1500,90,9E9,9E9,9E9,9E9"
    at = move(target(two), external_axes=("linear", "rotating"))
    assert at.target.external == pytest.approx((1.5, math.pi / 2))
    joint = move(
        f"MoveAbsJ [[0,0,0,0,0,0],[{two}]],v100,z10,tool0;",
        external_axes=("linear", "rotating", "linear"),
    )
    assert joint.target.external == pytest.approx((1.5, math.pi / 2))
    assert "eax_a is sent to 1500" in refusal(target(two))
    stands = program(target(two), external_axes=("linear",))
    assert "taken to stand there throughout" in stands.notes[0].message
    other = target(two) + target("1500,95,9E9,9E9,9E9,9E9")
    message = refusal(other, external_axes=("linear",))
    assert "eax_b is moved from 90 to 95" in message and "[external_axis.eax_b]" in message
    hole = target("9E9,90,9E9,9E9,9E9,9E9")
    assert "9E9" in refusal(hole, external_axes=("linear", "rotating"))
    zero = program(target("0,0,0,0,0,0"))
    assert zero.moves[0].target.external == () and "taken as not there" in zero.notes[0].message


def test_a_declared_datum_hides_a_predefined_one():
    data = "CONST zonedata z10:=[FALSE,1,1,1,1,1,1];\nCONST speeddata slow:=v5;\n" + DATA
    at = move("MoveL p,slow,z10,tool0;", data)
    assert at.zone.tcp == 0.001
    assert (at.speed.name, at.speed.tcp) == ("slow", 0.005)


def test_predefined_names_of_all_tables():
    for speed in predefined.SPEEDS:
        assert move(f"MoveL p,{speed},z10,tool0;").speed == predefined.speed(speed)
    for zone in predefined.ZONES:
        assert move(f"MoveL p,v10,{zone},tool0;").zone == predefined.zone(zone)
