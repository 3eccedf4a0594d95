"""What a program asks of its own position, tool and frame; functions on strings and bits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.program.question import QuestionKind
from flyby.core.registry import find_robot
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions
from flyby.vendors.abb.run.reader import read

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
P = f"[[500,0,600],[0,0,1,0],[0,0,0,0],{UNUSED}]"
DATA = f"""
  CONST robtarget p:={P};
  CONST jointtarget home:=[[0,10,20,0,30,0],{UNUSED}];
  PERS tooldata tGun:=[TRUE,[[0,0,100],[1,0,0,0]],[4,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[100,0,50],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  VAR robtarget now; VAR jointtarget jNow; VAR pos at; VAR num n; VAR string s; VAR bool b;
"""
"""``p`` points down: z of the tool is -z of the world, x is -x."""


def program(body, robot=None, answers=None, data=""):
    text = f"MODULE M\n{DATA}{data}\nPROC main()\n{body}\nENDPROC\nENDMODULE"
    return read(text, "a.mod", ReadOptions(robot=robot, answers=answers or Answers()))


def last(body, **options):
    return program(body, **options).moves[-1]


def refusal(body, **options):
    with pytest.raises(SourceError) as caught:
        program(body, **options)
    return str(caught.value)


@pytest.fixture(scope="module")
def robot():
    return find_robot("abb/irb1200-5-090")


def value(expression, kind="num", robot=None):
    """A num's value, as the height of a target in mm."""
    target = last(
        f"{'n' if kind == 'num' else 'b'}:={expression};\n"
        + ("IF b n:=1;\n" if kind == "bool" else "")
        + "MoveL Offs(p,0,0,n-600),v100,fine,tool0;",
        robot=robot,
    ).target
    return round(target.pose.position[2] * 1000, 9)


# -------------------------------------------------------------------------- position


def test_the_last_target_is_where_the_robot_stands():
    before = "MoveL p,v100,fine,tGun\\WObj:=wTable;\n"
    same = last(f"{before}now:=CRobT();\nMoveL now,v100,fine,tGun\\WObj:=wTable;")
    assert same.target.pose == program(before).moves[0].target.pose
    assert same.target.configuration == program(before).moves[0].target.configuration
    world = last(f"{before}MoveL CRobT(\\Tool:=tGun\\WObj:=wobj0),v100,fine,tGun;").target.pose
    assert world.position == pytest.approx((0.6, 0, 0.65))
    flange = last(f"{before}MoveL CRobT(\\Tool:=tool0\\WObj:=wobj0),v100,fine,tool0;").target.pose
    assert flange.position == pytest.approx((0.6, 0, 0.75))
    up = last(f"{before}at:=CPos();\nnow:=p; now.trans.z:=at.z+5;\nMoveL now,v100,fine,tGun;")
    assert up.target.pose.position == pytest.approx((0.5, 0, 0.605))


def test_joint_values_are_known_after_a_joint_target():
    body = "MoveAbsJ home,v100,fine,tGun;\njNow:=CJointT();\njNow.robax.rax_6:=45;\n"
    target = last(f"{body}MoveAbsJ jNow,v100,fine,tGun;").target
    expected = [math.radians(v) for v in (0, 10, 20, 0, 30, 45)]
    assert target.joints == pytest.approx(expected)


def test_without_a_robot_its_kinematics_are_asked_for_by_name():
    for body in (
        "MoveAbsJ home,v100,fine,tGun;\nMoveL CRobT(),v100,fine,tGun;",
        "MoveL p,v100,fine,tGun;\nMoveAbsJ CJointT(),v100,fine,tGun;",
    ):
        (said,) = [n.message for n in program(body).notes if "left out" in n.message]
        function = "CRobT()" if "CRobT" in body else "CJointT()"
        assert f"{function} (name the robot)" in said and f'[values] "{function}"' in said
    first = "now:=CRobT(\\Tool:=tool0);\nMoveL now,v100,fine,tool0;"
    assert "CRobT" in refusal(first)
    answers = Answers(
        {"crobt(\\tool:=tool0)": ((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0), (0.0,) * 4, (9e9,) * 6)}
    )
    assert last(first, answers=answers).target.pose.position == pytest.approx((1e-3, 2e-3, 3e-3))


def test_the_robot_answers_with_its_kinematics(robot):
    body = "MoveAbsJ home,v100,fine,tGun\\WObj:=wTable;\n"
    pose = last(f"{body}MoveL CRobT(\\Tool:=tGun\\WObj:=wTable),v100,fine,tGun;", robot=robot)
    q = np.radians([0, 10, 20, 0, 30, 0])
    back = last(
        f"{body}MoveAbsJ CalcJointT(CRobT(),tGun\\WObj:=wTable),v100,fine,tGun;", robot=robot
    )
    assert back.target.joints == pytest.approx(tuple(q), abs=1e-9)
    again = last(f"{body}MoveL CalcRobT(home,tGun\\WObj:=wTable),v100,fine,tGun;", robot=robot)
    assert again.target.pose.position == pytest.approx(pose.target.pose.position, abs=1e-12)
    assert again.target.configuration == pose.target.configuration
    assert "CalcJointT: target cannot be reached: " in refusal(
        "MoveAbsJ home,v100,fine,tool0;\nnow:=p; now.trans.x:=9000;\n"
        "MoveAbsJ CalcJointT(now,tool0),v100,fine,tool0;",
        robot=robot,
    )


def test_behind_a_move_that_cannot_be_driven_the_position_is_that_before_it(robot):
    body = (
        "MoveAbsJ home,v100,fine,tool0;\nMoveL Offs(p,9000,0,0),v100,fine,tool0;\n"
        "jNow:=CJointT();\nMoveAbsJ jNow,v100,fine,tool0;"
    )
    first, _, last_ = program(body, robot=robot).moves
    assert last_.target.joints == pytest.approx(first.target.joints)


@settings(deadline=None, max_examples=15)
@given(st.tuples(*[st.floats(-40, 40) for _ in range(4)], st.floats(20, 70), st.floats(-90, 90)))
def test_calc_joint_undoes_calc_rob(robot, degrees):
    joints = ",".join(f"{v:.3f}" for v in degrees)
    body = f"MoveAbsJ [[{joints}],{UNUSED}],v100,fine,tGun;\nnow:=CRobT();\n"
    target = last(f"{body}MoveAbsJ CalcJointT(now,tGun),v100,fine,tGun;", robot=robot).target
    expected = [math.radians(float(f"{v:.3f}")) for v in degrees]
    assert target.joints == pytest.approx(expected, abs=1e-7)


def test_displacement_counts_in_the_present_position():
    body = "PDispSet [[10,0,0],[1,0,0,0]];\nMoveL p,v100,fine,tool0;\nnow:=CRobT();\n"
    assert last(f"{body}MoveL now,v100,fine,tool0;").target.pose.position[0] == pytest.approx(0.51)
    undone = f"{body}now:=ORobT(now);\nPDispOff;\nMoveL now,v100,fine,tool0;"
    assert last(undone).target.pose.position[0] == pytest.approx(0.51)


def test_present_tool_and_frame():
    body = "MoveL p,v100,fine,tGun\\WObj:=wTable;\ntNow:=CTool();\nwNow:=CWObj();\n"
    move = last(
        f"{body}MoveL p,v100,fine,tNow\\WObj:=wNow;", data="PERS tooldata tNow; PERS wobjdata wNow;"
    )
    assert move.tool.tcp.position == (0, 0, 0.1)
    assert move.work_object.user.position == pytest.approx((0.1, 0, 0.05))


def test_mirrored_points():
    plane = "[[0,0,500],[1,0,0,0]]"
    target = last(f"MoveL MirPos(p,{plane}),v100,fine,tool0;").target
    assert target.pose.position == pytest.approx((0.5, 0, 0.4))
    # Pointing up now; mirrored twice it is what it was.
    R = target.pose.matrix()[:3, :3]
    assert R[:, 2] == pytest.approx((0, 0, 1))
    twice = last(f"MoveL MirPos(MirPos(p,{plane}),{plane}),v100,fine,tool0;").target.pose
    assert twice.matrix() == pytest.approx(last("MoveL p,v100,fine,tool0;").target.pose.matrix())
    other = last(f"MoveL MirPos(p,{plane}\\MirY),v100,fine,tool0;").target.pose.matrix()
    assert np.linalg.det(other[:3, :3]) == pytest.approx(1)
    assert other[:3, 2] == pytest.approx((0, 0, 1))


def test_frames_of_points():
    points = ",".join(f"Offs(p,{x},{y},0)" for x, y in ((0, 0), (100, 0), (50, 30)))
    body = "fNow:=DefFrame({}{});\nMoveL Offs(p,fNow.trans.x,0,0),v100,fine,tool0;"
    data = "VAR pose fNow;"
    for origin, x in (("", 0.5), ("\\Origin:=2", 0.6), ("\\Origin:=3", 0.55)):
        move = last(body.format(points, origin), data=data)
        assert move.target.pose.position[0] == pytest.approx(0.5 + x)
    moved = ",".join(f"Offs(p,{x},{y},7)" for x, y in ((0, 0), (100, 0), (50, 30)))
    shift = f"fNow:=DefDframe({points},{moved});\nMoveL Offs(p,0,0,fNow.trans.z),v100,fine,tool0;"
    assert last(shift, data=data).target.pose.position[2] == pytest.approx(0.607)


# --------------------------------------------------------------- strings, bits, data


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        *[('StrFind("Robotics",1,"aeiou")', 2), ('StrFind("Robotics",1,"aeiou"\\NotInSet)', 1)],
        *[('StrFind("abc",1,STR_DIGIT)', 4), ('StrMatch("Robotics",1,"bo")', 3)],
        *[('StrMatch("Robotics",4,"bo")', 9), ('StrLen(StrMap("Robotics","aeiou","AEIOU"))', 8)],
        *[('StrToByte("10")', 10), ('StrToByte("AE"\\Hex)', 174), ('StrToByte("A"\\Char)', 65)],
        *[("BitAnd(38,34)", 34), ("BitOr(39,162)", 167), ("BitXOr(39,162)", 133)],
        *[("BitNeg(38)", 217), ("BitLSh(38,3)", 48), ("BitRSh(38,1)", 19)],
        *[("BitAndDnum(1099511627776,1099511627777)", 1099511627776)],
        *[("StrLen(NumToStr(1.5,2\\Exp))", 8), ("StrLen(ByteToStr(5\\Bin))", 8)],
        *[("StrLen(ValToStr([1,2,3]))", 7), ("CSpeedOverride()", 100), ("Dim(aRow,1)", 3)],
    ],
)
def test_functions_of_nums(expression, expected):
    text = f"n:={expression};\nMoveL Offs(p,0,0,n/1E6-600),v100,fine,tool0;"
    height = last(text, data="VAR num aRow{3};").target.pose.position[2]
    assert height * 1e9 == pytest.approx(expected)


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        *[('StrMemb("Robotics",2,"aeiou")', True), ('StrMemb("S4",1,STR_DIGIT)', False)],
        *[('StrOrder("FIRST","SECOND",STR_UPPER)', True), ('StrOrder("b","a","ab")', False)],
        *[('StrDigCmp("1234",LT,"99999999999999999")', True), ("BitCheck(6,2)", True)],
        *[('DecToHex("255")="FF"', True), ('HexToDec("ff")="255"', True)],
        *[('ByteToStr(122\\Hex)="7A"', True), ('ByteToStr(65\\Char)="A"', True)],
        *[('StrMap("Robotics","aeiou","AEIOU")="RObOtIcs"', True), ("IsPers(tGun)", True)],
        *[("IsVar(n)", True), ('Type(p)="robtarget"', True), ("TestAndSet(b)", True)],
        *[('StrToVal("3.8",n)', True), ('StrToVal("x",n)', False), ("TestAndSet(bSet)", False)],
        *[('StrToVal("[1,2,3]",at)', True), ('StrToVal("[1,2]",at)', False)],
    ],
)
def test_functions_of_bools(condition, holds):
    text = f"IF {condition} MoveL p,v100,fine,tool0;"
    assert len(program(text, data="VAR bool bSet:=TRUE;").moves) == holds


