"""What KRL programs ask of files that are not at hand, and how it is answered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import degrees
from pathlib import Path

import pytest

from flyby.core.driving.past_faults import drive
from flyby.core.errors import SourceError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.assumed_places import assumed_places
from flyby.core.program.move import Move
from flyby.core.program.program import Program
from flyby.core.program.target import PoseTarget
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.answers_file import load_answers

KR30 = find_robot("kuka/kr30-3")
VENDOR = find_vendor("kuka")
START = "PTP {A1 0,A2 -90,A3 100,A4 0,A5 60,A6 0}\n"


def read(body: str, folder: Path, values: str = "") -> Program:
    answers = folder / "answers.toml"
    answers.write_text(f"[values]\n{values}\n", "utf-8")
    told = load_answers(answers)
    open_ended = replace(told, goes_on=True)
    return VENDOR.read(f"DEF m()\n{body}END\n", "m.src", robot=KR30, answers=open_ended)


def said(program: Program) -> str:
    return " ".join(note.message for note in program.notes)


def test_tools_and_bases_that_no_file_says_are_asked_for(tmp_path: Path) -> None:
    body = "BAS(#TOOL,3)\n$BASE=BASE_DATA[2]\n" + START + "PTP {X 900,Y 0,Z 300,A 0,B 90,C 0}\n"
    program = read(body, tmp_path)
    assert {"TOOL_DATA[3]", "BASE_DATA[2]"} <= {question.key for question in program.questions}
    assert '[values] "BASE_DATA[2]" = …' in said(program)
    told = '"BASE_DATA[2]" = "{X 100,Y 0,Z 400}"\n"TOOL_DATA[3]" = { Z = 50 }'
    answered = read(body, tmp_path, told)
    assert "no $config.dat" not in said(answered)
    move = answered.moves[-1]
    assert move.work_object.pose.position == pytest.approx((0.1, 0.0, 0.4))
    assert move.tool.tcp.position == pytest.approx((0.0, 0.0, 0.05))


def test_faults_of_places_name_the_base_that_is_not_known(tmp_path: Path) -> None:
    body = "BAS(#TOOL,0)\n$BASE=BASE_DATA[2]\n" + START + START.replace("A1 0", "A1 9")
    program = read(body + "PTP {X 90,Y 0,Z 30,A 0,B 90,C 0}\n", tmp_path)
    (fault,) = drive(Controller(VENDOR, KR30), program).faults
    assert "BASE_DATA[2] is not known, and may well be why" in fault.message
    told = read(
        body + "PTP {X 9000,Y 0,Z 30,A 0,B 90,C 0}\n", tmp_path, '"BASE_DATA[2]" = "{X 1,Y 0}"'
    )
    (fault,) = drive(Controller(VENDOR, KR30), told).faults
    assert "may well be why" not in fault.message


def test_homes_are_kukas_own_with_a_note_or_answered(tmp_path: Path) -> None:
    program = read("PTP XHOME\n", tmp_path)
    assert "KUKA's own is taken (A1 0, A2 -90, A3 90" in said(program)
    answered = read("PTP XHOME\n", tmp_path, 'XHOME = "{A1 10,A2 -80,A3 70,A4 0,A5 20,A6 0}"')
    assert "KUKA's own" not in said(answered)
    assert answered.moves[0].target.joints[0] == pytest.approx(0.17453, abs=1e-4)


def test_a_component_that_nothing_sets_is_asked_for_as_its_declaration_says(tmp_path: Path) -> None:
    """And not as what it might be where it is used: axes, or a position."""
    body = (
        "STRUC order INT kind,E6AXIS joints,E6POS place,state mode\nENUM state idle,busy\n"
        "DECL order o\n" + START + "PTP o.joints\nPTP o.place\nm=o.kind\nw=o.mode\n"
    )
    asked = {q.key.lower(): q.type for q in read(body, tmp_path).questions}
    assert asked["o.joints"] == "axis values" and asked["o.place"] == "position"
    assert asked["o.kind"] == "whole number" and not asked["o.mode"]


def test_components_that_routines_give_are_not_known(tmp_path: Path) -> None:
    body = (
        "DECL E6POS p\n" + START + 'r=EKI_GetReal("cam","Pos/X",p.X)\n'
        "p.Y=0\np.Z=900\np.A=0\np.B=90\np.C=0\nLIN p\np.Z=p.Z+50\nLIN p\n"
    )
    program = read(body, tmp_path)
    assert [bool(move.open) for move in program.moves] == [False, True, True]
    assert '[values] "p.X" = …' in program.moves[1].open
    answered = read(body, tmp_path, '"p.X" = 1000')
    target = answered.moves[-1].target
    assert isinstance(target, PoseTarget) and not any(move.open for move in answered.moves)
    assert target.pose.position == pytest.approx((1.0, 0.0, 0.95))


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("row=lane[k+7]", "there is no lane[10]: index 10 is outside 1 to 4"),
        ("lane[k+7]=row", "there is no lane[10]: index 10 is outside 1 to 4"),
        ("row=12/(k-3)", "division by zero"),
        ("x=SQRT(-1.0*k)", "SQRT: there is no finite value for these arguments"),
    ],
)
def test_an_error_of_the_controller_ends_the_program_behind_what_was_driven(
    tmp_path: Path, line: str, says: str
) -> None:
    head = "DECL INT row,lane[4],k\nDECL REAL x\nrow=0\nk=3\n"
    rest = START.replace("A1 0", "A1 20")
    program = read(head + START + rest + line + "\n" + rest, tmp_path)
    assert [bool(move.open) for move in program.moves] == [False, False, True]
    (fault,) = drive(Controller(VENDOR, KR30), program).faults
    assert str(fault).startswith("m.src:8:") and fault.message.endswith(
        f"{says}: the controller stops the program here"
    )
    with pytest.raises(SourceError, match=r"m\.src:8:"):
        VENDOR.read(f"DEF m()\n{head}{START}{rest}{line}\nEND\n", "m.src", robot=KR30)
    with pytest.raises(SourceError, match=r"m\.src:6:"):
        read(head + line + "\n" + rest, tmp_path)


def test_an_index_below_one_that_others_may_have_changed_is_not_taken(tmp_path: Path) -> None:
    body = (
        "DECL INT nr\nDECL FRAME spot[5]\nnr=0\nCountParts(nr)\n"
        + START
        + "PTP spot[nr-1]\n"
        + START
    )
    program = read(body, tmp_path)
    assert [bool(move.open) for move in program.moves] == [False, True, False]
    assert not any("-1" in note.message for note in program.notes)


def test_a_position_of_which_a_part_is_written_is_not_known_in_the_others(tmp_path: Path) -> None:
    body = "DECL FRAME p\n" + START + 'r=EKI_GetFrame("cam","Pos",p)\np.Z=p.Z+50\nLIN p\n'
    assert "what EKI_GetFrame gave p" in read(body, tmp_path).moves[-1].open


def test_a_search_finds_at_its_end_what_its_interrupt_puts_down(tmp_path: Path) -> None:
    body = (
        "INTERRUPT DECL 9 WHEN $IN[4]==TRUE DO hit()\n" + START + "INTERRUPT ON 9\n"
        "LIN_REL {Z -100}\nINTERRUPT OFF 9\nf=at\nf.Z=f.Z+30\nLIN f\nEND\nDEF hit()\nBRAKE\n"
        "at=$POS_INT\nRESUME\n"
    )
    program = read(body, tmp_path)
    assert not any(move.open for move in program.moves)
    before, after = (move.target.pose.position for move in program.moves[1:])
    assert after[2] - before[2] == pytest.approx(0.03)


@pytest.mark.parametrize("rest", ["", " Vel=0.3 m/s"])
def test_closed_folds_of_arcs_and_waits(tmp_path: Path, rest: str) -> None:
    body = (
        f"{START}WAIT FOR ( IN 4 'Teil da' )\nARCON WDAT1 LIN P1{rest} CPDAT1 Tool[1] Base[0]\n"
        f"ARCOFF WDAT2 LIN P2{rest} CPDAT2 Tool[1] Base[0]\n"
    )
    points = 'XP1 = "{X 1000,Y 0,Z 900,A 0,B 90,C 0}"\nXP2 = "{X 1000,Y 90,Z 900,A 0,B 90,C 0}"'
    program = read(body, tmp_path, points)
    assert len(program.moves) == 3
    speed = program.moves[1].speed.tcp
    assert (speed == pytest.approx(0.3)) is bool(rest)


ASKING = """BAS(#INITMOV,0)
PDAT_ACT=PP7
FDAT_ACT=FP7
BAS(#PTP_PARAMS,60)
PTP XP7
IF clear AND NOT busy THEN
WAIT FOR ready
ENDIF
IF kind==3 THEN
HALT
ENDIF
FOR I=1 TO 6
$VEL_AXIS[I]=share
ENDFOR
IF colour==#RED THEN
HALT
ENDIF
CIRC XA,XB
LIN XP7:offs
SLIN XS WITH $TOOL=STOOL2(FS), $ACC=SACC_CP(LS), $IPO_MODE=SIPO_MODE(FS.IPO_FRAME)
LIN grid[row,col]
"""


def test_what_is_asked_for_is_typed_as_it_is_used(tmp_path: Path) -> None:
    """An example has to be usable: a position is no number."""
    program = read(ASKING, tmp_path)
    asked = {question.key: question for question in program.questions}
    types = {
        "XP7": "position",
        "FP7": "tool and base",
        "PP7": "PDAT",
        "clear": "true or false",
        "busy": "true or false",
        "kind": "whole number",
        "share": "number",
        "colour": "a constant, as #RED",
        "XA": "position",
        "XB": "position",
        "offs": "position",
        "FS": "FDAT",
        "LS": "LDAT",
        "FS.IPO_FRAME": "#BASE or #TCP",
        "row": "whole number, from 1",
    }
    assert [key for key, part in types.items() if part not in asked[key].type] == []
    assert [name for name, _ in asked["FP7"].example] == ["TOOL_NO", "BASE_NO", "IPO_FRAME"]
    assert [name for name, _ in asked["XA"].example] == list("XYZABC")


def test_the_examples_of_what_is_asked_are_answers(tmp_path: Path) -> None:
    from flyby.core.source.execution.answers_text import answers_text

    program = read(ASKING, tmp_path)
    lines = answers_text(program.questions, "m.src").partition("[branches]")[0].splitlines()
    told = [line[1:] for line in lines if line.startswith("#") and not line.startswith("# ")]
    again = read(ASKING, tmp_path, "\n".join(told))
    assert len(told) > 12
    assert [bool(move.open) for move in again.moves].count(True) == 1  # an item of grid


def test_an_index_that_is_not_known_leaves_the_rest_of_the_program(tmp_path: Path) -> None:
    body = START + "LIN pts[n]\npos=XP1\npos.Z=pos.Z+lift[n,k].Z\nLIN pos\n" + START
    program = read(body, tmp_path)
    assert [bool(move.open) for move in program.moves] == [False, True, True, False]
    assert "the value of XP1" in str(program.moves[2].open)
    keys = {question.key for question in program.questions}
    assert {"n", "XP1"} <= keys
    assert "pts[4]" in {q.key for q in read(body, tmp_path, "n = 4").questions}


def test_parts_of_an_answered_position_are_answered(tmp_path: Path) -> None:
    body = START + "near=XP1\nnear.Z=XP1.Z+100\nLIN near\n"
    told = read(body, tmp_path, "XP1 = { X = 900, Y = 0, Z = 700, A = 0, B = 90, C = 0 }")
    assert not told.moves[1].open
    target = told.moves[1].target
    assert isinstance(target, PoseTarget)
    assert target.pose.position == pytest.approx((0.9, 0.0, 0.8))


def test_an_answer_of_another_type_is_named_with_its_file(tmp_path: Path) -> None:
    with pytest.raises(SourceError, match=r"a BOOL, not 1 \(ready as answered in .*answers\.toml"):
        read(START + "IF ready THEN\n" + START + "ENDIF\n", tmp_path, "ready = 1")


def test_what_an_interrupt_sends_is_not_written_by_it(tmp_path: Path) -> None:
    """A state server sends where the robot is; that is not what makes it unknown."""
    sends = 'RET=EKI_SetReal("state","A1",$AXIS_ACT.A1)\nRET=EKI_SetInt("state","n",sent)\n'
    text = (
        "INTERRUPT DECL 16 WHEN $TIMER_FLAG[1]==TRUE DO tell( )\nINTERRUPT ON 16\nsent=1\n" + START
    )
    body = text + "IF sent==1 THEN\n" + START + "ENDIF\nEND\nDEF tell( )\n" + sends
    program = read(body, tmp_path)
    assert len(program.moves) == 2
    assert not [q for q in program.questions if q.key.lower() in ("$axis_act", "sent")]


def test_what_functions_give_is_typed_as_it_is_used(tmp_path: Path) -> None:
    """Their parts and what stands beside them say what they are: a frame, a status."""
    body = (
        'st=EKI_CheckBuffer("plan","goal")\nIF st.BUFF>0 THEN\n'
        + START
        + "ENDIF\nIF st.CONNECTED THEN\nHALT\nENDIF\nLIN whereIs(3):offs\nat=seen(1)\nc=at.Z+1\n"
    )
    asked = {question.key: question for question in read(body, tmp_path).questions}
    status = asked['EKI_CheckBuffer("plan","goal")']
    assert [name for name, _ in status.example] == ["BUFF", "CONNECTED"]
    assert "structure" in status.type
    assert {asked[key].type for key in ("whereIs(3)", "offs", "seen(1)")} == {"position"}


def test_tools_that_were_answered_are_still_listed(tmp_path: Path) -> None:
    """`flyby ask` with the answers so far loses none of them."""
    body = START + "$TOOL=TOOL_DATA[3]\nPTP {X 900,Y 0,Z 700,A 0,B 90,C 0}\n"
    for values in ("", '"TOOL_DATA[3]" = { Z = 50 }'):
        listed = {q.key: q.answered for q in read(body, tmp_path, values).questions}
        assert listed["TOOL_DATA[3]"] is bool(values)


POLLED = """DEF m( )
act = 0
WHILE act >= 0
SWITCH act
CASE 1
PTP {A1 0,A2 -90,A3 100,A4 0,A5 60,A6 0}
CASE 2
PTP {A1 20,A2 -90,A3 100,A4 0,A5 60,A6 0}
ENDSWITCH
act = 0
ENDWHILE
END
"""


def test_what_is_asked_of_a_loop_that_waits_for_orders_changes_nothing(tmp_path: Path) -> None:
    """With the passes answered as they were taken, others still write what the loop waits for."""
    from flyby.core.source.execution.answers_text import answers_text

    bare = VENDOR.read(POLLED, "m.src", robot=KR30, answers=Answers(goes_on=True))
    answers = tmp_path / "answers.toml"
    answers.write_text(answers_text(bare.questions, "m.src"), "utf-8")
    again = VENDOR.read(POLLED, "m.src", robot=KR30, answers=load_answers(answers))
    assert len(bare.moves) == len(again.moves) > 0


def test_what_is_asked_says_its_type_as_cases_and_components_use_it(tmp_path: Path) -> None:
    body = (
        START
        + "SWITCH part\nCASE #flansch\nPTP {A1 5}\nCASE #deckel\nPTP {A1 7}\nENDSWITCH\n"
        + "SWITCH job.nr\nCASE 3,4\nPTP {A1 8}\nENDSWITCH\n"
        + "shift=tray[2].offs\np=$NULLFRAME\np.X=p.X+shift.X\n"
    )
    program = read(body, tmp_path)
    asked = {question.key: question for question in program.questions}
    assert (asked["part"].type, asked["part"].example) == ("a constant, as #FLANSCH", "#FLANSCH")
    assert asked["job.NR"].type == "whole number"
    assert asked["tray[2].OFFS"].type == "position"
    answered = read(body, tmp_path, 'part = "#deckel"\n"job.NR" = 4')
    assert len(answered.moves) == 3


def test_what_ethernet_calls_return_is_asked_as_a_status_that_is_well(tmp_path: Path) -> None:
    body = (
        "DECL EKI_STATUS ret\n" + START + 'ret=EKI_Open("cam")\nIF ret.Msg_No<>0 THEN\nHALT\n'
        "PTP {A1 5}\nENDIF\nPTP {A1 7}\n"
    )
    (question,) = (q for q in read(body, tmp_path).questions if "EKI_Open" in q.key)
    assert "EKI_STATUS" in question.type
    assert dict(question.example) == {"MSG_NO": 0, "READ": 1, "BUFF": 0, "CONNECTED": True}
    well = "'EKI_Open(\"cam\")' = { MSG_NO = 0 }"
    assert len(read(body, tmp_path, well).moves) == 2
    assert len(read(body, tmp_path, well.replace("0", "7")).moves) == 3


def test_a_menu_in_a_structure_that_a_computer_writes_is_asked_for_and_answered(
    tmp_path: Path,
) -> None:
    body = (
        "pc.job=0\npc.dx=0.0\n"
        + START
        + "LOOP\nSWITCH pc.job\nCASE 4\nPTP {A1 5}\npc.job=0\nCASE 7\nPTP {A1 9}\npc.job=0\n"
        + "ENDSWITCH\nENDLOOP\n"
    )
    program = read(body, tmp_path)
    assert len(program.moves) == 2
    assert "moves the robot only if others" in said(program) and "PC.JOB" in said(program).upper()
    (question,) = (q for q in program.questions if q.key.lower() == "pc.job")
    assert question.type == "whole number"
    assert turns(read(body, tmp_path, '"pc.job" = 7').moves) == [0, 9]
    menu = '[sequences]\n"pc.job" = [7, 4, 9, 7]\n[passes]\n"m.src:5" = 4'
    assert turns(read(body, tmp_path, menu).moves) == [0, 9, 5, 9]


def turns(moves: Sequence[Move]) -> list[float]:
    return [round(degrees(move.target.joints[0])) for move in moves]  # type: ignore[union-attr]


def test_a_shift_behind_a_place_that_nobody_knows_is_no_place(tmp_path: Path) -> None:
    body = (
        "DECL FRAME up\nDECL E6POS p\nup={X 0,Y 0,Z 200,A 0,B 0,C 0}\n"
        "p={X 900,Y 0,Z 900,A 0,B 90,C 0}\n"
    )
    moves = "LIN FindPart(3):up\nLIN FindPart(3):cell[2]:up\nLIN FindPart(3):p\nLIN p:FindPart(3)\n"
    program = read(body + START + moves, tmp_path)
    assert [bool(move.open) for move in program.moves] == [False, True, True, False, False]
    assert "FindPart" in program.moves[1].open
    place = '"FindPart(3)" = "{X 900,Y 0,Z 700,A 0,B 90,C 0}"'
    moves = read(body + START + "LIN FindPart(3):up\n", tmp_path, place).moves
    assert moves[-1].target.pose.position == pytest.approx((1.1, 0, 0.7))  # type: ignore[union-attr]


def test_a_count_that_begins_with_an_answer_ends_its_loop(tmp_path: Path) -> None:
    body = (
        START
        + "LOOP\nPTP {A1 5}\nlayer=layer+1\nIF layer==3 THEN\nrow=row+1\nlayer=1\nENDIF\n"
        + "IF row==2 THEN\nGOTO done\nENDIF\nPTP {A1 7}\nENDLOOP\ndone:\nPTP {A1 9}\n"
    )
    program = read(body, tmp_path, "layer = 1\nrow = 0")
    assert turns(program.moves) == [0, 5, 7, 5, 7, 5, 7, 5, 9]
    assert "endless" not in said(program)


def test_a_function_that_the_way_taken_does_not_return_from_is_asked_for(tmp_path: Path) -> None:
    looks = (
        "END\nDEFFCT REAL look()\nDECL REAL k\nk=0\nLOOP\nIF $IN[7] THEN\nIF k>0 THEN\nRETURN k\n"
        "ENDIF\nENDIF\nWAIT SEC 0.1\nENDLOOP\nENDFCT\nDEF other()\n"
    )
    body = START + "LIN_REL {Y 1}\nPTP {X 900,Y 0,Z 300,A 0,B 90,C 0}\n$VEL.CP=look()\n" + looks
    assert "look()" in {question.key for question in read(body, tmp_path).questions}
    answered = read(body, tmp_path, '"look()" = 0.5').questions
    assert next(q for q in answered if q.key == "look()").answered
    with pytest.raises(SourceError, match="ends without RETURN and a value"):
        read(START + "$VEL.CP=n()\nEND\nDEFFCT REAL n()\nENDFCT\nDEF o()\n", tmp_path)


def test_a_frame_that_is_declared_and_nowhere_set_is_assumed_by_its_name(tmp_path: Path) -> None:
    body = (
        "DECL FRAME BASE_DATA[32]\nBASE_DATA[1]={X 1000,Y 0,Z 0,A 0,B 0,C 0}\n"
        + START
        + "$BASE=BASE_DATA[3]\nLIN {X 900,Y 0,Z 700,A 0,B 90,C 0}\n"
    )
    program = read(body, tmp_path)
    assert program.moves[-1].work_object.name == "BASE_DATA[3]"
    assert assumed_places(program) == {1: ("BASE_DATA[3]",)}
    answered = read(
        body, tmp_path, '"BASE_DATA[3]" = { X = 50, Y = 0, Z = 0, A = 0, B = 0, C = 0 }'
    )
    assert not assumed_places(answered)
    assert answered.moves[-1].work_object.pose.position[0] == pytest.approx(0.05)


def test_joints_that_are_singular_themselves_are_no_fault_of_an_unknown_tool(
    tmp_path: Path,
) -> None:
    body = "BAS(#TOOL,3)\n" + START + "PTP {A5 0}\nLIN_REL {Y 50}\n"
    (fault,) = drive(Controller(VENDOR, KR30), read(body, tmp_path)).faults
    assert "it stands so where the move before ends (m.src:4:1), whatever" in fault.message
    assert "TOOL_DATA" not in fault.message


def test_loads_that_no_file_says_are_answered_as_they_are_shown(tmp_path: Path) -> None:
    body = START + "$LOAD=LOAD_DATA[4]\n" + START.replace("A1 0", "A1 9")
    (load,) = [q for q in read(body, tmp_path).questions if q.key == "LOAD_DATA[4]"]
    assert load.example == (("M", 1.0),)
    told = read(body, tmp_path, '"LOAD_DATA[4]" = { M = 12 }').moves[-1].tool.load
    assert told is not None and told.mass == 12.0


@pytest.mark.parametrize(
    ("condition", "holds", "told"),
    [
        *(("$T1", False, True), ("$T2", False, True), ("$AUT", False, True)),
        *(("$EXT", True, False), ("$MODE_OP==#EX", True, "#T2"), ("$MODE_OP<>#AUT", True, "#AUT")),
        ("$MODE_OP==#T1", False, "#T1"),
    ],
)
def test_a_plc_runs_the_program_where_nobody_says_otherwise(krl, condition, holds, told) -> None:
    move = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\n"
    text = f"DEF demo( )\nIF {condition} THEN\n{move}ENDIF\nEND"
    program = krl(src=text, answers=Answers(goes_on=True))
    assert (len(program.moves), program.questions) == (int(holds), ())
    values = {condition.split("=")[0].split("<")[0].lower(): told}
    other = krl(src=text, answers=Answers(goes_on=True, values=values))
    assert len(other.moves) == int(not holds)
