"""Code that names changed data and was not driven, in the three languages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from flyby.core.program.move import MoveC
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.bystanders import bystanders
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
    concerned = bystanders(program, moved(program, which), supplied.speaks.wording)
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
    (one,) = bystanders(program, program.with_moves(tuple(moves)), vendor.speaks.wording)
    assert one.datum == "zz" and one.move == 1 and [p.line for p in one.places] == [11]
    # A move that has got a datum of its own leaves the old one alone.
    assert moves[1].origin is not None
    own = replace(moves[1].origin, zone=replace(moves[1].origin.zone, datum="zz_2"))
    moves[1] = replace(moves[1], origin=own)
    assert bystanders(program, program.with_moves(tuple(moves)), vendor.speaks.wording) == ()
