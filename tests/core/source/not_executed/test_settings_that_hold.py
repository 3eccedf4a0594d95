"""Numbers that hold until they are set again, and code that was not driven under them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.not_executed.search import not_executed

_ROBOTS = {
    "abb": ("abb/irb6640-180-255", "mod"),
    "kuka": ("kuka/kr30-3", "src"),
    "ur": ("ur/ur10e", "script"),
}
_AXES = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def read(vendor: str, text: str, folder: Path) -> Program:
    robot, suffix = _ROBOTS[vendor]
    folder.mkdir(exist_ok=True)
    path = folder / f"m.{suffix}"
    path.write_text(text, "utf-8")
    return find_vendor(vendor).read_file(path, robot=find_robot(robot))


def told(
    vendor: str,
    text: str,
    folder: Path,
    moves: tuple[int, ...],
    part: str,
    **options: str,
) -> dict[str, list[int]]:
    """Lines by datum, where a part of some moves is patched and the result read again."""
    before = read(vendor, text, folder)
    robot, supplied = find_robot(_ROBOTS[vendor][0]), find_vendor(vendor)
    changed = list(before.moves)
    for i in moves:
        move = changed[i]
        if part == "zone":
            assert isinstance(move.zone, Radius)
            new = replace(move, zone=move.zone.resized(move.zone.tcp * 1.5))
        else:
            old, speaks = move.speed, supplied.speaks
            assert speaks is not None
            name = speaks.pace if isinstance(move, MoveJ) else "tcp"
            scaled = {name: 0.8 * getattr(old, name)}
            new = replace(move, speed=replace(old, **scaled))
        changed[i] = new
    asked = before.with_moves(tuple(changed))
    files = supplied.patch(asked, robot, options)
    assert files
    after = before.reading.again(files)  # type: ignore[attr-defined]
    assert supplied.speaks is not None and supplied.speaks.wording is not None
    found = not_executed(before, after, supplied.speaks.wording)
    return {one.datum: sorted({place.line for place in one.places}) for one in found}


def krl(*body: str, after: str = "") -> str:
    """A program whose driven part stands in lines 5 to 8, and ``body`` from line 9 on."""
    lines = [
        "DEF m()",
        "BAS(#INITMOV,0)",
        "PTP {A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}",
        "$VEL.CP=0.5",
        "$APO.CDIS=20",
        "LIN {X 1500,Y 0,Z 1400,A 0,B 90,C 0} C_DIS",
        "LIN {X 1500,Y 200,Z 1400,A 0,B 90,C 0} C_DIS",
        "LIN {X 1500,Y 200,Z 1600,A 0,B 90,C 0}",
        *body,
        "END",
    ]
    return "\n".join(lines) + "\n" + after


_LIN = "LIN {X 1500,Y 300,Z 1600,A 0,B 90,C 0}"


@pytest.mark.parametrize(
    ("body", "after", "zone", "speed"),
    [
        # A branch that was not driven, with an approximation and without.
        (["IF FALSE THEN", f"{_LIN} C_DIS", _LIN, "ENDIF"], "", [10], [10, 11]),
        # Set again before: for both, in the branch and before it, and for one of them.
        (["IF FALSE THEN", "$APO.CDIS=5", "$VEL.CP=1", f"{_LIN} C_DIS", "ENDIF"], "", [], []),
        (["$APO.CDIS=5", "$VEL.CP=1", "IF FALSE THEN", f"{_LIN} C_DIS", "ENDIF"], "", [], []),
        (["IF FALSE THEN", "$APO.CDIS=5", f"{_LIN} C_DIS", "ENDIF"], "", [], [11]),
        (["IF FALSE THEN", "BAS(#INITMOV,0)", f"{_LIN} C_DIS", "ENDIF"], "", [], []),
        (["IF FALSE THEN", "BAS(#VEL_CP,1)", f"{_LIN} C_DIS", "ENDIF"], "", [11], []),
        (["IF FALSE THEN", "$VEL={CP 1}", f"{_LIN} C_DIS", "ENDIF"], "", [11], []),
        # Set on a condition only, or in the other branch.
        (
            ["IF FALSE THEN", "IF $IN[1] THEN", "$APO.CDIS=5", "ENDIF", f"{_LIN} C_DIS", "ENDIF"],
            "",
            [13],
            [13],
        ),
        (
            ["IF TRUE THEN", "$APO.CDIS=5", "ELSE", f"{_LIN} C_DIS", "ENDIF"],
            "",
            [12],
            [12],
        ),
        # Other settings than those of the motion.
        (["IF FALSE THEN", "PTP {A1 10} C_PTP", "ENDIF"], "", [], []),
        (["IF FALSE THEN", "SPTP {A1 10} WITH $VEL_AXIS[1]=20 C_SPL", "ENDIF"], "", [10], []),
        # What is asked of the variable itself.
        (["IF FALSE THEN", "S=$APO.CDIS", "ENDIF"], "", [10], []),
        # Routines: called, not called, and with settings of their own or of who calls.
        (["IF FALSE THEN", "SUB()", "ENDIF"], f"DEF SUB()\n{_LIN} C_DIS\nEND\n", [14], [14]),
        ([], f"DEF SUB()\n{_LIN} C_DIS\nEND\n", [11], [11]),
        ([], f"DEF SUB()\nBAS(#INITMOV,0)\n{_LIN} C_DIS\nEND\n", [], []),
        (
            ["IF FALSE THEN", "$APO.CDIS=5", "SUB()", "ENDIF"],
            f"DEF SUB()\n{_LIN} C_DIS\nEND\n",
            [],
            [15],
        ),
    ],
)
def test_settings_of_krl_hold_for_motions_that_were_not_driven(
    tmp_path: Path, body: list[str], after: str, zone: list[int], speed: list[int]
) -> None:
    text = krl(*body, after=after)
    found = told("kuka", text, tmp_path, (1, 2), "zone")
    assert found == ({"$APO.CDIS": zone} if zone else {})
    found = told("kuka", text, tmp_path, (1, 2, 3), "speed")
    assert found == ({"$VEL.CP": speed} if speed else {})


def test_a_later_turn_of_a_loop_comes_under_what_was_set_in_it(tmp_path: Path) -> None:
    """The setting before the loop holds in its first turn only."""
    far = "{X 1500,Y 200,Z 1600,A 0,B 90,C 0}"
    text = krl(
        "$APO.CDIS=7",
        "FOR I=1 TO 1",
        "IF I==2 THEN",
        f"{_LIN} C_DIS",
        "ENDIF",
        "$APO.CDIS=9",
        f"{_LIN} C_DIS",
        f"LIN {far}",
        "ENDFOR",
    )
    assert told("kuka", text, tmp_path, (4,), "zone") == {"$APO.CDIS": [12]}


@pytest.mark.parametrize(
    ("setting", "label"),
    [
        ("BAS(#VEL_CP,0.5)", "$VEL.CP"),
        ("$VEL={CP 0.5,ORI1 200,ORI2 200}", "$VEL"),
        ("S=0.5\n$VEL.CP=S", "S"),
    ],
)
def test_however_a_setting_is_made(tmp_path: Path, setting: str, label: str) -> None:
    text = krl(setting, _LIN, "IF FALSE THEN", _LIN, "ENDIF")
    line = 12 + setting.count("\n")
    assert told("kuka", text, tmp_path, (4,), "speed") == {label: [line]}


def test_data_of_forms_hold_for_plain_motions_behind_them(tmp_path: Path) -> None:
    """Another form states its own; a plain motion has what the last one set."""
    form = ["LDAT_ACT={}", "BAS(#CP_PARAMS,0.4)"]
    own, other = ([one.format(f"LCP{k}") for one in form] for k in (1, 2))
    text = krl(
        *own,
        f"{_LIN} C_DIS",
        "LIN {X 1500,Y 0,Z 1600,A 0,B 90,C 0}",
        "IF FALSE THEN",
        *other,
        f"{_LIN} C_DIS",
        "ENDIF",
        "IF FALSE THEN",
        f"{_LIN} C_DIS",
        "ENDIF",
    )
    datum = "DECL LDAT LCP{}={{VEL 2,ACC 100,APO_DIST 30,APO_FAC 50,ORI_TYP #VAR}}\n"
    (tmp_path / "m.dat").write_text(
        f"DEFDAT m\n{datum.format(1)}{datum.format(2)}ENDDAT\n", "utf-8"
    )
    found = told("kuka", text, tmp_path, (4,), "zone")
    assert list(found.values()) == [[19]]


def test_settings_that_a_patch_puts_in(tmp_path: Path) -> None:
    """A motion's own setting holds for what is not driven behind it, up to the old one."""
    text = krl("IF FALSE THEN", f"{_LIN} C_DIS", "ENDIF")
    assert told("kuka", text, tmp_path, (1,), "zone", shared="own") == {}
    assert told("kuka", text, tmp_path, (2,), "zone", shared="own") == {"$APO.CDIS": [10]}


