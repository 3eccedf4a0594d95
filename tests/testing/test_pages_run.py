"""Every Python block of README.md and docs/ runs, and every path that they name exists."""

from __future__ import annotations

import contextlib
import io
import re
import shutil
import sys
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from markdown_it import MarkdownIt

import flyby

ROOT = Path(__file__).parents[2]
DOCUMENTS = {
    str(page.relative_to(ROOT)): page.read_text("utf-8")
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
}
BLOCKS = {
    name: blocks
    for name, text in DOCUMENTS.items()
    if (blocks := re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE))
}
LANGUAGES = {"python", "sh", "toml", "text"}
"""Of code in pages. `sh` without placeholders is run by tests/cli/test_readme.py."""
ARM = "testing/skeleton/arm-1.toml.txt"
"""The robot that stands beside the plugin of a page."""
PARTS = (
    "benchmarks|cli|core|docs|drawing|examples|identification|problems|tasks|testing|tests|"
    "validation|vendors"
)
PATH = re.compile(rf"(?<![\w./…-])(?:{PARTS})/[\w./*-]*")


@dataclass(frozen=True)
class Ran:
    """What running a page left: lines that it printed, its folder and its names."""

    lines: list[str]
    folder: Path
    names: dict[str, Any]


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Ran]:
    """What running a page left; each is run once."""
    return cache(lambda page: _run(page, tmp_path_factory.mktemp("page")))


def _run(page: str, folder: Path) -> Ran:
    """All blocks of a page in order, in one namespace, in a folder with examples and logs."""
    (folder / "examples").symlink_to(ROOT / "examples")
    _log_square(folder / "logs")
    # Classes of a page look for the module that they stand in.
    module = sys.modules["page"] = ModuleType("page")
    names: dict[str, Any] = vars(module)
    arm = (ROOT / ARM).read_text("utf-8").replace("@name@", "acme")
    (folder / "arm-1.toml").write_text(arm, "utf-8")
    names["__file__"] = str(folder / "page.py")
    printed = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(printed):
        for block in BLOCKS[page]:
            exec(compile(block, page, "exec"), names)
    return Ran(printed.getvalue().splitlines(), folder, names)


def _log_square(folder: Path) -> None:
    """A program with a log beside it: its emulation by a clock that began 0.2 s earlier."""
    folder.mkdir()
    shutil.copy(ROOT / "examples" / "square.mod", folder)
    program = flyby.read(folder / "square.mod", robot="abb/irb6640-180-255")
    driven = flyby.emulate(program).trajectory
    columns = np.column_stack([driven.t + 0.2, driven.q])
    head = "t,q1,q2,q3,q4,q5,q6"
    np.savetxt(folder / "square.csv", columns, "%.9g", ",", header=head, comments="")


@pytest.mark.parametrize("page", BLOCKS)
def test_a_page_runs(page: str, ran: Callable[[str], Ran]) -> None:
    shows = any("print(" in block for block in BLOCKS[page])
    assert bool(ran(page).lines) == shows


@pytest.mark.parametrize("page", DOCUMENTS)
def test_code_is_fenced_and_names_its_language(page: str) -> None:
    """Indented code would be run by no test."""
    assert not list(code_outside_of_tests(DOCUMENTS[page]))


@pytest.mark.parametrize(
    "text",
    [
        "Indented:\n\n    import flyby\n",
        "- in a list:\n\n      import flyby\n",
        "```\nimport flyby\n```\n",
        "~~~ python\nimport flyby\n~~~\n",
        "```py\nimport flyby\n```\n",
        "- in a list:\n\n  ```python\n  import flyby\n  ```\n",
        "```text\n>>> import flyby\n```\n",
    ],
)
def test_code_that_would_not_run_is_found(text: str) -> None:
    assert list(code_outside_of_tests(text))


def code_outside_of_tests(text: str) -> Iterator[str]:
    """Code of a page that is indented, of no known language, or Python that `BLOCKS` misses."""
    for token in MarkdownIt().parse(text):
        if token.type == "code_block":
            yield f"line {token.map[0] + 1} is indented code: fence it"
        elif token.type == "fence":
            missed = token.info == "python" and (token.markup != "```" or token.level > 0)
            if missed or token.info not in LANGUAGES or ">>> " in token.content:
                yield f"line {token.map[0] + 1} is code that no test runs"


@pytest.mark.parametrize("page", DOCUMENTS)
def test_toml_that_is_shown_can_be_read(page: str) -> None:
    for token in MarkdownIt().parse(DOCUMENTS[page]):
        if token.info == "toml":
            tomllib.loads(token.content)


@pytest.mark.parametrize("page", BLOCKS)
def test_guides_use_the_front_door(page: str) -> None:
    """Other pages say it where they use inner parts; how to write a plugin is all about them."""
    inner = re.search(r"(?m)^(?:from|import) flyby\.", "\n".join(BLOCKS[page]))
    if page != "docs/guides/plugins.md" and inner:
        assert not page.startswith("docs/guides/") and page != "README.md"
        assert "inner parts of flyby" in re.sub(r"\s+", " ", DOCUMENTS[page])


def test_the_readme_reads_emulates_optimises_and_writes_in_ten_lines(
    ran: Callable[[str], Ran],
) -> None:
    (example,) = BLOCKS["README.md"]
    assert len([line for line in example.splitlines() if line]) <= 11
    emulated, _, optimised = ran("README.md").lines[:3]
    assert re.match(r"\d+\.\d{3} s; move 4 takes \d+\.\d{3} s: \w+", emulated)
    before, after = map(float, re.findall(r"(\d+\.\d{3}) s", optimised)[:2])
    assert after < before and "is proven" in optimised
    written = (ran("README.md").folder / "out").iterdir()
    assert [path.name for path in written] == ["two_joints.mod"]


def test_a_translation_is_written_in_the_language_of_its_robot(ran: Callable[[str], Ran]) -> None:
    written = (ran("docs/guides/translation.md").folder / "translated").iterdir()
    assert {path.suffix for path in written} == {".src", ".dat"}


def test_the_gradients_of_the_page_on_collisions_are_of_near_pairs(
    ran: Callable[[str], Ran],
) -> None:
    samples, pairs = ran("docs/reference/collision.md").names["which"]
    assert len(samples) == len(pairs) > 0


@pytest.mark.parametrize("page", DOCUMENTS)
def test_paths_that_are_named_exist(page: str) -> None:
    missing = [
        path
        for path in (found.rstrip(".") for found in PATH.findall(DOCUMENTS[page]))
        if not any(ROOT.glob(path.rstrip("/")))
    ]
    assert not missing


@pytest.mark.parametrize("page", DOCUMENTS)
def test_modules_that_are_named_without_a_folder_exist(page: str) -> None:
    """`via_selection.py` is found somewhere in a folder of the package."""
    named = set(re.findall(r"`(\w+\.py)`", DOCUMENTS[page]))
    assert named <= {path.name for part in PARTS.split("|") for path in (ROOT / part).rglob("*.py")}


def test_the_modules_of_the_emulator_are_in_their_folders() -> None:
    folder, seen = "", 0
    _, _, section = DOCUMENTS["docs/architecture.md"].partition("\n## The emulator, ")
    for line in section.partition("\n## ")[0].splitlines():
        if line.startswith("| "):
            _, where, modules = (cell.strip() for cell in line.strip("|").split("|"))
            folder = where.strip("`/") or folder
            for module in re.findall(r"`(\w+)`", modules):
                if module.islower():
                    assert (ROOT / "core" / "motion" / folder / f"{module}.py").exists(), module
                    seen += 1
    assert seen > 50
