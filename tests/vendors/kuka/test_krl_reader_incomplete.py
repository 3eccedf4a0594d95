"""KRL whose points, data, devices or lines are not all there: driven as far as it can be."""

from __future__ import annotations

import pytest

from flyby.core.errors import LeftOpenError
from flyby.core.program.move import MoveC, MoveJ, MoveL, Opaque
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions
from flyby.vendors.kuka.language import Krl

START = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}"
POSE = "X 1300,Y 0,Z %s,A 0,B 90,C 0"
INIT = f"BAS(#INITMOV,0)\n{START}\n"
P1 = "DECL E6POS XP1={" + POSE % 1000 + ",S 2,T 2}\n"
MENDED = Answers(goes_on=True, mends=True)


def said(program):
    return " ".join(note.message for note in program.notes)


def heights(program):
    return [round(1000 * m.target.pose.position[2]) for m in program.moves[1:]]


def test_a_motion_to_a_point_that_nobody_declares_is_left_out(krl):
    body = INIT + "LIN XP1\nLIN XP9\nLIN_REL {Z 50}\nLIN {Z 20}\nLIN XP1 C_DIS"
    program = krl(body, P1)
    assert heights(program) == [1000, 1000]
    kept = [s.text for s in program.statements if isinstance(s, Opaque)]
    assert kept == ["LIN XP9", "LIN_REL {Z 50}", "LIN {Z 20}"]
    assert "the motion is left out: unknown point 'XP9': did you mean XP1" in said(program)
    assert "after the one of line 5" in said(program)


@pytest.mark.parametrize("body", ["PTP XP7\nLIN XP8", "PTP XP1\nLIN XP8\nPTP XP1"])
def test_a_program_whose_points_are_missing_says_so(krl, body):
    with pytest.raises(LeftOpenError, match=r"unknown point 'XP[78]'.*name the \.dat"):
        krl(body, P1)


@pytest.mark.parametrize(
    ("body", "height"),
    [
        ("GetShift(dz)\np.Z=p.Z+dz\nLIN p", 1000),
        ("dz=25\nGetShift(dz)\np.Z=p.Z+dz\nLIN p", 1025),
        ("p.Z=p.Z-2*$ANIN[1]\nLIN p", 1000),
        ("LIN p:shift", 1000),
        ("$BASE=shift\nLIN p", 1000),
        ("p.Z=p.Z+SIN($ANIN[1])\nLIN p", 1000),
        ("found=$IN[1]\nLIN p:{X 0,Y 0,Z 0,A $ANIN[2],B 0,C 0}", 1000),
    ],
)
def test_what_others_add_to_a_target_counts_as_nothing(krl, body, height):
    data = "REAL dz\nFRAME f\nBOOL found\nDECL E6POS p={" + POSE % 1000 + "}\n"
    program = krl(INIT + body, data)
    assert heights(program) == [height]
    assert "depends on" in said(program)


def test_what_an_interrupt_finds_is_where_the_search_ends(krl):
    src = (
        "DEF demo( )\nINTERRUPT DECL 20 WHEN $IN[1]==TRUE DO Found()\n"
        f"{INIT}INTERRUPT ON 20\nLIN XP1\nIF hit THEN\nLIN place\nENDIF\nLIN place\nEND\n"
        "DEF Found( )\nBRAKE\nhit=TRUE\nplace=$POS_INT\nRESUME\nEND"
    )
    data = P1 + "BOOL hit=FALSE\nDECL E6POS place={" + POSE % 900 + "}\n"
    program = krl(src=src, data=data)
    assert heights(program)[-1] == 1000  # where the search ends
    assert "which the interrupt's Found() writes" in said(program)


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("$VEL.CP=speed\nLIN XP1", "$VEL.CP depends on the value of speed"),
        ("$VEL_AXIS[1]=speed\nPTP XP1", "$VEL_AXIS depends on the value of speed"),
        ("$OV_PRO=speed\nLIN XP1", "$OV_PRO depends on the value of speed"),
        ("$APO.CDIS=speed\nLIN XP1 C_DIS", "$APO.CDIS depends on the value of speed"),
        ("$ORI_TYPE=kind\nLIN XP1", "$ORI_TYPE depends on the value of kind"),
        ("$TOOL=gripper\nLIN XP1", "$TOOL depends on the value of gripper"),
        ("PDAT_ACT=PPDAT9\nBAS(#PTP_DAT)\nPTP XP1", "PDAT_ACT depends on the value of PPDAT9"),
        ("FDAT_ACT=FP9\nBAS(#FRAMES)\nPTP XP1", "FDAT_ACT depends on the value of FP9"),
        ("PTP XP1 WITH $TOOL=STOOL2(FP9)", "the number of a tool depends on the value of FP9"),
        ("SPTP XP1 WITH $APO=SAPO_PTP(PPDAT9) C_SPL", "SAPO_PTP takes the motion's data"),
    ],
)
def test_settings_that_nobody_states_have_their_defaults(krl, body, told):
    program = krl(INIT + body, P1)
    assert len(program.moves) == 2
    assert told in said(program)


