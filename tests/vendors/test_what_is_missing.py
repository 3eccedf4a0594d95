"""What a program does not say, in every language: driven as far as it can be, and said."""

from __future__ import annotations

import pytest

from flyby.core.errors import SourceError
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor

ROBOTS = {"abb": "abb/irb1200-5-090", "kuka": "kuka/kr30-3", "ur": "ur/ur5e"}
HOME = {
    "abb": "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;",
    "kuka": "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}",
    "ur": "movej([0,-1.57,1.57,-1.57,-1.57,0])",
}
TO = {
    "abb": "MoveJ %s,v100,fine,tool0;",
    "kuka": "PTP %s",
    "ur": "movej(%s)",
}
POINT = {
    "abb": "[[450,0,%s],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]",
    "kuka": "{X 1300,Y 0,Z %s,A 0,B 90,C 0}",
    "ur": "p[-0.45,0.1,%s,2.2214,2.2214,0]",
}
HIGH = {"abb": "600", "kuka": "1000", "ur": "0.4"}
LOW = {"abb": "500", "kuka": "900", "ur": "0.3"}
CALL = {"abb": "OpenGripper 1;", "kuka": "OpenGripper(1)", "ur": "open_gripper(1)"}
NAMED = {"abb": "OpenGripper", "kuka": "OpenGripper", "ur": "open_gripper"}
FRAME = {
    "abb": "MODULE demo\nVAR num n;\nPROC main()\n{}\nENDPROC\nENDMODULE\n",
    "kuka": "DEF demo( )\nBAS(#INITMOV,0)\n{}\nEND\n",
    "ur": "def demo():\n{}\nend\n",
}
SUFFIX = {"abb": "demo.mod", "kuka": "demo.src", "ur": "demo.script"}
ASKED = {
    "abb": "n:=AInput(ai1);",
    "kuka": "n=$ANIN[1]",
    "ur": "n = get_standard_analog_in(1)",
}


def program(language: str, *lines: str) -> Program:
    text = FRAME[language].format("\n".join(lines))
    return find_vendor(language).read(text, SUFFIX[language], robot=find_robot(ROBOTS[language]))


def to(language: str, height: str) -> str:
    return TO[language] % (POINT[language] % height)


def heights(made: Program) -> list[float]:
    return [round(move.target.pose.position[2], 6) for move in made.moves[1:]]  # type: ignore[union-attr]


def said(made: Program) -> str:
    return " ".join(note.message for note in made.notes)


@pytest.fixture(params=["abb", "kuka", "ur"])
def language(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def both(language: str) -> list[float]:
    scale = 1 if language == "ur" else 1e-3
    return [scale * float(HIGH[language]), scale * float(LOW[language])]


def test_a_routine_whose_text_is_missing_is_stepped_over(language: str) -> None:
    lines = [to(language, HIGH[language]), CALL[language], to(language, LOW[language])]
    made = program(language, HOME[language], *lines)
    assert heights(made) == pytest.approx(both(language))
    assert NAMED[language] in said(made)


def test_a_move_to_a_point_that_is_missing_is_left_out(language: str) -> None:
    missing = TO[language] % "pMissing"
    lines = [to(language, HIGH[language]), missing, to(language, LOW[language])]
    made = program(language, HOME[language], *lines)
    assert heights(made) == pytest.approx(both(language))
    assert "pMissing" in said(made) and "left out" in said(made)


def test_what_a_signal_adds_counts_as_nothing(language: str) -> None:
    lines = [ASKED[language], to(language, HIGH[language] + "+n"), to(language, LOW[language])]
    made = program(language, HOME[language], *lines)
    assert heights(made) == pytest.approx(both(language))


def test_a_program_of_which_every_point_is_missing_names_one(language: str) -> None:
    with pytest.raises(SourceError, match="pMissing"):
        program(language, TO[language] % "pMissing", TO[language] % "pOther")