def test_every_setting_that_has_changed_counts(tmp_path: Path) -> None:
    """A second one as well, where code behind it alone has no value of its own."""
    far = "LIN {X 1500,Y 200,Z 1600,A 0,B 90,C 0}"
    text = krl("IF FALSE THEN", "$APO.CDIS=8", f"{_LIN} C_DIS", "ENDIF", "$APO.CDIS=9")
    text = text.replace("$APO.CDIS=9\n", f"$APO.CDIS=9\n{_LIN} C_DIS\n{far}\n")
    text = text.replace("END\n", f"IF FALSE THEN\n{_LIN} C_DIS\nENDIF\nEND\n")
    assert told("kuka", text, tmp_path, (1, 2, 4), "zone") == {"$APO.CDIS": [17]}


def test_calls_of_what_was_driven_elsewhere(tmp_path: Path) -> None:
    """A driven routine that is called in another branch as well drives changed numbers there."""
    sub = f"DEF SUB()\n{_LIN} C_DIS\n$APO.CDIS=12\nLIN {{X 1500,Y 0,Z 1600,A 0,B 90,C 0}}\nEND\n"
    text = krl("SUB()", "IF FALSE THEN", "$APO.CDIS=5", "SUB()", "ENDIF", after=sub)
    assert told("kuka", text, tmp_path, (1, 2, 4), "zone") == {}
    text = krl("SUB()", "IF FALSE THEN", "SUB()", "ENDIF", after=sub)
    assert told("kuka", text, tmp_path, (1, 2, 4), "zone") == {"$APO.CDIS": [11]}
    text = krl("$APO.CDIS=6", "SUB()", "IF FALSE THEN", "SUB()", "ENDIF", after=sub)
    assert told("kuka", text, tmp_path, (1, 2), "zone") == {}


