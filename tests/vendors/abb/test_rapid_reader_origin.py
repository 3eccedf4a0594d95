"""Which text a move's numbers come from, and who else reads it."""

from __future__ import annotations

import pytest

from flyby.core.program.origin import Ownership
from flyby.vendors.abb.run.reader import read

OWNED, SHARED, DERIVED = Ownership.OWNED, Ownership.SHARED, Ownership.DERIVED
UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def point(x):
    return f"[[{x},-2.5,600],[0,0,1,0],[0,-1,0,0],{UNUSED}]"


DATA = f"""
  CONST robtarget p1:={point(1)};
  CONST robtarget p2:={point(2)};
  CONST robtarget same:=p1;
  CONST robtarget row{{2}}:=[{point(10)},{point(20)}];
  VAR robtarget moving:={point(30)};
  CONST robtarget sum:=[[1+1,0,0],[1,0,0,0],[0,0,0,0],{UNUSED}];
  CONST speeddata vOwn:=[100,500,5000,1000];
  CONST num nSpeed:=120;
"""


def read_text(body, routines=""):
    text = f"MODULE M\n{DATA}\nPROC main()\n{body}\nENDPROC\n{routines}\nENDMODULE"
    return text, [move.origin for move in read(text, "a.mod").moves]


def targets(body, routines=""):
    return [(o.target.ownership, o.target.datum) for o in read_text(body, routines)[1]]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("{p1}", [(OWNED, "p1")]),
        ("{p1}{p2}{p1}", [(SHARED, "p1"), (OWNED, "p2"), (SHARED, "p1")]),
        ("{same}", [(OWNED, "p1")]),
        ("{same}{p1}", [(SHARED, "p1"), (SHARED, "p1")]),
        ("{row{1}}{row{2}}", [(OWNED, "row{1}"), (OWNED, "row{2}")]),
        ("{row{2}}{row{2}}", [(SHARED, "row{2}"), (SHARED, "row{2}")]),
        ("{LITERAL}", [(OWNED, None)]),
        ("FOR i FROM 1 TO 2 DO {LITERAL} ENDFOR", [(SHARED, None), (SHARED, None)]),
        ("FOR i FROM 1 TO 2 DO {row{i}} ENDFOR", [(OWNED, "row{1}"), (OWNED, "row{2}")]),
        ("{Offs(p1,0,0,1)}", [(DERIVED, None)]),
        ("{Offs(p1,0,0,1)}{p1}", [(DERIVED, None), (SHARED, "p1")]),
        ("IF p1.trans.x > 0 {p1}", [(SHARED, "p1")]),
        ("IF p1.trans.x > 0 {p2}", [(OWNED, "p2")]),
        ("{moving}", [(OWNED, "moving")]),
        ("moving := p1;{moving}", [(DERIVED, None)]),
        ("moving.trans.x := 5;{moving}", [(DERIVED, None)]),
        ("{sum}", [(DERIVED, None)]),
        ("PDispSet [[0,0,1],[1,0,0,0]];{p1}", [(DERIVED, None)]),
        ("go p1; go p2;", [(OWNED, "p1"), (OWNED, "p2")]),
        ("go p1; go p1;", [(SHARED, "p1"), (SHARED, "p1")]),
        ("IF FALSE {p1} {p1}", [(OWNED, "p1")]),
    ],
)
def test_ownership_of_targets(body, expected):
    for name in (
        "p1",
        "p2",
        "same",
        "row{1}",
        "row{2}",
        "row{i}",
        "moving",
        "sum",
        "Offs(p1,0,0,1)",
    ):
        body = body.replace("{" + name + "}", f"MoveL {name},v100,z10,tool0;")
    body = body.replace("{LITERAL}", f"MoveL {point(7)},v100,z10,tool0;")
    routines = "PROC go(robtarget p)\nMoveL p,v100,z10,tool0;\nENDPROC"
    assert targets(body, routines) == expected


def test_spans_are_the_numbers_of_the_literal_in_order():
    text, (origin,) = read_text("  MoveL row{2}, vOwn, [FALSE,1,2,3,.4,5,-0.0], tool0;")
    numbers = [text[s.start : s.end] for s in origin.target.numbers]
    assert numbers == ["20", "-2.5", "600", "0", "0", "1", "0", "0", "-1", "0", "0"] + ["9E9"] * 6
    assert [text[s.start : s.end] for s in origin.speed.numbers] == ["100", "500", "5000", "1000"]
    zone = [text[s.start : s.end] for s in origin.zone.numbers]
    assert zone == ["1", "2", "3", ".4", "5", "-0.0"]
    assert text[origin.target.span.start : origin.target.span.end] == "row{2}"
    assert text[origin.statement.start : origin.statement.end].startswith("MoveL row{2}, vOwn,")
    assert text[origin.statement.start : origin.statement.end].endswith("tool0;")


def test_joint_targets_have_twelve_numbers():
    text, (origin,) = read_text(f"MoveAbsJ [[1,2,3,4,5,6],{UNUSED}],v100,z10,tool0;")
    assert len(origin.target.numbers) == 12 and origin.via is None
    assert text[origin.target.numbers[2].start] == "3"


def test_arcs_have_a_via():
    _, (origin,) = read_text("MoveC p1,p2,v100,z10,tool0;")
    assert (origin.via.ownership, origin.via.datum) == (OWNED, "p1")
    _, both = read_text("MoveC p1,p2,v100,z10,tool0;\nMoveL p1,v100,z10,tool0;")
    assert both[0].via.ownership is SHARED and both[1].target.ownership is SHARED


def test_predefined_data_are_shared_and_have_no_numbers():
    _, (origin,) = read_text("MoveL p1,v100,fine,tool0;")
    assert (origin.speed.ownership, origin.speed.datum, origin.speed.numbers) == (
        SHARED,
        "v100",
        (),
    )
    assert (origin.zone.ownership, origin.zone.datum) == (SHARED, "fine")


def test_numbers_in_options_belong_to_the_move():
    text, (origin,) = read_text("MoveL p1,vOwn\\V:=250,z10\\Z:=7,tool0;")
    speed, zone = origin.speed, origin.zone
    assert (speed.ownership, zone.ownership) == (OWNED, OWNED)
    assert text[speed.span.start : speed.span.end] == "vOwn\\V:=250"
    assert [text[s.start : s.end] for s in (*speed.numbers, *zone.numbers)] == ["250", "7"]
    _, two = read_text("MoveL p1,v10\\V:=nSpeed,z10,tool0;\nMoveL p2,v10\\V:=nSpeed,z10,tool0;")
    assert [(o.speed.ownership, o.speed.datum) for o in two] == [(SHARED, "nSpeed")] * 2
    _, (derived,) = read_text("MoveL p1,v10\\V:=2*nSpeed,z10,tool0;")
    assert derived.speed.ownership is DERIVED


def test_speeds_under_velset_are_derived():
    _, (origin,) = read_text("VelSet 50,1000;\nMoveL p1,vOwn,z10,tool0;")
    assert origin.speed.ownership is DERIVED and origin.speed.numbers == ()
    _, (capped,) = read_text("VelSet 100,50;\nMoveL p1,vOwn,z10,tool0;")
    assert capped.speed.ownership is DERIVED
    _, (full,) = read_text("VelSet 100,5000;\nMoveL p1,vOwn,z10,tool0;")
    assert full.speed.ownership is OWNED
