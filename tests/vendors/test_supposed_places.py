"""Moves whose place, tool, frame or zone hangs on what nobody says: driven, and not proven."""

from __future__ import annotations

from dataclasses import dataclass, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.program.assumed_places import refuse_assumed
from flyby.core.program.program import Program
from flyby.core.registry import find_vendor
from flyby.core.source.execution.answers import Answers, key
from flyby.core.source.execution.answers_file import load_answers
from flyby.core.source.execution.answers_text import answers_text
from flyby.core.source.reading import ReadOptions

EXTERNAL = ",".join(["9E9"] * 6)


@dataclass(frozen=True)
class Text:
    """A program with one line to be filled in, and a move behind it that is known.

    Args:
        unknown: a number that nobody says.
        hang: lines of which the path hangs on it; ``{n}`` is the number.
        do_not: lines of which it does not.
        chosen: lines of which it hangs on which branch is taken of one that hangs on the number,
            or on how often a loop runs.
        settled: lines of which it does not, though there is such a branch.
    """

    vendor: str
    file: str
    frame: str
    unknown: str
    hang: tuple[str, ...]
    do_not: tuple[str, ...]
    chosen: tuple[str, ...]
    settled: tuple[str, ...]


TEXTS = (
    Text(
        "abb",
        "m.mod",
        f"""MODULE m
CONST robtarget p0:=[[900,0,900],[0,0,1,0],[0,0,0,0],[{EXTERNAL}]];
CONST robtarget two{{{{2}}}}:=[p0,[[900,50,900],[0,0,1,0],[0,0,0,0],[{EXTERNAL}]]];
VAR robtarget p;
VAR pose d:=[[0,0,0],[1,0,0,0]];
VAR num n;
VAR num i;
VAR num k;
PROC main()
MoveJ p0,v500,fine,tool0;
{{line}}
PDispOff;
EOffsOff;
MoveL p0,v500,fine,tool0;
ENDPROC
PROC go(robtarget q)
MoveL q,v500,fine,tool0;
ENDPROC
PROC set(num k)
n:=k;
ENDPROC
PROC shadow(num i)
VAR num k;
k:=i;
i:=i+1;
ENDPROC
PROC seek()
n:=0;
WHILE {{n}}>n DO
n:=n+1;
IF n>5 RETURN;
ENDWHILE
n:=50;
ENDPROC
PROC early()
IF {{n}}>3 RETURN;
n:=10;
MoveL Offs(p0,0,n,0),v500,fine,tool0;
ENDPROC
FUNC num twice(num k)
IF k>20 RETURN 40;
RETURN 2*k;
ENDFUNC
ENDMODULE
""",
        "AInput(ai1)",
        (
            "MoveL Offs(p0,0,0,{n}),v500,fine,tool0;",
            "n:=2*{n};\np:=p0;\np.trans.x:=p.trans.x+n;\nMoveJ p,v500,fine,tool0;",
            "MoveL two{{{n}}},v500,fine,tool0;",
            "MoveL two{{1+{n}}},v500,fine,tool0;",
            "d.trans.x:={n};\nPDispSet d;\nMoveL p0,v500,fine,tool0;",
            "PDispOn \\ExeP:=p0,Offs(p0,{n},0,0),tool0;\nMoveL p0,v500,fine,tool0;",
            "MoveL p0,v500,z10\\Z:={n},tool0;",
            "MoveC Offs(p0,20,{n},0),Offs(p0,40,20,0),v500,fine,tool0;",
        ),
        (
            "MoveL p0,v500\\V:={n},fine,tool0;",
            "IF {n}>3 MoveL two{{2}},v500,fine,tool0;",
            "d.trans.x:={n};\nPDispSet d;\nPDispOff;\nMoveL p0,v500,fine,tool0;",
            "n:={n};\nWaitTime n;\nTPWrite ValToStr(n);",
        ),
        (
            "IF {n}>3 THEN\nn:=10;\nELSE\nn:=30;\nENDIF\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "IF {n}>3 n:=10;\nMoveL Offs(p0,0,2*n+1,0),v500,fine,tool0;",
            "p:=p0;\nIF {n}>3 p.trans.y:=10;\nMoveL p,v500,fine,tool0;",
            "IF {n}>3 n:=1;\nMoveL two{{n+1}},v500,fine,tool0;",
            "p:=p0;\nIF {n}>3 p:=two{{2}};\ngo p;",
            "IF {n}>3 set 10;\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "IF {n}>3 n:=10;\nMoveL Offs(p0,0,twice(n),0),v500,fine,tool0;",
            "MoveL Offs(p0,0,twice({n}),0),v500,fine,tool0;",
            "IF {n}>3 n:=10;\nIF n>5 THEN\np:=two{{2}};\nELSE\np:=p0;\nENDIF\n"
            "MoveL p,v500,fine,tool0;",
            "TEST {n}\nCASE 1:\nn:=10;\nDEFAULT:\nn:=20;\nENDTEST\n"
            "MoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "IF {n}>3 THEN\nd.trans.x:=10;\nPDispSet d;\nENDIF\nMoveL p0,v500,fine,tool0;",
            "IF {n}>3 d.trans.x:=10;\nPDispSet d;\nMoveL p0,v500,fine,tool0;",
            "IF {n}>3 n:=10;\nMoveL p0,v500,z10\\Z:=n,tool0;",
            "n:=0;\nWHILE {n}>n DO\nn:=n+1;\nENDWHILE\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "n:=0;\nFOR i FROM 1 TO {n} DO\nn:=n+1;\nENDFOR\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "early;\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "early;\nMoveL Offs(CRobT(),0,0,20),v500,fine,tool0;",
            "IF {n}>3 MoveL two{{2}},v500,fine,tool0;\np:=CRobT();\nMoveL p,v500,fine,tool0;",
            "n:=0;\nIF {n}>3 GOTO on;\nn:=10;\non:\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "n:=0;\nIF {n}>3 GOTO far;\nnear:\nn:=10;\nfar:\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "seek;\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "FOR i FROM 1 TO 2 DO\nn:=0;\nIF i=2 THEN\nIF {n}>3 GOTO on;\nENDIF\nn:=10;\non:\n"
            "ENDFOR\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "n:=0;\nWHILE n<5 DO\nn:=n+1;\nIF {n}>3 GOTO out;\nENDWHILE\nout:\n"
            "MoveL Offs(p0,0,n,0),v500,fine,tool0;",
        ),
        (
            "IF {n}>3 n:=10;\nMoveL p0,v500\\V:=n,fine,tool0;",
            "IF {n}>3 n:=10;\nn:=0;\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "IF {n}>3 n:=10;\nFOR i FROM 1 TO n DO\nMoveL Offs(p0,0,i,0),v500,fine,tool0;\nENDFOR",
            "IF {n}>3 n:=10;\nset 3;\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "IF {n}>3 n:=10;\ngo p0;",
            "IF {n}>3 MoveL two{{2}},v500,fine,tool0;\nMoveJ p0,v500,fine,tool0;\n"
            "MoveL Offs(CRobT(),0,0,20),v500,fine,tool0;",
            "early;\nn:=0;\nMoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "i:=10;\nk:=5;\nIF {n}>3 shadow 1;\nMoveL Offs(p0,k,i,0),v500,fine,tool0;",
            "n:=0;\nIF {n}>3 GOTO on;\nn:=10;\nMoveL Offs(p0,0,n,0),v500,fine,tool0;\non:",
            "again:\nn:=0;\nIF {n}>3 GOTO again;\nn:=10;\nlater:\n"
            "MoveL Offs(p0,0,n,0),v500,fine,tool0;",
            "IF {n}>3 PDispSet d;\nPDispOff;\nMoveL p0,v500,fine,tool0;",
            "IF {n}>3 THEN\nMoveL Offs(p0,0,10,0),v500,fine,tool0;\nENDIF",
        ),
    ),
    Text(
        "kuka",
        "m.src",
        """DEF m()
DECL E6POS p[2]
DECL E6POS q
DECL REAL n
DECL INT i
BAS(#INITMOV,0)
$TOOL={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
p[1]={{X 900,Y 0,Z 900,A 0,B 90,C 0}}
p[2]={{X 900,Y 50,Z 900,A 0,B 90,C 0}}
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}}
i=1
{line}
$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
PTP p[1]
END
DEF go(r:IN)
E6POS r
PTP r
END
DEF put(k:OUT)
INT k
k=2
END
DEF perhaps(k:OUT)
INT k
IF {n}>3 THEN
k=2
ENDIF
END
DEF shadow()
DECL INT i
i=2
END
DEF early(k:OUT)
INT k
IF {n}>3 THEN
RETURN
ENDIF
k=2
PTP {{A1 5,A2 -90,A3 90,A4 0,A5 20,A6 0}}
END
DEFFCT INT twice(k:IN)
INT k
IF k>1 THEN
RETURN 1
ENDIF
RETURN 2
ENDFCT
""",
        "$ANIN[1]",
        (
            "q=p[1]\nn=20\nNACHSTELLEN(n)\nq.Z=q.Z+n\nPTP q",
            "NACHSTELLEN(i)\nPTP p[i]",
            "NACHSTELLEN(i)\nq=p[i]\nPTP q",
            "$BASE.X={n}\nPTP p[2]",
            "PTP p[2]\n$APO.CDIS={n}\nLIN p[1] C_DIS",
        ),
        (
            "PTP p[2]\n$VEL.CP={n}\nLIN p[1]",
            "IF {n}>3 THEN\nPTP p[2]\nENDIF",
            "n={n}\nWAIT SEC n",
        ),
        (
            "IF {n}>3 THEN\ni=2\nENDIF\nPTP p[i]",
            "q=p[1]\nIF {n}>3 THEN\nq.Y=20\nELSE\nq.Y=30\nENDIF\nPTP q",
            "q=p[1]\nIF {n}>3 THEN\nq=p[2]\nENDIF\ngo(q)",
            "IF {n}>3 THEN\nput(i)\nENDIF\nPTP p[i]",
            "IF {n}>3 THEN\ni=2\nENDIF\nPTP p[twice(i)]",
            "IF {n}>3 THEN\ni=2\nENDIF\nIF i>1 THEN\nq=p[2]\nELSE\nq=p[1]\nENDIF\nPTP q",
            "SWITCH {n}\nCASE 1\ni=1\nDEFAULT\ni=2\nENDSWITCH\nPTP p[i]",
            "IF {n}>3 THEN\n$BASE.X=20\nENDIF\nPTP p[2]",
            "IF {n}>3 THEN\nBAS(#BASE,0)\nENDIF\nPTP p[2]",
            "IF {n}>3 THEN\nn=20\nELSE\nn=10\nENDIF\nPTP p[2]\n$APO.CDIS=n\nLIN p[1] C_DIS",
            "FOR i=1 TO {n}\nWAIT SEC 0\nENDFOR\nPTP p[i]",
            "i=1\nWHILE {n}>3\ni=i+1\nENDWHILE\nPTP p[i]",
            "early(i)\nPTP p[i]",
            "i=1\nperhaps(i)\nPTP p[i]",
            "IF {n}>3 THEN\nPTP p[2]\nENDIF\nLIN_REL {{Z 20}}",
            "IF {n}>3 THEN\nPTP p[2]\nENDIF\nPTP {{Z 920}}",
            "early(i)\nPTP {{A6 20}}",
            "i=1\nIF {n}>3 THEN\nGOTO ON\nENDIF\ni=2\nON:\nPTP p[i]",
        ),
        (
            "IF {n}>3 THEN\nn=20\nELSE\nn=10\nENDIF\n$VEL.CP=n\nPTP p[2]\nLIN p[1]",
            "IF {n}>3 THEN\ni=2\nENDIF\ni=1\nPTP p[i]",
            "IF {n}>3 THEN\ni=2\nENDIF\nput(i)\nPTP p[i]",
            "IF {n}>3 THEN\n$BASE.X=20\nENDIF\n$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\nPTP p[2]",
            "IF {n}>3 THEN\ni=2\nENDIF\nFOR n=1 TO i\nWAIT SEC 0\nENDFOR\ngo(p[1])",
            "early(i)\ni=1\nPTP p[i]",
            "i=1\nIF {n}>3 THEN\nshadow()\nENDIF\nPTP p[i]",
            "IF {n}>3 THEN\nPTP p[2]\nENDIF\nPTP p[1]\nLIN_REL {{Z 20}}",
            "i=1\nIF {n}>3 THEN\nGOTO ON\nENDIF\ni=2\nPTP p[i]\nON:",
        ),
    ),
    Text(
        "ur",
        "m.script",
        """def m():
  two = [p[0.4,0,0.4,0,3.1,0], p[0.5,0,0.4,0,3.1,0]]
  set_tcp(p[0,0,0.1,0,0,0])
  movej([0,-1.5,1.5,-1.5,-1.5,0])
  def go(q):
    movel(q)
  end
  def put(k):
    global h = k
  end
  def early():
    if {n} > 3:
      return 0
    end
    global h = 0.01
    movel(pose_add(two[0], p[0,0,h,0,0,0]))
  end
  def twice(k):
    if k > 0.02:
      return 0.04
    end
    return 2 * k
  end
  global h = 0
  {line}
  set_tcp(p[0,0,0.1,0,0,0])
  movej(two[0])
end
""",
        "read_input_float_register(3)",
        (
            "movel(pose_trans(two[0], p[0,0,{n},0,0,0]))",
            "h = {n} / 1000\n  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "movel(two[0], r={n})",
            "set_tcp(p[0,0,{n},0,0,0])\n  movel(two[0])",
            "movej(get_inverse_kin(pose_add(two[0], p[0,0,{n},0,0,0])))",
            "movec(pose_add(two[0], p[0.05,0,{n},0,0,0]), p[0.5,0.05,0.4,0,3.1,0])",
        ),
        (
            "movel(two[0], v={n})",
            "if {n} > 3:\n    movel(two[1])\n  end",
            "set_tcp(p[0,0,{n},0,0,0])",
            "h = {n}\n  sleep(h)",
        ),
        (
            "if {n} > 3:\n    h = 0.01\n  else:\n    h = 0.03\n  end\n"
            "  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "q = two[0]\n  if {n} > 3:\n    q[1] = 0.01\n  end\n  movel(q)",
            "q = two[0]\n  if {n} > 3:\n    q = two[1]\n  end\n  go(q)",
            "k = 0\n  if {n} > 3:\n    k = 1\n  end\n  movel(two[k])",
            "if {n} > 3:\n    put(0.01)\n  end\n  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "if {n} > 3:\n    h = 0.01\n  end\n  movel(pose_add(two[0], p[0,0,twice(h),0,0,0]))",
            "movel(pose_add(two[0], p[0,0,twice({n}),0,0,0]))",
            "if {n} > 3:\n    h = 0.01\n  end\n  if h > 0.005:\n    q = two[1]\n  else:\n"
            "    q = two[0]\n  end\n  movel(q)",
            "if {n} > 3:\n    set_tcp(p[0,0,0.2,0,0,0])\n  end\n  movel(two[0])",
            "if {n} > 3:\n    h = 0.01\n  end\n  movel(two[0], r=h)",
            "early()\n  movel(pose_add(get_actual_tcp_pose(), p[0,0,0.01,0,0,0]))",
            "if {n} > 3:\n    movel(two[1])\n  end\n"
            "  movel(pose_add(get_target_tcp_pose(), p[0,0,0.01,0,0,0]))",
            "early()\n  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "h = 0\n  k = 0\n  while k < 2:\n    k = k + 1\n    if {n} > 3:\n      continue\n"
            "    end\n    h = 0.01\n  end\n  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "k = 0\n  while {n} > k:\n    k = k + 0.01\n  end\n"
            "  movel(pose_add(two[0], p[0,0,k,0,0,0]))",
            "k = 0\n  while k < 0.05:\n    k = k + 0.01\n    if {n} > 3:\n      break\n    end\n"
            "  end\n  movel(pose_add(two[0], p[0,0,k,0,0,0]))",
        ),
        (
            "if {n} > 3:\n    h = 0.1\n  else:\n    h = 0.2\n  end\n  movel(two[0], v=h)",
            "if {n} > 3:\n    h = 0.1\n  end\n  h = 0\n  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "if {n} > 3:\n    h = 0.1\n  end\n  put(0)\n  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "if {n} > 3:\n    h = 0.1\n  end\n  go(two[0])",
            "if {n} > 3:\n    movel(two[1])\n  end\n  movel(two[0])\n"
            "  movel(pose_add(get_target_tcp_pose(), p[0,0,0.01,0,0,0]))",
            "k = 0\n  while k < 2:\n    k = k + 1\n    if {n} > 3:\n      continue\n    end\n"
            "    sleep(0.1)\n  end\n  movel(pose_add(two[0], p[0,0,0.01*k,0,0,0]))",
            "k = 0\n  while k < 2:\n    k = k + 1\n    j = 0\n    while {n} > j:\n      j = j + 1\n"
            "      if j > 5:\n        continue\n      end\n    end\n    h = 0.01\n  end\n"
            "  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
            "early()\n  h = 0\n  movel(pose_add(two[0], p[0,0,h,0,0,0]))",
        ),
    ),
)


