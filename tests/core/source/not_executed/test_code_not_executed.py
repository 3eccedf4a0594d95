"""Code that names changed data and was not driven, in the three languages."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from flyby.core.dialect import Wording
from flyby.core.program.move import MoveC
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.not_executed.search import not_executed
from flyby.core.source.text.references import reference_of, references
from flyby.core.spatial.pose import Pose

AXES = "[9E9,9E9,9E9,9E9,9E9,9E9]"
RAPID = f"""MODULE m
  CONST jointtarget p0 := [[0,-4,69,0,0,0],{AXES}];
  CONST jointtarget p1 := [[0,-21,62,0,0,0],{AXES}];
  CONST jointtarget p2 := [[0,-4,42,0,0,0],{AXES}];
  PERS zonedata zz:=[FALSE,30,45,45,4.5,45,4.5];
  PROC main()
    VAR jointtarget copy;
    MoveAbsJ p0,v1000,fine,tool0;
    MoveAbsJ p1,v1000,zz,tool0; ! p1 and zz
    IF FALSE THEN
      MoveAbsJ p1,v1000,zz,tool0;
    ENDIF
    copy := p2;
    MoveAbsJ
       copy,v1000,fine,tool0;
  ENDPROC
  PROC other()
    TPWrite "p0";
    MoveAbsJ P1,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
KRL = """DEF m()
DECL E6AXIS XP1
DECL E6AXIS XP2
XP1={A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}
XP2={A1 10,A2 -90,A3 90,A4 0,A5 0,A6 0}
$APO.CDIS=20
PTP XP1 C_DIS ; XP1
PTP XP2
IF FALSE THEN
PTP xp2
ENDIF
END
"""
URSCRIPT = """def m():
  home = [0,-1.5,1.5,0,0.5,0]
  there = [0.5,-1.5,1.5,0,0.5,0]
  movej(home, a=1, v=1)
  movej(there, a=1, v=1)
  if False:
    movej(there, a=1, v=1)
  end
end
def never():
  movej(home, a=1, v=1) # there
end
"""


def moved(program: Program, which: Sequence[int]) -> Program:
    """Other targets at some moves."""
    moves = list(program.moves)
    for i in which:
        move = moves[i]
        assert not isinstance(move, MoveC)
        if isinstance(move.target, JointTarget):
            target: JointTarget | PoseTarget = replace(
                move.target, joints=tuple(q + 0.01 for q in move.target.joints)
            )
        else:
            target = replace(move.target, pose=Pose((0.0, 0.0, 1.0), move.target.pose.quaternion))
        moves[i] = replace(move, target=target)
    return program.with_moves(tuple(moves))


def found(name: str, text: str, tmp_path: Path, which: Sequence[int]) -> dict[str, list[int]]:
    """Lines by datum."""
    vendor, robot, suffix = {
        "abb": ("abb", "abb/irb6640-180-255", "mod"),
        "kuka": ("kuka", "kuka/kr30-3", "src"),
        "ur": ("ur", "ur/ur10e", "script"),
    }[name]
    path = tmp_path / f"m.{suffix}"
    path.write_text(text, "utf-8")
    supplied = find_vendor(vendor)
    program = supplied.read_file(path, robot=find_robot(robot))
    assert supplied.speaks is not None and supplied.speaks.wording is not None
    concerned = not_executed(program, moved(program, which), supplied.speaks.wording)
    return {one.datum: [place.line for place in one.places] for one in concerned}


@pytest.mark.parametrize(
    ("vendor", "text", "moves", "lines"),
    [
        ("abb", RAPID, [0, 1, 2], {"p1": [11, 19]}),
        ("abb", RAPID, [0], {}),
        ("kuka", KRL, [0, 1], {"XP2": [10]}),
        ("ur", URSCRIPT, [0, 1], {"home": [11], "there": [7]}),
    ],
)
def test_what_was_not_driven_is_found_in_every_language(
    tmp_path: Path, vendor: str, text: str, moves: list[int], lines: dict[str, list[int]]
) -> None:
    assert found(vendor, text, tmp_path, moves) == lines


