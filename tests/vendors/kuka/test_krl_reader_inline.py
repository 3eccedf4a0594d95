"""BAS, inline forms of both generations, and $CONFIG.DAT."""

# ruff: noqa: E501 - lines of programs are as long as programs have them

from __future__ import annotations

import math

import pytest

from flyby.core.errors import SourceError
from flyby.core.program.move import Opaque
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import ContourFraction, Radius
from flyby.core.registry import find_robot

POINTS = """EXT  BAS (BAS_COMMAND  :IN,REAL  :IN )
DECL INT SUCCESS
DECL E6POS XP1={X 900.0,Y 0.0,Z 1200.0,A 0.0,B 90.0,C 0.0,S 2,T 35,E1 0.0,E2 0.0}
DECL FDAT FP1={TOOL_NO 2,BASE_NO 3,IPO_FRAME #BASE,POINT2[] " ",TQ_STATE FALSE}
DECL PDAT PPDAT1={VEL 70.0,ACC 60.0,APO_DIST 25.0}
DECL PDAT PPDAT2={VEL 70.0,ACC 60.0,APO_DIST 25.0,APO_MODE #CDIS,GEAR_JERK 50.0,EXAX_IGN 0}
DECL PDAT PPDAT3={VEL 70.0,ACC 60.0,APO_DIST 25.0,APO_MODE #CPTP}
DECL LDAT LCPDAT1={VEL 1.5,ACC 50.0,APO_DIST 15.0,APO_FAC 50.0,AXIS_VEL 100.0,AXIS_ACC 40.0,ORI_TYP #CONSTANT,CIRC_TYP #PATH}
"""
CONFIG = """&ACCESS RV
DEFDAT  $CONFIG
INT DEF_ADVANCE=3
REAL DEF_VEL_CP=3.0 ; path velocity [M/SEC]
REAL DEF_ACC_CP=4.0
REAL DEF_ACC_ORI1=200.0
DECL PDAT PDEFAULT={VEL 100.0,ACC 100.0,APO_DIST 100.0}
DECL FDAT FHOME={TOOL_NO 2,BASE_NO 0,IPO_FRAME #BASE,POINT2[] " ",TQ_STATE FALSE}
DECL PDAT PDAT_ACT
DECL LDAT LDAT_ACT
DECL FDAT FDAT_ACT
E6AXIS XHOME={A1 0.0,A2 -100.0,A3 100.0,A4 0.0,A5 10.0,A6 0.0,E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}
DECL FRAME TOOL_DATA[16]
TOOL_DATA[1]={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
TOOL_DATA[2]={X 5.0,Y 0.0,Z 150.0,A 0.0,B 0.0,C 0.0}
DECL CHAR TOOL_NAME[16,24]
TOOL_NAME[2,]="gun"
DECL LOAD LOAD_DATA[16]
LOAD_DATA[2]={M 8.0,CM {X 0.0,Y 0.0,Z 75.0,A 0.0,B 0.0,C 0.0},J {X 0.1,Y 0.1,Z 0.1}}
DECL FRAME BASE_DATA[32]
BASE_DATA[3]={X 1000.0,Y 0.0,Z 500.0,A 90.0,B 0.0,C 0.0}
SIGNAL part_there $IN[17]
ENDDAT
"""
OLD = """BAS (#INITMOV,0 )
;FOLD PTP HOME  Vel= 100 % DEFAULT;%{PE}%MKUKATPBASIS,%CMOVE,%VPTP,%P 1:PTP, 2:HOME
$BWDSTART = FALSE
PDAT_ACT=PDEFAULT
FDAT_ACT=FHOME
BAS (#PTP_PARAMS,100 )
$H_POS=XHOME
PTP  XHOME
;ENDFOLD
;FOLD PTP P1 CONT Vel= 30 % PDAT1 Tool[2] Base[3];%{PE}
$BWDSTART = FALSE
PDAT_ACT=PPDAT1
FDAT_ACT=FP1
BAS (#PTP_PARAMS,30 )
PTP  XP1 C_PTP
;ENDFOLD
;FOLD LIN P1 CONT Vel= 0.4 m/s CPDAT1 Tool[2] Base[3];%{PE}
$BWDSTART = FALSE
LDAT_ACT=LCPDAT1
FDAT_ACT=FP1
BAS(#CP_PARAMS,0.4)
SET_CD_PARAMS (0)
LIN XP1 C_DIS
;ENDFOLD
"""
NEW = """BAS (#INITMOV,0 )
;FOLD SPTP P1 CONT Vel=100 % PDAT1 Tool[2]:gun Base[3] ;%{PE}
;FOLD Parameters ;%{h}
;Params IlfProvider=kukaroboter.basistech.inlineforms.movement.spline; Kuka.PointName=P1
;ENDFOLD
SPTP XP1 WITH $VEL_AXIS[1] = SVEL_JOINT(45.0), $TOOL = STOOL2(FP1), $BASE = SBASE(FP1.BASE_NO), $IPO_MODE = SIPO_MODE(FP1.IPO_FRAME), $LOAD = SLOAD(FP1.TOOL_NO), $ACC_AXIS[1] = SACC_JOINT(PPDAT2), $APO = SAPO_PTP(PPDAT2), $GEAR_JERK[1] = SGEAR_JERK(PPDAT2), $COLLMON_TOL_PRO[1] = USE_CM_PRO_VALUES(0) C_SPL
;ENDFOLD
SLIN XP1 WITH $VEL=SVEL_CP( 0.3, , LCPDAT1), $TOOL=STOOL2( FP1), $BASE= SBASE( FP1.BASE_NO),$IPO_MODE=SIPO_MODE( FP1.IPO_FRAME), $LOAD=SLOAD( FP1.TOOL_NO), $ACC=SACC_CP( LCPDAT1), $APO=SAPO( LCPDAT1), $ORI_TYPE=SORI_TYP( LCPDAT1), $JERK=SJERK( LCPDAT1) C_SPL
"""


