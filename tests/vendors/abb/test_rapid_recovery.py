"""ERROR handlers take the errors that the program itself makes; others do not come."""

import pytest

import flyby
from flyby.core.errors import FaultCause, SourceError
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions
from flyby.vendors.abb.run.reader import read

P = "[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
AT = f"PROC at(num z)\nMoveL Offs({P},0,0,z),v100,fine,tool0;\nENDPROC"


def heights(body, data="", routines="", **options):
    """Where the moves go, mm."""
    main = f"PROC main()\n{body}\nENDPROC"
    text = f"MODULE M\n{data}\n{main}\n{AT}\n{routines}\nENDMODULE"
    moves = read(text, "a.mod", ReadOptions(**options)).moves
    return [round(1000 * move.target.pose.position[2], 6) for move in moves]


ERRORS = (
    "VAR errnum ERR_A:=-1;\nVAR errnum ERR_B:=-1;\nVAR num n;\nVAR num k:=3;\nVAR num list{2};\n"
)
BOOKED = "BookErrNo ERR_A;\nBookErrNo ERR_B;\n"


@pytest.mark.parametrize(
    ("body", "routines", "wanted"),
    [
        # TRYNEXT goes on behind the statement in which the error came, however deep it stands.
        ("IF k=3 THEN\nRAISE ERR_A;\nat 1;\nENDIF\nat 2;\nERROR\nat 9;\nTRYNEXT;", "", [9, 1, 2]),
        ("at 1/n;\nat 2;\nERROR\nIF ERRNO=ERR_DIVZERO TRYNEXT;\nat 8;", "", [2]),
        # RETRY runs it again, four times at most; the caller gets another error then.
        ("at 6/n;\nERROR\nn:=n+2;\nRETRY;", "", [3]),
        ("f;\nat 1;\nERROR\nat 7;\nIF ERRNO=ERR_EXCRTYMAX TRYNEXT;\nat 8;",
         "PROC f()\nat 1/n;\nERROR\nat 5;\nRETRY;\nENDPROC", [5, 5, 5, 5, 5, 7, 1]),
        # Without a handler the error goes to the caller's, as it does by RAISE in a handler.
        ("f;\nat 1;\nERROR\nat 9;\nTRYNEXT;", "PROC f()\nRAISE ERR_A;\nat 2;\nENDPROC", [9, 1]),
        ("f;\nat 1;\nERROR\nat 9;\nTRYNEXT;",
         "PROC f()\nRAISE ERR_A;\nat 2;\nERROR\nat 3;\nRAISE;\nENDPROC", [3, 9, 1]),
        ("f;\nat 1;\nERROR\nIF ERRNO=ERR_B at 9;\nTRYNEXT;",
         "PROC f()\nRAISE ERR_A;\nERROR\nRAISE ERR_B;\nENDPROC", [9, 1]),
        # The end of a handler, and RETURN in it, leave the routine.
        ("f;\nat 1;", "PROC f()\nRAISE ERR_A;\nat 2;\nERROR\nat 3;\nENDPROC", [3, 1]),
        ("at f(0);\nat 1;", "FUNC num f(num x)\nRETURN 1/x;\nERROR\nRETURN 4;\nENDFUNC", [4, 1]),
        # ERRNO tells errors apart; TEST does, too.
        ("RAISE ERR_B;\nat 1;\nERROR\nTEST ERRNO\nCASE ERR_A:\nat 5;\nCASE ERR_B:\nat 6;\nENDTEST\n"
         "TRYNEXT;", "", [6, 1]),
        # A handler with numbers takes those; another error goes on to the caller.
        ("f;\nat 1;\nERROR\nat 9;\nTRYNEXT;",
         "PROC f()\nRAISE ERR_B;\nERROR (ERR_A)\nat 3;\nTRYNEXT;\nENDPROC", [9, 1]),
        ("RAISE ERR_B;\nat 1;\nERROR (LONG_JMP_ALL_ERR)\nat 3;\nTRYNEXT;", "", [3, 1]),
        # An error in a handler is the caller's.
        ("f;\nat 1;\nERROR\nat 9;\nTRYNEXT;",
         "PROC f()\nRAISE ERR_A;\nERROR\nat 1/n;\nENDPROC", [9, 1]),
        # What the controller finds: indices, arguments that are not there, unknown routines.
        ("at list{k};\nat 1;\nERROR\nIF ERRNO=ERR_OUTOFBND TRYNEXT;", "", [1]),
        ('%"nobody"%;\nat 1;\nERROR\nIF ERRNO=ERR_REFUNKPRC TRYNEXT;', "", [1]),
        ("f;\nat 1;\nERROR\nIF ERRNO=ERR_NOTPRES TRYNEXT;",
         "PROC f(\\num x)\nat x;\nENDPROC", [1]),
        # Loops go on round a handler.
        ("FOR i FROM 1 TO 3 DO\nIF i=2 RAISE ERR_A;\nat i;\nENDFOR\nat 9;\nERROR\nTRYNEXT;", "",
         [1, 2, 3, 9]),
        # What waits for the world makes no error.
        ("WaitDI di1,1\\MaxTime:=2;\nat 1;\nERROR\nat 9;\nRETURN;", "", [1]),
        ('ErrRaise "ERR_B",4800,s,s,s,s,s;\nat 1;\nERROR\nIF ERRNO=ERR_B at 5;\nTRYNEXT;', "",
         [5, 1]),
        ("f;\nat 1;\nERROR\nat 5;\nTRYNEXT;",
         "PROC f()\nRAISE ERR_A;\nERROR\nRaiseToUser\\Continue;\nENDPROC", [5, 1]),
    ],
)  # fmt: skip
def test_the_handler_of_an_error(body, routines, wanted):
    assert heights(BOOKED + body, ERRORS, routines) == wanted


