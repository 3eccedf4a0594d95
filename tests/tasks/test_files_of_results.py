"""What Python writes of a result: proven, read back, and over nothing that was read."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

import flyby
from flyby.cli.main import app
from flyby.core.errors import InputError
from flyby.core.program.target import JointTarget
from flyby.problems.improve.zones.maximize import ZoneSolution

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"


@pytest.fixture
def square(tmp_path: Path) -> Path:
    """A file that is called as its module is, and so as what is written of it."""
    folder = tmp_path / "own"
    folder.mkdir()
    path = folder / "Square.mod"
    path.write_bytes((ROOT / "examples/square.mod").read_bytes())
    return path


def larger(path: Path) -> ZoneSolution:
    made = flyby.zones(flyby.read(path, robot=ROBOT), no_floor=True)
    assert made.changed and made.proven
    return made


def test_a_solution_takes_the_place_of_its_files(square: Path) -> None:
    made = larger(square)
    before = square.read_bytes()
    with pytest.raises(InputError, match="give its solution"):
        flyby.patch(made.program, in_place=True)
    with pytest.raises(InputError, match="not proven"):
        flyby.patch(replace(made, certificate=None), in_place=True)
    assert flyby.patch(replace(made, program=made.original), in_place=True) == ()
    assert square.read_bytes() == before
    assert flyby.patch(made, in_place=True) == (square,)
    assert square.read_bytes() == next(iter(made.texts.values())).data != before
    assert flyby.emulate(flyby.read(square, robot=ROBOT)).duration == made.after.time
    assert made.after.time < made.before.time


def test_nothing_goes_in_place_that_other_code_depends_on(square: Path) -> None:
    text = square.read_text("ascii")
    unused = "  PROC unused()\n    MoveAbsJ home, v100, fine, tool0;\n  ENDPROC\nENDMODULE"
    square.write_text(text.replace("ENDMODULE", unused), "ascii")
    before = square.read_bytes()
    program = flyby.read(square, robot=ROBOT)
    other = JointTarget((0.1, 0.0, 0.0, 0.0, 1.5, 0.0))
    moves = [
        replace(move, target=other) if isinstance(move.target, JointTarget) else move
        for move in program.moves
    ]
    changed = program.with_moves(tuple(moves))
    assert changed != program
    with pytest.raises(InputError, match="code that was not driven uses changed data"):
        flyby.patch(changed, in_place=True)
    assert square.read_bytes() == before
    (file,) = flyby.patch(changed, out=square.parent / "new")
    assert file.read_bytes() != before


def test_results_are_not_written_over_what_they_were_made_of(square: Path) -> None:
    program, before = flyby.read(square, robot=ROBOT), square.read_bytes()
    translation = flyby.translate(program, robot="abb/irb6640-235-255")
    for made in (flyby.record(program), translation, program):
        with pytest.raises(InputError, match="would overwrite"):
            flyby.write(made, square.parent, force=True)
        assert square.read_bytes() == before
        assert flyby.write(made, square.parent.parent / "new", force=True)
    (file,) = flyby.write(translation, square.parent.parent / "new", force=True)
    moves = flyby.read(file, robot="abb/irb6640-235-255").moves
    assert len(moves) == len(translation.program.moves)


@pytest.mark.parametrize(
    "words",
    [
        ("zones", "square.mod", "--clearance=-3"),
        ("identify", "logs", "--workers", "0"),
        ("pareto", "square.mod", "--no-floor"),
    ],
)
def test_wrong_arguments_have_a_status_of_their_own(words: tuple[str, ...]) -> None:
    made = CliRunner().invoke(app, [*words, "--robot", ROBOT])
    assert made.exit_code == 2, made.stderr
