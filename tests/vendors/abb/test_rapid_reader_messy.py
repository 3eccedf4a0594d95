"""A program as cells have them, and properties that hold for any text."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.errors import FlybyError, SourceError, Span
from flyby.core.program.move import MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.origin import Ownership, Spans
from flyby.core.program.program import Program
from flyby.core.program.question import QuestionKind
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.limits import ExecutionLimits
from flyby.core.source.reading import ReadOptions
from flyby.vendors.abb.run.reader import read

MESSY = (
    r"""%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE PalletCell(SYSMODULE)
  !**********************************************************
  ! Palettierzelle 3 - Gr"""
    + "ö"
    + r"""ße "B"; nicht ändern!
  !**********************************************************
  PERS tooldata tVac:=[TRUE,[[0,0,185.5],[1,0,0,0]],[4.2,[0,0,80],[1,0,0,0],0,0,0.02]];
  TASK PERS wobjdata wPallet:=[FALSE,TRUE,"",[[900,-400,20],[0.999999,0,0,0.001]],
    [[0,0,0],[1,0,0,0]]];
  CONST robtarget pHome:=[[650.25,0.00,800],[0.0000041,-1.7e-9,1,0],
    [0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  LOCAL CONST robtarget
    pPick :=
    [ [ 300.5 , - 120 , 45 ] ,   ! over the belt
      [0,0.707107,0.707107,0], [0,-1,0,0],
      [9E+09,9E+09,9E+09,9E+09,9E+09,9E+09] ];
  CONST robtarget pSlot{2,2}:=[[[[0,0,10],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
    [[0,200,10],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]],
    [[[300,0,10],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
    [[300,200,10],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]]];
  CONST jointtarget jPark:=[[0,-30,30,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata vPick:=[350,200,5000,1000];
  PERS num nLayer:=2;
  VAR num nHeight:=60;
  VAR clock ckCycle;
  VAR intnum irStop;
  VAR bool bDone;
  CONST string sName:="Layer ""A""\0A";

  PROC Main()
    VAR num nPlaced:=0;
    rInit;
    FOR nL FROM 1 TO nLayer DO
      FOR i FROM 1 TO 2 DO
        FOR j FROM 1 TO Dim(pSlot,2) DO
          rPick \Slow;
          rPlace pSlot{i,j}, (nL-1)*nHeight;
          nPlaced:=nPlaced+1;
          IF nPlaced MOD 4=0 TPWrite "layer done "\Num:=nL;
        ENDFOR
      ENDFOR
    ENDFOR
    MoveJ pHome,v1000,z50,tVac;
    MoveAbsJ jPark\NoEOffs,v500,fine,tVac\WObj:=wobj0;
    bDone:=TRUE;
    Stop;
  ENDPROC

  LOCAL PROC rInit()
    ConfL\Off; ConfJ\On; SingArea\Off;
    AccSet 80,100;
    VelSet 100,2000;
    ClkReset ckCycle; ClkStart ckCycle;
    IDelete irStop;
    CONNECT irStop WITH tStop;
    ISignalDI diStop,1,irStop;
    GripLoad load0;
    ! MoveJ pNotHere,v100,fine,tool0;
    MoveJ pHome,vmax,fine,tVac;
  ENDPROC

  PROC rPick(\switch Slow|switch Fast)
    VAR speeddata v;
    v:=vPick;
    IF Present(Slow) v.v_tcp:=vPick.v_tcp/2;
    MoveJ Offs(pPick,0,0,100),v1000,z50,tVac;
    MoveL pPick,v,fine,tVac;
    Set doVac;
    WaitDI diVac,1\MaxTime:=2;
    WaitTime\InPos,.25;
    MoveL RelTool(pPick,0,0,-100),v500\V:=700,z20\Z:=15,tVac;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      Reset doVac;
      RETRY;
    ENDIF
  ENDPROC

  PROC rPlace(robtarget pTo,num nUp)
    VAR robtarget p;
    p:=Offs(pTo,0,0,nUp);
    MoveL Offs(p,0,0,150),v800,z50,tVac\WObj:=wPallet;
    MoveC Offs(p,20,0,80),p,v200,fine,tVac\WObj:=wPallet;
    Reset doVac; PulseDO\PLength:=0.2,doBlow;
    WaitTime 0.1;
    MoveL Offs(p,0,0,150),v800,z50,tVac\WObj:=wPallet;
  ENDPROC

  TRAP tStop
    StopMove;
    EXIT;
  ENDTRAP
ENDMODULE""".replace("    Move", "\t\tMove")
)

SMALL = """MODULE Small
  CONST robtarget p10:=[[500.5,-0.25,600],[0,0,1,0],[0,-1,0,2],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num n{2}:=[1,0x10];
  PROC main()
    FOR i FROM 1 TO 2 DO
      MoveL Offs(p10,n{i}*2,0,-1.5e1),v100\\V:=250,z10,tool0\\WObj:=wobj0;
      IF i<>1 AND NOT FALSE THEN
        WaitTime 0.5;
      ELSE
        MoveJ p10,v100,fine,tool0;
      ENDIF
    ENDFOR
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "cp1252"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_a_messy_module(codec, end):
    program = read(MESSY.replace("\n", end).encode(codec), "cell.mod")
    assert program.name == "PalletCell"
    kinds = [type(move) for move in program.moves]
    assert kinds == [MoveJ, *[MoveJ, MoveL, MoveL, MoveL, MoveC, MoveL] * 8, MoveJ, MoveJ]
    assert sum(isinstance(s, Wait) for s in program.statements) == 16
    assert sum(isinstance(s, Opaque) and "Vac" in s.text for s in program.statements) == 24
    picks = program.moves[2:49:6]
    assert {round(m.speed.tcp, 9) for m in picks} == {0.175}
    assert {m.origin.target.ownership for m in picks} == {Ownership.SHARED}
    assert all(m.origin.target.datum == "pPick" for m in picks)
    placed = [m.target.pose.position for m in program.moves[5:49:6]]
    assert placed[0] == pytest.approx((0, 0, 0.01))
    assert placed[-1] == pytest.approx((0.3, 0.2, 0.07))
    assert program.moves[0].speed.joint_acceleration_fraction == 0.8
    assert program.moves[-1].target.joints[4] == pytest.approx(1.0471975512)
    said = " ".join(note.message for note in program.notes)
    for word in ("ISignalDI", "WaitDI", "Stop is kept", "TPWrite", "PulseDO"):
        assert word in said


def test_truncated_anywhere_it_never_crashes():
    for length in range(0, len(MESSY) - len("ENDMODULE"), 7):
        with pytest.raises(SourceError) as caught:
            read(MESSY[:length], "cell.mod")
        assert caught.value.span is not None and caught.value.span.start <= length


def test_spans_point_into_the_text_whatever_stands_before():
    before = "\ufeff! é\r\n"
    first, second = read(SMALL, "a"), read((before[1:] + SMALL).encode("utf-8-sig"), "a")
    for move, moved in zip(first.moves, second.moves, strict=True):
        shift = len(before) - 1
        assert moved.origin.statement.start == move.origin.statement.start + shift
        assert moved.origin.statement.line == move.origin.statement.line + 1
        assert moved.origin.statement.column == move.origin.statement.column


TOKEN = re.compile(r'"[^"]*"|[A-Za-z_]\w*|[\d.]+(?:[eE][-+]?\d+)?x?\w*|:=|<>|\S')
BLANKS = st.sampled_from([" ", "\n", "\r\n", "\r", "\t", "  ", " ! noise; [1,2\n", "\n\n!\r\n"])
CASES = st.sampled_from([str.lower, str.upper, str.swapcase, str])


def values(value: object) -> object:
    """All that counts of a value but where it stands and how names are spelt."""
    if isinstance(value, Span):
        return None
    if is_dataclass(value):
        own = {field.name: values(getattr(value, field.name)) for field in fields(value)}
        return type(value).__name__, own
    if isinstance(value, tuple | Spans):
        return [values(part) for part in value]
    return value.lower() if isinstance(value, str) else value


@settings(deadline=None, max_examples=60)
@given(st.data())
def test_layout_and_case_do_not_matter(data):
    tokens = TOKEN.findall(SMALL)
    blanks = data.draw(st.lists(BLANKS, min_size=len(tokens), max_size=len(tokens)))
    cases = data.draw(st.lists(CASES, min_size=len(tokens), max_size=len(tokens)))
    text = "".join(
        (case(token) if token[0].isalpha() else token) + blank
        for token, blank, case in zip(tokens, blanks, cases, strict=True)
    )
    assert values(read(text, "a").statements) == values(read(SMALL, "a").statements)


IMPATIENT = ReadOptions(limits=ExecutionLimits(statements=2000, moves=500))
"""Loops without end are met often here: they are given up early."""

PIECES = st.sampled_from(
    [
        *["MODULE m ", "ENDMODULE", "PROC main() ", "ENDPROC ", "IF ", " THEN ", "ENDIF ", "FOR "],
        *[" FROM ", " TO ", " DO ", "ENDFOR ", "WHILE ", "TRUE", "ENDWHILE ", "TEST ", "CASE 1:"],
        *["ENDTEST ", "GOTO a;", "a: ", "VAR num n{3};", "CONST robtarget p:=", "RETURN ;", "n{2}"],
        *["MoveL p,v100,z10,tool0;", "MoveC ", "Offs(p,1,2,3)", "[[1,2,3],[1,0,0,0]]", "9E9", "-"],
        *[
            ":=",
            ";",
            ",",
            "\\V:=",
            "\\",
            "?",
            "%",
            '"x"',
            '"',
            "!",
            "*",
            "NOT ",
            " AND ",
            "p.trans",
        ],
        *[
            "AccSet 100,",
            "VelSet ",
            "SetDO d,1;",
            "1E308",
            "0",
            "Present(n)",
            "Dim(n,1)",
            "RECORD ",
        ],
    ]
)
BODY = st.lists(PIECES, max_size=25).map("".join)


@settings(deadline=None, max_examples=400)
@given(st.one_of(st.text(max_size=200), st.binary(max_size=200), BODY))
def test_hostile_text_is_refused_and_nothing_else(text):
    try:
        program = read(text, "a.mod", IMPATIENT)
    except FlybyError as error:
        assert isinstance(error, SourceError) and error.span is not None
    else:
        assert isinstance(program, Program)


@settings(deadline=None, max_examples=400)
@given(BODY, BODY)
def test_hostile_statements_are_refused_and_nothing_else(declarations, body):
    point = "CONST robtarget p:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
    data = f"VAR num n{{3}}; {point} {declarations if 'WHILE' not in declarations else ''}"
    text = f"MODULE m {data} PROC main() {body} ENDPROC ENDMODULE"
    try:
        read(text, "a.mod", IMPATIENT)
    except FlybyError as error:
        assert isinstance(error, SourceError) and error.span is not None


@settings(deadline=None, max_examples=200)
@given(st.integers(0, len(MESSY) - 1), st.integers(0, 30), st.text(max_size=5))
def test_damaged_programs_are_refused_or_read(place, length, inserted):
    damaged = MESSY[:place] + inserted + MESSY[place + length :]
    try:
        read(damaged, "a.mod", IMPATIENT)
    except FlybyError as error:
        assert isinstance(error, SourceError) and error.span is not None


@settings(deadline=None, max_examples=100)
@given(
    st.lists(st.floats(-3000, 3000, allow_subnormal=False), min_size=3, max_size=3),
    st.integers(1, 6000),
    st.integers(0, 300),
)
def test_numbers_arrive_in_si_units(position, speed, zone):
    shown = ",".join(repr(v) for v in position)
    target = f"[[{shown}],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    move = f"MoveL {target},v100\\V:={speed},z10\\Z:={zone},tool0;"
    (read_move,) = read(f"MODULE m PROC main() {move} ENDPROC ENDMODULE", "a").moves
    assert read_move.target.pose.position == pytest.approx([v / 1000 for v in position])
    assert read_move.speed.tcp == pytest.approx(speed / 1000)
    assert read_move.zone.tcp == pytest.approx(zone / 1000)


def test_points_that_were_taught_on_a_standing_track_are_one_place_of_it():
    place = "[[600,0,900],[0,0,1,0],[0,0,0,0],[%s,9E9,9E9,9E9,9E9,9E9]]"
    lines = [f"MoveJ {place % e},v100,fine,tool0;" for e in ("2643.66", "2643.67", "2643.8")]
    text = "MODULE m\nPROC main()\n" + "\n".join(lines) + "\nENDPROC\nENDMODULE\n"
    robot = find_robot("abb/irb6640-180-255")
    made = find_vendor("abb").read(text, "m.mod", robot=robot, answers=Answers(goes_on=True))
    assert [bool(move.open) for move in made.moves] == [False, False, True]
    assert "moved from 2643.66 to 2643.8" in made.moves[2].open
    (note,) = (n.message for n in made.notes if "is sent to 2643.66" in n.message)
    assert "[external_axis.eax_a]" in note


def test_external_axes_alone_need_some():
    text = (
        "MODULE m\nPERS jointtarget j:=[[0,0,0,0,0,0],[10,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\n"
        "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n"
        "MoveExtJ j,vrot10,fine;\nENDPROC\nENDMODULE\n"
    )
    robot = find_robot("abb/irb6640-180-255")
    made = find_vendor("abb").read(text, "m.mod", robot=robot, answers=Answers(goes_on=True))
    assert "MoveExtJ moves external axes alone, and the robot has no external axes" in (
        made.moves[1].open
    )


@pytest.mark.parametrize(
    ("instruction", "kept", "lost"),
    [
        ('ReadCfgData path,"upper",n;', ("path", '"rob1_1"'), "n"),
        ('TPReadFK n,path,"a",stEmpty,stEmpty,stEmpty,stEmpty;', ("path", '"rob1_1"'), "n"),
        ("SocketReceive dev\\Str:=path\\Time:=k;", ("k", "3"), "path"),
        ("UIMsgBox path\\Result:=n;", ("path", '"rob1_1"'), "n"),
    ],
)
def test_what_an_instruction_is_only_told_stays_known(instruction, kept, lost):
    name, value = kept
    text = (
        'MODULE m\nVAR string path:="rob1_1";\nVAR num n:=1;\nVAR num k:=3;\nVAR socketdev dev;\n'
        f"PROC main()\n{instruction}\nIF {name}={value} THEN\n"
        "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\nENDIF\nENDPROC\n"
        "ENDMODULE\n"
    )
    made = find_vendor("abb").read(text, "m.mod")
    assert len(made.moves) == 1
    assert [q.key for q in made.questions if q.kind is not QuestionKind.PAUSE] == [lost]


def test_states_of_sockets_are_no_signals():
    text = (
        "MODULE m\nVAR socketdev s;\nPROC main()\nIF SOCKET_CLOSED=5 AND SOCKET_CREATED=1 AND "
        'SOCKET_CONNECTED=2 AND SOCKET_LISTENING=4 AND stEmpty="" THEN\n'
        "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\nENDIF\nENDPROC\n"
        "ENDMODULE\n"
    )
    made = find_vendor("abb").read(text, "m.mod")
    assert len(made.moves) == 1
    assert not made.questions


def test_a_search_finds_a_point_that_another_module_declares():
    robot = find_robot("abb/irb6640-180-255")
    text = (
        "MODULE m\nCONST robtarget p:=[[1300,0,900],[0,0,1,0],[0,0,0,0],"
        "[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\nMoveJ p,v100,fine,tool0;\n"
        "SearchL\\Stop,di1,pf,Offs(p,0,0,-100),v50,tool0;\nMoveL Offs(pf,0,0,50),v50,fine,tool0;\n"
        "ENDPROC\nENDMODULE\n"
    )
    made = find_vendor("abb").read(text, "m.mod", robot=robot)
    heights = [round(1e3 * move.target.pose.position[2]) for move in made.moves]
    assert heights == [900, 800, 850]
    assert any("'pf' is written and not declared" in note.message for note in made.notes)


def test_joint_values_that_nothing_sets_are_asked_for():
    text = (
        "MODULE m\nPERS jointtarget j;\nPROC main()\nMoveAbsJ j,v100,fine,tool0;\n"
        "j.robax:=[0,0,0,0,30,0];\nMoveAbsJ j,v100,fine,tool0;\nENDPROC\nENDMODULE\n"
    )
    vendor = find_vendor("abb")
    made = vendor.read(text, "m.mod")
    assert [move.target.joints[4] for move in made.moves] == pytest.approx([0, 0.5235987755982988])
    assert [question.key for question in made.questions] == ["j"]
    answers = Answers(values={"j": ((1.0,) * 6, (9e9,) * 6)})
    made = vendor.read(text, "m.mod", answers=answers)
    assert made.moves[0].target.joints == pytest.approx([0.017453292519943295] * 6)


ASKS = """MODULE asks
  VAR num x; VAR speeddata vFast; VAR bool b;
  CONST orient DOWN := [0,1,0,0];
  PROC main()
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;
    x := target_pos.x;
    vFast := [travel_speed, 500, 5000, 1000];
    IF go_home OR NOT is_safe THEN TPWrite "home"; ENDIF
    TEST arm_cmd
    CASE "PICK": drop 3, v_drop;
    CASE "STAY": TPWrite "stay";
    ENDTEST
    b := reached;
    IF b AND count_left > 2 TPWrite "more";
    pNow := CRobT(\\Tool:=tHand \\WObj:=wTable);
    MoveJ pick_at, v_pick, z_pick, tPick \\WObj:=wPick;
  ENDPROC
  PROC drop(num n, speeddata v)
    MoveL [[600,0,500+n],DOWN,[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v, fine, tool0;
  ENDPROC
ENDMODULE
"""


def test_questions_say_what_an_answer_looks_like(tmp_path) -> None:
    file = tmp_path / "asks.mod"
    file.write_text(ASKS)
    asked = flyby.ask(file, robot="abb/irb1600-6-145")
    assert {q.key: q.type for q in asked if q.table == "values"} == {
        "target_pos.x": "number",
        "travel_speed": "number",
        "go_home": "true or false",
        "is_safe": "true or false",
        "arm_cmd": "text",
        "v_drop": "speeddata",
        "reached": "true or false",
        "count_left": "number",
        "tHand": "tooldata",
        "wTable": "wobjdata",
        "pick_at": "robtarget",
        "v_pick": "speeddata",
        "z_pick": "zonedata",
        "tPick": "tooldata",
        "wPick": "wobjdata",
    }
    answers = tmp_path / "answers.toml"
    answers.write_text(re.sub(r"(?m)^#(?=[\"\w])", "", asked.toml))
    again = flyby.ask(file, robot="abb/irb1600-6-145", answers=answers)
    assert all(q.answered for q in again if q.table == "values")


@pytest.mark.parametrize(
    ("stray", "asked"),
    [
        ("COST speeddata vSlow:=[20,10,200,10];", {"vslow"}),
        ("PRES num n:=3;", set()),
        ("ENDPROC", set()),
        ("MoveL p,v100,fine,tool0;", set()),
        ("v:=3;", set()),
    ],
)
def test_what_begins_no_part_of_a_module_is_stepped_over(stray, asked):
    p = "[[500,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    speed = "vSlow" if asked else "v100"
    text = (
        f"MODULE M\nCONST robtarget p:={p};\n{stray}\nPERS num other:=1;\n"
        f"PROC main()\nMoveL p,{speed},fine,tool0;\nMoveL Offs(p,0,0,other),v50,fine,tool0;\n"
        "ENDPROC\nENDMODULE\n"
    )
    with pytest.raises(SourceError, match=r"^a.mod:3:1: .* stands where a declaration, PROC"):
        read(text, "a.mod")
    program = read(text, "a.mod", ReadOptions(answers=Answers(goes_on=True, mends=True)))
    assert len(program.moves) == 2
    assert {q.key.lower() for q in program.questions} == asked
    damage = [note for note in program.notes if note.damage]
    assert [note.span.line for note in damage] == [3]