@pytest.fixture(scope="module")
def robot():
    return find_robot("kuka/kr30-3")


def test_forms_of_krc2(krl, robot):
    program = krl(OLD, POINTS, files={"$config.dat": CONFIG}, robot=robot)
    home, point, line = program.moves
    assert home.target == JointTarget(
        tuple(map(math.radians, (0, -100, 100, 0, 10, 0))), (), "XHOME"
    )
    assert home.speed.joint_fraction == 1.0
    assert home.tool.name == "TOOL_DATA[2]" and home.work_object.name == "wobj0"
    assert point.speed.joint_fraction == 0.3
    assert point.speed.joint_acceleration_fraction == 0.6
    assert point.zone == ContourFraction(0.25)
    assert point.tool.tcp.position == (0.005, 0.0, 0.15)
    assert point.tool.load.mass == 8.0 and point.tool.load.name == "LOAD_DATA[2]"
    assert point.work_object.name == "BASE_DATA[3]"
    assert line.speed.tcp == 0.4
    assert line.speed.tcp_acceleration == 0.5 * 4.0
    assert line.speed.reorientation_acceleration == math.radians(50)
    assert line.zone == Radius(0.015, 0.015, 0.015)
    assert line.target.pose.quaternion == pytest.approx(point.target.pose.quaternion)
    assert not any("at hand" in note.message for note in program.notes)


def test_forms_of_krc4(krl):
    program = krl(NEW, POINTS, files={"KRC/R1/System/$config.dat": CONFIG})
    joint, line = program.moves
    assert joint.speed.joint_fraction == 0.45
    assert joint.speed.joint_acceleration_fraction == 0.6
    assert joint.zone == Radius(0.025, 0.025, 0.025)
    assert joint.tool.name == "TOOL_DATA[2]" and joint.work_object.name == "BASE_DATA[3]"
    assert line.speed.tcp == 0.3 and line.speed.reorientation == math.radians(200)
    assert line.speed.tcp_acceleration == pytest.approx(0.4 * 4.0)
    assert line.zone == Radius(0.015, 0.015, 0.015)
    assert not any(isinstance(s, Opaque) for s in program.statements)


