"""The command line under test, and small programs to give it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from flyby.cli.main import app

from ..tasks.conftest import small  # noqa: F401  a fixture of these tests too
from .box_program import CELL

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"
Flyby = Callable[..., Result]


@pytest.fixture
def flyby() -> Flyby:
    """Runs ``flyby`` with the arguments given."""
    runner = CliRunner()
    return lambda *words: runner.invoke(app, [str(word) for word in words])


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    """The file of the cell with the box."""
    path = tmp_path / "cell.toml"
    path.write_text(CELL, "utf-8")
    return path
