"""Programs of the corpus of which parts are missing: driven at the first command."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.registry import find_robot, find_vendor

CORPUS = Path(__file__).parents[1] / "corpus"
PROGRAMS = [
    (index.parent, entry)
    for index in sorted(CORPUS.glob("*/incomplete/index.toml"))
    for entry in tomllib.loads(index.read_text("utf-8"))["program"]
]


@pytest.mark.parametrize(("folder", "entry"), PROGRAMS, ids=lambda value: str(value)[-60:])
def test_it_is_driven_at_the_first_command(folder: Path, entry: dict[str, Any]) -> None:
    robot = find_robot(entry["robot"])
    vendor = find_vendor(entry["robot"].partition("/")[0])
    program = vendor.read_file(folder / entry["file"], robot=robot)
    assert len(program.moves) == entry["moves"]
    messages = " ".join(note.message for note in program.notes)
    for said in entry["says"]:
        assert said in messages
    assert Controller(vendor, robot).run(program).duration > 0


@pytest.mark.parametrize("language", ["krl", "urscript"])
def test_there_are_enough(language: str) -> None:
    assert sum(folder.parent.name == language for folder, _ in PROGRAMS) >= 15