def test_numbers_at_a_motion_that_is_called_elsewhere(tmp_path: Path) -> None:
    """The literal itself has changed for whoever calls."""
    text = URSCRIPT.replace("v=vel)", "v=0.3)", 1).replace(
        "  if False:\n    V", "  if False:\n    go(1)\n    V"
    )
    assert told("ur", text, tmp_path, (3, 4), "speed") == {"the motion in line 2": [24]}


RAPID = f"""MODULE m
  CONST jointtarget p1:=[[0,-4,69,0,0,0],{_AXES}];
  CONST jointtarget p2:=[[0,-21,62,0,0,0],{_AXES}];
  VAR zonedata zz:=[FALSE,30,45,45,4.5,45,4.5];
  VAR speeddata vv:=[1000,500,5000,1000];
  PROC main()
    MoveAbsJ p1,vv,fine,tool0;
    MoveAbsJ p2,vv,zz,tool0;
    MoveAbsJ p1,vv,fine,tool0;
    go 700;
    IF FALSE THEN
      MoveAbsJ p2,vv,zz,tool0;
    ENDIF
    IF FALSE THEN
      zz:=[FALSE,10,15,15,1.5,15,1.5];
      MoveAbsJ p2,v100,zz,tool0;
    ENDIF
    IF FALSE zz:=[FALSE,10,15,15,1.5,15,1.5];
    IF FALSE MoveAbsJ p2,v100,zz,tool0;
  ENDPROC
  PROC go(num v)
    MoveAbsJ p2,v1000\\V:=v,fine,tool0;
    IF v=1 THEN
      MoveAbsJ p1,v1000\\V:=v,fine,tool0;
    ENDIF
  ENDPROC
ENDMODULE
"""


def test_data_that_rapid_assigns(tmp_path: Path) -> None:
    assert told("abb", RAPID, tmp_path, (1,), "zone") == {"zz": [12, 19]}
    assert told("abb", RAPID, tmp_path, (0, 1, 2), "speed") == {"vv": [12]}


URSCRIPT = """def go(where, vel=0.7):
  movej(where, a=1, v=vel)
  if False:
    movej(where, a=1, v=vel)
  end
end
def never(vel):
  movej([0,-1.5,1.5,0,0.5,0], a=1, v=vel)
end
def m():
  global A = 1.2
  global V = 0.5
  R = 0.01
  movej([0,-1.5,1.5,0,0.5,0], a=A, v=V)
  movej([0.5,-1.5,1.5,0,0.5,0], a=A, v=V, r=R)
  movej([1,-1.5,1.5,0,0.5,0], a=A, v=V)
  go([0.3,-1.5,1.5,0,0.5,0], 0.9)
  go([0.4,-1.5,1.5,0,0.5,0])
  if False:
    movej([1,-1.5,1.5,0,0.5,0], a=A, v=1)
    movej([1,-1.5,1.5,0,0.5,0], a=1, v=V, r=R)
  end
  if False:
    V = 1
    movej([1,-1.5,1.5,0,0.5,0], a=1, v=V)
  end
end
def other():
  movej([0,-1.5,1.5,0,0.5,0], v=V)
  R = 0.02
  movej([0,-1.5,1.5,0,0.5,0], r=R)
end
"""


def test_variables_and_arguments_of_urscript(tmp_path: Path) -> None:
    """Each number of a speed has a variable of its own."""
    assert told("ur", URSCRIPT, tmp_path, (0, 1, 2), "speed") == {"V": [21, 29]}
    assert told("ur", URSCRIPT, tmp_path, (1,), "zone") == {"R": [21]}
    assert told("ur", URSCRIPT, tmp_path, (3,), "speed") == {"vel": [4]}
    assert told("ur", URSCRIPT, tmp_path, (4,), "speed") == {"vel": [4]}
