"""Every command that takes a program says which robot it takes, where nobody names one."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Flyby = Callable[..., Result]
SMALL = """MODULE m
CONST robtarget p1:=[[1000,0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p3:=[[1100,300,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p2:=[[1000,300,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
MoveJ p1,v500,fine,tool0;
MoveL p2,v500,z5,tool0;
MoveL p3,v500,fine,tool0;
ENDPROC
ENDMODULE
"""
TAKEN = "nobody says which robot it is: abb/"


@pytest.fixture
def small(tmp_path: Path) -> Path:
    path = tmp_path / "m.mod"
    path.write_text(SMALL, "utf-8")
    return path


@pytest.mark.parametrize("words", [["check"], ["zones"], ["view", "--no-browser"]])
def test_commands_that_write_no_program_take_one(flyby: Flyby, small: Path, words) -> None:
    name, *more = words
    result = flyby(name, small, *more)
    assert result.exit_code == 0, result.stderr
    assert result.stderr.count(TAKEN) == 1


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (["zones", "--in-place"], "--robot"),
        (["optimize", "--out", "new"], "--robot"),
        (["pareto", "--out", "new"], "--robot"),
        (["translate", "--robot", "ur/ur10e"], "--from"),
    ],
)
def test_commands_that_write_one_say_the_option(flyby: Flyby, small: Path, words, option) -> None:
    before = small.read_bytes()
    name, *more = words
    result = flyby(name, small, *more)
    assert result.exit_code == 2
    found = re.search(rf"say it, {option} (abb/\S+) if it is this one", result.stderr)
    assert found is not None
    assert small.read_bytes() == before and not (small.parent / "new").exists()
