"""Messages when names and files do not fit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from flyby.cli.output import console
from flyby.vendors.abb.motion.configuration import AbbConfiguration
from flyby.vendors.kuka.motion.configuration import KukaConfiguration
from flyby.vendors.ur.motion.configuration import UrConfiguration

ROBOT = "abb/irb6640-180-255"
SQUARE = Path(__file__).parents[2] / "examples/square.mod"
Flyby = Callable[..., Result]


def test_a_robot_is_known_without_its_vendor_and_offered_where_it_is_misspelt(
    flyby: Flyby,
) -> None:
    result = flyby("emulate", SQUARE, "--robot", "IRB 6640-180/2.55")
    assert f"on {ROBOT}" in result.stdout
    result = flyby("emulate", SQUARE, "--robot", "irb6640-18-256")
    assert f"near it are {ROBOT}" in result.stderr


def test_a_folder_and_a_name_without_suffix_are_told(flyby: Flyby, tmp_path: Path) -> None:
    assert "is a folder" in flyby("emulate", tmp_path, "--robot", ROBOT).stderr
    assert "no suffix" in flyby("emulate", tmp_path / "program", "--robot", ROBOT).stderr


@pytest.mark.parametrize("command", ["emulate", "ask", "check", "view", "diff"])
def test_what_is_no_program_is_told_before_a_robot_is_asked_for(
    flyby: Flyby, tmp_path: Path, command: str
) -> None:
    words = (command, SQUARE) if command == "diff" else (command,)
    result = flyby(*words, tmp_path / "mistyped.mod")
    assert result.exit_code != 0
    assert f"{tmp_path / 'mistyped.mod'}: there is no such file or folder" in result.stderr
    if command != "diff":
        (tmp_path / "cell.toml").write_text("", "utf-8")
        told = "a station has two robots" if command == "check" else "no vendor reads '.toml' files"
        assert told in flyby(command, tmp_path / "cell.toml").stderr


def test_units_of_a_mesh_are_asked_for_by_name(flyby: Flyby, tmp_path: Path) -> None:
    cell = tmp_path / "cell.toml"
    cell.write_text(f'robot = "{ROBOT}"\n[[obstacle]]\nname = "a"\nmesh = "a.stl"\nunit = "m"\n')
    told = flyby("emulate", SQUARE, "--cell", cell).stderr
    assert "obstacle[1].units: is missing: one of " in told and "mm" in told


def test_a_start_beyond_a_limit_is_no_matter_of_targets(flyby: Flyby, small) -> None:
    result = flyby("emulate", small(), "--robot", ROBOT, "--start", "200,0,0,0,0,0")
    assert "the start: joint J1 would stand at 200.00 °, beyond its limit" in result.stderr
    assert result.stderr.strip().endswith("start within the limits")


def test_what_is_kept_is_told_once_with_its_count(flyby: Flyby, small) -> None:
    program = small("SetDO do1, 1", "SetDO do1, 0", "MoveL Offs(p1,10,0,0), v200, fine, tool0")
    told = flyby("emulate", program, "--robot", ROBOT).stderr
    assert told.count("SetDO is kept") == told.count("(2 times, here first)") == 1


def test_configurations_are_written_as_their_vendor_does() -> None:
    assert str(AbbConfiguration(0, -1, 0, 7)) == "[0,-1,0,7]"
    assert (str(KukaConfiguration(2, 35)), str(KukaConfiguration(None, 3))) == ("S 2, T 35", "T 3")
    assert str(UrConfiguration((0.0, 3.141592653589793))) == "[0.00°, 180.00°]"


def test_a_name_does_not_speak_to_the_terminal(flyby: Flyby, tmp_path: Path) -> None:
    told = flyby("emulate", tmp_path / "a\x1b]0;owned\x07.mod", "--robot", ROBOT).stderr
    assert "\x1b" not in told and "a\ufffd]0;owned\ufffd.mod" in told


@pytest.mark.parametrize("width", [40, 80, 100, 160])
def test_tables_lose_nothing_in_narrow_terminals(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(console, "WIDE", width)
    columns = [(f"column {k}", "right") for k in range(12)]
    rows = [[f"{row}{k:02}.125" for k in range(12)] for row in range(3)]
    console.print_table(columns, rows)
    said = capsys.readouterr().out
    assert all(cell in said for row in rows for cell in row)
    assert all(f"column {k}" in said for k in range(12))
    assert all(len(line) <= width for line in said.splitlines())
    assert ("--json has it whole" in said) == (width < 150)


def test_texts_in_tables_are_broken_between_words(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(console, "WIDE", 30)
    console.print_table(
        [("#", "right"), ("target", "left")], [("1", "one 中文 extraordinary place")]
    )
    assert capsys.readouterr().out.splitlines()[1:-1] == [
        " #   target                   ",
        " ──────────────────────────── ",
        " 1   one 中文 extraordinary   ",
        "     place                    ",
    ]


def test_what_is_wrong_by_itself_ends_with_status_2(flyby: Flyby) -> None:
    robot = "--robot", ROBOT
    square = str(SQUARE)
    for words in (
        ("emulate", square, *robot, "--opaque", "keep"),
        ("emulate", square, *robot, "--period", "-1"),
        ("emulate", square, *robot, "--plot", "a.txt"),
        ("optimize", square, *robot, "--vias", "some"),
        ("optimize", square, *robot, "--starts", "0"),
        ("identify", square, *robot, "--workers", "0"),
        ("experiment", *robot, "--out", "new", "--angles", "0"),
        ("tune", square, *robot, "--jerk", "-1"),
        ("record", square, *robot, "--out", "new", "--period", "12"),
        ("paint", "part.stl", "--footprint", "f.toml", "--target", "5um", "--units", "ft"),
        ("fk", ROBOT, "a,b"),
        ("free", "--start", "0", "--goal", "0"),
        ("emulate", square, *robot, "--nonsense"),
    ):
        assert flyby(*words).exit_code == 2, words
    for words in (
        ("emulate", "missing.mod", *robot),
        ("emulate", square, "--robot", "abb/none"),
        ("zones", square, *robot, "--keep", "99"),
        ("tune", square, *robot, "--jerk", "1,2"),
        ("identify", "missing.mod", *robot),
    ):
        assert flyby(*words).exit_code == 1, words


def test_a_share_of_time_is_not_torn_apart(flyby: Flyby) -> None:
    said = flyby("emulate", SQUARE.with_name("deburring.mod"), "--robot", ROBOT).stdout
    rows = [line.split() for line in said.split("cycle")[0].splitlines() if " Move" in line]
    assert len(rows) == 98 and all(row[-1] in ("%)", "driven") for row in rows)


def test_helps_show_no_type_behind_switches(flyby: Flyby) -> None:
    said = flyby("paint", "--help").stdout
    assert "bool" not in said and "--force" in said
    assert "The first curve, and within what it may change" in said


def test_long_work_tells_of_itself_where_nobody_looks(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with console.progress("reading") as say:
        say("searching: 1 of 8")
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(console, "TOLD_EVERY", -1.0)
    with console.progress("reading") as say:
        say("searching: 2 of 8")
        say("searching: 3 of 8")
    assert capsys.readouterr().err == "searching: 2 of 8\nsearching: 3 of 8\n"
