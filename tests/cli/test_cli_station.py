"""``flyby station``, and what other commands do with a station file."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Flyby = Callable[..., Result]
EXAMPLE = Path("examples/two_robots")


@pytest.fixture
def station(tmp_path: Path) -> Path:
    folder = tmp_path / "station"
    shutil.copytree(EXAMPLE, folder)
    return folder / "station.toml"


def test_zones_of_a_station_are_written_into_a_folder(
    flyby: Flyby, station: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    before = {file.name: file.read_bytes() for file in station.parent.iterdir()}
    made = flyby("zones", station, "--out", out, "--json")
    told = json.loads(made.stdout)
    assert told["station_time_s"] < told["station_time_before_s"] and told["proven"]
    assert {Path(file).relative_to(out).as_posix() for file in told["files"]} == {
        "left/left.mod",
        "right/right.mod",
        "station.toml",
    }
    again = flyby("station", out / "station.toml", "--json")
    assert json.loads(again.stdout)["station_time_s"] == pytest.approx(told["station_time_s"])
    assert {file.name: file.read_bytes() for file in station.parent.iterdir()} == before


def test_zones_of_a_station_in_place(flyby: Flyby, station: Path) -> None:
    text = (station.parent / "left.mod").read_text()
    made = flyby("zones", station, "--in-place")
    assert "station time" in made.stdout and "left.mod" in made.stdout
    now = (station.parent / "left.mod").read_text()
    changed = [line for line in now.split("\n") if line not in text.split("\n")]
    assert len(changed) == 4 and all("z" in line for line in changed)


@pytest.mark.parametrize("command", ["zones", "check"])
def test_options_of_one_program_are_refused(flyby: Flyby, station: Path, command: str) -> None:
    made = flyby(command, station, "--entry", "main")
    assert made.exit_code == 2 and "--entry does not go with a station" in made.stderr


def test_a_page_of_the_station_is_written(flyby: Flyby, station: Path, tmp_path: Path) -> None:
    page = tmp_path / "zones.html"
    told = json.loads(flyby("zones", station, "--report", page, "--json").stdout)
    assert told["files"] == [str(page)] and page.stat().st_size > 500_000
    again = flyby("zones", station, "--report", page)
    assert again.exit_code == 2 or again.exit_code == 1
    assert "zones.html" in again.stderr


@pytest.mark.parametrize(
    "words", [("zones", "--plot", "x.png"), ("zones", "--unproven"), ("optimize", "--also", "ur5e")]
)
def test_options_without_a_meaning_for_stations_are_refused(
    flyby: Flyby, station: Path, words: tuple[str, ...]
) -> None:
    made = flyby(words[0], station, *words[1:])
    assert made.exit_code == 2 and f"{words[1]} does not go with a station" in made.stderr


def test_a_file_that_two_robots_drive_does_not_change_in_place(flyby: Flyby, station: Path) -> None:
    rests = "[9E9,9E9,9E9,9E9,9E9,9E9]"
    turns = [
        "[[90,0,0,0,30,0],%s], v500, fine",
        "[[110,9,0,0,30,0],%s], v500, z1",
        "[[110,-9,0,0,30,0],%s], v500, fine",
    ]
    lines = [f"MoveAbsJ {turn % rests}, tool0" for turn in turns]
    shared = station.parent / "shared.mod"
    body = ";".join([*lines, lines[0]])
    shared.write_text(f"MODULE shared\nPROC main()\n{body};\nENDPROC\nENDMODULE\n")
    text = station.read_text().split("[links]")[0]
    station.write_text(text.replace("left.mod", "shared.mod").replace("right.mod", "shared.mod"))
    made = flyby("zones", station, "--in-place")
    assert made.exit_code == 1 and "both drive" in made.stderr and "--out" in made.stderr
    made = flyby("zones", station, "--out", station.parent / "out")
    assert made.exit_code == 0


def test_a_station_is_checked(flyby: Flyby, station: Path) -> None:
    made = flyby("check", station)
    assert "left:" in made.stdout and "right:" in made.stdout
    assert "proven to keep clear of each other" in made.stdout
    right = station.parent / "right.mod"
    right.write_text(right.read_text().replace("WaitDI diFree, 1;", ""))
    station.write_text(station.read_text().split("[links]")[0])
    made = flyby("check", station)
    assert made.exit_code == 1 and "left.mod" in made.stderr and "right.mod" in made.stderr


def test_releases_are_a_stations(flyby: Flyby, station: Path) -> None:
    program, cell = station.parent / "left.mod", station.parent / "left.toml"
    made = flyby("optimize", program, "--cell", cell, "--release", "left.doLeft")
    assert made.exit_code == 2 and "--release names outputs of a station" in made.stderr
