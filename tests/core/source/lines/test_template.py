"""The language that ``flyby new-vendor`` writes: its course, its errors, its patches."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from flyby.core.errors import FlybyError, SourceError
from flyby.core.program.move import Move, MoveJ, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions

TEMPLATE = Path(__file__).parents[4] / "testing" / "skeleton" / "language.py.txt"
ROBOT: Any = None


@pytest.fixture(scope="module")
def language() -> Iterator[Any]:
    module = sys.modules["template"] = ModuleType("template")
    text = TEMPLATE.read_text("utf-8").replace("@NAME@", "ACME").replace("@name@", "acme")
    exec(compile(text, str(TEMPLATE), "exec"), vars(module))
    yield vars(module)["Language"]()
    del sys.modules["template"]


HOME = JointTarget((0.0, 0.1, 0.2, 0.0, 0.9, 0.0))
HALF = Speed(joint_fraction=0.5)


@pytest.mark.parametrize(
    "move",
    [
        MoveJ(HOME, Speed(tcp=0.5)),
        MoveJ(HOME, HALF, Radius(0.01, 0.02)),
        MoveJ(HOME, HALF, FINE, Tool("gun", load=None, robot_held=False)),
        MoveJ(JointTarget(HOME.joints, (1.0,)), HALF),
    ],
)
def test_what_the_language_cannot_say_is_refused(language: Any, move: Move) -> None:
    with pytest.raises(FlybyError, match="ACME"):
        language.write(Program((move,)), ROBOT, {})


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("WAIT 1\nMOVEX 1\n", r"job:2:1: 'MOVEX 1' is no ACME statement: this form of a motion"),
        ("WAIT 1 +\n", r"job:1:9: a number or a datum should stand here"),
        ("JUMP on\n", r"job:1:1: there is no label ON"),
        ("MOVEJ P[2] 50 STOP\n", r"unknown point 'P\[2\]': define it"),
        ("MOVEJ DI[1] 50 STOP\n", "'MOVEJ DI"),
        ("POINT P[1] 0 0 R[9] 0 0 0\nMOVEJ P[1] 50 STOP\n", r"depends on R\[9\]: answer it in"),
        ("LABEL a\nLABEL a\n", "two labels A"),
    ],
)
def test_an_error_says_where(language: Any, lines: str, said: str) -> None:
    with pytest.raises(SourceError, match=said):
        language.read(lines, "job", ReadOptions())


JOB = """\
POINT P[1] 0 10 20 0 90 0
POINT P[2] 10 10 20 0 90 0
POINT P[3] 0 10 R[1] 0 90 0
R[1] = 0
LABEL again
MOVEJ P[1] 50 STOP
IF DI[1] = ON JUMP over
MOVEJ P[3] 50 STOP
DO[1] = ON
LABEL over
R[1] = R[1] + 1
IF R[1] < 3 JUMP again
WAIT DI[2] = ON
MOVEJ P[2] 50 PASS 10
"""


def test_jumps_registers_and_points_are_carried_out(language: Any) -> None:
    program = language.read(JOB, "job", ReadOptions(answers=Answers(values={"di[1]": False})))
    thirds = [round(move.target.joints[2] * 57.29577951) for move in program.moves]
    assert thirds == [20, 0, 20, 1, 20, 2, 20]
    kept = [o.text for o in program.statements if isinstance(o, Opaque)]
    assert kept == [*["DO[1] = ON"] * 3, "WAIT DI[2] = ON"]


def test_answers_decide_what_the_lines_leave_open(language: Any) -> None:
    answers = Answers(values={"di[1]": True})
    assert len(language.read(JOB, "job", ReadOptions(answers=answers)).moves) == 4
    notes = " ".join(note.message for note in language.read(JOB, "job", ReadOptions()).notes)
    assert "the condition depends on DI[1]: " in notes


ENDLESS = "LABEL again\nMOVEJ P[1] 50 STOP\n{}JUMP again\nLABEL out\nPOINT P[1] 0 0 0 0 90 0\n"


@pytest.mark.parametrize(
    ("way_out", "said"),
    [
        ("", "the program is an endless loop (JUMP again): one pass is read"),
        ("IF DI[1] = ON JUMP out\n", "its body runs once, and then this way out is taken"),
    ],
)
def test_a_jump_back_that_nothing_known_ends_is_read_once(
    language: Any, way_out: str, said: str
) -> None:
    program = language.read(ENDLESS.format(way_out), "job", ReadOptions())
    assert len(program.moves) == 1
    assert any(said in note.message for note in program.notes)


def moved(program: Program, index: int, third: float) -> Program:
    moves = list(program.moves)
    target = moves[index].target
    assert isinstance(target, JointTarget)
    joints = (*target.joints[:2], third, *target.joints[3:])
    moves[index] = replace(moves[index], target=JointTarget(joints))
    return program.with_moves(tuple(moves))


def test_a_number_is_changed_where_it_stands(language: Any) -> None:
    program = language.read(JOB, "job", ReadOptions())
    changed = moved(program, len(program.moves) - 1, 0.5)
    (file,) = language.patch(changed, ROBOT, {}).values()
    assert file.text == JOB.replace("P[2] 10 10 20", "P[2] 10 10 28.647889757")


def test_a_shared_point_is_changed_for_all_or_for_none(language: Any) -> None:
    text = ENDLESS.format("MOVEJ P[1] 50 PASS 10\n")
    program = language.read(text, "job", ReadOptions())
    changed = moved(program, 1, 0.3)
    with pytest.raises(FlybyError, match=r"P\[1\] is read by move 1 as well"):
        language.patch(changed, ROBOT, {})
    with pytest.raises(FlybyError, match="a position of its own is not put in"):
        language.patch(changed, ROBOT, {"shared": "own"})