def test_what_nobody_handles_stops_the_program():
    for body, words in (
        ("RAISE ERR_A;", "no ERROR handler takes the error 1"),
        ("at 1/n;", "division by zero"),
        ("RAISE ERR_A;\nERROR\nRAISE;", "no ERROR handler takes the error 1"),
        ("at 1/n;\nERROR\nRETRY;", "tried again 4 times in vain: division by zero"),
        ("RAISE;", "stands outside a handler"),
        ("TRYNEXT;", "outside an error handler"),
    ):
        with pytest.raises(SourceError, match=words) as caught:
            heights(BOOKED + body, ERRORS)
        assert caught.value.span is not None


def test_a_branch_that_raises_is_taken_last_where_its_condition_is_not_known():
    body = "IF di1=0 THEN\nat 3;\nRAISE ERR_A;\nENDIF\nat 1;\nERROR\nat 9;\nTRYNEXT;"
    assert heights(body, ERRORS) == [1]
    assert heights(body, ERRORS, answers=Answers({"di1": 0.0})) == [3, 9, 1]


def test_an_index_beyond_an_array_is_an_error_only_where_the_course_is_certain():
    reading = (
        "WHILE bOn DO\nn:=n+1;\nok:=StrToVal(ReadStr(io),list{n});\nIF ReadBin(io)=3 bOn:=FALSE;\n"
    )
    body = f"{reading}ENDWHILE\nat list{{1}};"
    assert heights(body, ERRORS + "VAR bool bOn:=TRUE;\nVAR bool ok;") == [0]
    with pytest.raises(SourceError, match="index 3 of list is outside 1 to 2"):
        heights("at list{3};", ERRORS)


@pytest.mark.parametrize(
    ("call", "value"),
    [("RunMode()", "RUN_CONT_CYCLE"), ("OpMode()", "OP_AUTO"), ("GetTaskName()", '"T_ROB1"'),
     ("ExecHandler()", "HANDLER_NONE"), ("ExecLevel()", "LEVEL_NORMAL"), ("RobOS()", "TRUE"),
     ("IsStopMoveAct(\\FromMoveTask)", "FALSE"),
     ('ModExist("m")', "TRUE"), ('ModExist("x")', "FALSE")],
)  # fmt: skip
def test_how_the_program_runs_is_known(call, value):
    assert heights(f"IF {call}={value} at 1;\nIF {call}<>{value} at 2;") == [1]


def test_how_the_program_runs_can_be_answered():
    assert heights(
        "IF RunMode()=RUN_CONT_CYCLE at 1;\nat 2;", answers=Answers({"runmode()": 0.0})
    ) == [2]


SHARES = """MODULE shares
  VAR speeddata slow:=[100,500,5000,1000];
  PROC main()
    slow.v_tcp:=MaxRobSpeed()/100*30;
    MoveL [[500,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],slow,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(("answers", "speed"), [({}, 3.0), ({"maxrobspeed()": 6200.0}, 1.86)])
def test_how_fast_the_arm_can_be_is_asked_for(answers, speed) -> None:
    program = read(SHARES, "shares.mod", ReadOptions(answers=Answers(answers)))
    assert program.moves[0].speed.tcp == pytest.approx(speed)
    assert any("MaxRobSpeed()" in str(one) for one in program.questions)
    said = [note for note in program.notes if "speed of MoveL depends on" in str(note)]
    assert bool(said) == (not answers)


def test_the_name_of_an_argument():
    routines = 'PROC f(INOUT num x)\nIF ArgName(x)="k" at 1;\nENDPROC'
    assert heights("f k;", ERRORS, routines) == [1]


FAULTY = """MODULE rows
  CONST robtarget pFirst:=[[500,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num heights{2,2}:=[[600,550],[600,520]];
  PROC main()
    MoveJ pFirst,v500,fine,tool0;
    FOR row FROM 1 TO 3 DO
      MoveL Offs(pFirst,20*row,0,heights{row,2}-600),v200,fine,tool0;
    ENDFOR
    MoveJ pFirst,v500,fine,tool0;
  ENDPROC
  PROC early()
    VAR num deep;
    deep:=1/(heights{1,1}-600);
    MoveJ pFirst,v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_an_error_in_a_target_that_nobody_handles_is_a_fault() -> None:
    run = flyby.emulate(flyby.read(FAULTY, robot="abb/irb2600-12-165"))
    assert [move.kind for move in run.program.moves] == ["MoveJ", "MoveL", "MoveL", "stop", "MoveJ"]
    (fault,) = run.faults
    assert fault.cause is FaultCause.ERROR
    assert fault.span.line == 7
    assert "index 3 of heights is outside 1 to 2: the controller stops the program" in fault.message


def test_an_error_before_the_first_move_is_refused() -> None:
    with pytest.raises(SourceError, match="divi"):
        flyby.read(FAULTY, robot="abb/irb2600-12-165", entry="early")


def test_programs_that_are_read_strictly_are_refused_at_their_errors() -> None:
    with pytest.raises(SourceError, match=r"index 3 of heights is outside 1 to 2$"):
        read(FAULTY, "rows.mod", ReadOptions())


def test_handlers_take_errors_in_the_arguments_of_moves() -> None:
    text = FAULTY.replace(
        "    MoveJ pFirst,v500,fine,tool0;\n  ENDPROC\n  PROC early",
        """\
    MoveJ pFirst,v500,fine,tool0;
  ERROR
    TRYNEXT;
  ENDPROC
  PROC early""",
    )
    run = flyby.emulate(flyby.read(text, robot="abb/irb2600-12-165"))
    assert run.faults == ()
    assert [move.kind for move in run.program.moves] == ["MoveJ", "MoveL", "MoveL", "MoveJ"]
