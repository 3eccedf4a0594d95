"""Commands that pages show with words in the place of the reader's own files.

Those that can are run, with a file of the examples in the place of each word; of all others the
command and its options exist, and the reason is said here why they are not run.
"""

from __future__ import annotations

import re
import shlex
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import Result

from flyby.cli.main import app

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
WORD = re.compile(r"\b[A-Z]{3,}|[\[…]")
USAGE = "docs/reference/cli.md"
"""Its commands show how options go together, with all of them in brackets."""
TWO_JOINTS = {
    "PROGRAM": "examples/cell/two_joints.mod",
    "CELL": "examples/cell/two_joints.toml",
}
STAND_INS = {
    "docs/examples.md": {},
    "docs/guides/answers.md": {"PROGRAM.mod": "examples/deburring.mod"},
    "docs/guides/backups.md": {"STATION": "examples/station", "T_ROB2": "T_ROB1"},
    "docs/guides/diff.md": {
        **{"MONDAY": "examples/cell/two_joints.mod", "TUESDAY": "examples/cell/two_joints.mod"},
        **{"OLD.mod": "examples/square.mod", "NEW.mod": "examples/square.mod"},
        "cell.toml": "examples/cell/two_joints.toml",
    },
    "docs/guides/zones.md": TWO_JOINTS,
}
"""By page, what stands for its words."""
FURTHER = {
    "flyby emulate examples/station": ["--entry", "Pick"],
    "flyby check examples/station --task T_ROB1": ["--entry", "Pick"],
    "flyby diff examples/cell/two_joints.mod examples/cell/two_joints.mod": [
        *("--robot", "abb/irb6640-180-255"),
    ],
    "flyby diff examples/cell/two_joints.mod examples/cell/two_joints.mod --markdown": [
        *("--robot", "abb/irb6640-180-255"),
    ],
}
"""What a file of the examples asks for that the page's own does not."""
NOT_RUN = {
    "flyby experiment --cell CELL": "designs an hour of runs: by tests of experiments, shorter",
    "flyby identify LOGS": "fits for minutes: by tests of fits, on logs that are made there",
    "flyby emulate PROGRAM --robot ROBOT --motion mine.toml": "takes what identify would write",
    "flyby place PROGRAM --cell CELL --order": "by tests of orders, with tasks that are made there",
    "flyby station STATION": "shows all options in brackets; the line above it is run",
}


def shown() -> list[tuple[str, str]]:
    found = []
    for document in DOCUMENTS:
        name = document.relative_to(ROOT).as_posix()
        for block in re.findall(r"```sh\n(.*?)```", document.read_text("utf-8"), re.DOTALL):
            for line in block.splitlines():
                command = line.split("#")[0].strip()
                if command.startswith("flyby ") and WORD.search(command):
                    found.append((name, command))
    return found


def reason(name: str, command: str) -> str | None:
    if name == USAGE:
        return "usage"
    return next((why for begin, why in NOT_RUN.items() if command.startswith(begin)), None)


RUN = [one for one in shown() if reason(*one) is None]


def test_every_command_is_run_or_says_why_not() -> None:
    assert {name for name, _ in RUN} == set(STAND_INS)
    commands = [command for _, command in shown()]
    assert all(any(command.startswith(begin) for command in commands) for begin in NOT_RUN)


@pytest.mark.parametrize(("name", "command"), shown(), ids=lambda one: one[:60])
def test_a_command_and_its_options_exist(name: str, command: str) -> None:
    known = get_command(app).commands  # type: ignore[attr-defined]
    own = known[command.split()[1]]
    options = {option for parameter in own.params for option in parameter.opts}
    assert set(re.findall(r"--[a-z][a-z-]+", command)) <= options


@pytest.mark.parametrize("number", range(len(RUN)), ids=lambda k: RUN[k][1][:70])
def test_a_command_with_files_of_the_examples_runs(
    flyby: Callable[..., Result], monkeypatch: pytest.MonkeyPatch, tmp_path: Path, number: int
) -> None:
    name, command = RUN[number]
    # A copy: some write in place.
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    (tmp_path / "answers.toml").write_text("", "utf-8")
    monkeypatch.chdir(tmp_path)
    words = [STAND_INS[name].get(word, word) for word in shlex.split(command)]
    words += FURTHER.get(" ".join(words), [])
    if "--out" in words and words[words.index("--out") + 1] == "answers.toml":
        words.append("--force")
    result = flyby(*words[1:])
    assert result.exit_code == 0, result.output