def test_spline_ptp_by_percent(krl):
    body = "SPTP XP1 WITH $VEL_AXIS[1]=SVEL_JOINT(10), $APO=SAPO_PTP(PPDAT3) C_SPL"
    assert krl(body, POINTS).moves[0].zone == ContourFraction(0.25)


def test_what_is_not_at_hand_is_assumed_and_said(krl):
    program = krl(OLD, POINTS.replace("#CONSTANT", "#VAR"))
    messages = [str(note) for note in program.notes]
    assert sum("TOOL_DATA[2] is in no $config.dat at hand" in m for m in messages) == 1
    assert sum("BASE_DATA[3] is in no $config.dat at hand" in m for m in messages) == 1
    assert program.moves[0].target.joints[1] == math.radians(-90)
    assert program.moves[1].tool.name == "TOOL_DATA[2]"


def test_initialisation(krl):
    body = "BAS(#INITMOV,0)\nLIN XP1 C_DIS\nPTP XP1 C_PTP"
    line, joint = krl(body, POINTS).moves
    assert line.speed.tcp == 2.0 and line.speed.tcp_acceleration == 2.3
    assert line.speed.reorientation == math.radians(200)
    assert line.speed.reorientation_acceleration == math.radians(100)
    assert line.zone.tcp == 0.003
    assert joint.speed.joint_fraction == 1.0 and joint.zone == ContourFraction(0.5)


@pytest.mark.parametrize(
    ("commands", "check"),
    [
        ("BAS(#VEL_PTP,35)", lambda j, c: j.joint_fraction == 0.35),
        ("BAS(#ACC_PTP,40)", lambda j, c: j.joint_acceleration_fraction == 0.4),
        ("BAS(#VEL_PTP,250)", lambda j, c: j.joint_fraction == 1.0),
        ("BAS(#VEL_CP,0.75)", lambda j, c: c.tcp == 0.75),
        ("BAS(#VEL_CP,5)", lambda j, c: c.tcp == 2.0),
        ("BAS(#ACC_CP,50)", lambda j, c: c.tcp_acceleration == 1.15),
        ("PDAT_ACT=PPDAT1\nBAS(#PTP_DAT)", lambda j, c: j.joint_fraction == 0.7),
        ("LDAT_ACT={VEL 1.5,ACC 100,APO_DIST 9}\nBAS(#CP_DAT)", lambda j, c: c.tcp == 1.5),
        ("BAS(#EX_BAS,1)\nBAS(#OUT_SYNC,0)", lambda j, c: c.tcp == 2.0),
        ("$VEL.CP=$VEL_MA.CP", lambda j, c: c.tcp is None),
        ("$ACC=$ACC_MA", lambda j, c: c.tcp_acceleration is None),
    ],
)
def test_commands_of_bas(krl, commands, check):
    joint, line = krl(f"BAS(#INITMOV,0)\n{commands}\nPTP XP1\nLIN XP1", POINTS).moves
    assert check(joint.speed, line.speed)


def test_tool_and_base_by_number(krl):
    body = (
        "BAS(#INITMOV,0)\nBAS(#TOOL,2)\nBAS(#BASE,3)\nLIN XP1\nBAS(#TOOL,0)\nBAS(#BASE,0)\nLIN XP1"
    )
    first, second = krl(body, POINTS, files={"$CONFIG.DAT": CONFIG}).moves
    assert (first.tool.name, first.work_object.name) == ("TOOL_DATA[2]", "BASE_DATA[3]")
    assert (second.tool.name, second.work_object.name) == ("tool0", "wobj0")


