"""What is typed is the same value whoever converts it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from flyby.cli.main import Command
from flyby.core.source.write.options import OpaqueStyle

TYPED = [
    [],
    ["--text", "a b", "--path", "x/../y"],
    ["--path", ""],
    ["--several", "a", "--several", "b/c", "--words", "1"],
    ["--whole", "3", "--real", "1e-3", "--style", "comment", "--yes"],
    ["--whole", "three"],
    ["--real", "x"],
    ["--style", "none"],
]


@pytest.mark.parametrize("typed", TYPED, ids=" ".join)
def test_values_are_those_of_typer(typed: list[str]) -> None:
    found: list[object] = []

    def command(
        file: Path,
        text: str | None = None,
        path: Path = Path("here"),
        several: list[Path] | None = None,
        words: list[str] | None = None,
        whole: int = 1,
        real: float = 0.5,
        style: OpaqueStyle = OpaqueStyle.COMMENT,
        yes: bool = False,
    ) -> None:
        found.append((file, text, path, several, words, whole, real, style, yes))

    told = []
    for kind in ({}, {"cls": Command}):
        app = typer.Typer()
        app.command(**kind)(command)
        for words in (["file", *typed], typed):
            result = CliRunner().invoke(app, words)
            told.append((result.exit_code, result.output, found.pop() if found else None))
    assert told[:2] == told[2:]
    assert told[1][0] == 2 and told[1][1]


def test_usual_commands_do_without_pydantic() -> None:
    code = (
        "import sys; from flyby.cli.main import app\n"
        "app(['robots', 'abb/irb6640-180-255'], standalone_mode=False)\n"
        "sys.exit('pydantic' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0 and "irb6640" in done.stdout.lower()
