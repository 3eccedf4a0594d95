"""What a text leaves open: conditions, loops, answers; what is refused and what is stepped over."""

from __future__ import annotations

import pytest

from flyby.core.errors import SourceError
from flyby.core.program.move import Opaque
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.answers_file import load_answers
from flyby.core.source.execution.limits import ExecutionLimits
from flyby.core.source.reading import ReadOptions
from flyby.vendors.abb.run.reader import read

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
P = f"[[500,0,600],[0,0,1,0],[0,0,0,0],{UNUSED}]"
AT = f"PROC at(num z)\nMoveL Offs({P},0,0,z-600),v100,fine,tool0;\nENDPROC\n"


def program(body, data="", routines="", answers=None, **limits):
    text = f"MODULE M\n{data}\nPROC main()\n{body}\nENDPROC\n{AT}{routines}\nENDMODULE"
    return read(
        text, "a.mod", ReadOptions(answers=answers or Answers(), limits=ExecutionLimits(**limits))
    )


def heights(body, *rest, **options):
    moves = program(body, *rest, **options).moves
    return [round(move.target.pose.position[2] * 1000, 6) for move in moves]


def said(*args, **options):
    return [str(note) for note in program(*args, **options).notes]


# ------------------------------------------------------------------------- branches


@pytest.mark.parametrize(
    ("body", "taken"),
    [
        ("IF di1=1 THEN at 1; ELSE at 2; ENDIF", [1]),
        ("IF di1=1 THEN k:=1; ELSE at 2; ENDIF", [2]),
        ("IF di1=1 THEN k:=1; ELSEIF di2=1 THEN at 2; ENDIF at 9;", [2, 9]),
        ("IF di1=1 THEN k:=1; ELSEIF FALSE THEN at 2; ELSE k:=3; ENDIF at k;", [3]),
        ("IF di1=1 THEN k:=1; ENDIF at k;", [0]),
        ("IF di1=1 at 1;", [1]),
        ("IF di1=1 THEN at 1; EXIT; ELSE at 2; ENDIF", [2]),
        ("IF di1=1 THEN at 1; Stop; ENDIF at 2;", [2]),
        ("IF di1=1 THEN at 1; RETURN; ENDIF at 2;", [2]),
        ("sub; at 9;", [1, 9]),
        ("IF di1=1 THEN quit; ELSE at 2; ENDIF", [2]),
        ("IF k=0 OR di1=1 at 1;", [1]),
        ("IF k=1 AND di1=1 at 1;", []),
        ("IF di1=1 THEN deep; ENDIF", [5]),
        ("TEST GInput(g) CASE 1: k:=1; CASE 2,3: at 3; DEFAULT: at 4; ENDTEST", [3]),
        ("TEST k CASE 1: at 1; CASE n: at 2; DEFAULT: at 4; ENDTEST", [2]),
        ("TEST GInput(gi1) CASE 1: k:=1; DEFAULT: k:=2; ENDTEST at k;", [2]),
        ("again: at 1; IF di1=1 THEN at 2; GOTO again; ENDIF at 3;", [1, 3]),
        ("IF fOther(1,2) THEN at 1; ENDIF", [1]),
        ("IF bIn at 1;", [1]),
        ("k:=a{GInput(g)}; IF k>2 at 1;", [1]),
        ("a{GInput(g)}:=5; IF a{1}>2 at 1;", [1]),
    ],
)
def test_the_first_branch_that_moves_and_comes_back_is_taken(body, taken):
    routines = """
      PROC sub()
        IF di1=1 THEN at 1; RETURN; ENDIF
        at 2;
      ENDPROC
      PROC quit() at 7; EXIT; ENDPROC
      PROC deep() IF di7=1 deeper; ENDPROC
      PROC deeper() at 5; ENDPROC
    """
    data = "VAR num k; VAR num a{3}; VAR num n; PERS bool bIn; VAR signaldi sig;"
    assert heights(f"n := AInput(ai1);\nbIn := TestDI(di1);\n{body}", data, routines) == taken


SEEN = """FUNC num seen()
  WHILE TRUE DO
    IF fOther(1) THEN
      IF k>0 RETURN k;
    ENDIF
    WaitTime 0.1;
  ENDWHILE
ENDFUNC
"""


