"""Control flow, routines, files and what the text leaves open."""

# ruff: noqa: E501 - lines of programs are as long as programs have them

from __future__ import annotations

import pytest

from flyby.core.errors import EntryError, InputError, SourceError
from flyby.core.program.move import Opaque, Wait
from flyby.core.registry import find_vendor
from flyby.core.source.execution.answers import Answers, key
from flyby.core.source.reading import ReadOptions
from flyby.vendors.kuka.language import Krl
from flyby.vendors.kuka.write import writer

INIT = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nBAS(#INITMOV,0)\n"
POSE = "{X %s,Y 0,Z 0,A 0,B 0,C 0}"
P = {k: f"LIN {POSE % k}" for k in range(10)}


def visited(program):
    """X of every target, mm."""
    return [round(1000 * m.target.pose.position[0], 6) for m in program.moves]


@pytest.mark.parametrize(
    ("body", "x"),
    [
        ("FOR i=1 TO 3\nLIN_AT(i)\nENDFOR", [1, 2, 3]),
        ("FOR i=3 TO 1 STEP -1\nLIN_AT(i)\nENDFOR", [3, 2, 1]),
        ("FOR i=3 TO 1\nLIN_AT(i)\nENDFOR\nLIN_AT(9)", [9]),
        ("i=0\nWHILE i<2\ni=i+1\nLIN_AT(i)\nENDWHILE", [1, 2]),
        ("i=5\nREPEAT\nLIN_AT(i)\ni=i+1\nUNTIL i>4", [5]),
        ("i=0\nLOOP\ni=i+1\nIF i==3 THEN\nEXIT\nENDIF\nLIN_AT(i)\nENDLOOP", [1, 2]),
        (
            "i=2\nSWITCH i\nCASE 1\nLIN_AT(1)\nCASE 2,3\nLIN_AT(2)\nDEFAULT\nLIN_AT(4)\nENDSWITCH",
            [2],
        ),
        ("i=7\nSWITCH i\nCASE 1\nLIN_AT(1)\nDEFAULT\nLIN_AT(4)\nENDSWITCH", [4]),
        ("m=#second\nSWITCH m\nCASE #FIRST\nLIN_AT(1)\nCASE #Second\nLIN_AT(2)\nENDSWITCH", [2]),
        ("GOTO over\nLIN_AT(1)\nover:\nLIN_AT(2)", [2]),
        ("i=0\nagain:\ni=i+1\nLIN_AT(i)\nIF i<3 THEN\nGOTO again\nENDIF", [1, 2, 3]),
        ("IF 1>2 THEN\nLIN_AT(1)\nELSE\nLIN_AT(2)\nENDIF", [2]),
        ("IF TRUE THEN\nLIN_AT(1)\nENDIF\nRETURN\nLIN_AT(2)", [1]),
        ("LIN_AT(7/2)\nLIN_AT(7/2.0)", [3, 3.5]),
        ("LIN_AT('B101' B_OR 'H0A')\nLIN_AT(B_NOT 0 + 3)", [15, 2]),
        ("i=2.5\nLIN_AT(i)", [3]),
        ("LIN_AT(1+2*3)\nLIN_AT((1+2)*3)", [7, 9]),
        ("b=NOT FALSE AND FALSE\nIF b THEN\nLIN_AT(1)\nELSE\nLIN_AT(2)\nENDIF", [2]),
        ("i=1\nIF i==1 AND i<2 THEN\nLIN_AT(1)\nENDIF", [1]),
        ("i=3\nIF (i>1) EXOR (i>2) THEN\nLIN_AT(1)\nELSE\nLIN_AT(2)\nENDIF", [2]),
        ("n[2]=4\nn[1]=n[2]+1\nLIN_AT(n[1])", [5]),
        ("g[1,2]=6\nLIN_AT(g[1,2])", [6]),
        ("LIN_AT(SQRT(16)+ABS(-2)+SIN(90)+COS(0)+TAN(45))", [9]),
        ("LIN_AT(ATAN2(1,0)/30)", [3]),
        ('s[]="ab"\nLIN_AT(STRLEN(s[]))', [2]),
        ("d.count=3\nLIN_AT(d.count)\nd={w 1.5,count 2}\nLIN_AT(d.w+d.count)", [3, 3.5]),
        ("LIN_AT(double(4))", [8]),
        ("i=1\nbump(i)\nLIN_AT(i)\nkeep(i)\nLIN_AT(i)", [11, 11]),
    ],
)
def test_course(krl, body, x):
    src = f"""DEF demo( )
DECL INT i,n[5],g[3,3]
DECL BOOL b
DECL CHAR s[20]
ENUM order first,second
DECL order m
STRUC dim REAL w,h,INT count
DECL dim d
{INIT}{body}
END
DEF LIN_AT(x:IN)
REAL x
FRAME f
f={POSE % 0}
f.X=x
LIN f
END
DEFFCT REAL double(x:IN)
REAL x
RETURN 2*x
ENDFCT
DEF bump(x:OUT)
INT x
x=x+10
END
DEF keep(x:IN)
INT x
x=x+10
END
"""
    assert visited(krl(src=src)) == x


@pytest.mark.parametrize(
    "body",
    [
        f"LOOP\n{P[1]}\n$OUT[1]=TRUE\nENDLOOP\n{P[2]}",
        f"WHILE TRUE\n{P[1]}\nENDWHILE\n{P[2]}",
        f"REPEAT\n{P[1]}\nUNTIL FALSE\n{P[2]}",
        f"start:\n{P[1]}\nGOTO start\n{P[2]}",
    ],
)
def test_endless_loops_are_read_once(krl, body):
    program = krl(INIT + body)
    assert visited(program) == [1]
    assert any("one pass is read" in note.message for note in program.notes)


def test_a_loop_that_an_input_ends(krl):
    body = f"LOOP\n{P[1]}\nIF $IN[4] THEN\nEXIT\nENDIF\nENDLOOP\n{P[2]}"
    program = krl(INIT + body)
    assert visited(program) == [1, 2]
    assert any("$IN[4]" in note.message for note in program.notes)
    answers = Answers(sequences={key("$IN[4]"): (False, False, True)})
    assert visited(krl(INIT + body, answers=answers)) == [1, 1, 1, 2]


COUNTED = """FOR i=1 TO 3
last=i
ENDFOR
halve(last)
"""
HALVE = "DEF halve(n:IN)\nINT n,half\nhalf=n/2\nEND\n"


@pytest.mark.parametrize(
    ("body", "passed"),
    [
        (f"WHILE run\n{P[1]}\nENDWHILE\n{P[2]}", [1]),
        (f"REPEAT\n{P[1]}\nUNTIL NOT run\n{P[2]}", [1]),
        (f"LOOP\n{P[1]}\nIF NOT run THEN\nEXIT\nENDIF\nENDLOOP\n{P[2]}", [1]),
        # What a pass sets, and sets back, and what a routine has of its own, is no progress.
        (f"WHILE run\nrun=FALSE\n{P[1]}\nrun=TRUE\nENDWHILE", [1]),
        (f"last=3\ni=4\nWHILE run\n{COUNTED}{P[1]}\nENDWHILE\n{P[2]}", [1]),
        # Nor is a change of what does not decide the end.
        (f"WHILE run\nlast=last*0+5\n{P[1]}\nENDWHILE\n{P[2]}", [1]),
        (f"last=0\nWHILE last<9\nlast=last*0+5\n{P[1]}\nENDWHILE\n{P[2]}", [1, 1]),
        # An exit that only an input decides is taken.
        (f"WHILE run\n{P[1]}\nIF $IN[1] THEN\nEXIT\nENDIF\nENDWHILE\n{P[2]}", [1, 2]),
        # Nothing but a wait, for what another task changes.
        (f"WHILE run\nWAIT SEC 0.1\nENDWHILE\n{P[2]}", [2]),
        (f"LOOP\nIF NOT run THEN\nEXIT\nENDIF\nENDLOOP\n{P[2]}", [2]),
        # Progress: the loop ends by itself.
        (f"WHILE last<3\n{P[1]}\nlast=last+1\nENDWHILE\n{P[2]}", [1, 1, 1, 2]),
        (f"g[2]=0\nWHILE g[2]<2\n{P[1]}\ng[2]=g[2]+1\nENDWHILE\n{P[2]}", [1, 1, 2]),
    ],
)
def test_loops_that_change_nothing_are_endless(krl, body, passed):
    src = f"DEF demo( )\n{INIT}{body}\nEND\n{HALVE}"
    data = "BOOL run=TRUE\nINT last=0\nINT i=0\nINT g[3]"
    assert visited(krl(src=src, data=data)) == passed


def test_clocks_and_inputs_go_on_by_themselves(krl):
    body = f"$TIMER[1]=0\n$TIMER_STOP[1]=FALSE\nWHILE $TIMER[1]<500\n{P[1]}\nENDWHILE\n{P[2]}"
    program = krl(INIT + body)
    assert visited(program) == [1, 2]
    assert any("$TIMER[1]" in note.message for note in program.notes)


def test_cases_that_nobody_knows(krl):
    cases = f"CASE there\n{P[1]}\nCASE 2\n{P[2]}\nENDSWITCH"
    assert visited(krl(INIT + f"SWITCH 2\n{cases}")) == [2]
    program = krl(INIT + f"SWITCH 3\n{cases}")
    assert visited(program) == [1]
    assert any("depends on the value of there" in note.message for note in program.notes)
    answers = Answers({key("there"): 4.0})
    assert visited(krl(INIT + f"SWITCH 3\n{cases}", answers=answers)) == []


def test_characters_are_numbers(krl):
    body = f'n=c[1]\nIF (n==50) AND (n>c[2]) AND ("1"<n) THEN\n{P[1]}\nENDIF'
    assert visited(krl(INIT + body, 'DECL INT n\nDECL CHAR c[2]\nc[]="21"')) == [1]
    with pytest.raises(SourceError, match="a whole number is wanted"):
        krl(INIT + 'n="21"', "DECL INT n")


def test_loops_without_end_are_stopped(krl):
    with pytest.raises(SourceError, match="recursion"):
        krl(src="DEF demo( )\nother()\nEND\nDEF other( )\ndemo()\nEND")


def test_unknown_conditions(krl):
    body = f"IF $IN[1] THEN\n$OUT[1]=TRUE\nELSE\n{P[2]}\nENDIF\nWHILE part\n{P[3]}\nENDWHILE"
    program = krl(INIT + body, "SIGNAL part $IN[7]")
    assert visited(program) == [2, 3]
    messages = " ".join(n.message for n in program.notes)
    assert "branch 2 of 2" in messages and "the value of $IN[1]" in messages
    assert "its body runs once" in messages
    answers = Answers({key("$in[1]"): True, key("Part"): False})
    program = krl(INIT + body, "SIGNAL part $IN[7]", answers=answers)
    assert visited(program) == []
    assert Opaque("$OUT[1]=TRUE", True) in program.statements


def test_an_unknown_switch_takes_a_branch_that_moves(krl):
    body = f"SWITCH PGNO\nCASE 1\nSUCCESS=1\nCASE 2\n{P[2]}\nDEFAULT\n{P[3]}\nENDSWITCH"
    assert visited(krl(INIT + body, "INT SUCCESS")) == [2]
    answers = Answers(branches={"demo.src:5": 3})
    assert visited(krl(INIT + body, "INT SUCCESS", answers=answers)) == [3]


def test_what_no_condition_needs_is_not_asked(krl):
    body = f"IF FALSE AND $IN[1] THEN\n{P[1]}\nELSE\n{P[2]}\nENDIF"
    program = krl(INIT + body)
    assert visited(program) == [2]
    assert not any("condition" in n.message for n in program.notes)


def test_answers_of_other_kinds(krl):
    body = "x=$ANIN[1]\nLIN_AT:\nf.X=x+offset.X\nLIN f"
    data = "DECL FRAME f={Y 0,Z 0,A 0,B 0,C 0}\nDECL FRAME offset\nREAL x"
    answers = Answers({key("$ANIN[1]"): 2.5, key("offset"): (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)})
    with pytest.raises(SourceError, match=r"X of the target depends on the value of \$ANIN\[1\]"):
        krl(INIT + body, data)
    program = krl(INIT + body.replace("offset.X", "1"), data, answers=answers)
    assert visited(program) == [3.5]


def test_what_is_passed_is_passed_when_it_is_written_and_read_again(krl):
    program = krl(INIT + f"{P[1]} C_DIS\nCONTINUE\n$OUT[2]=FALSE\n{P[2]}")
    texts = [s.text for s in program.statements if isinstance(s, Opaque)]
    assert texts == ["CONTINUE", "$OUT[2]=FALSE"]
    written = writer.write(program, find_vendor("kuka").robot("kr30-3"), {})
    source = next(text for name, text in written.items() if name.endswith(".src"))
    assert "CONTINUE\n$OUT[2]=FALSE\n" in source.replace("\r", "")


def test_stops(krl):
    body = (
        f"{P[1]}\nIF $IN[1] THEN\nENDIF\n{P[2]}\nCONTINUE\nIF $IN[1] THEN\nENDIF\n{P[3]}\n"
        f"$OUT[1]=TRUE\nCONTINUE\n$OUT[2]=FALSE\n$OUT_C[3]=TRUE\nWAIT SEC 0.25\n"
        "WAIT FOR $IN[2]\nHALT\nPULSE($OUT[1],TRUE,0.5)\n$ANOUT[1]=0.5\nANOUT ON x=1.0*$VEL_ACT"
    )
    statements = krl(INIT + body).statements
    assert statements[1] == Wait(0.0)
    assert [type(s).__name__ for s in statements[2:4]] == ["MoveL", "MoveL"]
    kept = {s.text: s.stops for s in statements if isinstance(s, Opaque)}
    assert kept == {
        "$OUT[1]=TRUE": True,
        "CONTINUE": False,
        "$OUT[2]=FALSE": False,
        "$OUT_C[3]=TRUE": False,
        "WAIT FOR $IN[2]": True,
        "HALT": True,
        "PULSE($OUT[1],TRUE,0.5)": True,
        "$ANOUT[1]=0.5": True,
        "ANOUT ON x=1.0*$VEL_ACT": False,
    }
    assert Wait(0.25) in statements


def test_interrupts_are_kept(krl):
    body = f"INTERRUPT DECL 5 WHEN $IN[1] DO stop_it()\nINTERRUPT ON 5\n{P[1]}\nINTERRUPT OFF"
    program = krl(INIT + body)
    assert len([s for s in program.statements if isinstance(s, Opaque)]) == 3
    assert sum("interrupts are not emulated" in n.message for n in program.notes) == 1


def test_calls_in_other_files(krl):
    files = {
        "PICK.SRC": f"&ACCESS RVP\nDEF PICK( )\n{P[4]}\nhelper()\nEND\nDEF helper( )\nLIN own\nEND\n",
        "Pick.dat": f"DEFDAT PICK\nDECL E6POS own={POSE % 5}\nENDDAT\n",
        "lib.src": "DEF lib( )\nEND\nGLOBAL DEF place(n:IN)\nINT n\nLIN shared\nEND\n",
        "lib.dat": f"DEFDAT lib PUBLIC\nDECL GLOBAL FRAME shared={POSE % 6}\nENDDAT\n",
    }
    assert visited(krl(INIT + "pick()\nPLACE(1)", files=files)) == [4, 5, 6]
    program = krl(INIT + "helper()\n" + P[1], files=files)
    assert visited(program) == [1]
    assert any("unknown routine 'helper'" in n.message for n in program.notes)


def test_unknown_routines(krl):
    program = krl(INIT + f"n=3\nfetch(n)\n{P[1]}\nIF n==3 THEN\n{P[2]}\nENDIF", "INT n")
    assert visited(program) == [1, 2]
    messages = " ".join(n.message for n in program.notes)
    assert "as if it moved nothing" in messages and '[calls] fetch = "skip"' in messages
    assert "what fetch gave n" in messages
    answers = Answers(skipped=frozenset({"fetch"}))
    program = krl(INIT + f"fetch(1)\n{P[1]}", answers=answers)
    assert visited(program) == [1] and program.statements[0].text == "fetch(1)"


def test_unknown_functions_and_data(krl):
    body = (
        f"r=measure(1)\nIF r>5 THEN\n{P[1]}\nENDIF\nother_flag=TRUE\nIF nowhere THEN\n{P[2]}\nENDIF"
    )
    program = krl(INIT + body, "REAL r")
    assert visited(program) == [1, 2]
    messages = " ".join(n.message for n in program.notes)
    assert "measure()" in messages and "other_flag is declared in no file" in messages


def test_a_file_that_cannot_be_read_is_left_out(krl):
    program = krl(INIT + P[1], files={"bad.src": "DEF bad(\nLIN\n", "$config.dat": "DEFDAT x\n?"})
    assert visited(program) == [1]
    assert any("$config.dat cannot be read" in n.message for n in program.notes)


def test_the_entry(krl):
    src = f"DEF first( )\n{INIT}{P[1]}\nEND\nDEF demo( )\n{INIT}{P[2]}\nEND\nDEF with(a:IN)\nEND"
    assert visited(krl(src=src)) == [2]
    assert krl(src=src).name == "demo"
    assert visited(krl(src=src, entry="FIRST")) == [1]
    with pytest.raises(SourceError, match=r"there is no DEF 'third'"):
        krl(src=src, entry="third")


def test_the_entry_of_a_file_with_no_def_of_its_name(krl):
    """The one that no other calls, wherever it stands; where several may be meant, none."""
    src = f"DEF first( )\n{INIT}{P[1]}\nEND\nDEF last( )\n{INIT}{P[2]}\nEND\nDEF idle( )\nEND"
    with pytest.raises(EntryError, match=r"one of first \(1 move\), last \(1 move\), idle"):
        krl(src=src)
    assert visited(krl(src=src, entry="last")) == [2]
    calls = src.replace("DEF last( )\n", "DEF last( )\nfirst()\n")
    program = krl(src=calls)
    assert program.name == "last" and visited(program) == [1, 2]
    assert "no DEF is called like the file; last, which no other calls" in program.notes[0].message
    assert krl(src=src.replace("last( )", "last(a:IN)")).name == "first"


def test_an_entry_without_a_caller(krl):
    body = f"""IF NOT (VARSTATE("place")==#INITIALIZED) THEN
place=1
ENDIF
SWITCH place
CASE 1
{P[1]}
CASE 2
{P[2]}
ENDSWITCH
"""
    src = f"DEF demo(place:IN)\nINT place\n{INIT}{body}END\nDEF other( )\nEND"
    program = krl(src=src)
    assert visited(program) == [1]
    assert any("its arguments (place) have no values" in note.message for note in program.notes)
    answers = Answers({key("place"): 2.0})
    without = src.replace("IF NOT", "IF FALSE AND NOT")
    assert visited(krl(src=without, answers=answers)) == [2]
    with pytest.raises(
        SourceError, match="whose index depends on the value of place, which nothing sets"
    ):
        krl(src=f"DEF demo(place:IN)\nINT place\n{INIT}LIN P[place]\nEND", data="DECL FRAME P[3]")
    with pytest.raises(SourceError, match="holds functions"):
        krl(src="DEFFCT INT demo( )\nRETURN 1\nENDFCT")


def write(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text.encode("cp1252"))
    return path


def test_a_file_whose_name_ends_in_the_brackets_of_a_call(tmp_path):
    main = write(tmp_path, "cell/main().src", "DEF main( )\nBAS(#INITMOV,0)\nLift()\nEND")
    write(tmp_path, "cell/up/Lift().src", "DEF Lift( )\nLIN XP1\nEND")
    write(tmp_path, "cell/up/Lift().dat", f"DEFDAT Lift\nDECL FRAME XP1={POSE % 3}\nENDDAT")
    assert visited(Krl().read_file(main, ReadOptions())) == [3]


def test_a_controller_s_tree(tmp_path):
    main = write(
        tmp_path, "R1/Program/Cell.src", "DEF Cell( )\nBAS(#INITMOV,0)\nBAS(#BASE,1)\nfetch()\nEND"
    )
    write(tmp_path, "R1/Program/CELL.DAT", "DEFDAT CELL\nENDDAT")
    write(tmp_path, "R1/Program/sub/Fetch.src", "DEF Fetch( )\n;für alle\nLIN XP1\nEND")
    write(tmp_path, "R1/Program/sub/Fetch.dat", f"DEFDAT Fetch\nDECL FRAME XP1={POSE % 3}\nENDDAT")
    write(tmp_path, "R1/Program/unused.src", "DEF unused( )\nEND")
    write(
        tmp_path,
        "R1/System/$config.dat",
        "DEFDAT $CONFIG\nDECL FRAME BASE_DATA[8]\nBASE_DATA[1]={X 500.0,Y 0,Z 0,A 0,B 0,C 0}\nENDDAT",
    )
    program = Krl().read_file(main, ReadOptions())
    assert visited(program) == [3]
    assert program.moves[0].work_object.pose.position == (0.5, 0, 0)
    names = sorted(name.rpartition("/")[2] for name in program.reading.files)
    assert names == ["$config.dat", "CELL.DAT", "Cell.src", "Fetch.dat", "Fetch.src"]
    assert program.reading.main == str(main)


def test_a_frame_that_the_configuration_leaves_open_is_told(tmp_path):
    text = "DEF main( )\nBAS(#INITMOV,0)\nBAS(#BASE,2)\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 5,A6 0}\nEND"
    main = write(tmp_path, "main.src", text)
    text = "DEFDAT $CONFIG\nDECL FRAME BASE_DATA[8]\nBASE_DATA[1]={X 5,Y 0}\nENDDAT"
    write(tmp_path, "$config.dat", text)
    notes = [str(note) for note in Krl().read_file(main, ReadOptions()).notes]
    assert any("BASE_DATA[2] is in no $config.dat at hand: a frame of zeros" in n for n in notes)


def test_files_that_the_user_names(tmp_path):
    main = write(tmp_path, "a/main.src", f"DEF main( )\n{INIT}fetch()\nEND")
    other = write(tmp_path, "b/fetch.src", f"DEF fetch( )\n{P[2]}\nEND")
    assert visited(Krl().read_file(main, ReadOptions(others=(other,)))) == [2]
    assert visited(Krl().read_file(main, ReadOptions(others=(other.parent,)))) == [2]
    program = Krl().read_file(main, ReadOptions())
    assert not program.moves and "unknown routine 'fetch'" in program.notes[0].message
    with pytest.raises(InputError, match="cannot be read"):
        Krl().read_file(main, ReadOptions(others=(tmp_path / "none.src",)))


def test_a_data_list_is_no_program(tmp_path, krl):
    data = write(tmp_path, "x.dat", "DEFDAT x\nENDDAT")
    with pytest.raises(SourceError, match=r"read the \.src of the same name"):
        Krl().read_file(data, ReadOptions())
    with pytest.raises(SourceError, match="holds data"):
        krl(src="DEFDAT demo\nENDDAT")


@pytest.mark.parametrize(
    ("body", "passed"),
    [
        # The step is added to what the body has made of the counter.
        ("FOR i=1 TO 8\nLIN_AT(i)\ni=i+1\nENDFOR\nLIN_AT(i)", [1, 3, 5, 7, 9]),
        ("FOR i=8 TO 1 STEP -2\ni=i-1\nLIN_AT(i)\nENDFOR\nLIN_AT(i)", [7, 4, 1, -1]),
        ("FOR i=1 TO 100\nLIN_AT(i)\nIF i==2 THEN\ni=100\nENDIF\nENDFOR", [1, 2]),
        ("FOR i=1 TO 4\nskip(i)\nLIN_AT(i)\nENDFOR", [2, 4]),
        ("FOR g[2]=1 TO 4\nLIN_AT(g[2])\ng[2]=g[2]+1\nENDFOR", [1, 3]),
        # A parameter by reference is the item that it was at the call.
        ("i=1\nboth(i,g[i])\nLIN_AT(g[1])\nLIN_AT(i)", [7, 2]),
        # Once the loop is left by EXIT the counter is where it was.
        ("FOR i=1 TO 9\nIF i==3 THEN\nEXIT\nENDIF\nENDFOR\nLIN_AT(i)", [3]),
        ("FOR i=1 TO 3\nENDFOR\nLIN_AT(i)", [4]),
        ("FOR i=5 TO 3\nENDFOR\nLIN_AT(i)", [5]),
        # The bounds are those from before the loop.
        ("last=2\nFOR i=1 TO last\nLIN_AT(i)\nlast=9\nENDFOR", [1, 2]),
        ("i=3\nFOR i=i TO i+1\nLIN_AT(i)\nENDFOR", [3, 4]),
        ("FOR i=1 TO 2\nFOR last=1 TO 2\nLIN_AT(last)\nlast=last+1\nENDFOR\nENDFOR", [1, 1]),
        # It never gets on: endless, and read once.
        (f"FOR i=1 TO 3\n{P[4]}\ni=i-1\nENDFOR\nLIN_AT(9)", [4]),
        # What the counter becomes is not known.
        ("FOR i=1 TO 5\nLIN_AT(7)\ni=$ANIN[1]\nENDFOR\nLIN_AT(9)", [7, 9]),
        # The robot's place ends the loop.
        (f"{P[9]}\nWHILE $POS_ACT.X>5\nLIN_REL {{X -2}}\nENDWHILE", [9, 7, 5]),
        (f"{P[9]}\nREPEAT\nLIN_REL {{X -3}}\nUNTIL $POS_ACT.X<1", [9, 6, 3, 0]),
    ],
)
def test_counters_are_data(krl, body, passed):
    src = (
        f"DEF demo( )\n{INIT}{body}\nEND\n"
        "DEF LIN_AT(n:IN)\nINT n\nFRAME at\nat=$NULLFRAME\nat.X=n\nLIN at\nEND\n"
        "DEF skip(n:OUT)\nINT n\nn=n+1\nEND\n"
        "DEF both(n:OUT,m:OUT)\nINT n,m\nn=n+1\nm=7\nEND\n"
    )
    assert visited(krl(src=src, data="INT last=0\nINT i=0\nINT g[3]")) == passed


def test_a_bound_that_the_body_changes_is_told(krl):
    body = f"FOR i=1 TO last\n{P[1]}\nlast=1\nENDFOR"
    (note,) = [
        n for n in krl(INIT + body, "INT last=3\nINT i").notes if "changes last" in n.message
    ]
    assert note.span.line == 5


# -------------------------------------------------------- outputs that the program has set

SIGNALS = "SIGNAL grip $OUT[3]\nSIGNAL job $OUT[11] TO $OUT[14]\nSIGNAL part $IN[1] TO $IN[3]"


def branch(condition):
    return f"IF {condition} THEN\n{P[1]}\nENDIF\n{P[9]}"


@pytest.mark.parametrize(
    ("body", "passed"),
    [
        # The program knows what it has written.
        (f"$OUT[3]=FALSE\n{branch('$OUT[3]')}", [9]),
        (f"$OUT[3]=TRUE\n{branch('$OUT[3]==TRUE')}", [1, 9]),
        (f"grip=FALSE\n{branch('grip')}", [9]),
        (f"grip=FALSE\n{branch('$OUT[3]')}", [9]),
        (f"$OUT[3]=FALSE\n{branch('grip==TRUE')}", [9]),
        (f"$OUT_C[3]=FALSE\n{branch('grip')}", [9]),
        (f"i=3\n$OUT[i]=FALSE\ni=4\n$OUT[i]=TRUE\n{branch('$OUT[3]')}", [9]),
        (f"job=5\n{branch('job<>5')}", [9]),
        (f"job=5\n{branch('$OUT[12]')}", [9]),
        (f"job=5\n{branch('$OUT[11] AND $OUT[13]')}", [1, 9]),
        (f"job=0\n$OUT[12]=TRUE\n{branch('job==2')}", [1, 9]),
        (f"job=21\n{branch('job==5')}", [1, 9]),
        (
            f"$OUT[11]=TRUE\n$OUT[12]=TRUE\n$OUT[13]=FALSE\n$OUT[14]=FALSE\n{branch('job==3')}",
            [1, 9],
        ),
        (f"$ANOUT[1]=0.5\n{branch('$ANOUT[1]>0.6')}", [9]),
        (f"$FLAG[1]=FALSE\n{branch('$FLAG[1]')}", [9]),
        (f"put(3,FALSE)\n{branch('grip')}", [9]),
        # Inputs, and what nobody has written, are not known: branches that move are taken.
        (branch("$OUT[3]"), [1, 9]),
        (f"$OUT[3]=FALSE\n{branch('$IN[3]')}", [1, 9]),
        (f"$OUT[11]=TRUE\n{branch('job==2')}", [1, 9]),
        (branch("part==2"), [1, 9]),
        # Nor is what is not certain.
        (f"$OUT[3]=FALSE\n$OUT[3]=$IN[1]\n{branch('grip')}", [1, 9]),
        (f"$OUT[3]=FALSE\nPULSE($OUT[3],TRUE,0.5)\n{branch('grip')}", [1, 9]),
        (f"grip=FALSE\nPULSE(grip,TRUE,0.5)\n{branch('$OUT[3]')}", [1, 9]),
        (f"job=0\nPULSE($OUT[12],TRUE,0.5)\n{branch('job==2')}", [1, 9]),
        (f"PULSE(grip,TRUE,0.5)\ngrip=FALSE\n{branch('grip')}", [9]),
        (
            f"TRIGGER WHEN DISTANCE=0 DELAY=20 DO $OUT[3]=TRUE\ngrip=FALSE\n{P[5]}\n"
            + branch("grip"),
            [5, 1, 9],
        ),
        (
            f"grip=FALSE\n$OUT[4]=FALSE\nTRIGGER WHEN PATH=-5 DELAY=0 DO set3( ) PRIO=-1\n{P[5]}\n"
            f"{branch('grip')}\n{branch('$OUT[4]')}",
            [5, 1, 9, 9],
        ),
        (
            "INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO set3( )\nINTERRUPT ON 3\ngrip=FALSE\n"
            f"$OUT[4]=FALSE\n{branch('grip')}\n{branch('$OUT[4]')}",
            [1, 9, 9],
        ),
        (f"grip=FALSE\nGRP(1,2)\n{branch('grip')}", [1, 9]),
        # Somebody else changes what the program waits for.
        (f"i=2\nWAIT FOR ready( ) AND (i==5)\n{branch('i==2')}", [9]),
        (f"grip=TRUE\nWAIT FOR NOT grip\n{branch('NOT grip')}", [1, 9]),
        (f"grip=TRUE\nWAIT FOR NOT grip\n{branch('grip')}", [9]),
        (f"grip=TRUE\n$OUT[4]=FALSE\nWAIT FOR NOT grip AND $OUT[4]\n{branch('$OUT[4]')}", [1, 9]),
        (f"i=2\nWAIT FOR i==5\n{branch('i<>5')}", [9]),
        (f"i=2\nWAIT FOR (i==5) OR (i==6)\n{branch('i==2')}", [1, 9]),
        (f"grip=TRUE\nWAIT FOR 0 < 1\n{branch('NOT grip')}", [9]),
        (f"i=2\nWAIT FOR $IN[1] AND (i==5)\n{branch('i==2')}", [9]),
        (f"grip=TRUE\nWHILE grip\nWAIT SEC 0.1\nENDWHILE\n{branch('NOT grip')}", [1, 9]),
        (f"grip=TRUE\nREPEAT\nWAIT SEC 0.1\nUNTIL grip==FALSE\n{P[9]}", [9]),
        (f"grip=TRUE\nWHILE grip\n{P[3]}\nENDWHILE\n{P[9]}", [3, 9]),
        (f"grip=TRUE\nLOOP\n{P[3]}\nIF NOT grip THEN\nEXIT\nENDIF\nENDLOOP\n{P[9]}", [3, 3, 9]),
        (f"grip=TRUE\nw:\nWAIT SEC 0.1\nIF grip THEN\nGOTO w\nENDIF\n{P[9]}", [9]),
        # It changes it itself.
        (
            f"grip=TRUE\ni=0\nWHILE grip\ni=i+1\n{P[3]}\nIF i==3 THEN\ngrip=FALSE\nENDIF\nENDWHILE\n"
            + P[9],
            [3, 3, 3, 9],
        ),
    ],
)
def test_outputs_keep_what_the_program_sets(krl, body, passed):
    src = (
        f"DEF demo( )\n{INIT}{body}\nEND\nDEF set3( )\nhelp( )\nEND\nDEF help( )\ngrip=TRUE\nEND\n"
        "DEF put(n:IN,v:IN)\nINT n\nBOOL v\n$OUT[n]=v\nEND\n"
        "DEFFCT BOOL ready( )\nRETURN ($IN[1])\nENDFCT\n"
    )
    assert visited(krl(src=src, data=f"INT i=0\n{SIGNALS}")) == passed


def test_answers_to_outputs_and_bits(krl):
    body = f"{INIT}grip=FALSE\n{branch('grip')}"
    assert visited(krl(body, SIGNALS, answers=Answers({"grip": True}))) == [9]
    assert visited(krl(body, SIGNALS, answers=Answers(sequences={"grip": (True,)}))) == [1, 9]
    bits = Answers({"$in[1]": False, "$in[2]": True, "$in[3]": False})
    assert visited(krl(INIT + branch("part<>2"), SIGNALS, answers=bits)) == [9]
    skipped = krl(
        f"{INIT}grip=FALSE\nmy_clamp( )\n{branch('grip')}",
        SIGNALS,
        answers=Answers(skipped=frozenset({"my_clamp"})),
    )
    assert visited(skipped) == [1, 9]


@pytest.mark.parametrize(
    ("body", "passed"),
    [
        # Only a branch that nobody can decide ends the loop.
        (f"WHILE run\n{P[1]}\nIF $IN[1] THEN\nrun=FALSE\nENDIF\nENDWHILE\n{P[9]}", [1, 9]),
        (
            f"WHILE run\n{P[1]}\nlast=last+1\nIF $IN[1] THEN\nrun=FALSE\nENDIF\nENDWHILE\n{P[9]}",
            [1, 9],
        ),
        (f"REPEAT\n{P[1]}\nIF $IN[1] THEN\nrun=FALSE\nENDIF\nUNTIL NOT run\n{P[9]}", [1, 9]),
        (f"WHILE run\n{P[1]}\nIF $IN[1] THEN\nstop_it(run)\nENDIF\nENDWHILE\n{P[9]}", [1, 9]),
        (
            f"WHILE run\n{P[1]}\nSWITCH $ANIN[1]\nCASE 1\nrun=FALSE\nENDSWITCH\nENDWHILE\n{P[9]}",
            [1, 9],
        ),
        (
            f"LOOP\n{P[1]}\nIF NOT run THEN\nEXIT\nENDIF\nIF $IN[1] THEN\nrun=FALSE\nENDIF\n"
            f"ENDLOOP\n{P[9]}",
            [1, 9],
        ),
        (f"LOOP\n{P[1]}\nlast=last+1\nIF $IN[1] THEN\nEXIT\nENDIF\nENDLOOP\n{P[9]}", [1, 9]),
        # Something else ends it.
        (
            f"LOOP\n{P[1]}\nlast=last+1\nIF last>2 THEN\nEXIT\nENDIF\n"
            f"IF $IN[1] THEN\nEXIT\nENDIF\nENDLOOP\n{P[9]}",
            [1, 1, 1, 9],
        ),
        (
            f"WHILE run\n{P[1]}\nIF $IN[1] THEN\nrun=FALSE\nENDIF\ncount( )\nENDWHILE\n{P[9]}",
            [1, 1, 1, 9],
        ),
        (
            f"WHILE last<3\n{P[1]}\nlast=last+1\nIF $IN[1] THEN\nlast=9\nENDIF\nENDWHILE\n{P[9]}",
            [1, 1, 1, 9],
        ),
        (
            f"WHILE last<3\n{P[1]}\nlast=last+1\nIF $IN[1] THEN\nrun=FALSE\nENDIF\nENDWHILE\n{P[9]}",
            [1, 1, 1, 9],
        ),
    ],
)
def test_loops_that_an_undecided_branch_ends(krl, body, passed):
    src = f"DEF demo( )\n{INIT}{body}\nEND\nDEF stop_it(b:OUT)\nBOOL b\nb=FALSE\nEND\n"
    src += "DEF count( )\nlast=last+1\nIF last==3 THEN\nrun=FALSE\nENDIF\nEND\n"
    program = krl(src=src, data="BOOL run=TRUE\nINT last=0")
    assert visited(program) == passed
    answers = Answers(passes={"demo.src:5": 3})
    if passed == [1, 9]:
        again = krl(src=src, data="BOOL run=TRUE\nINT last=0", answers=answers)
        assert visited(again) == [1, 1, 1, 9]
