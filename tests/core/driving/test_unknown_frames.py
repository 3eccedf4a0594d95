"""Configurations of moves whose tool or frame nobody knows tell nothing of the pose driven."""

from __future__ import annotations

from pathlib import Path

import pytest

import flyby
from flyby.core.errors import FlybyError

ABB = """MODULE cell
  VAR num n;
  PROC main()
    MoveAbsJ [[10,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;
    MoveJ [[450,60,500],[0,0,1,0],[1,2,-3,6],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tSucker{wobj};
    MoveL [[450,-60,500],[0,0,1,0],[-3,1,2,1],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tSucker{wobj};
  ENDPROC
ENDMODULE
"""
KUKA = """DEF cell( )
  BAS(#INITMOV,0)
  BAS(#TOOL,4)
  PTP {{A1 10,A2 -90,A3 90,A4 0,A5 30,A6 0}}
  PTP {{X 1300,Y 100,Z 1000,A 0,B 90,C 0,S 5,T 2}}
END
"""
TEXT = {"abb/irb1200-5-090": ABB, "kuka/kr30-3": KUKA}
ANSWERS = {
    "abb/irb1200-5-090": "tSucker = [true, [[0, 0, 80], [1, 0, 0, 0]], [1, [0, 0, 40], "
    "[1, 0, 0, 0], 0, 0, 0]]",
    "kuka/kr30-3": '"TOOL_DATA[4]" = { Z = 80 }',
}
NAMES = {"abb/irb1200-5-090": "tSucker", "kuka/kr30-3": "TOOL_DATA[4]"}


def emulated(robot: str, tmp_path: Path, answers: str = "", wobj: str = ""):
    path = tmp_path / ("cell.mod" if robot.startswith("abb") else "cell.src")
    path.write_text(TEXT[robot].format(wobj=wobj))
    told = tmp_path / "told.toml"
    told.write_text(f"[values]\n{answers}\n")
    return flyby.emulate(flyby.read(path, robot=robot, answers=told if answers else None))


@pytest.mark.parametrize("robot", TEXT)
def test_they_give_way_to_the_nearest_with_a_note(robot: str, tmp_path: Path) -> None:
    run = emulated(robot, tmp_path)
    assert run.faults == ()
    notes = [note.message for note in run.notes if "contradicts" in note.message]
    assert len(notes) == 1
    assert f"as {NAMES[robot]} is not known" in notes[0]


@pytest.mark.parametrize("robot", TEXT)
def test_once_the_tool_is_known_they_count(robot: str, tmp_path: Path) -> None:
    try:
        faults = emulated(robot, tmp_path, ANSWERS[robot]).faults
    except FlybyError as refused:
        assert "contradicts" in str(refused)
    else:
        assert "contradicts" in faults[0].message
        assert "not known" not in faults[0].message


def test_all_that_is_not_known_is_named_once(tmp_path: Path) -> None:
    run = emulated("abb/irb1200-5-090", tmp_path, wobj="\\WObj:=wTable")
    assert run.faults == ()
    (note,) = [note.message for note in run.notes if "contradicts" in note.message]
    assert note.endswith("as tSucker and wTable are not known; so it is with 1 other move")