@pytest.mark.parametrize("use", ["BAS(#TOOL,17)", "$TOOL=TOOL_DATA[17]"])
def test_a_tool_that_nobody_sets(krl, use):
    program = krl(f"{use}\nLIN XP1", POINTS, files={"$config.dat": CONFIG})
    assert program.moves[0].tool.tcp.position == (0, 0, 0)
    assert any("TOOL_DATA[17] is in no $config.dat" in n.message for n in program.notes)


def test_a_tool_that_others_choose(krl):
    program = krl("BAS(#TOOL,$IN[1])\nLIN XP1", POINTS)
    assert program.moves[0].tool.name == "tool0"
    assert any("the number of a tool depends on" in n.message for n in program.notes)


def test_stationary_tool_of_a_form(krl):
    data = POINTS.replace("IPO_FRAME #BASE", "IPO_FRAME #TCP")
    line = krl(OLD.replace("PTP  XP1", ";"), data.replace("#CONSTANT", "#VAR")).moves[-1]
    assert not line.tool.robot_held and line.work_object.robot_held
    assert line.tool.name == "BASE_DATA[3]" and line.work_object.name == "TOOL_DATA[2]"


def test_a_base_that_the_program_moves(krl):
    body = "BAS(#INITMOV,0)\nBASE_DATA[3].Z=BASE_DATA[3].Z+155\n$BASE=BASE_DATA[3]\nLIN XP1"
    assert krl(body, POINTS).moves[0].work_object.pose.position[2] == pytest.approx(0.155)
    moved = krl(body, POINTS, files={"$config.dat": CONFIG}).moves[0].work_object.pose
    assert moved.position == pytest.approx((1.0, 0, 0.655))


def test_form_without_its_data(krl):
    program = krl("SLIN XP1 WITH $ACC=SACC_CP(LCPDAT9)", POINTS)
    assert any(
        "SACC_CP takes the motion's data" in n.message and "name the .dat" in n.message
        for n in program.notes
    )
    with pytest.raises(SourceError, match="unknown point 'XP9': did you mean XP1"):
        krl("BAS(#INITMOV,0)\nPTP XP9", POINTS)


def test_technology_packages_are_kept(krl):
    body = (
        "USERSPOT(#INIT)\nUSER_GRP(0,DUMMY,DUMMY,GDEFAULT)\nTM_SETUP()\n"
        "BAS(#INITMOV,0)\nPTP XP1\nARC_ON(1)\nGRP_OPEN(1)"
    )
    program = krl(body, POINTS)
    kept = [s for s in program.statements if isinstance(s, Opaque)]
    assert [k.text.partition("(")[0] for k in kept] == [
        "USERSPOT",
        "USER_GRP",
        "TM_SETUP",
        "ARC_ON",
        "GRP_OPEN",
    ]
    assert any("ARC_ON is kept" in n.message for n in program.notes)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        *[(name, f"{name} is kept") for name in ("GRPg_Check", "grp_open", "H50", "MsgNotify")],
        *[(name, f"{name} is kept") for name in ("EKI_Open", "ST_ON", "ArcMainNG", "Laser_On")],
        *[(name, "stay where it is") for name in ("RSI_MOVECORR", "ST_SKIPSENS", "TS_Search")],
        ("Touch1", "find nothing that differs"),
        ("Conv_Wait", "conveyors are taken to stand still"),
        *[(name, "as if it moved nothing") for name in ("Gripper_Change", "St_Pick", "GluePath")],
    ],
)
def test_routines_without_a_text(krl, call, told):
    """What may drive the robot is said to be stepped over."""
    program = krl(f"BAS(#INITMOV,0)\nPTP XP1\n{call}(1)", POINTS)
    assert program.statements[-1].text == f"{call}(1)"
    assert any(call in n.message and told in n.message for n in program.notes)


def test_a_program_s_own_routine_goes_before_the_table(krl):
    src = (
        "DEF demo( )\nGRP_OPEN()\nEND\nDEF GRP_OPEN( )\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nEND"
    )
    assert len(krl(src=src).moves) == 1