def test_zones_and_data_of_other_names(tmp_path: Path) -> None:
    path = tmp_path / "m.mod"
    path.write_text(RAPID, "utf-8")
    vendor = find_vendor("abb")
    program = vendor.read_file(path, robot=find_robot("abb/irb6640-180-255"))
    assert vendor.speaks is not None and vendor.speaks.wording is not None
    moves = list(program.moves)
    moves[1] = replace(moves[1], zone=Radius(0.02, 0.03, 0.03, 0.05, 0.03, 0.05))
    (one,) = not_executed(program, program.with_moves(tuple(moves)), vendor.speaks.wording)
    assert one.datum == "zz" and one.move == 1 and [p.line for p in one.places] == [11]
    # A move that has got a datum of its own leaves the old one alone.
    assert moves[1].origin is not None
    own = replace(moves[1].origin, zone=replace(moves[1].origin.zone, datum="zz_2"))
    moves[1] = replace(moves[1], origin=own)
    assert not_executed(program, program.with_moves(tuple(moves)), vendor.speaks.wording) == ()


ELEMENTS = {
    "abb": (
        "m.mod",
        f"""MODULE m
  CONST jointtarget p{{3}}:=[[[0,-4,69,0,0,0],{AXES}],[[0,-21,62,0,0,0],{AXES}],
    [[0,-4,42,0,0,0],{AXES}]];
  VAR num i:=2;
  PROC main()
    VAR jointtarget copy;
    MoveAbsJ p{{1}},v1000,fine,tool0;
    MoveAbsJ p{{2}},v1000,fine,tool0;
    copy:=p{{2}};
    go p{{2}},1;
    IF FALSE MoveAbsJ p{{2}},v1000,fine,tool0;
    IF FALSE THEN MoveAbsJ p{{i}},v1000,fine,tool0; ENDIF
    IF FALSE MoveAbsJ P{{3}},v1000,fine,tool0;
    IF FALSE MoveAbsJ copy,v1000,fine,tool0;
    IF FALSE i:=P{{2}}.robax.rax_1;
  ENDPROC
  PROC go(jointtarget where,num n)
    IF n=1 THEN
      MoveAbsJ where,v1000,fine,tool0;
    ELSE
      MoveAbsJ where,v100,fine,tool0;
    ENDIF
  ENDPROC
  PROC never(jointtarget where)
    VAR jointtarget p;
    MoveAbsJ p,v1000,fine,tool0;
    MoveAbsJ where,v1000,fine,tool0;
  ENDPROC
ENDMODULE
""",
        {"p{2}": [11, 12, 14, 15, 21]},
    ),
    "kuka": (
        "m.src",
        """DEF m()
DECL E6AXIS P[3]
DECL E6AXIS COPY
DECL INT I
P[1]={A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}
P[2]={A1 10,A2 -90,A3 90,A4 0,A5 0,A6 0}
P[3]={A1 20,A2 -90,A3 90,A4 0,A5 0,A6 0}
PTP P[1]
PTP P[2]
COPY=P[2]
GO(P[2],1)
IF FALSE THEN
PTP P[ 2 ]
PTP p[I]
PTP P[3]
PTP COPY
COPY.A1=P[2].A1
P[3].A1=P[1].A1
ENDIF
END
DEF GO(WHERE:IN,N:IN)
DECL E6AXIS WHERE
DECL INT N
IF N==1 THEN
PTP WHERE
ELSE
PTP WHERE C_PTP
ENDIF
END
DEF NEVER(WHERE:IN)
DECL E6AXIS P[3]
DECL E6AXIS WHERE
PTP P[2]
PTP WHERE
END
""",
        {"P[2]": [13, 14, 16, 17, 27]},
    ),
    "ur": (
        "m.script",
        """def go(where, n):
  if n == 1:
    movej(where, a=1, v=1)
  else:
    movej(where, a=2, v=1)
  end
end
def never(where):
  movej(where, a=1, v=1)
end
def m():
  P = [[0,-1.5,1.5,0,0.5,0], [0.5,-1.5,1.5,0,0.5,0], [0.7,-1.5,1.5,0,0.5,0]]
  movej(P[0], a=1, v=1)
  movej(P[1], a=1, v=1)
  copy = P[1]
  i = 1
  go(P[1], 1)
  if False: movej(P[1], a=1, v=1) end
  if False:
    movej(P[i], a=1, v=1)
    movej(P[2], a=1, v=1)
    movej(copy, a=1, v=1)
    movej(p[1], a=1, v=1)
    movej([P[1][0],-1.5,1.5,0,0.5,0], a=1, v=1)
  end
end
""",
        {"P[1]": [5, 18, 20, 22, 24]},
    ),
}


@pytest.mark.parametrize("vendor", ELEMENTS)
def test_elements_are_told_apart_and_followed(tmp_path: Path, vendor: str) -> None:
    """By index; where it is computed, all are meant. Copies and parameters count as the datum."""
    _, text, lines = ELEMENTS[vendor]
    concerned = found(vendor, text, tmp_path, [1])
    assert {name: sorted(set(at)) for name, at in concerned.items()} == lines


