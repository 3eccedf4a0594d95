"""``flyby import``, and commands that are given backups."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from flyby.core.cell.file import load_cell
from flyby.core.registry import installed

from ..vendors.abb.backup.station import Station, multimove, one_robot

Flyby = Callable[..., Result]


@pytest.fixture
def station(tmp_path: Path) -> Path:
    """A backup of one robot on a pedestal."""
    return Station(moc=one_robot("-base_frame_pos_z 0.5")).write(tmp_path / "station")


def test_one_screen_has_it_all(flyby: Flyby, station: Path) -> None:
    result = flyby("import", station)
    assert result.exit_code == 0, result.output
    for part in (
        *("Cell7", "RobotWare 6.08.0134", "abb/irb4600-40-255", "0.0, 0.0, 500.0", "T_ROB1"),
        *("Pick", "At(p)", "tGripper", "12.5, 0.0, 180.0", "wTable", "jHome", "digital input"),
        "period_s = 0.004032",
    ):
        assert part in result.output
    assert len(result.output.splitlines()) < 60


def test_json_has_all_in_si(flyby: Flyby, station: Path) -> None:
    told = json.loads(flyby("import", station, "--json").stdout)
    (robot,) = told["robots"]
    assert robot["base"]["position"] == [0.0, 0.0, 0.5]
    assert robot["axes"][0]["upper"] == pytest.approx(3.14159, abs=1e-4)
    (task,) = told["tasks"]
    assert [entry["name"] for entry in task["entries"]] == ["Main", "Pick", "At", "Service"]
    assert told["tools"]["tGripper"]["load"]["mass_kg"] == 4.5
    assert {signal["kind"] for signal in told["signals"]} >= {"digital input"}


def test_the_station_as_flybys_own_files_drives_as_the_backup_does(
    flyby: Flyby, station: Path, tmp_path: Path
) -> None:
    out = tmp_path / "made"
    assert flyby("import", station, "--out", out).exit_code == 0
    names = {"cell.toml", "robot.toml", "motion.toml", "answers.toml"}
    assert {path.name for path in out.iterdir()} == names
    own = json.loads(flyby("emulate", station, "--json").stdout)
    files = ("--cell", out / "cell.toml", "--io", out / "answers.toml", "--json")
    again = json.loads(flyby("emulate", station, *files).stdout)
    assert again["cycle_time_s"] == pytest.approx(own["cycle_time_s"], rel=1e-9)
    result = flyby("import", station, "--out", out)
    assert result.exit_code == 1
    assert "exists already" in result.output


def test_of_several_robots_each_has_files_of_its_own(flyby: Flyby, tmp_path: Path) -> None:
    folder = multimove().write(tmp_path / "two")
    result = flyby("import", folder, "--out", tmp_path / "made")
    assert result.exit_code == 0, result.output
    names = {path.name for path in (tmp_path / "made").iterdir()}
    assert {"cell_t_rob1.toml", "cell_t_rob2.toml", "robot_t_rob1.toml"} <= names


def test_of_a_backup_without_programs_the_arm_is_written(flyby: Flyby, tmp_path: Path) -> None:
    shutil.copytree(Path(__file__).parents[2] / "examples/kuka_archive", tmp_path / "bare")
    for path in (tmp_path / "bare").rglob("*"):
        if path.suffix.lower() in (".src", ".sub"):
            path.unlink()
    result = flyby("import", tmp_path / "bare", "--out", tmp_path / "made")
    assert result.exit_code == 0, result.output
    assert "no programs are in it" in result.output
    made = {path.name for path in (tmp_path / "made").iterdir()}
    assert made == {"cell.toml", "robot.toml", "motion.toml"}
    load_cell(tmp_path / "made/cell.toml", installed())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda path: path, "there is no such file or folder"),
        (lambda path: path.mkdir(), "no backup is in this folder"),
        (lambda path: path.write_bytes(b"PK\x03\x04broken"), "is no zip archive, or is cut short"),
        (lambda path: path.write_text("x"), "no backup is in this file"),
    ],
)
def test_what_is_no_backup_is_refused(
    flyby: Flyby, tmp_path: Path, make: Callable[[Path], object], message: str
) -> None:
    path = tmp_path / "thing"
    make(path)
    result = flyby("import", path)
    assert result.exit_code == 1
    assert message in result.output
    assert "Traceback" not in result.output


@pytest.mark.parametrize("command", ["emulate", "ask", "check", "zones"])
def test_commands_take_a_backup(flyby: Flyby, station: Path, command: str) -> None:
    more = ("--no-floor",) if command == "zones" else ()
    result = flyby(command, station, *more)
    assert result.exit_code in (0, 1), result.output
    assert "error" not in result.output


def test_a_folder_without_programs_is_no_backup(flyby: Flyby, tmp_path: Path) -> None:
    result = flyby("emulate", tmp_path)
    assert result.exit_code == 1
    assert "no backup is in this folder" in result.output


def test_a_backup_says_which_robot_a_translated_program_is_for(
    flyby: Flyby, station: Path, tmp_path: Path
) -> None:
    words = ("--to", "ur", "--robot", "ur/ur20", "--out", tmp_path / "out", "--entry", "Pick")
    result = flyby("translate", station, *words)
    assert "--from" not in result.output
    assert "which robot" not in result.output
    result = flyby("translate", station / "RAPID/TASK1/PROGMOD/MainModule.mod", *words)
    assert result.exit_code == 2
    assert "Give --from" in result.output


def test_figures_are_printed_without_what_binary_fractions_add(flyby: Flyby) -> None:
    archive = Path(__file__).parents[2] / "examples/kuka_archive"
    assert "time.joint_smoothing_s = [0.072, 0.072] (" in flyby("import", archive).output