def test_a_function_that_the_way_taken_does_not_return_from_is_asked_for():
    data = "VAR num k;"
    assert heights("at 1; at seen()+3;", data, SEEN) == [1, 3]
    asked = program("at 1; at seen()+3;", data, SEEN).questions
    assert "seen()" in {question.key for question in asked}
    answers = Answers(values={"seen()": 4.0})
    assert heights("at 1; at seen()+3;", data, SEEN, answers=answers) == [1, 7]
    with pytest.raises(SourceError, match="ends without RETURN and a value"):
        heights("at 1; at none();", data, "FUNC num none() k:=1; ENDFUNC")


def test_a_function_that_is_called_as_an_instruction_is_said_to_be_one():
    said_ = said("at 1; seen; at 2;", "VAR num k;", SEEN)
    assert any("'seen' is a FUNC, which no controller calls as an instruction" in s for s in said_)


def test_a_tool_turned_by_what_is_not_known_points_as_it_would_without():
    body = "p:=%s; p.rot:=OrientZYX(%s); MoveJ p,v100,fine,tool0;"
    data = "VAR robtarget p; VAR num a;"
    (move,) = program("a:=AInput(ai1); " + body % (P, "a,0,180"), data).moves
    assert not move.open
    assert abs(move.target.pose.quaternion[1]) == pytest.approx(1.0)
    with pytest.raises(SourceError, match="the target of MoveJ depends on"):
        program("a:=AInput(ai1); " + body % (P, "a,a,a"), data)


def test_what_was_decided_is_noted_once_with_line_and_branch():
    body = "FOR i FROM 1 TO 3 DO\nIF diPart=1 THEN\nat i;\nELSE\nk:=1;\nENDIF\nENDFOR"
    (note,) = said(body, "VAR num k;")
    assert note.startswith("a.mod:5:4: ")
    assert "diPart" in note and "branch 1 of 2" in note and "(3 times)" in note


def test_a_branch_that_goes_on_is_better_than_one_that_ends_the_program():
    body = (
        'TPReadNum n,"peg";\nIF n=1 THEN\nk:=5;\nELSEIF n=2 THEN\nk:=6;\nELSE\nEXIT;\nENDIF\nat k;'
    )
    assert heights(body, "VAR num n; VAR num k;") == [5]


def test_answers_to_branches_and_passes_by_line():
    body = "IF di1=1 THEN\nat 1;\nELSE\nat 2;\nENDIF\nWHILE di2=0 DO\nat 3;\nENDWHILE"
    assert heights(body) == [1, 3]
    answers = Answers(branches={"a.mod:4": 2}, passes={"a.mod:9": 3})
    assert heights(body, answers=answers) == [2, 3, 3, 3]
    assert said(body, answers=answers) == []
    assert heights(body, answers=Answers(branches={"a.mod:4": 0})) == [2, 3]
    with pytest.raises(SourceError, match="there are 2 branches, not 3"):
        program(body, answers=Answers(branches={"a.mod:4": 3}, file="io.toml"))


def test_what_others_write_into_a_pers_is_answered():
    data = "PERS num z:=0;\nVAR num y:=3;\nPERS pos at0:=[1,2,0];"
    answers = Answers(values={"z": 4.0, "y": 9.0, "at0": (5.0, 6.0, 7.0)})
    assert heights("at z; at y; at at0.z; z:=z+1; at z;", data, answers=answers) == [4, 3, 7, 5]
    assert heights("at z; at at0.z;", data) == [0, 0]
    asked = program("at z;", data, answers=answers).questions
    assert not any(question.key == "z" for question in asked)  # the text says it
    with pytest.raises(SourceError, match="the answer to 'z'"):
        heights("at z;", data, answers=Answers(values={"z": "red"}))


def test_a_datum_of_a_module_that_is_not_at_hand_is_written():
    body = "nDone := 4;\nIncr nDone;\nat nDone;\nsPlc.state := 7;\nnDone := 6;\nat nDone;"
    assert heights(body) == [5, 6]
    first, second = said(body)
    assert first.startswith("a.mod:4:1: 'nDone' is written and not declared in what is at hand")
    assert first.endswith("(3 times, here first)") and second.startswith("a.mod:7:1: 'sPlc' is")


