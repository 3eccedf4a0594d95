"""Where an output is on along lines at one speed, the path is the work, and stays."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import flyby
from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.program import Program
from flyby.core.program.zone import Fine
from flyby.core.registry import find_robot, find_vendor
from flyby.problems.improve.process_paths import lines_moved, process_paths
from flyby.problems.improve.solution import Moved
from flyby.problems.improve.zones.points import find_points

RAPID = """MODULE Glue
  CONST robtarget above:=[[1200,0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ above,v1000,fine,tool0;
    MoveL Offs(above,0,0,-100),v500,{stop},tool0;
    {on}
    MoveL [[1400,0,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,z5,tool0;
    {line} [[1400,300,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],{speed},z5,tool0;
    MoveL [[1200,300,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,{stop},tool0;
    {off}
    MoveL [[1200,300,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,z50,tool0;
    MoveL [[1200,100,1000],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,z50,tool0;
    MoveJ above,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
ROBOT = "abb/irb6640-180-255"


def rapid(**words: str) -> Program:
    usual = {
        "stop": "fine",
        "on": "SetDO doGlue,1;",
        "off": "Reset doGlue;",
        "line": "MoveL",
        "speed": "v200",
    }
    return find_vendor("abb").read(RAPID.format(**usual | words), "Glue.mod")


def paths(program: Program, vendor: str = "abb") -> list[tuple[str, int, int]]:
    dialect = find_vendor(vendor).speaks
    assert dialect is not None
    return [(p.output, p.first, p.last) for p in process_paths(program, dialect.signals)]


def test_between_on_and_off() -> None:
    assert paths(rapid()) == [("doGlue", 2, 4)]


def test_a_bead_that_is_faster_on_its_last_lines() -> None:
    further = (
        "MoveL [[1100,300,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v300,fine,tool0;"
    )
    last = "v200,{stop},tool0;\n    {off}"
    text = RAPID.replace(last, f"v300,z5,tool0;\n    {further}\n    {{off}}")
    words = {"stop": "fine", "on": "Set doGlue;", "off": "Reset doGlue;", "line": "MoveL"}
    program = find_vendor("abb").read(text.format(**words, speed="v200"), "Glue.mod")
    assert paths(program) == [("doGlue", 2, 3), ("doGlue", 4, 5)]


def test_without_stops_at_its_ends() -> None:
    assert paths(rapid(stop="z1")) == [("doGlue", 2, 4)]


@pytest.mark.parametrize(
    "words",
    [
        {"line": "MoveJ"},  # through the air
        {"off": ""},  # never off again
        {"on": "Reset doGlue;", "off": "SetDO doGlue,1;"},
        {"on": "PulseDO doGlue;"},
        {"off": "Reset doOther;"},
        {"on": "SetDO doGlue,1; Reset doGlue;"},  # at a stop alone
    ],
    ids=str,
)
def test_what_is_no_work(words: dict[str, str]) -> None:
    assert paths(rapid(**words)) == []


def test_what_is_switched_on_the_way_counts() -> None:
    text = RAPID.replace("MoveL [[1400,0,800]", "MoveLDO [[1400,0,800]").replace(
        "z5,tool0;\n    {line}", "z5,tool0,doGlue,1;\n    {line}"
    )
    words = {"stop": "z1", "on": "", "off": "Reset doGlue;", "line": "MoveL", "speed": "v200"}
    assert paths(find_vendor("abb").read(text.format(**words), "Glue.mod")) == [("doGlue", 2, 4)]


KRL = """DEF bead()
$TOOL=$NULLFRAME
$BASE=$NULLFRAME
PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
$VEL.CP=0.2
$APO.CDIS=5
LIN {X 1400,Y 0,Z 1200,A 0,B 90,C 0}
$OUT[7]=TRUE
LIN {X 1400,Y 100,Z 1200,A 0,B 90,C 0} C_DIS
LIN {X 1400,Y 100,Z 1100,A 0,B 90,C 0} C_DIS
LIN {X 1400,Y 0,Z 1100,A 0,B 90,C 0}
$OUT[7]=FALSE
PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
END
"""
UR = """def bead():
  movej([0,-1.5,1.5,-1.5,-1.5,0], a=1.2, v=1)
  set_standard_digital_out(2, True)
  movel(p[0.4,-0.1,0.3,0,3.14,0], a=1.2, v=0.1, r=0.005)
  movel(p[0.5,-0.1,0.3,0,3.14,0], a=1.2, v=0.1, r=0.005)
  movel(p[0.5,0.1,0.3,0,3.14,0], a=1.2, v=0.1)
  set_standard_digital_out(2, False)
  movej([0,-1.5,1.5,-1.5,-1.5,0], a=1.2, v=1)
end
"""


def test_other_languages() -> None:
    assert paths(find_vendor("kuka").read(KRL, "bead.src"), "kuka") == [("$OUT[7]", 2, 4)]
    (found,) = paths(find_vendor("ur").read(UR, "bead.script"), "ur")
    assert found[1:] == (1, 3)


def test_improvements_leave_it_alone(tmp_path: Path) -> None:
    file = tmp_path / "Glue.mod"
    file.write_text(RAPID.format(stop="fine", on="Set doGlue;", off="Reset doGlue;", line="MoveL",
                                 speed="v200"))  # fmt: skip
    program = flyby.read(file, robot=ROBOT)
    larger = flyby.zones(program, no_floor=True)
    zones = [move.zone for move in larger.program.moves]
    assert zones[2:5] == [move.zone for move in program.moves[2:5]]
    assert zones[5:7] != [move.zone for move in program.moves[5:7]]
    assert "doGlue is on there" in " ".join(note.message for note in larger.notes)

    freed = flyby.zones(program, no_floor=True, free=["DOGLUE"])
    assert freed.program.moves[2].zone != program.moves[2].zone
    assert not any("doGlue" in note.message for note in freed.notes)

    every = flyby.zones(program, no_floor=True, free=["all"])
    passed = [not isinstance(move.zone, Fine) for move in every.program.moves]
    assert passed == [False, False, True, True, False, True, True, False]

    with pytest.raises(InputError, match=r"outputs that it sets: doGlue"):
        flyby.zones(program, no_floor=True, free=["doGleu"])


def test_an_output_that_nothing_is_kept_for_is_freed_in_vain(tmp_path: Path) -> None:
    file = tmp_path / "Glue.mod"
    file.write_text(RAPID.format(stop="fine", on="Set doGlue;", off="Reset doGlue;", line="MoveJ",
                                 speed="v200"))  # fmt: skip
    made = flyby.zones(flyby.read(file, robot=ROBOT), no_floor=True, free=["doGlue"])
    assert any("doGlue has no effect" in note.message for note in made.notes)


def test_points_in_a_row_on_lines_are_said_to_have_moved() -> None:
    program = rapid(on="GlueOn;", off="GlueOff;")
    one, other = Moved(2, 0.01, 0.0, 0.0), Moved(3, 0.2, 0.0, 0.0)
    (note,) = lines_moved(program, [one, other])
    assert note.move == 2 and "2 points in a row" in note.message and "200 mm" in note.message
    assert not lines_moved(program, [one])
    assert not lines_moved(program, [one, replace(other, move=5)])


def test_the_end_of_a_bead_is_kept_past_a_move_that_goes_nowhere() -> None:
    """The zone behind it is driven where the bead ends."""
    nowhere = "MoveL [[1200,300,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,z5,tool0;"
    text = RAPID.replace("{off}", "{off}\n    " + nowhere)
    words = {"stop": "z5", "on": "Set doGlue;", "off": "Reset doGlue;", "line": "MoveL"}
    program = find_vendor("abb").read(text.format(**words, speed="v200"), "Glue.mod")
    ((output, first, last),) = paths(program)
    assert (first, last) == (2, 4)
    process = dict.fromkeys(range(first, last + 1), output)
    controller = Controller(find_vendor("abb"), find_robot(ROBOT))
    points = find_points(controller, program, None, {}, (), False, process)
    assert [points.move[corner] for corner in points.growths] == [6, 7]