def test_values_read_from_strings_arrive():
    body = 'b:=StrToVal("[1,2,"+"3.5]",at);\nn:=at.z;\nb:=StrToVal("-2",n);\n'
    target = last(f"{body}MoveL Offs(p,0,0,at.z+n),v100,fine,tool0;").target
    assert target.pose.position[2] == pytest.approx(0.6015)
    open_text = "b:=StrToVal(ReadStr(io),n);\nMoveL Offs(p,0,0,n),v100,fine,tool0;"
    assert last(open_text).target.pose.position[2] == pytest.approx(0.6)


def test_bits_are_set_and_cleared():
    body = "n:=5;\nBitSet n,2;\nBitClear n,1;\nMoveL Offs(p,0,0,n),v100,fine,tool0;"
    assert last(body).target.pose.position[2] == pytest.approx(0.606)
    assert "numbered from 1 to 8" in refusal("BitSet n,9;")


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        ('StrFind("abc",9,"a")', "position 9 is outside"),
        ('StrMap("abc","ab","c")', "two strings of equal length"),
        ('StrToByte("x1")', "no finite value"),
        ("BitAnd(300,1)", "no whole number of 8 bits"),
        ("BitAnd(1.5,1)", "no whole number of 8 bits"),
        ('StrDigCmp("a",LT,"1")', "strings of digits"),
        ("StrLen(5)", "a string is wanted"),
    ],
)
def test_functions_refuse_what_they_do_not_take(expression, words):
    assert words in refusal(f"s:=ValToStr({expression});")