@pytest.mark.parametrize(
    ("condition", "taken"),
    [
        ("bGo", [1]),
        ("NOT bOn", [2]),
        ("bGo=TRUE AND n=3", [1, 3]),
        ("3=n", [3]),
        ("NOT (bOn OR n<>0)", [2]),
        ("n>5", [3]),
        ("bGo OR di1=1", []),
        ("n=0", []),
        ("a{2}=7", [5]),
        ("n<>n", [3]),
        ("DInput(di1)=1 AND bGo", [1]),
        ("NOT (TestDI(di1) OR bOn)", [2]),
        ("TestDI(di1) OR bGo", []),
        ("nMost=9", []),
    ],
)
def test_what_was_waited_for_holds_afterwards(condition, taken):
    """Where it is not known which value satisfied the wait, the branch that moves is taken."""
    data = "VAR bool bGo; VAR bool bOn:=TRUE; VAR num n; VAR num a{3}; CONST num nMost:=1;"
    body = f"""WaitUntil\\Inpos,{condition}\\MaxTime:=3;
      IF bGo at 1;
      IF NOT bOn at 2;
      IF n=3 THEN at 3; ELSEIF n<>0 THEN at 4; ENDIF
      IF a{{2}}=7 at 5;"""
    assert heights(body, data) == taken


def test_elements_are_written_without_touching_copies():
    data = "VAR num a{3}:=[1,2,3]; VAR num b{3}; VAR num m{2,2}:=[[1,2],[3,4]]; VAR num c{2,2};"
    body = """a{2}:=20; b:=a; a{2}:=21; b{3}:=a{2}+1;
      at a{2}; at b{2}; at b{3};
      m{2,1}:=30; m{1,2}:=m{2,1}+1; c:=m; m{2,1}:=0; m{2,2}:=9;
      at c{2,1}; at c{1,2}; at m{2,1}; at m{2,2};
      a:=[5,6,7]; a{1}:=8; at a{1}; at a{3};
      b{GInput(g)}:=1; IF b{1}=4 at 99;"""
    assert heights(body, data) == [21, 20, 22, 30, 31, 0, 9, 8, 7, 99]


# ---------------------------------------------------------------------------- loops


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("WHILE di1=1 DO at 1; ENDWHILE at 2;", [1, 2]),
        ("WHILE di1=1 DO k:=1; ENDWHILE at k;", [0]),
        ("FOR i FROM 1 TO GInput(g) DO at i; ENDFOR at 9;", [1, 9]),
        ("FOR i FROM GInput(g) TO 5 DO k:=1; ENDFOR at k;", [0]),
        ("WHILE TRUE DO at 1; IF di1=1 RETURN; ENDWHILE", [1]),
        ("loop; at 9;", [1, 9]),
        ("WHILE TRUE DO at 1; IF di1=1 GOTO out; at 2; ENDWHILE out: at 9;", [1, 2, 9]),
        ("WHILE bRun DO at 1; n:=n+1; ENDWHILE at 9;", [1]),
        ("WHILE bRun DO at 1; bRun:=FALSE; ENDWHILE at 9;", [1, 9]),
        ("WHILE n<3 DO at n; Incr n; ENDWHILE", [0, 1, 2]),
        ("again: at 1; n:=n+1; GOTO again; at 2;", [1]),
        ("again: at 1; IF di1=1 GOTO out; GOTO again; out: at 9;", [1, 9]),
        ("again: at n; n:=n+1; IF n=3 GOTO out; GOTO again; out: at 9;", [0, 1, 2, 9]),
        ("WHILE TRUE DO at 1; IF di1=1 GOTO next; at 2; next: ENDWHILE", [1, 2]),
        ("WHILE n<2 DO n:=n+1; ENDWHILE WHILE DInput(di1)=1 DO at n; ENDWHILE", [2]),
    ],
)
def test_loops_that_the_text_does_not_end(body, expected):
    routines = "PROC loop()\nWHILE TRUE DO\nat 1;\nIF di1=1 RETURN;\nENDWHILE\nENDPROC"
    assert heights(body, "VAR num k; VAR num n; VAR bool bRun:=TRUE;", routines) == expected


def test_loops_end_by_sequences_of_answers():
    answers = Answers(sequences={"dinput(di1)": (0.0, 0.0, 1.0), "di2": (True, True, False)})
    body = "WHILE DInput( di1 )=0 DO\nat 1;\nENDWHILE\nWHILE di2=1 DO\nat 2;\nENDWHILE\nat 3;"
    assert heights(body, answers=answers) == [1, 1, 2, 2, 3]


# -------------------------------------------------------------------------- answers


