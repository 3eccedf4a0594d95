"""Tools and work objects that nobody knows: named in the headline, never proven or written."""

from __future__ import annotations

from pathlib import Path

import pytest

import flyby
from flyby.core.errors import InputError, MotionError
from flyby.core.program.program import Program

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
ROBOT = "abb/irb1600-6-145"


def rapid(x: float, z: float, answers: str | Path | None = None) -> Program:
    points = [(x, 0, z), (x, 100, z), (x, 100, z + 100), (x, 0, z + 100)]
    moves = "\n".join(
        f"MoveL [[{x},{y},{z}],[0,0,1,0],[0,0,0,0],{UNUSED}],v200,z5,tGrip\\WObj:=wTable;"
        for x, y, z in points
    )
    text = f"MODULE M\nPROC main()\n{moves}\nENDPROC\nENDMODULE\n"
    return flyby.read(text, robot=ROBOT, answers=answers, configuration="nearest")


def test_they_are_named_with_the_time_that_rests_on_them() -> None:
    run = flyby.emulate(rapid(700, 600))
    assert not run.faults and not run.program.placed
    assert run.report.unknown == ("tGrip", "wTable")


def test_one_that_does_not_do_is_put_to_where_the_robot_drives_and_said() -> None:
    run = flyby.emulate(rapid(0, 0))
    assert not run.faults
    assert run.program.placed == ("wTable",) and run.report.unknown == ("tGrip", "wTable")
    said = [note.message for note in run.notes if "an example with which it drives" in note.message]
    (message,) = said
    assert message.startswith("wTable is not known, and the robot does not drive")
    assert flyby.emulate(rapid(700, 600)).report.notes != run.report.notes


def test_what_the_user_asks_to_stop_at_is_not_put_elsewhere() -> None:
    with pytest.raises(MotionError):
        flyby.emulate(rapid(0, 0), strict=True)


def test_what_does_not_drive_for_them_is_mended_by_saying_what_they_are() -> None:
    fixes = {f.fix for f in flyby.check(rapid(0, 0)) if f.rule == "cannot-drive"}
    (fix,) = fixes
    assert fix.startswith("say what tGrip and wTable are in a file (answers; `flyby ask` writes")


@pytest.mark.parametrize("placed", [False, True])
def test_nothing_is_proven_or_written_with_them(placed: bool, tmp_path: Path) -> None:
    program = rapid(0, 0) if placed else rapid(700, 600)
    program = flyby.emulate(program).program
    assert bool(program.placed) == placed
    for task in (flyby.zones, flyby.optimize):
        with pytest.raises(InputError, match="tGrip and wTable are not known: nothing can"):
            task(program)
    with pytest.raises(InputError, match="nothing can be proven or written"):
        flyby.write(program, tmp_path / "new.mod")


def test_once_they_are_answered_all_is_done_with_them(tmp_path: Path) -> None:
    answers = tmp_path / "a.toml"
    lines = [
        line[1:] if line.startswith(("#tGrip", "#wTable")) else line
        for line in flyby.ask(rapid_file(tmp_path), robot=ROBOT).toml.splitlines()
    ]
    answers.write_text("\n".join(lines), "utf-8")
    program = rapid(700, 600, answers)
    assert flyby.emulate(program).report.unknown == ()
    flyby.write(program, tmp_path / "new.mod")
    assert "tGrip" in (tmp_path / "new.mod").read_text("utf-8")


def rapid_file(folder: Path) -> Path:
    move = f"MoveL [[700,0,600],[0,0,1,0],[0,0,0,0],{UNUSED}],v200,z5,tGrip\\WObj:=wTable;"
    file = folder / "a.mod"
    file.write_text(f"MODULE M\nPROC main()\n{move}\nENDPROC\nENDMODULE\n", "utf-8")
    return file


def test_nothing_is_proven_of_a_way_that_begins_where_nobody_knows() -> None:
    """A line from where the robot stands is driven from its ready posture, which is a guess."""
    moves = "\n".join(
        f"MoveL Offs(p,0,0,{z}),v200,{zone},tool0;" for z, zone in ((50, "z10"), (0, "fine"))
    )
    text = f"MODULE M\nVAR robtarget p;\nPROC main()\np:=CRobT();\n{moves}\nENDPROC\nENDMODULE\n"
    program = flyby.read(text, robot=ROBOT)
    assert not flyby.emulate(program).faults
    for task in (flyby.zones, flyby.optimize):
        with pytest.raises(InputError, match=r"stands before the first move, .*say it \(start\)"):
            task(program)
    known = flyby.read(text, robot=ROBOT, start=(0.0, 0.0, 0.0, 0.0, 0.5, 0.0))
    assert not any(move.supposed for move in known.moves)


def test_a_configuration_tells_nothing_of_a_target_that_is_not_known() -> None:
    """It is driven with the nearest; of the places that are known it stays a fault."""
    pose = f"[[900,%s,900],[0,0,1,0],[0,0,0,0],{UNUSED}]"
    lines = [
        f"MoveJ {pose % 0},v200,fine,tool0;",
        f"p:={pose % 100}; p.robconf.cf4:=2;",
        'TPReadNum p.trans.z, "How high?";',
        "MoveJ p,v200,fine,tool0;",
    ]
    text = "MODULE M\nPROC main()\nVAR robtarget p;\n%s\nENDPROC\nENDMODULE\n"
    run = flyby.emulate(flyby.read(text % "\n".join(lines), robot=ROBOT))
    assert not run.faults
    (said,) = [n.message for n in run.notes if "contradicts the pose" in n.message]
    assert said.endswith("as the target is not known")
    with pytest.raises(InputError, match="nothing can be proven or written"):
        flyby.optimize(run.program)
    known = text % "\n".join(lines[:2] + lines[3:])
    with pytest.raises(MotionError, match="contradicts the pose"):
        flyby.emulate(flyby.read(known, robot=ROBOT))
