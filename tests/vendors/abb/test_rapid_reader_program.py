"""What a RAPID program executes: data, expressions, control flow, routines, kept statements."""

from __future__ import annotations

import math

import pytest

from flyby.core.errors import InputError, SourceError
from flyby.core.program.move import Opaque, Wait
from flyby.core.source.execution.limits import ExecutionLimits
from flyby.core.source.reading import ReadOptions
from flyby.vendors.abb.run.reader import read, read_file

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
P = f"[[500,0,600],[0,0,1,0],[0,0,0,0],{UNUSED}]"


LIFT = f"PROC at(num z)\nMoveL Offs({P},0,0,z-600),v100,fine,tool0;\nENDPROC\n"


def program(body, data="", routines=""):
    text = f"MODULE M\n{data}\nPROC main()\n{body}\nENDPROC\n{routines}\nENDMODULE"
    return read(text, "a.mod")


def heights(body, data="", routines=""):
    """z in mm of each target, where ``at x;`` is a move to height x."""
    moves = program(body, data, LIFT + routines).moves
    return [round(move.target.pose.position[2] * 1000, 6) for move in moves]


def refusal(body, data="", routines=""):
    with pytest.raises(SourceError) as caught:
        heights(body, data, routines)
    assert caught.value.span is not None
    return str(caught.value)


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        *[("1+2*3", 7), ("-2*3", -6), ("7 DIV 2", 3), ("-7 DIV 2", -3), ("-7 MOD 2", -1)],
        *[("(1+2)*3", 9), ("10/4", 2.5), ("2-3-4", -5), ("-(2+3)", -5), ("- -2", 2)],
        *[("Abs(-3)", 3), ("Sqrt(16)", 4), ("Pow(2,10)", 1024), ("Exp(0)", 1)],
        *[("Sin(30)", 0.5), ("Cos(60)", 0.5), ("Tan(45)", 1), ("ASin(0.5)", 30)],
        *[("ACos(0.5)", 60), ("ATan(1)", 45), ("ATan2(-1,-1)", -135)],
        *[("Round(2.5)", 3), ("Round(-2.345\\Dec:=2)", -2.35), ("Trunc(-2.9)", -2)],
        *[("Distance([0,0,0],[3,4,0])", 5), ("DotProd([1,2,3],[4,5,6])", 32)],
        *[("VectMagn([2,3,6])", 7), ('StrLen("abcd")', 4), ("AbsDnum(-2)", 2)],
        *[("EulerZYX(\\Z,OrientZYX(10,20,30))", 10), ("EulerZYX(\\Y,OrientZYX(10,20,30))", 20)],
        *[("EulerZYX(\\X,OrientZYX(10,20,30))", 30), ("EulerZYX(\\Y,OrientZYX(10,90,0))", 90)],
    ],
)
def test_expressions(expression, value):
    assert heights(f"at {expression};") == [pytest.approx(value, abs=1e-6)]


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        *[("1<2", True), ("2<=2", True), ("3<>3", False), ("[1,2,3]=[1,2,3]", True)],
        *[("TRUE AND NOT FALSE", True), ("TRUE XOR TRUE", False), ('"a"+"b"="ab"', True)],
        *[("NOT TRUE AND FALSE", True), ("FALSE OR 1=1", True), ("NOT FALSE OR TRUE", True)],
        ('StrPart("Robotics",1,5)="Robot"', True),
        ('ValToStr(2)="2" AND NumToStr(1.25,1)="1.2"', True),
    ],
)
def test_conditions(condition, holds):
    assert heights(f"IF {condition} at 1;") == ([1] if holds else [])


def test_vectors_and_frames():
    body = """
      a := [1,0,0] * [0,1,0];
      a := 2 * a + [0,0,1] - [0,0,1]/2;
      at a.z;
      f := PoseMult([[0,0,5],OrientZYX(90,0,0)],[[1,0,0],[1,0,0,0]]);
      at f.trans.y;
      f := PoseMult(f, PoseInv(f));
      at f.trans.y + f.rot.q1;
      a := PoseVect([[0,0,5],OrientZYX(0,0,90)],[0,1,0]);
      at a.z;
      o := OrientZYX(90,0,0) * OrientZYX(-90,0,0);
      at o.q1;
      o := NOrient([3,0,0,4]);
      at o.q4;
      f := DefFrame(p1, p2, p3);
      at EulerZYX(\\Z, f.rot);
    """
    data = f"""VAR pos a; VAR pose f; VAR orient o; VAR robtarget p1:={P};
      VAR robtarget p2:=[[500,9,600],[0,0,1,0],[0,0,0,0],{UNUSED}];
      VAR robtarget p3:=[[400,9,600],[0,0,1,0],[0,0,0,0],{UNUSED}];"""
    assert heights(body, data) == pytest.approx([2.5, 1, 1, 6, 1, 0.8, 90], abs=1e-6)