def read(text: Text, line: str, answers: Answers) -> Program:
    reader = find_vendor(text.vendor).reader
    assert reader is not None
    written = text.frame.format(line=line.format(n=text.unknown), n=text.unknown)
    return reader.read(written, text.file, ReadOptions(answers=answers))


@pytest.mark.parametrize(
    ("text", "line"), [(text, line) for text in TEXTS for line in text.hang], ids=repr
)
def test_what_the_path_hangs_on_is_said_and_refused(text: Text, line: str) -> None:
    program = read(text, line, Answers(goes_on=True))
    supposed = [move for move in program.moves if move.supposed]
    assert len(supposed) == 1
    where = supposed[0].statement
    with pytest.raises(InputError, match="nothing can be proven or written") as refused:
        refuse_assumed(program)
    assert str(refused.value).startswith(f"{where}: ")
    assert not program.moves[-1].supposed


@pytest.mark.parametrize(
    ("text", "line"), [(text, line) for text in TEXTS for line in text.do_not], ids=repr
)
def test_what_the_path_does_not_hang_on_is_no_hindrance(text: Text, line: str) -> None:
    refuse_assumed(read(text, line, Answers(goes_on=True)))


@pytest.mark.parametrize(
    ("text", "line"), [(text, line) for text in TEXTS for line in text.chosen], ids=repr
)
def test_what_a_branch_sets_that_nobody_decides_is_supposed(text: Text, line: str) -> None:
    program = read(text, line, Answers(goes_on=True))
    moves = program.moves[1:-1]
    assert moves[-1].supposed and not program.moves[-1].supposed
    with pytest.raises(InputError, match="nothing can be proven or written"):
        refuse_assumed(program)


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: text.vendor)
def test_what_is_asked_and_not_answered_is_as_little_known(text: Text, tmp_path) -> None:
    path = tmp_path / "answers.toml"
    for line in text.chosen:
        program = read(text, line, Answers(goes_on=True))
        path.write_text(answers_text(program.questions, text.file), "utf-8")
        told = replace(load_answers(path), goes_on=True)
        again = read(text, line, told)
        assert [m.supposed for m in again.moves] == [m.supposed for m in program.moves]


@pytest.mark.parametrize(
    ("text", "line"), [(text, line) for text in TEXTS for line in text.settled], ids=repr
)
def test_what_is_set_anew_behind_a_branch_is_known(text: Text, line: str) -> None:
    program = read(text, line, Answers(goes_on=True))
    assert program.moves[1:-1]
    refuse_assumed(program)


@pytest.mark.parametrize(
    ("text", "line"),
    [(text, line) for text in TEXTS for line in (*text.chosen, *text.settled)],
    ids=repr,
)
def test_with_an_answer_branches_are_known(text: Text, line: str) -> None:
    refuse_assumed(read(text, line, Answers(goes_on=True, values={key(text.unknown): 1.0})))


@given(
    at=st.sampled_from([(text, line) for text in TEXTS for line in text.hang if "{n}" in line]),
    value=st.sampled_from([1.0, 2.0]),
)
def test_with_an_answer_it_is_known(at: tuple[Text, str], value: float) -> None:
    text, line = at
    number = value - 1 if "1+" in line else value
    program = read(text, line, Answers(goes_on=True, values={key(text.unknown): number}))
    refuse_assumed(program)
