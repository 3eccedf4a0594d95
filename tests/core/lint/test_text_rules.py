"""Rules that search the text, in each language; and clean programs, in which nothing is found."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from flyby.core.lint.check import check
from flyby.core.registry import find_robot, find_vendor

EXAMPLES = Path(__file__).parents[3] / "examples"
ROBOTS = {
    ".mod": "abb/irb6640-180-255",
    ".src": "kuka/kr30-3",
    ".script": "ur/ur5e",
}
RAPID = """MODULE Lines
  CONST robtarget p1:=[[1300,100,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
{data}
  PROC main()
    ConfJ\\Off;
    MoveJ p1,v1000,fine,tool0;
{moves}
  ENDPROC
ENDMODULE
"""
KRL = """DEF lines()
  BAS(#INITMOV,0)
  $TOOL={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
  $BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
  $VEL.CP=0.3
{data}
  PTP {{A1 0,A2 -90,A3 90,A4 0,A5 -45,A6 0}}
{moves}
END
"""
SCRIPT = """def lines():
  set_tcp(p[0,0,0.1,0,0,0])
{data}
  movej([0,-1.57,1.57,-1.57,-1.57,0], a=1.4, v=1.05)
{moves}
end
"""
CLEAN = {
    ".mod": (
        RAPID,
        "  CONST robtarget p2:=[[1300,200,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];",
        "    MoveL P2,v200,z20,tool0;\n    MoveL Offs(p2,0,0,80),v200,fine,tool0;",
    ),
    ".src": (
        KRL,
        "  $APO.CDIS=20",
        "  LIN {X 1000,Y 0,Z 1000,A 0,B 90,C 0} C_DIS\n"
        "  LIN {X 1000,Y 200,Z 1000,A 0,B 90,C 0} c_dis\n"
        "  LIN {X 1000,Y 200,Z 800,A 0,B 90,C 0}",
    ),
    ".script": (
        SCRIPT,
        "  above = p[-0.5,0.2,0.4,0,3.14,0]",
        "  movel(above, a=1.2, v=0.25, r=0.05)\n  movel(p[-0.5,0.2,0.2,0,3.14,0], a=1.2, v=0.25)",
    ),
}


def findings(text: str, suffix: str):
    vendor, robot = find_vendor(ROBOTS[suffix].split("/")[0]), find_robot(ROBOTS[suffix])
    return check(vendor.read(text, f"lines{suffix}", robot=robot), vendor, robot)


def found(suffix: str, rule: str, data: str = "", moves: str = "") -> list[tuple[int, str]]:
    template, clean_data, clean_moves = CLEAN[suffix]
    text = template.format(data=data or clean_data, moves=moves or clean_moves)
    return [(f.span.line, f.message) for f in findings(text, suffix) if f.rule == rule]


@pytest.mark.parametrize("suffix", list(CLEAN))
def test_nothing_is_found_in_a_clean_program(suffix) -> None:
    template, data, moves = CLEAN[suffix]
    assert [
        (f.rule, f.message)
        for f in findings(template.format(data=data, moves=moves), suffix)
        if f.rule != "reader"
    ] == []


def test_nothing_is_found_in_the_clean_example() -> None:
    vendor, robot = find_vendor("abb"), find_robot(ROBOTS[".mod"])
    assert check(vendor.read_file(EXAMPLES / "square.mod", robot=robot), vendor, robot) == ()


@pytest.mark.parametrize(
    ("suffix", "data", "names"),
    [
        (
            ".mod",
            "  LOCAL PERS\n    jointtarget jOld:=[[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; ! jOld",
            "jOld",
        ),
        (".mod", '  ! CONST robtarget pGone:=[];\n  CONST string s:="CONST robtarget pNo";', ""),
        (
            ".src",
            "  DECL E6POS hier, da[3], dort\n  da[1]={X 1,Y 2,Z 3,A 0,B 0,C 0} ; dort",
            "hier dort",
        ),
        (".src", "  E6AXIS XHOME\n  XHOME=$AXIS_ACT", ""),
        (
            ".script",
            "  global Top_p=p[-0.5,0.2,0.4,0,3.14,0]\n  global Top_q=[0,-1,1,0,0,0] # Top_p",
            "Top_p",
        ),
        (".script", "  Here=p[-0.5,0.2,0.4,0,3.14,0]\n  here=Here", ""),
    ],
)
def test_targets_that_stand_nowhere_else_are_told(suffix, data, names) -> None:
    moves = "" if suffix == ".src" else CLEAN[suffix][2].replace("P2", "p1").replace("p2", "p1")
    if suffix == ".script":
        moves = "  movel(p[-0.5,0.2,0.2,0,3.14,0], a=1.2, v=0.25)"
    hits = found(suffix, "unused-target", data, moves)
    assert [message.split()[0] for _, message in hits] == names.split()


def test_reading_the_position_behind_a_zone_is_told_as_what_it_is() -> None:
    moves = CLEAN[".src"][2].replace(" c_dis\n", " c_dis\n  $VEL.CP=0.001*$POS_ACT.X\n")
    hits = found(".src", "zone-switched-off", "  $APO.CDIS=20", moves)
    assert [line for line, _ in hits] == [9]
    assert "but an instruction after it that ends the look-ahead stops the robot" in hits[0][1]


def test_an_approximation_that_no_motion_asks_for_is_told() -> None:
    switched_off = partial(found, ".src", "zone-switched-off")
    stops = CLEAN[".src"][2].replace(" C_DIS", "").replace(" c_dis", " ; c_dis")
    ((line, message),) = switched_off("  $APO.CDIS=20", stops)
    assert (line, message.split()[0]) == (6, "$APO.CDIS=20")
    assert not switched_off("  $APO.CDIS=0.0", stops)
    assert not switched_off("  ; $APO.CDIS=20", stops)


def test_no_advance_run_is_told_where_a_zone_is_asked_for() -> None:
    hits = found(".src", "zone-switched-off", "  $APO.CDIS=20\n  $ADVANCE=0")
    assert [(line, message.split(":")[0]) for line, message in hits] == [(7, "$ADVANCE=0")]


def test_a_zone_without_size_is_told_at_its_motion() -> None:
    hits = found(".src", "zone-switched-off", "  $APO.CDIS=0")
    assert [line for line, _ in hits] == [8, 9]
    assert all("size is 0" in message for _, message in hits)