def test_answers_to_signals_calls_operators_and_data(tmp_path):
    file = tmp_path / "io.toml"
    file.write_text(
        f"""
        [values]
        di_part = true
        "GInput(giJob)" = 7
        nHeight = 40
        bFlag = 1
        pVision = {P.replace("9E9", "9e9")}
        tGrip = [true, [[0,0,100],[1,0,0,0]], [1,[0,0,1],[1,0,0,0],0,0,0]]
        "aPos{{2}}.trans.z" = 11
        [calls]
        rGripOpen = "skip"
        """
    )
    answers = load_answers(file)
    body = """
      IF di_part=1 at 1;
      IF di_part = high at 2;
      at GInput(giJob);
      TPReadNum nHeight, "height?";
      at nHeight;
      bFlag := TestDI(di9);
      IF bFlag at 3;
      rGripOpen 50, \\Fast;
      pVision := fVision();
      MoveL pVision,v100,fine,tGrip;
      at z;
    """
    data = "VAR num nHeight; VAR bool bFlag; VAR robtarget pVision;"
    read_program = program(body.replace("at z;", ""), data, answers=answers)
    assert [round(m.target.pose.position[2] * 1000) for m in read_program.moves] == [
        *(1, 2, 7, 40, 3, 600)
    ]
    assert read_program.moves[-1].tool.name == "tGrip"
    assert read_program.moves[-1].tool.tcp.position == (0, 0, 0.1)
    kept = [s.text for s in read_program.statements if isinstance(s, Opaque)]
    assert "rGripOpen 50, \\Fast;" in kept
    with pytest.raises(SourceError, match=r"the answer to 'nHeight': a num is wanted"):
        program('TPReadNum nHeight, "?";', data, answers=Answers({"nheight": "high"}))


def test_what_is_assumed_names_the_key_of_its_answer():
    for body, words in (
        ("at GInput(gi1);", '[values] "GInput(gi1)" = …'),
        ("rSomething;\nat 1;", "in the table [calls]"),
        (f"MoveL {P},v100,fine,tNot;", '[values] "tNot" = …'),
    ):
        said = [note.message for note in program(body).notes]
        assert any(words in message for message in said), said


def test_waits_set_their_time_flag_to_false():
    body = "WaitUntil di1=1\\MaxTime:=2\\TimeFlag:=bLate;\nIF bLate at 1;\nat 2;"
    assert heights(body, "VAR bool bLate:=TRUE;") == [2]


def test_signals_are_handed_to_routines_by_their_names():
    routines = "PROC check(VAR signaldi sig)\nIF DInput(sig)=1 at 1;\nIF sig=1 at 2;\nENDPROC"
    assert heights("check diA;", "", routines) == [1, 2]
    assert heights("check diA;", "", routines, answers=Answers({"dia": False})) == [1]


def test_elements_and_components_are_handed_over_by_reference():
    routines = (
        "PROC count(INOUT num n)\nn := n + 1;\nENDPROC\nPROC all(num n{*})\nat n{2};\nENDPROC"
    )
    body = "count a{2};\ncount p.trans.z;\nat a{2};\nat p.trans.z;\nall a;\nall [7,8];"
    assert heights(body, f"VAR num a{{2}}:=[1,2]; VAR robtarget p:={P};", routines) == [
        *(3, 601, 3, 8)
    ]


def test_late_calls():
    routines = "PROC part2()\nat 2;\nENDPROC"
    assert heights('CallByVar "part",2; %"M:part2"%;', "", routines) == [2, 2]
    with pytest.raises(SourceError, match="unknown routine 'part0'"):
        program('%"part"+NumToStr(GInput(g),0)%;')


@pytest.mark.parametrize("call", ['CallByVar "part",GInput(g)', '%"part"+NumToStr(GInput(g),0)%'])
def test_a_late_call_of_an_unknown_number_calls_the_first_of_that_name(call) -> None:
    """A dispatcher that a PLC tells what to do: its routines are what moves the robot."""
    routines = "PROC part12()\nat 12;\nENDPROC\nPROC Part3()\nat 3;\nENDPROC\nPROC party()\nENDPROC"
    assert heights(f"{call};", "", routines, answers=Answers(goes_on=True)) == [3]
    zero = routines + "\nPROC part0()\nat 0;\nENDPROC"
    assert heights(f"{call};", "", zero, answers=Answers(goes_on=True)) == [0]


