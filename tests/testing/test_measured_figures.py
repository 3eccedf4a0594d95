"""Figures in the docs say when they were measured, and name commands that print them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
HEADING = re.compile(r"^#+ ", re.MULTILINE)
COSTS = re.compile(r"(?m)^(?=.*\d).*(\bCPU\b|[Ww]all[- ]time|\bwall s\b).*$")
MEASURED = re.compile(r"^Measured (\d{4}-\d\d-\d\d) at `([0-9a-f]{7,40})`: (.*?)$", re.MULTILINE)
COMMAND = re.compile(r"`(?:\S+=\S+ )?python (benchmarks/\w+\.py)([^`]*)`")


def sections() -> list[tuple[str, str]]:
    """Place and text of each section of every page that tells times of CPU or wall."""
    found = []
    for page in PAGES:
        for text in HEADING.split(page.read_text("utf-8")):
            if COSTS.search(text):
                found.append((f"{page.name}: {text.partition(chr(10))[0]}", text))
    return found


@pytest.mark.parametrize(("place", "text"), sections(), ids=lambda value: value.partition("\n")[0])
def test_times_say_when_they_were_measured(place: str, text: str) -> None:
    if place == "README.md: Measurements":  # what holds for all
        return
    assert MEASURED.search(text), f"{place}: a line 'Measured DATE at `COMMIT`: `COMMAND`.'"


def test_commands_are_there() -> None:
    """Scripts exist, and so do their cases and options."""
    seen = 0
    for page in PAGES:
        for line in MEASURED.finditer(page.read_text("utf-8")):
            commands = COMMAND.findall(line[3])
            assert commands or "by hand" in line[3], line[0]
            for script, words in commands:
                source = (ROOT / script).read_text("utf-8")
                for case in re.findall(r"--case (\S+)", words):
                    assert case in source, line[0]
                for option in re.findall(r"--([a-z]+)", words):
                    assert option == "case" or option in source, line[0]
                seen += 1
    assert seen > 10