SHARED = "PERS num go; PERS bool ready; PERS num list{3}; VAR num mine;"


@pytest.mark.parametrize("condition", ["go=1", "ready", "list{2}>4"])
def test_a_persistent_datum_without_a_value_is_another_tasks(condition):
    """Nobody at hand knows it: a branch that drives is taken, and the value is asked for."""
    read = program(f"IF {condition} THEN\nMoveL p,v100,fine,tool0;\nENDIF", data=SHARED)
    assert len(read.moves) == 1
    (question,) = (q for q in read.questions if q.kind is QuestionKind.DATUM)
    key = condition.split("=")[0].split(">")[0]
    assert question.key == key
    answers = Answers({key.lower(): False if key == "ready" else 0.0})
    assert not program(
        f"IF {condition} THEN\nMoveL p,v100,fine,tool0;\nENDIF", data=SHARED, answers=answers
    ).moves


def test_what_the_program_writes_itself_it_knows():
    body = "go:=2;\nIF go=1 THEN\nMoveL p,v100,fine,tool0;\nENDIF\nIF mine=1 MoveL p,v9,fine,tool0;"
    read = program(body, data=SHARED)
    assert not read.moves
    assert not read.questions


STATES = """
TEST state
CASE 0:
MoveL p,v100,fine,tool0;
state:=1;
CASE 1:
MoveL Offs(p,0,0,10),v100,fine,tool0;
state:=2;
CASE 2:
MoveL Offs(p,0,0,20),v100,fine,tool0;
ENDTEST"""