def test_other_modules_mean_their_own_data(tmp_path: Path) -> None:
    """A data list's data are its own module's; another module without the name means a global."""
    point = "{A1 10,A2 -90,A3 90,A4 0,A5 0,A6 0}"
    files = {
        "m.src": "DEF m()\nPTP XP1\nPTP XP2\nEND\n",
        "m.dat": f"DEFDAT m PUBLIC\nDECL GLOBAL E6AXIS XP1={point}\n"
        f"DECL E6AXIS XP2={point}\nENDDAT\n",
        "own.src": "DEF own()\nPTP XP1\nEND\n",
        "own.dat": f"DEFDAT own\nDECL E6AXIS XP1={point}\nENDDAT\n",
        "other.src": "DEF other()\nPTP XP1\nEND\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, "utf-8")
    kuka = find_vendor("kuka")
    others = [tmp_path / name for name in files if name.startswith("o")]
    program = kuka.read_file(tmp_path / "m.src", robot=find_robot("kuka/kr30-3"), others=others)
    assert kuka.speaks is not None and kuka.speaks.wording is not None
    (one,) = not_executed(program, moved(program, [0]), kuka.speaks.wording)
    assert [(Path(place.file).name, place.line) for place in one.places] == [("other.src", 2)]


def test_a_language_may_have_the_index_in_its_names() -> None:
    wording = Wording(
        silent=re.compile(r"![^\n]*"),
        targets=re.compile(r"^(?P<names>P\[\d+\](?:,P\[\d+\])*)=", re.MULTILINE),
        name=re.compile(r"P\[\d+(?::\w+)?\]|\w+"),
    )
    assert list(wording.declared("P[1]=0\nP[12],P[2]=0\n")) == [
        ("P[1]", 0),
        ("P[12]", 7),
        ("P[2]", 13),
    ]
    text = "J P[1] J P[2:part] J P[R[1]] J P[12] J MP[2]"
    changed = reference_of("P[2]", wording)
    assert [
        text[one.start : one.end]
        for one in references(changed.name, text, wording)
        if one.meets(changed)
    ] == ["P[2:part]", "P[R[1]]"]


HANDED = {
    "abb": f"""MODULE m
  CONST jointtarget p:=[[0,-21,62,0,0,0],{AXES}];
  VAR jointtarget held;
  PROC main()
    VAR jointtarget r;
    MoveAbsJ p,v1000,fine,tool0;
    fill Abs(-3),r\\fast;
    held:=give();
    IF FALSE MoveAbsJ give(),v1000,fine,tool0;
    IF FALSE THEN
      MoveAbsJ r,v1000,fine,tool0;
      MoveAbsJ held,v1000,fine,tool0;
    ENDIF
  ENDPROC
  FUNC jointtarget give()
    RETURN p;
  ENDFUNC
  PROC fill(num n,INOUT jointtarget q\\switch fast)
    IF n>2 q:=p;
  ENDPROC
ENDMODULE
""",
    "kuka": """DEF m()
DECL E6AXIS R
DECL E6AXIS HELD
XP1={A1 5,A2 -90,A3 90,A4 0,A5 0,A6 0}
PTP XP1
FILL(ABS(-3),R)
HELD=GIVE()
IF FALSE THEN
PTP GIVE()
;
PTP R
PTP HELD
ENDIF
END
DEFFCT E6AXIS GIVE()
RETURN XP1
ENDFCT
DEF FILL(N:IN,Q:OUT)
DECL E6AXIS Q
DECL REAL N
Q=XP1
END
""",
    "ur": """def give():
  return there
end
def m():
  global there = [0.5,-1.5,1.5,0,0.5,0]

  movej(there, a=1, v=1)
  held = give()
  if give()[0] < 0: movej(give(), a=1, v=1) end
  if False:
    movej([give()[0],-1.5,1.5,0,0.5,0], a=1, v=1)
    movej(held, a=1, v=1)
  end
end
""",
}


@pytest.mark.parametrize("vendor", HANDED)
def test_what_routines_give_back_is_followed(tmp_path: Path, vendor: str) -> None:
    """By their value or a parameter; neither headings nor declarations are uses."""
    (lines,) = found(vendor, HANDED[vendor], tmp_path, [0]).values()
    assert sorted(set(lines)) == [9, 11, 12]
