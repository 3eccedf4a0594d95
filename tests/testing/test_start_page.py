"""docs/start.md: its commands run in their order, and print what the page shows."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from flyby.cli.main import app

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "start.md").read_text("utf-8")
SHOWN = re.findall(r"```sh\n(flyby [^\n]*)\n```\n\n```text\n(.*?)```", PAGE, re.DOTALL)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
SLACK = 0.02
"""Share by which a figure may differ on another machine."""


def test_the_page_runs_as_it_is_shown(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    assert len(SHOWN) == PAGE.count("```sh\n") == 4
    for command, shown in SHOWN:
        result = CliRunner().invoke(app, shlex.split(command)[1:])
        assert result.exit_code == (1 if "diff" in command else 0), result.output
        printed = [line for line in result.stdout.splitlines() if line.strip()]
        for line in filter(str.strip, shown.splitlines()):
            while printed and not alike(line, printed[0]):
                printed.pop(0)
            assert printed, f"{command} does not print: {line}"


def alike(shown: str, printed: str) -> bool:
    """Whether two lines have the same words, and all but the same numbers."""
    words = [" ".join(NUMBER.sub("#", line.replace("─", "")).split()) for line in (shown, printed)]
    values = [[float(n) for n in NUMBER.findall(line)] for line in (shown, printed)]
    return words[0] == words[1] and values[0] == pytest.approx(values[1], rel=SLACK, abs=0.02)


@pytest.mark.parametrize("other", [" 1 MoveL p 2.000", " 2 MoveJ p 2.000", " 1 MoveJ p 2.100"])
def test_another_line_is_told_apart(other: str) -> None:
    assert alike(" 1  MoveJ p 2.000", " 1 MoveJ   p 2.001")
    assert not alike(" 1 MoveJ p 2.000", other)