@pytest.mark.parametrize(
    ("cycles", "heights"), [(1, [600]), (2, [600, 610]), (4, [600, 610, 620, 620])]
)
def test_main_is_run_again_and_again(cycles, heights):
    read = program(STATES, data="VAR num state;", answers=Answers(cycles=cycles))
    assert [round(1000 * m.target.pose.position[2]) for m in read.moves] == heights
    said = [note for note in read.notes if "its next pass goes another way" in note.message]
    assert [note.span.line for note in said] == ([11] if cycles == 1 else [])


def test_a_main_that_goes_the_same_way_again_is_not_spoken_of():
    count = "n:=n+1;\nIF mine=0 MoveL p,v100,fine,tool0;\nMoveL Offs(p,0,0,n),v100,fine,tool0;"
    assert not any("next pass" in n.message for n in program(count, data=SHARED).notes)


@pytest.mark.parametrize("said", ["state:=1;", "init;", "IF n=0 THEN\nstate:=1;\nENDIF", "ask;"])
def test_a_main_that_writes_what_it_decides_by_is_not_spoken_of(said):
    """What each pass writes first does not come from the pass before."""
    data = (
        "VAR num state;\nPROC init()\nstate:=1;\nENDPROC\n"
        'PROC ask()\nTPReadNum state,"which?";\nENDPROC'
    )
    answers = Answers({"state": 1.0})
    body = f"{said}\nTEST state\nCASE 1:\nMoveL p,v100,fine,tool0;\nENDTEST"
    read = program(body, data=data, answers=answers)
    assert len(read.moves) == 1
    assert not any("next pass" in n.message for n in read.notes)


def test_an_endless_loop_in_main_is_its_passes():
    body = "WHILE TRUE DO\nMoveL Offs(p,0,0,n),v100,fine,tool0;\nn:=n+10;\nENDWHILE"
    assert len(program(body, answers=Answers(cycles=3)).moves) == 3