def test_a_parameter_by_reference_is_the_element_that_it_was_at_the_call():
    both = "PROC both(INOUT num n,INOUT num m)\nn:=n+1;\nm:=7;\nENDPROC"
    body = "n:=1;\nboth n,g{n};\nat g{1};\nat n;"
    assert heights(body, "VAR num n;\nVAR num g{3};", both) == [7, 2]


def test_the_variable_of_a_for_can_only_be_read():
    with pytest.raises(SourceError, match="i is a constant"):
        program("FOR i FROM 1 TO 3 DO\ni:=i+1;\nENDFOR")
    assert heights("k:=2;\nFOR i FROM 1 TO k DO\nk:=9;\nat i;\nENDFOR") == [1, 2]


# -------------------------------------------------------- outputs that the program has set

BY_HAND = "VAR signaldo sig;\nVAR triggdata tg;\nVAR intnum ino;"
ROUTINES = """PROC put(VAR signaldo s,num v)
SetDO s,v;
ENDPROC
TRAP tr
Reset do1;
ENDTRAP"""


@pytest.mark.parametrize(
    ("body", "taken"),
    [
        # The program knows what it has written.
        ("SetDO do1,0; IF DOutput(do1)=1 at 1; at 9;", [9]),
        ("SetDO do1,1; IF DOutput(do1)=1 at 1; at 9;", [1, 9]),
        ("Set do1; IF do1=1 at 1;", [1]),
        ("Reset DO1; IF DOutput(Do1)=high at 1; at 9;", [9]),
        ("SetDO\\Sync,do1,low; IF DOutput(do1)=0 at 1;", [1]),
        ("Set do1; InvertDO do1; IF DOutput(do1)=1 at 1; at 9;", [9]),
        ("SetGO go1,5; TEST GOutput(go1) CASE 4: at 4; CASE 5: at 5; ENDTEST", [5]),
        ("SetAO ao1,2.5; IF AOutput(ao1)>2 at 1;", [1]),
        ("k:=3; SetGO go1,k; k:=1; FOR i FROM 1 TO GOutput(go1) DO at i; ENDFOR", [1, 2, 3]),
        ("put do1,0; IF DOutput(do1)=1 at 1; at 9;", [9]),
        ("put do2,1; put do1,0; IF DOutput(do2)=1 at 2;", [2]),
        ("SetDO do1,0; AliasIO do1,sig; Set sig; IF DOutput(do1)=1 at 1;", [1]),
        ("SetDO do1,1; SetDO do2,0; IF DOutput(do1)=0 OR DOutput(do2)=1 at 1; at 9;", [9]),
        # Inputs, and what nobody has written, are not known: branches that move are taken.
        ("IF DOutput(do1)=1 at 1;", [1]),
        ("SetDO do1,0; IF DInput(do1)=1 at 1;", [1]),
        # Nor is what something else may have written since.
        ("SetDO do1,0; SetDO do1,DInput(di1); IF DOutput(do1)=1 at 1;", [1]),
        ("SetDO do1,0; PulseDO\\PLength:=0.2,do1; IF DOutput(do1)=1 at 1;", [1]),
        ("SetDO do1,0; SetDO\\SDelay:=0.2,do1,1; IF DOutput(do1)=1 at 1;", [1]),
        ("SetDO do1,0; CONNECT ino WITH tr; IF DOutput(do1)=1 at 1;", [1]),
        ("CONNECT ino WITH tr; SetDO do1,0; IF DOutput(do1)=1 at 1;", [1]),
        ("CONNECT ino WITH tr; SetDO do2,0; IF DOutput(do2)=1 at 1; at 9;", [9]),
        (
            f"SetDO do1,0; MoveLDO {P},v100,z10,tool0,do1,1; IF DOutput(do1)=1 at 1;",
            [600, 1],
        ),
        (
            f"SetDO do1,0; SetDO do2,0; TriggIO tg,5\\DOp:=do1,1; TriggL {P},v100,tg,z10,tool0; "
            "IF DOutput(do1)=1 at 1; IF DOutput(do2)=1 at 2;",
            [600, 1],
        ),
        (f'SetDO do1,0; MoveLSync {P},v100,z10,tool0,"rP"; IF DOutput(do1)=1 at 1;', [600, 1]),
        ('SetDO do1,0; IODisable "board",5; IF DOutput(do1)=1 at 1;', [1]),
        ("SetDO do1,0; k:=fOther(); IF DOutput(do1)=1 at 1;", [1]),
        # A write after that is certain again.
        ("PulseDO do1; Reset do1; IF DOutput(do1)=1 at 1; at 9;", [9]),
        # A wait for what the program has not set itself: somebody else sets it.
        ("Set do1; WaitDO do1,0; IF DOutput(do1)=1 at 1; at 9;", [9]),
        ("Set do1; WaitUntil DOutput(do1)=0; IF DOutput(do1)=1 at 1; at 9;", [9]),
        ("Set do1; WaitUntil do1=0; IF DOutput(do1)=1 at 1; at 9;", [9]),
        ("Set do1; WaitUntil do1=0 AND di1=1; at 9;", [9]),
        ("SetGO go1,3; WaitGO go1\\GT,5; IF GOutput(go1)=3 at 1; at 9;", [1, 9]),
        ("Set do1; WHILE DOutput(do1)=1 DO WaitTime 0.1; ENDWHILE at 9;", [9]),
        ("Set do1; WHILE DOutput(do1)=1 DO at 3; ENDWHILE at 9;", [3, 9]),
        ("Set do1; w: WaitTime 0.1; IF DOutput(do1)=1 GOTO w; at 9;", [9]),
        ("Set do1; WHILE TRUE DO at 3; IF DOutput(do1)=0 GOTO out; ENDWHILE out: at 9;", [3, 3, 9]),
        # It changes it itself.
        (
            "Set do1; k:=0; WHILE DOutput(do1)=1 DO k:=k+1; at k; IF k=3 Reset do1; ENDWHILE at 9;",
            [1, 2, 3, 9],
        ),
        (
            "Set do1; k:=0; WHILE DOutput(do1)=1 AND k<3 DO k:=k+1; at k; ENDWHILE at 9;",
            [1, 2, 3, 9],
        ),
        ("Reset do1; n: IF DOutput(do1)=0 THEN at 1; Set do1; GOTO n; ENDIF at 9;", [1, 9]),
    ],
)
def test_outputs_keep_what_the_program_sets(body, taken):
    data = f"VAR num k:=0;\n{BY_HAND}"
    assert heights(body, data, ROUTINES) == taken


