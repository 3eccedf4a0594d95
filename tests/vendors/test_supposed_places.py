"""Moves whose place, tool, frame or zone hangs on what nobody says: driven, and not proven."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.program.assumed_places import refuse_assumed
from flyby.core.program.program import Program
from flyby.core.registry import find_vendor
from flyby.core.source.execution.answers import Answers, key
from flyby.core.source.reading import ReadOptions

EXTERNAL = ",".join(["9E9"] * 6)


@dataclass(frozen=True)
class Text:
    """A program with one line to be filled in, and a move behind it that is known.

    Args:
        unknown: a number that nobody says.
        hang: lines of which the path hangs on it; ``{n}`` is the number.
        do_not: lines of which it does not.
    """

    vendor: str
    file: str
    frame: str
    unknown: str
    hang: tuple[str, ...]
    do_not: tuple[str, ...]


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
PROC main()
MoveJ p0,v500,fine,tool0;
{{line}}
PDispOff;
EOffsOff;
MoveL p0,v500,fine,tool0;
ENDPROC
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
    ),
    Text(
        "ur",
        "m.script",
        """def m():
  two = [p[0.4,0,0.4,0,3.1,0], p[0.5,0,0.4,0,3.1,0]]
  set_tcp(p[0,0,0.1,0,0,0])
  movej([0,-1.5,1.5,-1.5,-1.5,0])
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
    ),
)


def read(text: Text, line: str, answers: Answers) -> Program:
    reader = find_vendor(text.vendor).reader
    assert reader is not None
    written = text.frame.format(line=line.format(n=text.unknown))
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


@given(
    at=st.sampled_from([(text, line) for text in TEXTS for line in text.hang if "{n}" in line]),
    value=st.sampled_from([1.0, 2.0]),
)
def test_with_an_answer_it_is_known(at: tuple[Text, str], value: float) -> None:
    text, line = at
    number = value - 1 if "1+" in line else value
    program = read(text, line, Answers(goes_on=True, values={key(text.unknown): number}))
    refuse_assumed(program)