def test_a_coupled_base_without_its_table_stands_still(krl):
    body = INIT + "$BASE=EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,{X 0,Y 0,Z 100})\nLIN XP1"
    program = krl(body, P1, robot=find_robot("kuka/kr30-3"))
    assert program.moves[-1].work_object.pose.position == pytest.approx((0, 0, 0.1))
    assert "EK couples the base" in said(program) and "[external_axis.…]" in said(program)


SPLINE = """$APO.CDIS=15
SPLINE WITH $VEL.CP=0.25
TIME_BLOCK START
SLIN XP1
SPL {Y 50} WITH $VEL.CP=0.1
TRIGGER WHEN PATH=-10 DELAY=0 DO $OUT[4]=TRUE
SCIRC {Y 80,Z 1020},{Y 100,Z 1000}
TIME_BLOCK END=4.5
ENDSPLINE C_SPL
PTP_SPLINE
SPTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
SPTP {A1 10}
ENDSPLINE
LIN_REL {Z 10}"""


def test_spline_blocks(krl):
    program = krl(INIT + SPLINE, P1, robot=find_robot("kuka/kr30-3"))
    kinds = [type(move) for move in program.moves[1:]]
    assert kinds == [MoveL, MoveL, MoveC, MoveJ, MoveJ, MoveL]
    first, slow, arc, *_ = program.moves[1:]
    assert [first.speed.tcp, slow.speed.tcp, arc.speed.tcp] == [0.25, 0.1, 0.25]
    assert first.zone == slow.zone != FINE
    assert arc.zone == Radius(0.015, 0.015, 0.015)
    assert arc.events and not slow.events
    assert program.moves[5].zone == FINE
    assert program.moves[-1].speed.tcp != 0.25  # what stands behind WITH ends with the block
    assert "SPLINE blocks are driven segment by segment" in said(program)


@pytest.mark.parametrize("line", ["x=1", "LIN XP1", "IF TRUE THEN"])
def test_what_a_spline_block_does_not_take(krl, line):
    with pytest.raises(Exception, match="to close SPLINE of line"):
        krl(f"SPLINE\n{line}\nENDSPLINE", P1)


def test_a_file_that_only_lacks_its_last_line(krl):
    program = krl(src=f"DEF demo( )\n{INIT}LIN XP1\n", files={"demo.dat": "DEFDAT demo\n" + P1})
    assert heights(program) == [1000]
    assert "the file ends without END, to close DEF demo" in said(program)
    assert "the file ends without ENDDAT, to close DEFDAT demo" in said(program)


def test_lines_as_closed_folds_show_them(krl):
    body = """INI
PTP HOME Vel= 100 % DEFAULT
PTP P1 CONT Vel=50 % PDAT1 Tool[3]:Zange Base[2]:Tisch
OUT 3 'Greifer' State=FALSE CONT
WAIT Time= 0.5 sec
LIN P1 Vel=0.5 m/s CPDAT1 Tool[3]:Zange Base[2]:Tisch
CIRC P1 xP1 CONT Vel=0.2 m/s CPDAT2"""
    _, joint, line, arc = krl(body, P1).moves
    assert joint.speed.joint_fraction == 0.5 and joint.zone != FINE
    assert line.speed.tcp == 0.5 and line.zone == FINE
    assert (line.tool.name, line.work_object.name) == ("TOOL_DATA[3]", "BASE_DATA[2]")
    assert isinstance(arc, MoveC) and arc.speed.tcp == 0.2


def test_characters_by_their_codes(krl):
    body = INIT + 'FOR i=1 TO 3\nname[i]=0\nENDFOR\nname[]="AB"\nname[2]=65\n'
    body += 'IF name[2]=="A" THEN\nLIN XP1\nENDIF'
    assert heights(krl(body, P1 + "CHAR name[8]\nINT i")) == [1000]
    with pytest.raises(Exception, match="takes characters, or their codes"):
        krl("CHAR name[8]\nname[1]=300", P1)


