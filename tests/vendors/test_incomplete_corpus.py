"""Programs of the corpus of which parts are missing: driven at the first command.

``moves`` of the index are those that are driven: others go to what nobody knows.
"""

import tomllib
from pathlib import Path
from typing import Any

import pytest

import flyby

CORPUS = Path(__file__).parents[1] / "corpus"
PROGRAMS = [
    (index.parent, entry)
    for index in sorted(CORPUS.glob("*/incomplete/index.toml"))
    for entry in tomllib.loads(index.read_text("utf-8"))["program"]
]


@pytest.mark.parametrize(("folder", "entry"), PROGRAMS, ids=lambda value: str(value)[-60:])
def test_it_is_driven_at_the_first_command(folder: Path, entry: dict[str, Any]) -> None:
    program = flyby.read(folder / entry["file"], robot=entry["robot"])
    messages = " ".join(note.message for note in program.notes)
    for said in entry["says"]:
        assert said in messages
    run = flyby.emulate(program)
    assert len(program.moves) - len(run.faults) == entry["moves"]
    assert run.duration > 0 or not program.moves


@pytest.mark.parametrize(("language", "least"), [("krl", 25), ("urscript", 20), ("rapid", 8)])
def test_there_are_enough(language: str, least: int) -> None:
    assert sum(folder.parent.name == language for folder, _ in PROGRAMS) >= least
