"""``flyby check``: findings with line, rule and fix, and an exit status that scripts can use."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"

Flyby = Callable[..., Result]
Small = Callable[..., Path]


def test_findings_have_line_rule_and_fix(flyby: Flyby, small: Small) -> None:
    path = small("MoveL Offs(p1,100,0,0), v500, z100, tool0", "MoveL p1, v500, z10, tool0")
    result = flyby("check", path, "--robot", ROBOT)
    assert result.exit_code == 0
    assert "zone-cut" in result.stdout
    assert "zone-last" in result.stdout
    assert "2 warning" in result.stdout


def test_json_has_every_finding_with_its_place(flyby: Flyby, small: Small) -> None:
    path = small("MoveL Offs(p1,100,0,0), v500, z100, tool0", "MoveL p1, v500, fine, tool0")
    report = json.loads(flyby("check", path, "--robot", ROBOT, "--json").stdout)
    (cut,) = [f for f in report["findings"] if f["rule"] == "zone-cut"]
    assert (cut["file"], cut["line"], cut["move"], cut["severity"]) == (str(path), 6, 2, "warning")
    assert cut["fix"]


def test_findings_that_are_alike_are_one_row(flyby: Flyby, small: Small) -> None:
    """The first, with its line and how many there are; JSON has them all."""
    path = small(*(f"MoveL Offs(p1,{4 * k},{k % 2},0),v500,z10,tool0" for k in range(1, 30)))
    told = flyby("check", path, "--robot", ROBOT)
    assert told.stdout.count("zone-cut") == 1, told.output
    every = json.loads(flyby("check", path, "--robot", ROBOT, "--json").stdout)["findings"]
    cut = [one for one in every if one["rule"] == "zone-cut"]
    assert f"(and {len(cut) - 1} like" in told.stdout and len(cut) > 20


def test_an_error_among_the_findings_ends_with_status_1(flyby: Flyby, small: Small) -> None:
    path = small("MoveL Offs(p1,9000,0,0), v500, fine, tool0")
    result = flyby("check", path, "--robot", ROBOT)
    assert result.exit_code == 1
    assert "cannot-drive" in result.stdout


def test_a_text_that_cannot_be_read_is_a_finding(flyby: Flyby, small: Small) -> None:
    path = small("MoveL p1, v500, fine")
    result = flyby("check", path, "--robot", ROBOT, "--json")
    assert result.exit_code == 1
    found = json.loads(result.stdout)["findings"]
    assert [f["line"] for f in found if f["severity"] == "error"][:1] == [6]


def test_a_move_to_where_nobody_knows_is_a_finding(flyby: Flyby, small: Small) -> None:
    path = small("MoveL pNowhere, v500, fine, tool0")
    result = flyby("check", path, "--robot", ROBOT, "--json")
    assert result.exit_code == 1
    (error,) = (f for f in json.loads(result.stdout)["findings"] if f["severity"] == "error")
    assert (error["rule"], error["line"]) == ("cannot-drive", 6)
    assert "pNowhere" in error["message"]


def test_a_missing_file_is_no_finding(flyby: Flyby, tmp_path: Path) -> None:
    result = flyby("check", tmp_path / "absent.mod", "--robot", ROBOT)
    assert result.exit_code == 1
    assert "absent.mod" in result.stderr
    assert not result.stdout


def test_nothing_found_is_said(flyby: Flyby, small: Small) -> None:
    path = small("MoveL Offs(p1,100,0,0), v500, fine, tool0", "MoveAbsJ home, v500, fine, tool0")
    result = flyby("check", path, "--robot", ROBOT)
    assert result.exit_code == 0
    assert "nothing found" in result.stdout


@pytest.mark.parametrize("robot", ["kuka/kr30-3", ROBOT])
def test_a_data_list_is_no_program(flyby: Flyby, robot: str) -> None:
    result = flyby("check", ROOT / "examples" / "seam.dat", "--robot", robot)
    assert result.exit_code == 1
    assert "seam.dat: a data list drives no robot: read the .src of the same name" in result.stderr
