"""What messages on single robots of a station advise can be done where robots are stated."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import flyby
from flyby.core.errors import InputError

from .stations import Write


def refused(*source: Path) -> str:
    with pytest.raises(InputError) as caught:
        flyby.station(source)
    return str(caught.value)


def test_a_robot_that_nobody_names_stands_in_the_cell_file(write: Write) -> None:
    file = write({"one": ["go 0", "go 1"], "two": ["go 0", "go 1"]})
    file.write_text(file.read_text().replace('cell = "two.toml"\n', ""))
    assert "robot.two: which robot? Give robot in its cell file" in refused(file)


def test_what_is_not_known_of_a_program_is_answered_in_the_station_file(write: Write) -> None:
    file = write({"one": ["go 0", "go 1"], "two": ["go 0", "go 1"]})
    folder = file.parent
    points = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\nPTP {A1 9,A2 -90,A3 90,A4 0,A5 30,A6 0}"
    (folder / "two.src").write_text(f"DEF two()\nBAS(#INITMOV,0)\n{points}\nEND\n")
    tool = '[tool."TOOL_DATA[1]"]\ntcp = { xyz_mm = [0, 0, 50] }\n'
    cell = 'robot = "kuka/kr6-r900-2"\nbase = { xyz_mm = [9000, 0, 0] }\n'
    (folder / "two.toml").write_text(cell + tool)
    file.write_text(file.read_text().replace("two.mod", "two.src"))
    assert "TOOL_DATA[1] is not known" in (said := refused(file)) and "(answers;" in said
    answers = '[values]\n"TOOL_DATA[1]" = "{X 0,Y 0,Z 50,A 0,B 0,C 0}"\n'
    (folder / "told.toml").write_text(answers)
    file.write_text(file.read_text().replace('"two.src"', '"two.src"\nanswers = "told.toml"'))
    assert flyby.station(file).clear


def test_an_entry_of_a_backup_is_chosen_in_a_station_file(tmp_path: Path) -> None:
    folders = [tmp_path / name for name in ("left", "right")]
    for folder in folders:
        shutil.copytree("examples/kuka_archive", folder)
    assert "Choose with entry in a station file: " in refused(*folders)
