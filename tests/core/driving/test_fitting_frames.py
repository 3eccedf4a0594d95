"""Places of unknown work objects, and TCPs of unknown tools, that would do."""

from __future__ import annotations

from pathlib import Path

import pytest

import flyby
from flyby.core.driving.fitting_frames import frames_that_fit
from flyby.core.motion.emulator.controller import Controller

ROBOT = "abb/irb1600-6-145"
UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def rapid(folder: Path, *points: tuple[float, float, float], tool: str = "tool0") -> Path:
    moves = "\n".join(
        f"MoveJ [[{x},{y},{z}],[0,0,1,0],[0,0,0,0],{UNUSED}],v100,fine,{tool}\\WObj:=wTable;"
        for x, y, z in points
    )
    file = folder / "a.mod"
    file.write_text(f"MODULE M\nPROC main()\n{moves}\nENDPROC\nENDMODULE\n", "utf-8")
    return file


def fitting(file: Path, robot: str = ROBOT) -> dict[str, object]:
    program = flyby.read(file, robot=robot, configuration="nearest")
    return frames_that_fit(Controller(program.setup.vendor, program.setup.robot), program)


def test_a_frame_is_found_from_which_the_arm_drives(tmp_path: Path) -> None:
    file = rapid(tmp_path, (0, 0, 0), (200, 0, 0), (200, 150, 30))
    (key,) = fitting(file)
    assert key == "wTable"
    toml = flyby.ask(file, robot=ROBOT).toml
    assert f"found by trying, and not measured: with it {ROBOT} drives more of the moves" in toml
    answers = tmp_path / "a.toml"
    answers.write_text(toml, "utf-8")
    program = flyby.read(file, robot=ROBOT, answers=answers, configuration="nearest")
    assert not flyby.emulate(program).faults


def test_what_the_default_reaches_is_left_as_it_is(tmp_path: Path) -> None:
    file = rapid(tmp_path, (700, 0, 600), (750, 100, 600))
    assert fitting(file) == {}
    assert "drives more" not in flyby.ask(file, robot=ROBOT).toml


def test_work_that_is_too_large_for_the_arm_has_no_place(tmp_path: Path) -> None:
    assert fitting(rapid(tmp_path, (0, 0, 0), (9000, 0, 0))) == {}


@pytest.mark.parametrize("robot", ["kuka/kr10-r1100-3", "kuka/kr16-r2010"])
def test_a_base_of_krl_is_answered_in_its_words(tmp_path: Path, robot: str) -> None:
    point = "{X %s,Y 0,Z 0,A 0,B 90,C 0}"
    moves = "\n".join(f"PTP {point % x}" for x in (0, 100, 150))
    file = tmp_path / "a.src"
    file.write_text(
        f"DEF a()\nBAS(#INITMOV,0)\n$BASE=BASE_DATA[7]\n$TOOL=TOOL_DATA[1]\n{moves}\nEND\n", "utf-8"
    )
    (line,) = [one for one in flyby.ask(file, robot=robot).toml.splitlines() if "BASE_DATA" in one]
    line = line.removeprefix("#")  # of an arm that drives it where the controller's own base is
    assert line.startswith('"BASE_DATA[7]" = { X = ') and "C = 0 }" in line
    answers = tmp_path / "a.toml"
    answers.write_text(f"[values]\n{line}\n", "utf-8")
    assert not flyby.emulate(flyby.read(file, robot=robot, answers=answers)).faults
