"""``flyby ask``, and what ``flyby emulate`` makes of the file that it writes."""

from __future__ import annotations

import json
import shlex
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

import flyby as package

Flyby = Callable[..., Result]
ROBOT = ("--robot", "ur/ur10e")
CELL = """def cell():
  while True:
    while get_digital_in(3) == False:
      sync()
    end
    movej([0, -1.57, 1.57, -1.57, -1.57, 0], a=1.4, v=1.05)
    my_gripper(1)
    sleep(0.5)
    movej([0.5, -1.57, 1.57, -1.57, -1.57, 0], a=1.4, v=1.05)
    set_digital_out(4, True)
  end
end
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    path = tmp_path / "cell.script"
    path.write_text(CELL, "utf-8")
    return path


def test_all_that_is_asked_is_a_file_of_answers(flyby: Flyby, cell: Path) -> None:
    result = flyby("ask", cell, *ROBOT)
    assert result.exit_code == 0
    found = tomllib.loads(result.stdout)
    assert found["calls"] == {"my_gripper": "skip"}
    assert found["passes"] == {} and '#"cell.script:3" = 0' in result.stdout
    assert set(found["durations"]) == {"while get_digital_in(3) == False", "my_gripper(1)"}
    assert '#"get_digital_in(3)" = false' in result.stdout
    listed = json.loads(flyby("ask", cell, *ROBOT, "--json").stdout)["questions"]
    assert {entry["table"] for entry in listed} == {"values", "calls", "passes", "durations"}
    assert package.ask(cell, robot="ur/ur10e").toml == result.stdout


def test_the_time_of_a_cycle_is_divided(flyby: Flyby, cell: Path, tmp_path: Path) -> None:
    answers = tmp_path / "answers.toml"
    assert flyby("ask", cell, *ROBOT, "--out", answers).exit_code == 0
    words = ("emulate", cell, *ROBOT, "--io", answers, "--cycles", "2")
    plain = flyby(*words)
    assert plain.exit_code == 0
    assert "devices" not in plain.stdout
    text = answers.read_text("utf-8").replace('"my_gripper(1)" = 0', '"my_gripper(1)" = 0.4')
    answers.write_text(text.replace('== False" = 0', '== False" = 6'), "utf-8")
    timed = flyby(*words)
    assert "the last of 2" in timed.stdout
    assert "waits 0.500 s" in timed.stdout
    assert "devices 6.400 s" in timed.stdout
    shares = json.loads(flyby(*words, "--json").stdout)["cycle"]
    assert shares["devices_s"] == pytest.approx(6.4)
    assert shares["total_s"] == pytest.approx(shares["motion_s"] + 6.9)


def test_a_cycle_with_a_fault_has_no_time(flyby: Flyby, tmp_path: Path) -> None:
    path = tmp_path / "far.script"
    path.write_text(
        "def far():\n  movej([0, -1.57, 1.57, -1.57, -1.57, 0])\n  while True:\n"
        "    movej([0.5, -1.57, 1.57, -1.57, -1.57, 0])\n    movel(p[9, 0, 0, 0, 0, 0])\n"
        "    movej([0, -1.57, 1.57, -1.57, -1.57, 0])\n"
        "    movej([0.2, -1.57, 1.57, -1.57, -1.57, 0])\n  end\nend\n"
    )
    words = ("emulate", path, *ROBOT)
    assert (
        "no cycle time, one pass of the loop at line 3, the last of 2, but for 1 fault: "
        in flyby(*words).stdout
    )
    report = json.loads(flyby(*words, "--json").stdout)
    assert report["cycle_time_s"] is report["cycle"]["total_s"] is None
    assert report["cycle"]["motion_s"] > 0.0


def test_emulate_says_it_in_a_line_a_kind(flyby: Flyby, cell: Path) -> None:
    result = flyby("emulate", cell, *ROBOT)
    assert result.exit_code == 0
    asked = [line for line in result.stderr.splitlines() if "not known: " in line]
    assert len(asked) == 4
    assert "the same command with `ask` for `emulate`, and `--out answers.toml`" in result.stderr


def test_a_file_that_is_there_is_kept(flyby: Flyby, cell: Path) -> None:
    result = flyby("ask", cell, *ROBOT, "--out", cell, "--force")
    assert result.exit_code != 0
    assert cell.read_text("utf-8") == CELL


def test_a_wait_that_takes_time_is_not_said_to_take_none(flyby: Flyby, tmp_path: Path) -> None:
    station = Path(__file__).parents[2] / "examples/station"
    known = "waiting takes no time here"
    assert known in flyby("emulate", station, "--entry", "Pick").stderr
    answers = tmp_path / "answers.toml"
    answers.write_text('[durations]\n"WaitDI diPart,1" = 2\n', "utf-8")
    result = flyby("emulate", station, "--entry", "Pick", "--io", answers)
    assert known not in result.stderr and "cycle time 2.990 s" in result.stdout


UNKNOWN_FRAME = {
    "m.mod": (
        "MODULE m\nCONST robtarget p1:=[[0,0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
        "CONST robtarget p2:=[[0,300,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
        "PROC main()\nMoveJ p1,v500,fine,tool0\\WObj:=wobjTable;\n"
        "MoveL p2,v500,fine,tool0\\WObj:=wobjTable;\nENDPROC\nENDMODULE\n",
        ["--robot", "abb/irb1600-6-145"],
    ),
    "m.src": (
        "DEF m( )\n$TOOL=$NULLFRAME\n$BASE=BASE_DATA[5]\n"
        "PTP {X 0,Y 0,Z 900,A 0,B 90,C 0,S 2,T 10}\nLIN {X 0,Y 300,Z 900,A 0,B 90,C 0}\nEND\n",
        ["--robot", "kuka/kr30-3"],
    ),
}


@pytest.mark.parametrize("file", UNKNOWN_FRAME)
def test_the_command_that_is_said_drives_with_what_was_found(
    flyby: Flyby, tmp_path: Path, file: str
) -> None:
    text, robot = UNKNOWN_FRAME[file]
    program, answers = tmp_path / file, tmp_path / "my answers.toml"
    program.write_text(text, "utf-8")
    assert " assumed: cycle time" in flyby("emulate", program, *robot).stdout
    result = flyby("ask", program, *robot, "--cycles", "2", "--out", answers)
    (line,) = (line for line in result.stdout.splitlines() if line.startswith("next: "))
    words = shlex.split(line.removeprefix("next: "))
    assert words[:2] == ["flyby", "emulate"] and str(answers) in words
    assert "found by trying, and not measured" in answers.read_text("utf-8")
    assert flyby(*words[1:]).exit_code == 0
