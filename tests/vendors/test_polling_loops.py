"""Loops that drive what others tell them to: another task, a computer, an operator."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

import flyby
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers

EXTERNAL = "[9E9,9E9,9E9,9E9,9E9,9E9]"
RAPID = f"""MODULE m
  RECORD box num count; pos at; ENDRECORD
  RECORD job_of num what; box parts; ENDRECORD
  PERS job_of order:=[0,[2,[0,0,0]]];
  PERS num job:=0;
  PERS bool go_home:=FALSE;
  PERS bool lamps{{3}}:=[FALSE,FALSE,FALSE];
  VAR num n:=0;
  PROC main()
    go_home:=FALSE;
    WHILE TRUE DO
      BODY
      WaitTime 0.1;
    ENDWHILE
  ENDPROC
  PROC A()
    MoveAbsJ [[10,0,0,0,30,0],{EXTERNAL}],v100,fine,tool0;
    MoveAbsJ [[20,0,0,0,30,0],{EXTERNAL}],v100,fine,tool0;
  ENDPROC
  FUNC bool asked()
    RETURN job=1;
  ENDFUNC
ENDMODULE
"""
KRL = """DEF m()
DECL INT own
BAS(#INITMOV,0)
own=0
CMD=0
LOOP
BODY
WAIT SEC 0.1
ENDLOOP
END
DEF A()
PTP {A1 10,A2 -90,A3 90,A4 0,A5 30,A6 0}
PTP {A1 20,A2 -90,A3 90,A4 0,A5 30,A6 0}
END
"""
LIST = """DEFDAT m PUBLIC
DECL GLOBAL INT JOB=0
ENDDAT
"""


def read(vendor: str, body: str, answers: Answers | None = None) -> Program:
    if vendor == "abb":
        return find_vendor("abb").read(RAPID.replace("BODY", body), "m.mod", answers=answers)
    with TemporaryDirectory() as folder:
        main = Path(folder) / "m.src"
        main.write_text(KRL.replace("BODY", body), "utf-8")
        main.with_suffix(".dat").write_text(LIST, "utf-8")
        return find_vendor("kuka").read_file(main, answers=answers)


@pytest.mark.parametrize(
    ("vendor", "body", "writes"),
    [
        ("abb", "IF go_home THEN A; go_home:=FALSE; ENDIF", "go_home"),
        ("abb", "IF go_home A;", "go_home"),
        ("abb", "TEST job CASE 1: A; DEFAULT: ENDTEST", "job"),
        ("abb", "IF asked() THEN A; ENDIF", "job"),
        ("abb", "n:=job; IF n=4 THEN A; ENDIF", "job"),
        ("abb", "n:=n+1; IF job=n+1000000 THEN A; ENDIF", "job"),
        ("abb", "IF elsewhere THEN A; elsewhere:=FALSE; ENDIF", ""),
        ("abb", "IF order.what=3 THEN A; order.what:=0; ENDIF", "order.what, order.parts.count"),
        ("abb", "IF lamps{2} A;", "lamps"),
        ("kuka", "IF CMD==3 THEN\nA()\nENDIF", "CMD"),
        ("kuka", "SWITCH JOB\nCASE 1,2\nA()\nENDSWITCH", "JOB"),
    ],
)
def test_others_are_taken_to_have_written(vendor: str, body: str, writes: str) -> None:
    program = read(vendor, body)
    assert len(program.moves) == 2
    said = [
        note.message for note in program.notes if "moves the robot only if others" in note.message
    ]
    assert bool(writes) is bool(said)
    assert all(writes in message for message in said)
    assert any("one pass is read" in note.message for note in program.notes)


@pytest.mark.parametrize(
    ("vendor", "body"),
    [("kuka", "IF own==3 THEN\nA()\nENDIF"), ("abb", "FOR i FROM 1 TO 2 DO IF i=3 A; ENDFOR")],
)
def test_what_is_the_routines_own_nobody_else_writes(vendor: str, body: str) -> None:
    assert not read(vendor, body).moves


def test_a_motion_that_comes_by_itself_is_waited_for() -> None:
    program = read("abb", "n:=n+1; IF n=3 THEN A; ENDIF")
    assert len(program.moves) == 2
    assert not any("others" in note.message for note in program.notes)


def test_a_component_that_others_write_is_answered_by_its_name() -> None:
    body = "TEST order.what CASE 1: A; CASE 2: A; A; ENDTEST"
    for what, moves in ((1, 2), (2, 4), (3, 0)):
        assert len(read("abb", body, Answers(values={"order.what": float(what)})).moves) == moves


def test_answers_go_before() -> None:
    body = "IF go_home A;"
    assert not read("abb", body, Answers(branches={"m.mod:12": 0})).moves
    # That is the line which `flyby ask` lists: it changes nothing.
    assert read("abb", body, Answers(passes={"m.mod:11": 1})).moves == read("abb", body).moves


@pytest.mark.parametrize(
    ("robot", "text", "driven"),
    [
        (
            "abb/irb1600-6-145",
            "MODULE m\nVAR num cmd;\nVAR num x{4};\nVAR socketdev s;\nVAR robtarget p;\n"
            "PROC main()\n"
            "SocketReceive s\\Str:=msg;\ncmd:=asked(msg);\nTEST cmd\nCASE 1:\n"
            "p:=[[x{1},x{2},x{3}],[x{4},0,0,0],[0,0,0,0]," + EXTERNAL + "];\n"
            "MoveL p,v100,fine,tool0;\nCASE 2:\n"
            "MoveAbsJ [[20,0,0,0,30,0]," + EXTERNAL + "],v100,fine,tool0;\nENDTEST\nENDPROC\n"
            "ENDMODULE\n",
            1,
        ),
        (
            "ur/ur5e",
            "def m():\n  movej([0,-1.5,1.5,-1.5,-1.5,0])\n  d = socket_read_ascii_float(6)\n"
            "  if d[0] == 1:\n    movel(p[d[1],d[2],d[3],0,3.14,0])\n  elif d[0] == 2:\n"
            "    movej([0.5,-1.5,1.5,-1.5,-1.5,0])\n  end\nend\n",
            2,
        ),
    ],
)
def test_a_branch_to_a_known_place_is_taken(robot: str, text: str, driven: int) -> None:
    vendor = find_vendor(robot.partition("/")[0])
    name = f"m{vendor.suffixes[0]}"
    program = vendor.read(text, name, robot=find_robot(robot), answers=Answers(goes_on=True))
    assert [bool(move.open) for move in program.moves] == [False] * driven
    assert any("drives to what nobody knows" in note.message for note in program.notes)
    branch = next(q for q in program.questions if q.table == "branches")
    answered = Answers(goes_on=True, branches={branch.key: 1})
    program = vendor.read(text, name, robot=find_robot(robot), answers=answered)
    assert any(move.open for move in program.moves)


def test_one_place_under_two_names_is_left_from_a_ready_posture() -> None:
    text = RAPID.replace("BODY", "") + (
        f"MODULE b\nCONST jointtarget jHome:=[[0,0,0,0,30,0],{EXTERNAL}];\nPROC home()\n"
        f"MoveAbsJ jHome,v100,fine,tool0;\nMoveAbsJ [[0,0,0,0,30,0],{EXTERNAL}],v100,fine,tool0;\n"
        "ENDPROC\nENDMODULE\n"
    )
    program = flyby.read(text, robot="abb/irb1600-6-145", entry="home")
    assert any("no move leads from one place" in note.message for note in program.notes)
    assert flyby.emulate(program).duration > 0