@pytest.mark.parametrize("suffix", [".src", ".sub"])
def test_global_definitions_anywhere_in_the_tree(tmp_path, suffix):
    def write(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
        return path

    main = write("KRC/R1/Program/line 4/jobs/main.src", f"DEF main( )\n{INIT}Pick(far)\nEND")
    write(
        f"KRC/R1/Program/lib/hands{suffix}",
        "DEF hands()\nEND\nGLOBAL DEF Pick(p:IN)\nE6POS p\nLIN p\nEND",
    )
    write(
        "KRC/R1/Mada/points.dat",
        "DEFDAT points PUBLIC\nDECL GLOBAL E6POS far={" + POSE % 950 + "}\nENDDAT",
    )
    assert heights(Krl().read_file(main, ReadOptions())) == [950]


def test_another_project_beside_is_another_project(tmp_path):
    for name, height in (("one", 1000), ("two", 900)):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "$config.dat").write_text(
            "DEFDAT $CONFIG\nDECL GLOBAL E6POS far={" + POSE % height + "}\nENDDAT"
        )
    (tmp_path / "two" / "main.src").write_text(f"DEF main( )\n{INIT}LIN far\nEND")
    (tmp_path / "three").mkdir()
    (tmp_path / "three" / "main.src").write_text(f"DEF main( )\n{INIT}LIN far\nEND")
    assert heights(Krl().read_file(tmp_path / "two" / "main.src", ReadOptions())) == [900]
    with pytest.raises(LeftOpenError, match="far"):
        Krl().read_file(tmp_path / "three" / "main.src", ReadOptions())


def test_an_index_that_nobody_knows(krl):
    data = P1 + "DECL E6POS p[2]\np[1]={" + POSE % 900 + "}\np[2]={" + POSE % 800 + "}\n"
    program = krl(INIT + "LIN p[$IN[3]]\nLIN XP1", data)
    assert heights(program) == [1000]
    assert "the motion is left out" in said(program)


@pytest.mark.parametrize("line", ["ASYPTP {E1 30}", "ASYPTP XPark", "ASYSTOP(1)", "ASYCONT 1"])
def test_axes_that_move_beside_the_program(krl, line):
    program = krl(INIT + f"{line}\nLIN XP1", P1)
    assert heights(program) == [1000]
    assert "move beside the program are not emulated" in said(program)


def test_which_of_several_configurations_is_taken_is_said(tmp_path):
    def config(folder, height):
        folder.mkdir(exist_ok=True)
        data = "DECL GLOBAL E6POS far={" + POSE % height + "}"
        (folder / "$config.dat").write_text(f"DEFDAT $CONFIG\n{data}\nENDDAT")

    main = tmp_path / "main.src"
    main.write_text(f"DEF main( )\n{INIT}LIN far\nEND")
    config(tmp_path / "line1", 900)
    assert "differing" not in said(Krl().read_file(main, ReadOptions()))
    config(tmp_path / "line2", 800)
    program = Krl().read_file(main, ReadOptions())
    assert heights(program) == [900]
    assert "2 differing $config.dat" in said(program) and "line2" in said(program)
    config(tmp_path, 700)
    program = Krl().read_file(main, ReadOptions())
    assert heights(program) == [700] and "differing" not in said(program)


def test_a_point_that_nothing_sets_is_asked_for_and_not_taken_for_the_present_one(krl):
    body = INIT + "FRAME spot\nLIN XP1\nLIN spot\nLIN XP1 C_DIS"
    program = krl(body, P1)
    assert heights(program) == [1000, 1000]
    assert "the target of LIN depends on the value of spot, which nothing sets" in said(program)


def test_a_point_that_is_answered_counts_where_it_is_copied_too(krl):
    body = INIT + "FRAME spot\nFRAME other\nother = spot\nLIN other"
    spot = "{" + POSE % 900 + "}"
    assert heights(krl(body, P1, answers=Answers(values={"spot": spot}))) == [900]


def test_a_line_that_includes_a_file_is_stepped_over_and_said(krl):
    src = f'INCLUDE "points.dat"\n\nDEF demo( )\n{INIT}LIN XP1\nEND\n'
    program = krl(src=src, data=P1, answers=MENDED)
    assert heights(program) == [1000]
    assert "KRL includes no files: take the line out" in said(program)


def test_a_speed_behind_a_target_is_not_taken_for_a_closed_fold(krl):
    program = krl(INIT + "LIN XP1 C_DIS VEL=100\nLIN XP1", P1, answers=MENDED)
    *_, last = program.moves
    assert round(1000 * last.target.pose.position[2]) == 1000
    assert "a motion takes no VEL=100 behind its target: set $VEL.CP" in said(program)


def test_a_point_of_another_program_says_whose_it_is(krl):
    files = {"points.dat": f"DEFDAT points\n{P1}ENDDAT\n"}
    with pytest.raises(LeftOpenError, match=r"points\.dat declares it for its own program alone"):
        krl("BAS(#INITMOV,0)\nPTP XP1", files=files)