def test_rel_tool_moves_and_turns_in_the_tool_frame():
    target = program(f"MoveL RelTool({P},10,0,30\\Rz:=90),v100,fine,tool0;").moves[0].target
    # Tool axes of quaternion (0,0,1,0): x to -x, z to -z.
    assert target.pose.position == pytest.approx((0.49, 0, 0.57))
    half = math.sqrt(0.5)
    assert target.pose.quaternion == pytest.approx((0, half, half, 0))


def test_components_elements_and_copies():
    body = """
      p := q;
      p.trans.z := p.trans.z + 5;
      at p.trans.z; at q.trans.z;
      n{2,3} := 7; n{1,1} := n{2,3} * 2;
      at n{1,1}; at Dim(n,2);
      rows{2}.trans.z := 9;
      at rows{2}.trans.z; at rows{1}.trans.z;
      Incr k; Add k, 10; Decr k; at k; Clear k; at k;
    """
    data = f"""VAR robtarget p; PERS robtarget q:={P}; VAR num n{{2,3}}; VAR num k:=1;
      VAR robtarget rows{{2}}:=[{P},{P}];"""
    assert heights(body, data) == [605, 600, 14, 3, 9, 600, 11, 0]


def test_data_may_use_data_declared_later():
    data = "CONST num a:=b*2; CONST num b:=c{2}; CONST num c{2}:=[3,4];"
    assert heights("at a;", data) == [8]


def test_control_flow():
    body = """
      FOR i FROM 1 TO 3 DO at i; ENDFOR
      FOR i FROM 3 TO 2 DO at i; ENDFOR
      FOR i FROM 0 TO 1 STEP 0.5 DO at i; ENDFOR
      WHILE k < 2 DO k := k + 1; at 10 + k; ENDWHILE
      TEST k CASE 1: at 1; CASE 2, 3: at 22; DEFAULT: at 99; ENDTEST
      TEST "x" CASE "y": at 1; DEFAULT: at 33; ENDTEST
      IF k = 1 THEN at 1; ELSEIF k = 2 THEN at 44; ELSE at 3; ENDIF
      back:
      k := k + 1;
      IF k < 5 GOTO back;
      at k;
    """
    expected = [1, 2, 3, 3, 2, 0, 0.5, 1, 11, 12, 22, 33, 44, 5]
    assert heights(body, "VAR num k;") == expected


def test_exit_and_return():
    routines = "PROC part()\nat 1;\nRETURN;\nat 2;\nENDPROC"
    assert heights("part; at 3; EXIT; at 4;", "", routines) == [1, 3]
    assert heights("at 3; ExitCycle; at 4;") == [3]


def test_routines_with_arguments():
    routines = """
      PROC lift(num z\\num extra, \\switch twice, INOUT num count, VAR num list{*})
        count := count + 1;
        list{1} := 5;
        IF Present(extra) at extra;
        at z;
        IF Present(twice) again z\\extra?extra;
      ENDPROC
      PROC again(num z\\num extra)
        IF Present(extra) THEN at z + extra; ELSE at z + 1; ENDIF
      ENDPROC
      FUNC num half(num x)
        IF x > 100 RETURN 100;
        RETURN x / 2;
      ENDFUNC
    """
    body = """
      lift 1, k, n;
      lift 2\\extra:=20\\twice, k, n;
      lift half(6)\\twice, k, n;
      at k; at n{1};
      %"ag"+"ain"% 7;
    """
    expected = [1, 20, 2, 22, 3, 4, 3, 5, 8]
    assert heights(body, "VAR num k; VAR num n{2};", routines) == expected


def test_local_data_hide_global_ones_and_start_anew():
    routines = "PROC part()\nVAR num k:=5;\nk := k + 1;\nat k;\nENDPROC"
    assert heights("part; part; at k;", "VAR num k:=1;", routines) == [6, 6, 1]


