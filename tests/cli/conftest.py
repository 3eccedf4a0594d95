"""The command line under test, and small programs to give it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from flyby.cli.main import app

from .box_program import CELL

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"
UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
MODULE = """MODULE Small
  CONST jointtarget home := [[0,0,0,0,90,0],{unused}];
  CONST robtarget p1 := [[1300,100,900],[0,0,1,0],[0,0,0,0],{unused}];
  PROC main()
    MoveJ p1, v1000, fine, tool0;
{moves}
  ENDPROC
ENDMODULE
"""

Flyby = Callable[..., Result]


@pytest.fixture
def flyby() -> Flyby:
    """Runs ``flyby`` with the arguments given."""
    runner = CliRunner()
    return lambda *words: runner.invoke(app, [str(word) for word in words])


@pytest.fixture
def small(tmp_path: Path) -> Callable[..., Path]:
    """Writes a RAPID program that begins at p1 and goes on with the lines given."""

    def write(*moves: str) -> Path:
        path = tmp_path / "small.mod"
        text = "\n".join(f"    {move};" for move in moves)
        path.write_text(MODULE.format(unused=UNUSED, moves=text), "ascii")
        return path

    return write


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    """The file of the cell with the box."""
    path = tmp_path / "cell.toml"
    path.write_text(CELL, "utf-8")
    return path
