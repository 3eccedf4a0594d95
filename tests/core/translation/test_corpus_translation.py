"""The corpus' programs on other vendors' robots: translated, or refused with move and line."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers_file import load_answers
from flyby.core.spatial.pose import Pose
from flyby.core.translation.translate import translate

CORPUS = Path(__file__).parents[2] / "corpus"
ROBOTS = {
    "abb": ("abb/irb1600-6-145", "abb/irb6640-180-255"),
    "kuka": ("kuka/kr30-3",),
    "ur": ("ur/ur10e",),
}
PLACES = {
    "abb": ((0.0, 0.0, 0.0), (-0.6, 0.0, -0.3)),
    "kuka": ((0.0, 0.0, 0.0), (-0.6, 0.0, -0.3), (-0.8, 0.0, 0.0), (0.6, 0.0, 0.4)),
    "ur": ((0.0, 0.0, 0.0), (0.9, 0.0, 0.5), (0.6, 0.0, 0.4)),
}
"""m; where a new robot may stand so that it reaches."""
MOST = 100
"""Moves of a program that are translated; what follows is more of the same: time."""
TOO_FAR = {
    ("palletising.mod", "ur"),
    ("box_sorter.mod", "ur"),
    ("SpotMain.mod", "ur"),
    ("kleberaupe.script", "kuka"),
    ("palettieren.src", "ur"),
}
"""What no place of the new arm reaches, or not without a line through a singular wrist."""


def entries() -> list[tuple[str, dict]]:
    found = []
    for index in sorted(CORPUS.glob("*/index.toml")):
        table = tomllib.loads(index.read_text("utf-8"))
        found += [(index.parent.name, entry) for entry in table["program"]]
    return found


def others(robot: str) -> list[str]:
    return [new for new in ROBOTS if not robot.startswith(new)]


CASES = [
    pytest.param(language, entry, new, id=f"{Path(entry['file']).name}-{new}")
    for k, (language, entry) in enumerate(entries())
    for new in others(entry["robot"])[k % 2 : k % 2 + 1]
]
"""Each program on one other make, in turns: time."""


@cache
def read(language: str, file: str, robot: str, answers: str | None, others: tuple[str, ...]):
    folder = CORPUS / language
    vendor = find_vendor(robot.split("/")[0])
    given = None if answers is None else load_answers(folder / answers)
    return vendor.read_file(
        folder / file, None, find_robot(robot), given, [folder / other for other in others]
    )


@pytest.mark.parametrize(("language", "entry", "new"), CASES)
def test_a_program_is_translated_or_refused_with_its_line(
    language, entry, new, tmp_path: Path
) -> None:
    old = entry["robot"]
    program = read(
        language, entry["file"], old, entry.get("answers"), tuple(entry.get("others", ()))
    )
    program = beginning(program)
    refusals = []
    for place, name in ((place, name) for place in PLACES[new] for name in ROBOTS[new]):
        try:
            made = translate(program, side(old), side(name), Pose(place))
        except MotionError as error:
            refusals.append(error)
            continue
        check_moves(made, program)
        check_files(made, *side(name), tmp_path)
        return
    assert (Path(entry["file"]).name, new) in TOO_FAR, refusals[0]
    for error in refusals:
        assert error.span is not None
        assert re.search(r":\d+:\d+: move \d+: ", str(error))


def beginning(program: Program) -> Program:
    moves = [i for i, s in enumerate(program.statements) if isinstance(s, MoveJ | MoveL | MoveC)]
    return replace(program, statements=program.statements[: [*moves, None][: MOST + 1][-1]])


def side(name: str):
    return find_vendor(name.split("/")[0]), find_robot(name)


def check_moves(made, program) -> None:
    left_out = {note.span for note in made.losses if "left out, as" in note.message}
    kept = [move for move in program.moves if move.origin.statement not in left_out]
    assert len(made.program.moves) >= len(kept)
    lost = [note for note in made.losses if note.span is None]
    assert not lost, f"losses without a line: {lost[:3]}"


def check_files(made, vendor, robot, folder: Path) -> None:
    """What was written is read again, and drives alike."""
    for file, text in vendor.write(made.program, robot).items():
        assert text.isascii()
        (folder / file).write_text(text, "ascii", newline="")
    (main,) = (path for path in folder.iterdir() if path.suffix in vendor.suffixes)
    again = vendor.read_file(main, robot=robot)
    assert [type(move) for move in again.moves] == [type(move) for move in made.program.moves]
    controller = Controller(vendor, robot)
    runs = [controller.run(p, made.start) for p in (made.program, again)]
    assert runs[0].duration == pytest.approx(runs[1].duration, rel=1e-3)
    ends = [run.trajectory.q[-1] for run in runs]
    assert ends[0] == pytest.approx(ends[1], abs=1e-5)