def test_an_endless_main_loop_is_read_once():
    result = program(f"WHILE TRUE DO\nMoveJ {P},v100,z10,tool0;\nENDWHILE\nMoveJ bad;")
    assert len(result.moves) == 1
    assert "one pass" in result.notes[-1].message


def test_a_loop_with_a_way_out_is_run_to_its_end():
    body = "WHILE TRUE DO\nk := k + 1;\nat k;\nIF k = 3 GOTO done;\nENDWHILE\ndone:\nat 9;"
    assert heights(body, "VAR num k;") == [1, 2, 3, 9]


def test_loops_without_end_are_refused():
    def refused(body, routines="", **limits):
        options = ReadOptions(limits=ExecutionLimits(**limits))
        lift = f"PROC at(num z)\nMoveL Offs({P},0,0,z-600),v100,fine,tool0;\nENDPROC\n"
        text = f"MODULE M\nVAR num k;\nPROC main()\n{body}\nENDPROC\n{lift}{routines}\nENDMODULE"
        with pytest.raises(SourceError) as caught:
            read(text, "a.mod", options)
        return str(caught.value)

    assert "called each other" in refused("f;", "PROC f()\nf;\nENDPROC")


def test_unknown_values_travel_and_drive_as_their_defaults():
    assert heights(
        "x := DInput(di1); y := x + 1; now := CTime(); at 1;",
        "VAR num x; VAR num y; VAR string now;",
    ) == [1]
    assert heights("IF FALSE AND di1 = 1 at 1;") == []
    data = "VAR num x; VAR robtarget p;"
    for body, z, name in [
        ("x := DInput(di1) + 1;\nat x;", 1, "DInput"),
        ('TPReadNum x, "how many";\nat 2*x-3;', -3, "TPReadNum"),
        ("at n{GInput(gi1)};", 4, "GInput"),
        ("at Max(StrLen(ReadStr(io)),Foo(1)+2);", 2, "ReadStr"),
    ]:
        found = program(body, data + " VAR num n{2}:=[4,5];", LIFT)
        assert heights(body, data + " VAR num n{2}:=[4,5];") == [z]
        assert any(name in note.message and "is taken" in note.message for note in found.notes)
    message = refusal("p := CRobT();\np.trans.z := 5;\nMoveJ p,v100,fine,tool0;", data)
    assert "no move can be driven" in message and "CRobT" in message


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("at 1/0;", "division by zero"),
        ("at Sqrt(-1);", "no finite value"),
        ("at Exp(9999);", "no finite value"),
        ("at 1E308*10;", "too large"),
        ('at "a"+1;', "does not take"),
        ("at n{0};", "index 0 of n is outside 1 to 3"),
        ("at n{4};", "index 4 of n is outside 1 to 3"),
        ("at n{1.5};", "whole number"),
        ("at n{1,2};", "2 indices"),
        ("at p.trans.w;", "components of a pos are x, y, z"),
        ("at k.x;", "no components"),
        ("k := TRUE;", "a num is wanted"),
        ("p := [1,2];", "robtarget has 4 components, not 2"),
        ("c := 2;", "constant"),
        ("two m:=1, 2;", "this argument of two is n, not m"),
        ("at loop;", "depends on itself"),
        ("MoveLL p, v100, z10, tool0;", "did you mean movel?"),
        ("GOTO nowhere;", "no label nowhere"),
        ("RAISE 1;", "no ERROR handler takes the error 1"),
        ("RETRY;", "RETRY stands outside an error handler"),
        ("at 1, 2;", "at takes 1 argument, not 2"),
        ("at 1\\q:=2;", "unknown argument of at 'q'"),
        ("k := Offs(p,0,0);", "Offs takes 4 arguments, not 3"),
        ("k := nothing(1);", "without RETURN"),
        ('%"nix"%;', "unknown routine 'nix'"),
        ("IF k at 1;", "a bool is wanted"),
        ("SearchL di1, 5, p, v100, tool0;", "needs a datum to put its point in"),
        ("TriggL p, v100, z10, tool0;", "takes 5 arguments"),
        ("MoveLDO p, v100, z10, tool0, do1;", "takes 6 arguments"),
    ],
)
def test_refusals(body, words):
    data = f"""VAR num n{{3}}; VAR num k; VAR robtarget p:={P}; CONST num c:=1;
      CONST num loop:=loop2; CONST num loop2:=loop;"""
    routines = "FUNC num nothing(num x)\nENDFUNC\nPROC two(num n, num m)\nENDPROC"
    assert words in refusal(body, data, routines)


