"""What the README says is true."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import Result

from flyby.cli.main import app

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]


def test_the_main_command_runs(
    flyby: Callable[..., Result], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (line,) = re.findall(r"\.venv/bin/flyby (emulate .*)", README)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    result = flyby(*shlex.split(line))
    assert result.exit_code == 0, result.output
    written = {path.name for path in tmp_path.iterdir()} - {"examples"}
    assert written == {"path.png", "path.csv", "cleaned.mod"}


def shown_commands() -> list[str]:
    """Commands of all documents that are meant as they stand: without PLACEHOLDERS and comments."""
    blocks = [
        block
        for document in DOCUMENTS
        if document.name != "start.md"  # by tests/testing/test_start_page.py, in its order
        for block in re.findall(r"```sh\n(.*?)```", document.read_text("utf-8"), re.DOTALL)
    ]
    lines = [line.split("#")[0].strip() for block in blocks for line in block.splitlines()]
    commands = [line for line in lines if line.startswith("flyby ")]
    return [line for line in commands if not re.search(r"\b[A-Z]{3,}|[\[…]", line)]


@pytest.mark.parametrize("command", sorted(set(shown_commands())))
def test_a_command_that_is_shown_runs(
    command: str, flyby: Callable[..., Result], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    words = shlex.split(command)[1:]
    result = flyby(*words)
    assert result.exit_code == 0, result.output
    if "--out" in words:
        assert any((tmp_path / words[words.index("--out") + 1]).iterdir())


def test_there_is_one_test_command_for_ci() -> None:
    assert len(re.findall(r"^python -m venv .*pytest$", README, re.MULTILINE)) == 1


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(document: Path) -> None:
    for link, anchor in re.findall(r"\]\(([^)#:]*)#?([^)#:]*)\)", document.read_text("utf-8")):
        page = document.parent / link if link else document
        assert page.exists(), link
        if anchor:
            headings = re.findall(r"(?m)^#+ (.*)$", page.read_text("utf-8"))
            anchors = [re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-") for text in headings]
            assert anchor in anchors, f"{link}#{anchor}"


def sections() -> dict[str, str]:
    """The page of the command line by its headings; under "" what holds for all commands."""
    text = (ROOT / "docs" / "reference" / "cli.md").read_text("utf-8")
    parts = re.split(r"(?m)^## (.*)$", text)
    return {"": parts[0], **dict(zip(parts[1::2], parts[2::2], strict=True))}


@pytest.mark.parametrize("command", sorted(get_command(app).commands))
def test_a_command_is_documented_where_its_name_stands(command: str) -> None:
    """Its section leads to all its options, which are listed once, and names none that is gone."""
    commands, shown = get_command(app).commands, sections()[f"flyby {command}"]
    every = {o for one in commands.values() for p in one.params for o in p.opts}
    assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", shown)) <= every | {"--help"}
    generated = (ROOT / "docs" / "reference" / "commands.md").read_text("utf-8")
    listed = re.split(r"(?m)^## ", generated)
    (own,) = [part for part in listed if part.startswith(f"flyby {command}\n")]
    options = {o for p in commands[command].params for o in p.opts if o.startswith("--")}
    assert options - {"--help"} <= set(re.findall(r"--[a-z-]+", own))
    if "| option | meaning |" in own and options:
        assert f"(commands.md#flyby-{command})" in shown or not re.search(r"(?m)^- `--", shown)
        assert "| option | meaning |" not in shown
