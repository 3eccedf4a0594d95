"""A user's own motion file: by option, and by the cell."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from flyby.cli.main import app
from flyby.core.cell.file import load_cell
from flyby.core.registry import find_robot, find_vendor, installed

ROBOT = "abb/irb1200-5-090"
PROGRAM = """MODULE m
PROC main()
MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
MoveAbsJ [[40,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
ENDPROC
ENDMODULE
"""


@pytest.fixture
def files(tmp_path):
    (tmp_path / "p.mod").write_text(PROGRAM, "utf-8")
    (tmp_path / "own.toml").write_text(f"robot = '{ROBOT}'\n[time]\nsmoothing_s = 0.2\n", "utf-8")
    (tmp_path / "other.toml").write_text("robot = 'abb/irb1600-6-145'\n", "utf-8")
    (tmp_path / "cell.toml").write_text(f"robot = '{ROBOT}'\nmotion = 'own.toml'\n", "utf-8")
    return tmp_path


def _duration(*options: str) -> float:
    result = CliRunner().invoke(app, ["emulate", *options, "--json"])
    assert result.exit_code == 0, result.output
    return float(json.loads(result.stdout)["cycle_time_s"])


def test_it_is_used_by_option_and_by_cell(files) -> None:
    program = str(files / "p.mod")
    plain = _duration(program, "--robot", ROBOT)
    by_option = _duration(program, "--robot", ROBOT, "--motion", str(files / "own.toml"))
    by_cell = _duration(program, "--cell", str(files / "cell.toml"))
    vendor = find_vendor("abb")
    before = sum(vendor.motion_of(find_robot(ROBOT)).smoothing)
    assert by_option - plain == pytest.approx(0.2 - before, abs=0.005)
    assert by_cell == by_option


def test_another_robots_is_refused(files) -> None:
    result = CliRunner().invoke(
        app,
        ["emulate", str(files / "p.mod"), "--robot", ROBOT, "--motion", str(files / "other.toml")],
    )
    assert result.exit_code != 0
    assert "irb1600-6-145" in result.output and "other.toml" in result.output


def test_a_cell_without_one_leaves_the_vendor_alone(files) -> None:
    (files / "plain.toml").write_text(f"robot = '{ROBOT}'\n", "utf-8")
    cell = load_cell(files / "plain.toml", installed())
    assert cell.find_vendor(installed()) is find_vendor("abb")