def test_kept_statements_stay_in_place_with_one_note_per_kind():
    result = program(
        f"SetDO do1,1;\nMoveJ {P},v100,fine,tool0;\nsetdo \\SDelay:=0.2, do2, 0;\n"
        'WaitTime \\InPos, 0.5;\nWaitUntil di1=1\\MaxTime:=5;\nTPWrite "n: " \\Num:=3;\nStop;'
    )
    texts = [s.text for s in result.statements if isinstance(s, Opaque)]
    assert texts == [
        *["SetDO do1,1;", "setdo \\SDelay:=0.2, do2, 0;", "WaitUntil di1=1\\MaxTime:=5;"],
        *['TPWrite "n: " \\Num:=3;', "Stop;"],
    ]
    assert [s.stops for s in result.statements if isinstance(s, Opaque)] == [0, 0, 1, 0, 1]
    assert result.statements[3] == Wait(0.5)
    kinds = [note.message.split()[0] for note in result.notes]
    assert kinds == ["SetDO", "WaitUntil", "TPWrite", "Stop"]


def test_a_wait_for_an_unknown_time_is_kept_as_a_stop():
    (statement,) = program("WaitTime AInput(ai1);").statements
    assert isinstance(statement, Opaque) and statement.stops
    assert "above zero" in refusal("VelSet 100,0;")


def test_functions_in_messages_run():
    routines = 'FUNC string go()\nat 5;\nRETURN "x";\nENDFUNC'
    assert heights("TPWrite go();", "", routines) == [5]


def test_entries():
    text = f"MODULE Work\nPROC go()\nMoveJ {P},v100,fine,tool0;\nENDPROC\n{{}}\nENDMODULE"
    only = read(text.format(""), "a.mod")
    assert only.name == "Work" and len(only.moves) == 1
    assert "only procedure, go" in only.notes[0].message
    two = text.format(f"PROC rest()\nMoveJ {P},v50,z1,tool0;\nENDPROC\nPROC needs(num x)\nENDPROC")
    assert read(two, "a.mod", ReadOptions("GO")).moves == only.moves
    assert read(two, "a.mod", ReadOptions("rest")).moves[0].speed.name == "v50"
    with pytest.raises(SourceError, match=r"one of go \(1 move\), rest"):
        read(two, "a.mod")
    with pytest.raises(SourceError, match="takes arguments"):
        read(two, "a.mod", ReadOptions("needs"))
    with pytest.raises(SourceError, match="no routine in it can be run"):
        read("MODULE M\nENDMODULE", "a.mod")


def test_several_modules_of_one_text_are_one_program():
    text = f"MODULE A\nCONST robtarget p:={P};\nENDMODULE\nMODULE B\nPROC main()\n"
    text += "MoveJ p,v100,fine,tool0;\nENDPROC\nENDMODULE"
    assert read(text, "a.mod").name == "B"
    twice = "MODULE A\nVAR num p;\nVAR num P;\nPROC main()\nENDPROC\nENDMODULE"
    with pytest.raises(SourceError, match=r"a\.mod:3:1: P is declared twice"):
        read(twice, "a.mod")


def test_values_of_types_that_are_not_read_stay_unknown():
    data = "VAR seamdata s; VAR num k;\nRECORD pair\nnum a;\nclock c;\nENDRECORD\nVAR pair r;"
    routines = "PROC f(seamdata x)\nat x.ignition;\nENDPROC"
    for body in (
        "s := [1,2]; at s.purge;",
        "f 5;",
        "r.c := 5; at r.c;",
        "s.purge := 1; at s.purge;",
    ):
        assert heights(body, data, routines) == [0]
    assert heights("r.a := 3; at r.a;", data) == [3]
    function = "FUNC num wrong()\nRETURN TRUE;\nENDFUNC"
    assert "the value of wrong: a num is wanted" in refusal("at wrong();", "", function)


def test_files(tmp_path):
    path = tmp_path / "Größe.mod"
    path.write_bytes(f"MODULE M PROC main() MoveJ {P},v100,fine,tool0; ENDPROC ENDMODULE".encode())
    origin = read_file(path).moves[0].origin
    assert origin.statement.file == str(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_file(tmp_path / "none.mod")