def test_answers_to_outputs():
    """One after the other they are what is read; a lasting one is for what nobody has set."""
    body = "SetDO do1,0; IF DOutput(do1)=1 at 1; IF DOutput(do1)=1 at 2; at 9;"
    assert heights(body, answers=Answers({"doutput(do1)": 1.0})) == [9]
    turns = Answers(sequences={"doutput(do1)": (0.0, 1.0)})
    assert heights(body, answers=turns) == [2, 9]
    skipped = "SetDO do1,0; rGrip; IF DOutput(do1)=1 at 1;"
    assert heights(skipped, answers=Answers(skipped=frozenset({"rgrip"}))) == [1]


@pytest.mark.parametrize(
    ("body", "driven"),
    [
        # Only a branch that nobody can decide ends the loop.
        ("WHILE run DO at 1; IF di1=1 run:=FALSE; ENDWHILE at 9;", [1, 9]),
        ("WHILE run DO at 1; k:=k+1; IF di1=1 run:=FALSE; ENDWHILE at 9;", [1, 9]),
        ("WHILE run DO at 1; IF di1=1 THEN off run; ENDIF ENDWHILE at 9;", [1, 9]),
        (
            "WHILE run DO at 1; TEST GInput(g) CASE 1: run:=FALSE; DEFAULT: k:=1; ENDTEST ENDWHILE "
            "at 9;",
            [1, 9],
        ),
        # Something else ends it.
        ("WHILE k<3 DO at 1; k:=k+1; IF di1=1 k:=9; ENDWHILE at 9;", [1, 1, 1, 9]),
        ("WHILE k<3 DO at 1; k:=k+1; IF di1=1 run:=FALSE; ENDWHILE at 9;", [1, 1, 1, 9]),
    ],
)
def test_loops_that_an_undecided_branch_ends(body, driven):
    data = "VAR num k:=0;\nVAR bool run:=TRUE;"
    off = "PROC off(INOUT bool b)\nb:=FALSE;\nENDPROC"
    assert heights(body, data, off) == driven
    if driven == [1, 9]:
        three = Answers(passes={"a.mod:5": 3})
        assert heights(body, data, off, answers=three) == [1, 1, 1, 9]
