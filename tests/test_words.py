"""The words of docs/terms.md are used, not the private ones that they replaced."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
REPLACED = {
    r"bystanders?": "code not executed",
    r"belongings?|belonging": "compatibility of a log",
    r"tearing": "torn samples",
    r"workshops?|crews?": "worker pool; solve, round, verify",
    r"class bench": "worker pool",
    r"strays|strayed": "deviation, deviation bounds",
    r"pays?": "saves; is kept if it saves more than",
    r"(?:is|are|was|were|be|been|being) told(?! (?:apart|from))|told of|can be told": (
        "called with; is reported; options of"
    ),
    r"most telling": "most informative",
}
"""Pattern of words that are not used any more, and what stands in their place."""


def texts() -> list[Path]:
    """Code and docs, without the history of changes and without this file."""
    rooms = {path for path in ROOT.iterdir() if path.is_dir() and path.name[0] not in "._"}
    found = [path for room in rooms for path in room.rglob("*") if path.suffix in (".py", ".md")]
    found += [path for path in ROOT.glob("*.*") if path.suffix in (".py", ".md")]
    left_out = {ROOT / "CHANGELOG.md", Path(__file__)}
    generated = {"build", "dist", "node_modules"}
    return [
        path
        for path in sorted(found)
        if path not in left_out and not generated & set(path.relative_to(ROOT).parts)
    ]


TEXTS = {path.relative_to(ROOT): path.read_text("utf-8") for path in texts()}


@pytest.mark.parametrize("pattern", REPLACED)
def test_replaced_words_do_not_come_back(pattern: str) -> None:
    """A replaced word names its place and the word to write."""
    expression = re.compile(rf"\b(?:{pattern})\b", re.IGNORECASE)
    assert TEXTS
    found = [
        f"{path}:{number}: {line.strip()} (write: {REPLACED[pattern]})"
        for path, text in TEXTS.items()
        if expression.search(text)
        for number, line in enumerate(text.splitlines(), 1)
        if expression.search(line)
    ]
    assert not found, "\n".join(found)


def test_one_name_is_one_class() -> None:
    """Outside of the languages, whose words are each language's own, and of the checks."""
    left_out = {"vendors", "validation", "tests", "benchmarks", "examples"}
    places: dict[str, list[str]] = {}
    for path, text in TEXTS.items():
        if path.suffix != ".py" or path.parts[0] in left_out:
            continue
        if path.is_relative_to("core/source/lines"):
            continue  # a language too, the base of those that strangers add
        for name in re.findall(r"^class ([A-Z]\w*)", text, re.MULTILINE):
            places.setdefault(name, []).append(path.as_posix())
    assert len(places) > 500
    shared = {name: found for name, found in places.items() if len(found) > 1}
    # What a task hands out is what the core drove, with what tables and pictures add.
    assert shared.pop("Run") == ["core/motion/emulator/run.py", "tasks/results/runs.py"]
    assert not shared


def test_where_terms_live_exists() -> None:
    """The places that the page of terms names are there."""
    text = (ROOT / "docs" / "terms.md").read_text("utf-8")
    named = [
        place
        for line in text.splitlines()
        if line.startswith("|")
        for place in re.findall(r"`([\w*/]+(?:/|\.py))`", line.split("|")[3])
    ]
    assert len(named) > 20
    assert not [place for place in named if not list(ROOT.glob(place))]
